// Lattices half a period apart (proof/half_waves.h): the same value by one of them, and only where
// no sign is seen.
#include "proof/half_waves.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Hexagons {
    Scenery s;
    Graph &g = s.g;
    NodeId at = g.swizzle(s.p, std::array{0, 2}), period, half, a, b;

    explicit Hexagons(bool by_rounding, double shift = 1, double sign = 1)
        : period(vec2(1, 1.75 * sign)), half(vec2(0.5, 0.875 * sign)),
          a(g.sub(g.make(Op::Mod, {at, period}), half)) {
        // x % m - m/2 is the wave of x - m/2
        const double whole = by_rounding ? shift + 1 : shift;
        const NodeId moved = g.sub(at, g.mul(half, g.number(whole)));
        b = by_rounding ? g.sub(moved, g.mul(period, s.call(Op::Round, g.div(moved, period))))
                        : g.sub(g.make(Op::Mod, {moved, period}), half);
    }
    NodeId vec2(double x, double y) {
        return g.make(Op::Make, Type::Vec2, {g.number(x), g.number(y)});
    }
    NodeId square(NodeId v) { return g.make(Op::Dot, {v, v}); }
    NodeId nearer() { return g.make(Op::Select, {g.make(Op::Less, {square(a), square(b)}), a, b}); }
    double value(NodeId of, std::array<double, 3> point) {
        const NodeId found = ir::substitute(g, of, {{s.p, g.vec3(point[0], point[1], point[2])}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    }
};

using HexMeasure = std::function<NodeId(Hexagons &, NodeId)>;
const std::vector<HexMeasure> even{
    [](Hexagons &h, NodeId v) { return h.s.length(v); },
    [](Hexagons &h, NodeId v) {
        const NodeId size = h.s.call(Op::Abs, v);
        return h.g.make(Op::Max,
                        {h.g.component(size, 0), h.g.make(Op::Dot, {size, h.vec2(0.5, 0.9)})});
    },
    [](Hexagons &h, NodeId v) {
        const NodeId x = h.g.component(v, 0);
        return h.g.add({h.g.mul(x, x), h.s.cos(h.g.component(v, 1))});
    },
    [](Hexagons &h, NodeId v) {
        return h.g.add({h.s.call(Op::Abs, h.g.mul(h.g.component(v, 0), h.g.component(v, 1))),
                        h.s.call(Op::Sqrt, h.square(h.g.mul(v, h.g.number(-2))))});
    }};
const std::vector<HexMeasure> not_even{
    [](Hexagons &h, NodeId v) { return h.g.component(v, 0); },
    [](Hexagons &h, NodeId v) { return h.g.mul(h.g.component(v, 0), h.g.component(v, 1)); },
    [](Hexagons &h, NodeId v) { return h.s.length(h.g.add(v, h.vec2(0.1, 0))); },
    [](Hexagons &h, NodeId v) {
        return h.s.call(Op::Abs, h.g.make(Op::Dot, {v, h.vec2(0.5, 0.9)}));
    }};

} // namespace

TEST_CASE("two lattices half a period apart are one, by its sizes") {
    for (const bool by_rounding : {false, true})
        for (const double shift : {1.0, -1.0, 3.0})
            for (const HexMeasure &measure : even) {
                Hexagons h(by_rounding, shift);
                const NodeId field = measure(h, h.nearer()),
                             found = proof::with_half_waves(h.g, field);
                CAPTURE(by_rounding, shift, &measure - even.data());
                REQUIRE(found != field);
                for (int k = 0; k < 400; ++k) {
                    const std::array<double, 3> point{0.0371 * k - 7, 0, 0.0533 * k - 9};
                    CHECK(h.value(found, point) ==
                          Approx(h.value(field, point)).epsilon(1e-9).margin(1e-9));
                }
            }
}

namespace {

// x - m*(S((x - c)/m) + d) by an op S; the second one's borders lie at `borders`.
NodeId nearer_by(Hexagons &h, Op step, double d, NodeId borders) {
    const auto way = [&](NodeId x, double more) {
        const NodeId count = h.s.call(step, h.g.div(x, h.period));
        return h.g.sub(h.at, h.g.mul(h.period, h.g.add(count, h.g.number(more))));
    };
    h.a = way(h.at, d);
    h.b = way(h.g.sub(h.at, borders), d + 0.5);
    return h.nearer();
}

} // namespace

TEST_CASE("lattices by floor and ceil are one, and with borders aside where that is not seen") {
    struct Way {
        Op step;
        double d, x, y;
        bool is_one;
    };
    for (const Way &way :
         {Way{Op::Floor, 0.5, 0.5, 0.875, true}, Way{Op::Ceil, -0.5, 0.5, 0.875, true},
          Way{Op::Floor, 0.5, 0.5, 1, true}, Way{Op::Floor, 0.5, 0.5, 0.7, true},
          Way{Op::Ceil, -0.5, 0.5, 1, true}, Way{Op::Floor, 0.5, 0.5, 1.2, false},
          Way{Op::Floor, 0.5, 0.45, 0.875, false}, Way{Op::Floor, 0.45, 0.5, 0.875, false},
          Way{Op::Round, 0.5, 0.5, 0.875, false}})
        for (const HexMeasure &measure : even) {
            Hexagons h(false);
            const NodeId field = measure(h, nearer_by(h, way.step, way.d, h.vec2(way.x, way.y))),
                         found = proof::with_half_waves(h.g, field);
            CAPTURE(int(way.step), way.d, way.x, way.y, &measure - even.data());
            CHECK((found != field) == way.is_one);
            for (int k = 0; k < 400; ++k) {
                const std::array<double, 3> point{0.0371 * k - 7, 0, 0.0533 * k - 9};
                CHECK(h.value(found, point) ==
                      Approx(h.value(field, point)).epsilon(1e-9).margin(1e-9));
            }
        }
}

TEST_CASE("lattices stay two where a sign is seen, or where they are not half a period apart") {
    for (const bool by_rounding : {false, true}) {
        for (const HexMeasure &measure : not_even) {
            Hexagons h(by_rounding);
            const NodeId field = measure(h, h.nearer());
            CAPTURE(by_rounding, &measure - not_even.data());
            CHECK(proof::with_half_waves(h.g, field) == field);
        }
        Hexagons negative(by_rounding, 1, -1); // |w| is no more than half of the size of a period
        const NodeId of_negative = even[0](negative, negative.nearer());
        CHECK(proof::with_half_waves(negative.g, of_negative) == of_negative);
        for (const double shift : {0.9, 1.001, 2.0, 0.0}) {
            Hexagons h(by_rounding, shift);
            const NodeId field = even[0](h, h.nearer());
            CAPTURE(by_rounding, shift);
            CHECK(proof::with_half_waves(h.g, field) == field);
        }
    }
}
