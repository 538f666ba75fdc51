// The op table's columns, and the passes that are shared: inlining and rows of constants.
#include "ir/passes/cost.h"
#include "ir/passes/inline.h"
#include "ir/passes/rows.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstring>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::ir;
using test::Reference;

namespace {
// How many different arguments a spelling names, if it names them all: {0}, {1}, … without a gap.
int named(const char *form) {
    int n = 0;
    while (std::strstr(form, (fmt::format("{{{}}}", n)).c_str())) ++n;
    CHECK(std::strstr(form, (fmt::format("{{{}}}", n + 1)).c_str()) == nullptr);
    return n;
}
} // namespace

TEST_CASE("an op's spellings name each of its arguments") {
    for (std::size_t k = 0; k < op_count; ++k) {
        const OpInfo &op = info(static_cast<Op>(k));
        INFO(op.name);
        const int arguments = op.arity < 0 ? 2 : op.arity; // of any number: two by two
        if (*op.glsl) CHECK(named(op.glsl) == arguments);
        if (*op.text) CHECK(named(op.text) == arguments);
        CHECK((op.takes == Takes::Own || op.rule == TypeRule::Same));
        CHECK((!op.function || (op.arity == 1 && op.takes == Takes::Floats)));
        CHECK((op.takes == Takes::Own || (*op.glsl && *op.text)));
    }
}

TEST_CASE("an op with a value of its own has spellings, but for those that need the payload") {
    constexpr OpSet bound{
#define FATHOM_BOUND(name, ...) Op::name,
#include "ir/ops.def"
    };
    constexpr OpSet by_payload{Op::Splat, Op::Make, Op::Swizzle, Op::Column, Op::Blend};
    for (std::size_t k = 0; k < op_count; ++k) {
        const Op op = static_cast<Op>(k);
        INFO(info(op).name);
        if (bound[op] || by_payload[op]) continue;
        CHECK(*info(op).text);
        CHECK((*info(op).glsl || op == Op::Union || op == Op::Intersection));
    }
}

TEST_CASE("a function of the language says in a line what it is") {
    const std::pair<const char *, std::string_view> rows[] = {
#define FATHOM_FUNCTION(name, function, glsl, weight, cost, parity, trouble, undefined, doc)       \
    {#function, doc},
#include "ir/ops.def"
    };
    for (const auto &[function, doc] : rows) {
        INFO(function);
        CHECK(doc.size() > 5);
        CHECK(doc.find('\n') == doc.npos);
    }
}

TEST_CASE("what takes long takes an op's weight in a shader") {
    struct Row {
        Op op;
        double cost;
    };
    constexpr double simple = 1, division = 3, curve = 12, size = 1, count = 1; // in simple ones
    const Row rows[] = {
#define FATHOM_OP(name, arity, rule, glsl, text, weight, cost, ...) {Op::name, cost},
#include "ir/ops.def"
    };
    for (const Row &row : rows) {
        const OpInfo &op = info(row.op);
        INFO(op.name);
        if (op.takes != Takes::Own && row.op != Op::Neg) CHECK(op.weight >= 1);
        if (row.cost >= division) CHECK(op.weight >= 3);
        if (row.cost >= curve) CHECK(op.weight >= 5);
    }
}

TEST_CASE("an op costs what its column says, by component where it is by component") {
    Graph g;
    const auto own = [&](NodeId id) { // without what it is made of
        double cost = cost_of(g, id);
        for (NodeId arg : g.args(id)) cost -= cost_of(g, arg);
        return cost;
    };
    const NodeId p = g.point(), x = g.component(p, 0);
    CHECK(own(g.make(Op::Perlin, {p})) == Approx(octave_cost));
    CHECK(own(g.make(Op::Worley, {p})) == Approx(worley_cost));
    CHECK(own(g.make(Op::SpotNoise, Type::Float, {p, x, x})) == Approx(spot_cost));
    CHECK(own(g.make(Op::Sin, {x})) > 0);
    CHECK(own(g.make(Op::Sin, {p})) == Approx(3 * own(g.make(Op::Sin, {x}))));
    CHECK(own(g.make(Op::Sqrt, {x})) < own(g.make(Op::Sin, {x})));
    CHECK(own(g.add(x, g.number(1))) < own(g.make(Op::Sqrt, {x})));
    CHECK(own(g.make(Op::Union, {x, g.neg(x), g.make(Op::Abs, {x})})) ==
          Approx(3 * own(g.add(x, g.number(1)))));
    CHECK(own(g.swizzle(p, std::array{2, 1, 0})) == 0);
}

TEST_CASE("a call written out has the value of the call") {
    Graph g;
    const NodeId a = g.fresh_var(Type::Float), b = g.fresh_var(Type::Float);
    const FunctionId inner = g.add_function({"inner", {}, {a}, g.mul(a, g.add(a, g.number(1)))});
    const FunctionId outer =
        g.add_function({"outer",
                        {},
                        {b},
                        g.add(g.call(inner, std::array{b}), g.call(inner, std::array{g.neg(b)}))});
    const NodeId x = g.component(g.point(), 0);
    const NodeId twice = g.add(g.call(outer, std::array{x}), g.call(inner, std::array{x}));
    const WithoutCalls plain = without_calls(g, twice, 1000);
    CHECK(plain.all);
    CHECK(g[called(g, g.call(inner, std::array{x}))].op == Op::Mul);
    std::vector<NodeId> todo{plain.root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        REQUIRE(g[id].op != Op::Call);
        todo.insert(todo.end(), g.args(id).begin(), g.args(id).end());
    }
    for (double at : {-2.0, 0.0, 0.75}) {
        Reference reference(g);
        reference.point = {at, 0, 0};
        CHECK(reference.number(plain.root) == reference.number(twice));
    }
    // With too little room the rest keeps its calls, and says so.
    const WithoutCalls some = without_calls(g, twice, 3);
    CHECK_FALSE(some.all);
    Reference reference(g);
    reference.point = {0.75, 0, 0};
    CHECK(reference.number(some.root) == reference.number(twice));
}

TEST_CASE("what `also` replaces is replaced in the function, not in the arguments") {
    Graph g;
    const NodeId a = g.fresh_var(Type::Float);
    const FunctionId f = g.add_function({"f", {}, {a}, g.add(a, g.time())});
    const NodeId later = g.add(g.time(), g.number(1));
    const NodeId value = called(g, f, std::array{g.time()}, {{g.time(), later}});
    Reference reference(g);
    reference.time = 5;
    CHECK(reference.number(value) == 5 + 6);
}

TEST_CASE("iterations written out are those of the loop") {
    Graph g;
    Loop record;
    record.count = g.integer(4);
    record.max_count = 4;
    record.index = g.fresh_var(Type::Int);
    record.vars = {g.fresh_var(Type::Float), g.fresh_var(Type::Float)};
    // Both read the values before the iteration: the second takes over the first.
    const NodeId index = g.make(Op::ToFloat, Type::Float, {record.index});
    record.next = {g.add(g.mul(record.vars[0], g.number(2)), index), record.vars[0]};
    const NodeId x = g.component(g.point(), 0);
    std::vector<NodeId> values{x, g.number(0)};
    const NodeId loop = g.make(Op::Loop, Type::Float, values, g.add_loop(record).index);
    const NodeId second = g.make(Op::LoopResult, Type::Float, {loop}, 1);
    CHECK(in_iteration(g, record, 2, values, index) == g.number(2));
    for (int i = 0; i < 4; ++i) values = after_iteration(g, record, i, values);
    Reference reference(g);
    reference.point = {0.5, 0, 0};
    CHECK(reference.number(values[0]) == reference.number(loop));
    CHECK(reference.number(values[1]) == reference.number(second));
}

TEST_CASE("expressions that differ in constants are one with rows") {
    Graph g;
    const auto ball = [&](double x, double y, double r) {
        const NodeId centre = g.vec3(x, y, 1);
        return g.sub(g.make(Op::Length, {g.sub(g.point(), centre)}),
                     g.mul(g.number(r), g.number(1.5)));
    };
    std::vector<NodeId> balls{ball(1, 2, 3), ball(4, 5, 6), ball(7, 5, 6)};
    std::vector<Skeleton> parts(balls.size());
    std::vector<Row> rows;
    for (std::size_t i = 0; i < balls.size(); ++i) {
        REQUIRE(take_apart(g, balls[i], 100, parts[i]));
        CHECK(parts[i].words == parts[0].words);
        rows.push_back(parts[i].row);
    }
    Skeleton other;
    CHECK(take_apart(g, g.neg(balls[0]), 100, other));
    CHECK(other.words != parts[0].words);
    Skeleton small;
    CHECK_FALSE(take_apart(g, balls[0], 2, small));

    std::vector<int> column;
    const std::vector<bool> all(rows[0].size(), true);
    Table table;
    table.rows = 3;
    table.stride = lay_out(g, rows, all, 0, column);
    CHECK(table.stride == 4); // a centre and a radius
    table.data.resize(12);
    for (std::size_t r = 0; r < 3; ++r) fill_row(g, rows[r], column, &table.data[4 * r]);
    const TableId data = g.add_table(table);
    for (int r = 0; r < 3; ++r) {
        const auto read = [&](std::size_t c, NodeId constant) {
            return column[c] < 0
                       ? constant
                       : read_table(g, g.type(constant), g.integer(r), table_slot(data, column[c]));
        };
        std::size_t next = 0;
        const NodeId again = put_together(g, balls[0], read, next);
        CHECK(next == column.size());
        Reference reference(g);
        reference.point = {0.3, -1, 2};
        CHECK(reference.number(again) ==
              Approx(reference.number(balls[static_cast<std::size_t>(r)])));
    }
    // Columns that nobody wants stand in no table; equal ones stand once.
    CHECK(lay_out(g, rows, std::vector<bool>(rows[0].size(), false), 0, column) == 0);
    const std::vector<Row> twins{{rows[0][0], rows[0][0]}, {rows[1][0], rows[1][0]}};
    CHECK(lay_out(g, twins, {true, true}, 7, column) == 7 + components(g.type(rows[0][0])));
    CHECK(column[0] == column[1]);
}
