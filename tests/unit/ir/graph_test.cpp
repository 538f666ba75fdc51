// The graph: one node for equal things, constants folded, identities applied, copies made where
// asked.
#include "ir/lower/lower.h"
#include "ir/passes/dump.h"
#include "ir/passes/fold.h"
#include "ir/passes/walk.h"
#include "ir/semantics.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::ir;

namespace {

// Turns constants into parameters, so that nothing is folded.
struct Unfolded {
    Graph g;
    test::Reference eval{g};
    NodeId hide(const Constant &c) {
        eval.params.push_back({c.value[0], c.value[1], c.value[2], c.value[3]});
        return g.param(static_cast<std::uint32_t>(eval.params.size() - 1), c.type);
    }
};

} // namespace

TEST_CASE("equal nodes are one") {
    Graph g;
    const NodeId x = g.component(g.point(), 0), y = g.component(g.point(), 1);
    CHECK(g.add(x, y) == g.add(x, y));
    CHECK(g.add(x, y) == g.add(y, x));
    CHECK(g.sub(x, y) != g.sub(y, x));
    CHECK(g.number(0.0) == g.number(-0.0));
    CHECK(g.number(1) != g.integer(1));
    CHECK(g.fresh_var(Type::Float) != g.fresh_var(Type::Float));
    CHECK(g.make(Op::Union, {x, y}) != g.make(Op::Union, {y, x})); // a tie shows the first
}

TEST_CASE("a million nodes stay one each") {
    Graph g;
    const NodeId x = g.component(g.point(), 0);
    const auto build = [&] {
        NodeId sum = x;
        for (int i = 1; i < 200000; ++i) sum = g.add(g.mul(sum, x), g.number(i));
        return sum;
    };
    const NodeId first = build();
    const std::size_t size = g.size();
    CHECK(build() == first);
    CHECK(g.size() == size);
    CHECK(g.reads(first).point);
}

TEST_CASE("identities") {
    Graph g;
    const NodeId p = g.point(), x = g.component(p, 0), y = g.component(p, 1), z = g.component(p, 2);
    const NodeId zero = g.number(0), one = g.number(1);
    CHECK(g.add(x, zero) == x);
    CHECK(g.sub(x, x) == zero);
    CHECK(g.mul(x, one) == x);
    CHECK(g.mul(x, zero) == zero);
    CHECK(g.mul(p, one) == p);
    CHECK(g.div(x, one) == x);
    CHECK(g.neg(g.neg(x)) == x);
    CHECK(g.sub(zero, x) == g.neg(x));
    CHECK(g.add(x, g.neg(y)) == g.sub(x, y));
    CHECK(g.make(Op::Min, {x, x}) == x);
    CHECK(g.make(Op::Abs, {g.neg(x)}) == g.make(Op::Abs, {x}));
    CHECK(g.make(Op::Pow, {x, g.number(2)}) == g.mul(x, x));
    CHECK(g.make(Op::Select, {g.boolean(true), x, y}) == x);
    CHECK(g.make(Op::Make, Type::Vec3, {x, y, z}) == p);
    CHECK(g.swizzle(p, std::array{0, 1, 2}) == p);
    CHECK(g.swizzle(g.swizzle(p, std::array{2, 1, 0}), std::array{0}) == z);
    CHECK(g.component(g.make(Op::Make, Type::Vec3, {y, x, z}), 0) == y);
    CHECK(g.component(g.splat(x, Type::Vec3), 2) == x);
    CHECK(g.make(Op::Union, {x}) == x);
    CHECK(g.make(Op::MatMul, Type::Vec3,
                 {g.constant({Type::Mat3, {1, 0, 0, 0, 1, 0, 0, 0, 1}}), p}) == p);
    // Not identities: they would change a value.
    CHECK(g.div(x, x) != one);
    CHECK(g.make(Op::Pow, {x, g.number(0.5)}) != g.make(Op::Sqrt, {x}));
}

TEST_CASE("folding agrees with the evaluation of the same op on inputs, for nasty arguments") {
    const double nasty[] = {
        0, 1, -1, 0.5, -0.5, 2, -2, 3, -3, 1.5, -2.5, 1e-9, 1e9, -1e9, 3.14159265358979};
    for (std::size_t k = 0; k < op_count; ++k) {
        const Op op = static_cast<Op>(k);
        const OpInfo &row = info(op);
        const bool plain = row.rule == TypeRule::Same && op != Op::Cross && op != Op::Transpose;
        if (!plain) continue;
        for (double a : nasty)
            for (double b : nasty) {
                const double c[] = {a, b, a * b};
                Unfolded u;
                std::vector<NodeId> constants, inputs;
                for (int i = 0; i < row.arity; ++i) {
                    const Constant value{Type::Float, {c[i]}};
                    constants.push_back(u.g.constant(value));
                    inputs.push_back(u.hide(value));
                }
                const double folded = u.eval.number(u.g.make(op, constants));
                const double computed = u.eval.number(u.g.make(op, inputs));
                CAPTURE(row.name, a, b);
                CHECK((folded == computed || (std::isnan(folded) && std::isnan(computed))));
            }
    }
}

TEST_CASE("ints saturate, and division by zero is 0") {
    Graph g;
    const auto value = [&](Op op, int a, int b) {
        return *g.as_number(g.make(op, {g.integer(a), g.integer(b)}));
    };
    CHECK(value(Op::Add, 2147483647, 1) == 2147483647);
    CHECK(value(Op::Mul, -2147483647, 2) == -2147483648.0);
    CHECK(value(Op::Sub, -2147483647 - 1, 1) == -2147483648.0);
    CHECK(value(Op::Div, 7, -2) == -3);
    CHECK(value(Op::Div, 7, 0) == 0);
    CHECK(value(Op::Div, -2147483647 - 1, -1) == 2147483647);
    CHECK(value(Op::Mod, -1, 3) == 2);
    CHECK(value(Op::Mod, 1, -3) == -2);
    CHECK(value(Op::Mod, 5, 0) == 5);
    CHECK(*g.as_number(g.make(Op::ToInt, Type::Int, {g.number(1e30)})) == 2147483647);
    CHECK(*g.as_number(g.make(Op::ToInt, Type::Int, {g.number(-2.9)})) == -2);
}

TEST_CASE("matrices: columns, products and transposes") {
    Unfolded u;
    const Constant m{Type::Mat2, {1, 2, 3, 4}}, v{Type::Vec2, {5, 6}};
    Graph &g = u.g;
    const auto numbers = [&](NodeId id) {
        const Constant c = u.eval(id);
        return std::vector<double>(c.value.begin(), c.value.begin() + components(c.type));
    };
    for (bool hidden : {false, true}) {
        const NodeId mn = hidden ? u.hide(m) : g.constant(m),
                     vn = hidden ? u.hide(v) : g.constant(v);
        CHECK(numbers(g.make(Op::MatMul, {mn, vn})) ==
              std::vector<double>{1 * 5 + 3 * 6, 2 * 5 + 4 * 6});
        CHECK(numbers(g.make(Op::MatMul, {vn, mn})) ==
              std::vector<double>{1 * 5 + 2 * 6, 3 * 5 + 4 * 6});
        CHECK(numbers(g.make(Op::MatMul, {mn, mn})) == std::vector<double>{7, 10, 15, 22});
        CHECK(numbers(g.make(Op::Transpose, {mn})) == std::vector<double>{1, 3, 2, 4});
        CHECK(numbers(g.make(Op::Column, Type::Vec2, {mn}, 1)) == std::vector<double>{3, 4});
    }
}

TEST_CASE("what a node reads") {
    Graph g;
    const NodeId x = g.component(g.point(), 0), v = g.fresh_var(Type::Float);
    CHECK(g.reads(g.add(x, g.time())).time);
    CHECK(!g.reads(g.add(x, g.time())).params);
    CHECK(g.reads(g.add(x, v)).free_vars);
    CHECK(g.free_vars(g.mul(g.add(x, v), v)) == std::vector{v});

    Function f{"f", {}, {v}, g.mul(v, g.param(0, Type::Float))};
    const NodeId call = g.call(g.add_function(f), std::array{x});
    CHECK(g.reads(call).params);
    CHECK(g.reads(call).point);
    CHECK(!g.reads(call).free_vars);
}

namespace {
// x + 1*y + 2*y + … as a loop: for i < n: acc = acc + i*y
NodeId loop(Graph &g, NodeId count, NodeId start, NodeId y) {
    Loop record;
    record.count = count;
    record.index = g.fresh_var(Type::Int);
    record.vars = {g.fresh_var(Type::Float), g.fresh_var(Type::Float)};
    record.next = {g.add(record.vars[0], g.mul(g.make(Op::ToFloat, {record.index}), y)),
                   g.add(record.vars[1], g.number(1))};
    record.condition = g.make(Op::Less, {record.vars[0], g.number(100)});
    record.max_count = 10;
    return g.make(Op::Loop, Type::Float, {start, g.number(0)}, g.add_loop(record).index);
}
} // namespace

TEST_CASE("folds carry values, stop at their condition, and bind their variables") {
    Graph g;
    const NodeId x = g.component(g.point(), 0), y = g.component(g.point(), 1),
                 free = g.fresh_var(Type::Float);
    const NodeId sum = loop(g, g.integer(4), x, y);
    const NodeId iterations = g.make(Op::LoopResult, Type::Float, {sum}, 1);
    CHECK(g.make(Op::LoopResult, Type::Float, {sum}, 0) == sum);
    CHECK(!g.reads(sum).free_vars);
    CHECK(g.reads(loop(g, g.integer(4), x, free)).free_vars);
    CHECK(g.free_vars(loop(g, g.integer(4), x, free)) == std::vector{free});

    test::Reference eval(g);
    eval.point = {1, 2, 0};
    CHECK(eval.number(sum) == 1 + 2 * (0 + 1 + 2 + 3));
    CHECK(eval.number(iterations) == 4);
    eval.point = {1, 60, 0}; // 1, 1, 61, 181: the condition ends it
    CHECK(eval.number(iterations) == 3);
}

TEST_CASE("substitution enters folds, and gives the copy variables of its own") {
    Graph g;
    const NodeId x = g.component(g.point(), 0), y = g.component(g.point(), 1);
    const NodeId inner = loop(g, g.integer(3), x, y);
    // The loop at the point (loop, loop, loop): the copy's body holds the original.
    const NodeId nested = substitute(g, inner, {{g.point(), g.splat(inner, Type::Vec3)}});
    test::Reference eval(g);
    eval.point = {1, 2, 0};
    const double once = 1 + 2 * 3;
    CHECK(eval.number(inner) == once);
    CHECK(eval.number(nested) == once + once * 3);
    // Nothing to replace, nothing copied.
    CHECK(substitute(g, inner, {{g.fresh_var(Type::Float), x}}) == inner);
}

TEST_CASE("what replaces a fold stands for its first value alone") {
    Graph g;
    const NodeId x = g.component(g.point(), 0), y = g.component(g.point(), 1);
    const NodeId sum = loop(g, g.integer(4), x, y),
                 iterations = g.make(Op::LoopResult, Type::Float, {sum}, 1),
                 root = g.add(sum, g.mul(g.number(100), iterations));
    test::Reference eval(g);
    eval.point = {1, 2, 0};
    CHECK(eval.number(substitute(g, root, {{sum, g.number(7)}})) == 7 + 100 * 4);
    // What else is replaced is so in the other values, too: x, 60 added, ends by the condition.
    const NodeId both = substitute(g, root, {{sum, g.number(7)}, {y, g.number(60)}});
    CHECK(eval.number(both) == 7 + 100 * 3);
}

TEST_CASE("substitution is deep but not recursive") {
    Graph g;
    const NodeId p = g.point();
    NodeId chain = g.component(p, 0);
    for (int i = 0; i < 300000; ++i) chain = g.make(Op::Sin, {g.add(chain, g.number(i))});
    const NodeId moved = substitute(g, chain, {{p, g.vec3(1, 2, 3)}});
    CHECK(g.is_constant(moved)); // and folds as it goes
}

TEST_CASE("a dump names what it shows, in an order of its own") {
    Graph g;
    g.number(17); // what the arena holds beside does not show
    const NodeId x = g.component(g.point(), 0);
    const NodeId d = g.sub(g.make(Op::Length, {g.point()}), g.add(x, g.number(0.5)));
    CHECK(dump(g, d) == "%0: float = length point\n"
                        "%1: float = swizzle.x point\n"
                        "%2: float = add %1 0.5\n"
                        "%3: float = sub %0 %2\n");
    CHECK(dump(g, g.vec3(1, 0.1, 0)) == "vec3(1, 0.1, 0)\n");
}

TEST_CASE("shapes are kept once and print as a tree") {
    Scene scene;
    Graph &g = scene.graph;
    const auto leaf = [&](double r) {
        Shape s;
        s.kind = ShapeKind::Leaf;
        s.args = {g.sub(g.make(Op::Length, {g.point()}), g.number(r))};
        return scene.shapes.add(s);
    };
    const ShapeId a = leaf(1), b = leaf(2);
    CHECK(leaf(1) == a);
    Shape both;
    both.kind = ShapeKind::Union;
    both.children = {a, b, a};
    CHECK(dump(g, scene.shapes, scene.shapes.add(both)) == "#0 union\n"
                                                           "    %0: float = length point\n"
                                                           "    %1: float = sub %0 1\n"
                                                           "  #1 leaf %1\n"
                                                           "    %2: float = sub %0 2\n"
                                                           "  #2 leaf %2\n"
                                                           "  #1\n");
}
