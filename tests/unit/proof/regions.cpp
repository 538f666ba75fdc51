// Bounds in regions: what is known of the distances of their points is used, and holds at each of
// these points.
#include "build.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;
using proof::Zone;

namespace {

Zone round(RegionKind kind, double radius, int axis = 1) {
    Zone zone;
    zone.kind = kind;
    zone.half[0] = radius;
    zone.axis = axis;
    return zone;
}

bool holds(const Zone &zone, const std::array<double, 3> &p) {
    double square = 0;
    for (std::size_t i = 0; i < 3; ++i)
        if (zone.kind != RegionKind::Tube || int(i) != zone.axis)
            square += std::pow(p[i] - zone.center[i].lo, 2);
    return square <= std::pow(zone.half[0].lo, 2);
}

// The bound in a zone, and the steepest slope at points of it that are spread evenly and near its
// holes.
struct Slopes {
    double proved = 0, seen = 0;
};
Slopes slopes(Scenery &s, NodeId field, const Zone &zone) {
    proof::Work work;
    proof::Flattening context{s.g, work};
    const proof::Ranges ranges = proof::ranges_of(s.scene, work);
    context.ranges = &ranges;
    const proof::Domain domain{proof::outer_box(zone), &zone};
    Slopes out{proof::bound_field(context, ranges, field, domain, {}).lipschitz, 0};
    const proof::Tape tape = proof::flatten(context, field);
    proof::Machine at(tape, ranges);
    proof::Dice dice{7};
    for (int i = 0; i < 60'000; ++i) {
        std::array<double, 3> p{};
        for (std::size_t k = 0; k < 3; ++k) {
            const Interval side = domain.box.p[k].finite() ? domain.box.p[k] : Interval(-2, 2);
            p[k] = side.lo + side.width() * dice.next();
        }
        if (!zone.less.empty() && i % 2 == 0) { // on a hole's border, and a little off it
            const Zone &hole = zone.less[0];
            double size = 0;
            for (std::size_t k = 0; k < 3; ++k)
                if (hole.kind != RegionKind::Tube || int(k) != hole.axis) size += p[k] * p[k];
            const double to = hole.half[0].lo * (1 + 0.01 * dice.next()) / std::sqrt(size);
            for (std::size_t k = 0; k < 3; ++k)
                if (hole.kind != RegionKind::Tube || int(k) != hole.axis) p[k] *= to;
        }
        if (!holds(zone, p)) continue;
        if (std::ranges::any_of(zone.less, [&](const Zone &hole) { return holds(hole, p); }))
            continue;
        at.run(proof::Cell{{Interval(p[0]), Interval(p[1]), Interval(p[2])}});
        if (at.norm() < ir::rounding::infinity) out.seen = std::max(out.seen, at.norm());
    }
    return out;
}

// p turned about y by an angle.
NodeId turned(Scenery &s, NodeId x, NodeId z, NodeId angle) {
    const NodeId c = s.cos(angle), n = s.sin(angle);
    const NodeId u = s.g.add(s.g.mul(c, x), s.g.mul(n, z)),
                 v = s.g.sub(s.g.mul(c, z), s.g.mul(n, x));
    return s.g.make(Op::Make, Type::Vec2, {u, v});
}

} // namespace

TEST_CASE("bounds in a region hold at its points, and are near what is steepest there") {
    Zone ball = round(RegionKind::Ball, 2), off_axis = ball, off_middle = ball;
    off_axis.less = {round(RegionKind::Tube, 0.1)};
    off_middle.less = {round(RegionKind::Ball, 0.2)};
    struct One {
        const char *name;
        Zone zone;
        std::function<NodeId(Scenery &)> field;
        double near; // the steepest slope over what is proved, at least
    };
    const auto angle = [](Scenery &s) { return s.g.make(Op::Atan2, {s.z, s.x}); };
    const auto radius = [](Scenery &s) {
        return s.length(s.g.make(Op::Make, Type::Vec2, {s.x, s.z}));
    };
    const std::vector<One> all{
        {"petals", off_axis, [&](Scenery &s) { return s.sin(s.g.mul(s.n(5), angle(s))); }, 0.94},
        {"petals on a cylinder", off_axis,
         [&](Scenery &s) { return s.g.sub(radius(s), s.sin(s.g.mul(s.n(5), angle(s)))); }, 0.9},
        {"one over the length", off_middle,
         [](Scenery &s) { return s.g.div(s.n(1), s.length(s.p)); }, 0.94},
        {"one over the distance of an axis", off_axis,
         [&](Scenery &s) { return s.g.div(s.n(1), radius(s)); }, 0.94},
        {"the length squared", ball,
         [](Scenery &s) { return s.g.mul(s.length(s.p), s.length(s.p)); }, 0.94},
        {"a twist", ball,
         [](Scenery &s) {
             const NodeId q = turned(s, s.x, s.z, s.g.mul(s.n(4), s.y));
             return s.g.component(q, 0);
         },
         0.9},
        {"a knot's plane", off_axis,
         [&](Scenery &s) {
             const NodeId q = turned(s, s.g.sub(radius(s), s.n(1)), s.y, s.g.mul(s.n(2), angle(s)));
             return s.g.add(s.g.component(q, 0),
                            s.g.mul(s.n(0.5), s.call(Op::Abs, s.g.component(q, 1))));
         },
         0.6},
    };
    for (const One &one : all) {
        Scenery s;
        INFO(one.name);
        const Slopes found = slopes(s, one.field(s), one.zone);
        CHECK(found.seen <= found.proved);
        CHECK(found.seen >= one.near * found.proved);
    }
}
