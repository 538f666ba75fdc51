// Fields made larger by a number (proof/rescaled.h): the same value without it, whatever they
// measure, and the bound of what they are made of.
#include "proof/rescaled.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

std::optional<proof::Rescaled> moved_in(Graph &graph, proof::Factor factor, NodeId expression) {
    proof::RescaledNodes known;
    proof::Work work;
    return proof::rescaled(graph, factor, expression, known, work);
}

struct Sized {
    Scenery s;
    Graph &g = s.g;
    NodeId size = g.param(0, Type::Float), zero = g.number(0), half = g.number(0.5);
    NodeId n4 = g.number(4), smaller = g.div(s.p, size), larger = g.mul(s.p, size);

    double value(NodeId of, double by, std::array<double, 3> at) {
        const NodeId found =
            ir::substitute(g, of, {{size, g.number(by)}, {s.p, g.vec3(at[0], at[1], at[2])}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    }
    NodeId box(NodeId q) {
        const NodeId way = g.sub(s.call(Op::Abs, q), g.vec3(0.4, 0.5, 0.6));
        const NodeId most =
            g.make(Op::Max, {g.component(way, 0),
                             g.make(Op::Max, {g.component(way, 1), g.component(way, 2)})});
        return g.add(s.length(g.make(Op::Max, {way, g.vec3(0, 0, 0)})),
                     g.make(Op::Min, {most, zero}));
    }
    NodeId least(NodeId a, NodeId b, bool by_mix, bool cubic) {
        const NodeId k = g.number(0.3);
        if (by_mix) {
            const NodeId h = g.make(
                Op::Clamp, {g.add(half, g.div(g.mul(half, g.sub(b, a)), k)), zero, g.number(1)});
            return g.sub(g.make(Op::Mix, {b, a, h}), g.mul({g.mul(k, h), g.sub(g.number(1), h)}));
        }
        const NodeId h = g.make(Op::Max, {g.sub(k, s.call(Op::Abs, g.sub(a, b))), zero});
        const NodeId square = g.mul(h, h);
        return g.sub(g.make(Op::Min, {a, b}), cubic ? g.div(g.mul(square, h), g.number(6 * 0.09))
                                                    : g.div(square, g.number(4 * 0.3)));
    }
};

using Measure = std::function<NodeId(Sized &, NodeId)>;
const std::vector<std::pair<const char *, Measure>> measures{
    {"a ball", [](Sized &z, NodeId q) { return z.g.sub(z.s.length(q), z.half); }},
    {"a ball by its square",
     [](Sized &z, NodeId q) {
         return z.g.sub(z.s.call(Op::Sqrt, z.g.make(Op::Dot, {q, q})), z.half);
     }},
    {"a box", [](Sized &z, NodeId q) { return z.box(q); }},
    {"a norm of the eighth power",
     [](Sized &z, NodeId q) {
         NodeId sum = z.zero;
         for (int i = 0; i < 3; ++i)
             sum = z.g.add(
                 sum, z.g.make(Op::Pow, {z.s.call(Op::Abs, z.g.component(q, i)), z.g.number(8)}));
         return z.g.sub(z.g.make(Op::Pow, {sum, z.g.number(0.125)}), z.half);
     }},
    {"a smooth minimum by mix",
     [](Sized &z, NodeId q) { return z.least(z.box(q), z.g.component(q, 1), true, false); }},
    {"a smooth minimum by a square",
     [](Sized &z, NodeId q) { return z.least(z.box(q), z.g.component(q, 1), false, false); }},
    {"a smooth minimum by a cube",
     [](Sized &z, NodeId q) { return z.least(z.box(q), z.g.component(q, 1), false, true); }},
    {"a grid",
     [](Sized &z, NodeId q) {
         return z.g.sub(z.s.length(z.g.sub(q, z.s.call(Op::Round, q))), z.g.number(0.3));
     }},
    {"a grid by %",
     [](Sized &z, NodeId q) {
         const NodeId two = z.g.vec3(2, 2, 2), one = z.g.vec3(1, 1, 1);
         return z.s.length(z.g.sub(z.g.make(Op::Mod, {z.g.add(q, one), two}), one));
     }},
    {"a grid of few",
     [](Sized &z, NodeId q) {
         const NodeId few =
             z.g.make(Op::Clamp, {z.s.call(Op::Round, q), z.g.vec3(-1, -1, -1), z.g.vec3(1, 2, 1)});
         return z.g.sub(z.s.length(z.g.sub(q, few)), z.g.number(0.3));
     }},
    {"a choice",
     [](Sized &z, NodeId q) {
         const NodeId y = z.g.component(q, 1);
         return z.g.make(Op::Select, {z.g.make(Op::Less, {y, z.zero}), z.g.neg(y), z.s.length(q)});
     }},
    {"a ball beside one that stays",
     [](Sized &z, NodeId q) {
         return z.g.make(Op::Min, {z.s.length(q), z.g.sub(z.s.length(z.s.p), z.half)});
     }},
    {"a ball in a noise",
     [](Sized &z, NodeId q) {
         return z.g.add({z.s.length(q), z.s.sin(z.g.mul(z.g.number(3), z.s.x))});
     }},
};

} // namespace

TEST_CASE("a number and its inverse leave an expression of the same value") {
    for (const auto &[name, measure] : measures) {
        INFO(name);
        for (const bool divides : {false, true}) {
            Sized z;
            const NodeId inner = measure(z, divides ? z.larger : z.smaller);
            const auto found = moved_in(z.g, {z.size, divides}, inner);
            REQUIRE(found);
            for (const double by : {0.3, 1.0, 1.7})
                for (const std::array<double, 3> at :
                     {std::array{0.2, 0.7, -0.3}, std::array{-1.1, 0.1, 0.9},
                      std::array{0.45, -0.62, 0.33}, std::array{2.3, 1.9, -1.4}}) {
                    const double inside = z.value(inner, by, at);
                    CHECK(z.value(found->value, by, at) ==
                          Approx(divides ? inside / by : inside * by).epsilon(1e-9).margin(1e-9));
                }
        }
    }
}

TEST_CASE("products in one order have the same value, and those of one scale are one") {
    Sized z;
    Graph &g = z.g;
    const NodeId t = g.time(), four = g.splat(z.n4, Type::Vec3), by = g.splat(z.size, Type::Vec3),
                 moves = g.mul(t, z.size);
    const NodeId often = g.div(four, by), times = g.mul(four, z.s.p);
    const std::array<NodeId, 4> same{g.div(times, by), g.mul(often, z.s.p),
                                     g.mul(g.div(z.s.p, by), four),
                                     g.div({g.mul(z.s.p, by), g.mul(by, by)})};
    const NodeId one = g.mul(g.div(z.s.p, by), four);
    for (std::size_t i = 0; i < 3; ++i) CHECK(proof::with_factors_in_order(g, same[i]) == one);
    for (const auto &[name, measure] : measures)
        for (const NodeId vector : same) {
            INFO(name);
            const NodeId scaled = g.mul(vector, g.splat(moves, Type::Vec3));
            const NodeId f = g.div({g.mul(measure(z, scaled), t), z.size}),
                         ordered = proof::with_factors_in_order(g, f);
            for (const std::array<double, 3> at :
                 {std::array{0.2, 0.7, -0.3}, std::array{-1.1, 0.1, 0.9}}) {
                const auto value = [&](NodeId of) {
                    return z.value(ir::substitute(g, of, {{t, g.number(0.7)}}), 1.3, at);
                };
                CHECK(value(ordered) == Approx(value(f)).epsilon(1e-9).margin(1e-9));
            }
        }
}

TEST_CASE("the least of several sizes meets each of them") {
    for (const bool divides : {false, true}) {
        Sized z;
        Graph &g = z.g;
        const NodeId t = g.time(), sizes = z.s.vec(z.size, t, g.number(1.2));
        const NodeId extreme = g.make(divides ? Op::Max : Op::Min, {z.size, t}),
                     inner = z.box(divides ? g.mul(z.s.p, sizes) : g.div(z.s.p, sizes));
        const auto found = moved_in(g, {extreme, divides}, inner);
        REQUIRE(found);
        for (const double by : {0.3, 1.0, 1.7})
            for (const double time : {0.4, 1.1, 1.9}) {
                const auto at = [&](NodeId of) {
                    return z.value(ir::substitute(g, of, {{t, g.number(time)}}), by,
                                   {0.9, -1.3, 0.7});
                };
                const double s = divides ? 1 / std::max(by, time) : std::min(by, time);
                CHECK(at(found->value) == Approx(s * at(inner)).epsilon(1e-9).margin(1e-9));
            }
    }
}

TEST_CASE("what no inverse is in stays as it is") {
    Sized z;
    CHECK_FALSE(moved_in(z.g, {z.size, false}, z.box(z.s.p)));
    CHECK_FALSE(moved_in(z.g, {z.size, false}, z.box(z.larger)));
    CHECK_FALSE(moved_in(z.g, {z.size, true}, z.box(z.smaller)));
    CHECK_FALSE(moved_in(z.g, {z.size, false}, z.s.sin(z.g.component(z.smaller, 0))));
}

TEST_CASE("the factors of a product are found, and numbers left aside") {
    Sized z;
    const NodeId t = z.g.time();
    const NodeId product = z.g.div({z.g.mul(z.g.number(2), z.size), z.g.mul(t, z.g.number(3))});
    const auto factors = proof::factors_of(z.g, product);
    REQUIRE(factors.size() == 2);
    CHECK((factors[0].number == z.size && !factors[0].divides));
    CHECK((factors[1].number == t && factors[1].divides));
}

TEST_CASE("waves of a point that is made larger are as steep as what they are over its size") {
    struct Case {
        const char *name;
        bool alike; // the slope is the same whatever the size
        std::function<NodeId(Sized &, NodeId)> field;
    };
    const auto waves = [](Sized &z, NodeId q) {
        Graph &g = z.g;
        return g.add(g.mul(z.s.sin(g.component(q, 0)), z.s.cos(g.component(q, 1))),
                     z.s.sin(g.component(q, 2)));
    };
    const auto over = [&](Sized &z, NodeId q) { return z.g.div(waves(z, q), z.size); };
    const Case cases[] = {
        {"larger", true, [&](Sized &z, NodeId p) { return over(z, z.g.mul(p, z.size)); }},
        {"larger and moved", true,
         [&](Sized &z, NodeId p) {
             return over(z, z.g.sub(z.g.vec3(0.2, 1, 0), z.g.mul(p, z.size)));
         }},
        {"larger and mirrored", true,
         [&](Sized &z, NodeId p) { return over(z, z.g.mul(z.s.call(Op::Abs, p), z.size)); }},
        {"smaller", true,
         [&](Sized &z, NodeId p) {
             return z.g.mul(waves(z, z.g.div({p, z.size})), z.size);
         }},
        {"smaller by two products in other orders", true,
         [&](Sized &z, NodeId p) {
             const NodeId four = z.g.splat(z.n4, Type::Vec3), q = z.g.div(p, z.size),
                          more = z.g.div({z.g.mul(four, p), z.size});
             return z.g.mul(z.g.add(z.s.length(q), waves(z, more)), z.size);
         }},
        {"larger, over nothing", false,
         [&](Sized &z, NodeId p) { return waves(z, z.g.mul(p, z.size)); }},
        {"larger, times the size", false,
         [&](Sized &z, NodeId p) { return z.g.mul(waves(z, z.g.mul(p, z.size)), z.size); }},
        {"moved and multiplied by a coordinate", false,
         [&](Sized &z, NodeId p) {
             Graph &g = z.g;
             const NodeId moved = g.add(g.mul(z.size, g.component(p, 0)), g.number(3)),
                          x = g.mul(moved, g.component(p, 1)), y = g.mul(z.size, g.component(p, 2)),
                          w = g.mul(z.size, g.component(p, 0));
             return over(z, g.make(Op::Make, Type::Vec3, {x, y, w}));
         }},
        {"one coordinate less, by its own size", false, [&](Sized &z, NodeId p) {
             return over(
                 z, z.g.sub(z.g.mul(p, z.size), z.g.mul(z.g.swizzle(p, std::array{1, 2, 0}),
                                                        z.g.splat(z.g.number(0.5), Type::Vec3))));
         }}};
    for (const Case &one : cases) {
        INFO(one.name);
        Sized z;
        REQUIRE(z.s.parameter(0.5, 2) == z.size);
        const NodeId f = one.field(z, z.s.p);
        const double bound = z.s.bound(f, cube(1.4)).lipschitz;
        double steepest = 0;
        proof::Dice dice{11};
        for (int i = 0; i < 30'000; ++i) {
            const double by = i % 3 == 0 ? 0.5 : i % 3 == 1 ? 2 : 0.5 + 1.5 * dice.next();
            std::array<double, 3> p{}, q{};
            for (std::size_t k = 0; k < 3; ++k) {
                p[k] = 1.4 * (2 * dice.next() - 1);
                q[k] = p[k] + 1e-4 * (dice.next() - 0.5);
            }
            const double run = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
            steepest = std::max(steepest, std::fabs(z.value(f, by, p) - z.value(f, by, q)) / run);
        }
        CHECK(steepest <= bound * (1 + 1e-3));
        if (one.alike) CHECK(bound <= 1.2 * steepest);
    }
}
