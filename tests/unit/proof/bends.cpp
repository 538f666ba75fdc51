// Second derivatives along lines: never above what the machine says, nearly that where the rule is
// attained, and infinity for what has a kink or no rule.
#include "build.h"
#include "ir/noise.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;
using proof::Cell;

namespace {

// The machine's bound in a cube, and the largest second difference along short segments in it.
struct Bend {
    double proved = 0, seen = 0;
};

Bend bend(Scenery &s, NodeId field, double lo, double hi) {
    proof::Work work;
    proof::Flattening context{s.g, work};
    const proof::Ranges ranges = proof::ranges_of(s.scene, work);
    const proof::Tape tape = proof::flatten(context, field);
    proof::Machine machine(tape, ranges, true);
    machine.run(Cell{{Interval(lo, hi), Interval(lo, hi), Interval(lo, hi)}});
    Bend out{machine.bend(), 0};
    proof::Machine at(tape, ranges);
    proof::Dice dice{11};
    const double h = 1e-3;
    for (int i = 0; i < 40'000; ++i) {
        std::array<double, 3> p{}, u{};
        double size = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            p[c] = lo + h + (hi - lo - 2 * h) * dice.next();
            u[c] = 2 * dice.next() - 1;
            size += u[c] * u[c];
        }
        double sum = 0;
        for (const auto &[way, weight] :
             {std::pair{-1.0, 1.0}, std::pair{0.0, -2.0}, std::pair{1.0, 1.0}}) {
            Cell cell;
            for (std::size_t c = 0; c < 3; ++c) cell.p[c] = p[c] + way * h * u[c] / std::sqrt(size);
            at.run(cell);
            sum += weight * at.value(0).middle();
        }
        out.seen = std::max(out.seen, std::fabs(sum) / (h * h));
    }
    return out;
}

} // namespace

TEST_CASE("bends are bounded, and the bounds are near") {
    struct One {
        const char *name;
        std::function<NodeId(Scenery &)> field;
        double attained;
    };
    const std::vector<One> all{
        {"a wave", [](Scenery &s) { return s.g.mul(s.n(0.3), s.sin(s.g.mul(s.x, s.n(5)))); }, 0.9},
        {"a wave of a wave",
         [](Scenery &s) { return s.cos(s.g.add(s.x, s.sin(s.g.mul(s.y, s.n(2))))); }, 0.4},
        {"a product", [](Scenery &s) { return s.g.mul(s.x, s.y); }, 0.45},
        {"a square", [](Scenery &s) { return s.g.mul(s.x, s.x); }, 0.95},
        {"a square of a length",
         [](Scenery &s) {
             return s.g.make(Op::Dot, {s.p, s.p});
         },
         0.95},
        {"a length, off its zero", [](Scenery &s) { return s.length(s.p); }, 0.9},
        {"a quotient by a number", [](Scenery &s) { return s.g.div(s.sin(s.z), s.n(0.5)); }, 0.9},
        {"turned and spread",
         [](Scenery &s) {
             const NodeId q =
                 s.g.make(Op::MatMul, Type::Vec3,
                          {rotation(s.g, s.g.vec3(1, 2, 3), s.n(0.9)), s.g.mul(s.p, s.n(4))});
             return s.sin(s.g.component(q, 1));
         },
         0.2},
    };
    for (const One &one : all) {
        Scenery s;
        const Bend b = bend(s, one.field(s), 0.5, 2);
        INFO(one.name << ": seen " << b.seen << ", proved " << b.proved);
        CHECK(b.seen <= b.proved * (1 + 1e-4) + 1e-5);
        CHECK(b.seen >= one.attained * b.proved);
    }
}

// The machine knows noise by its bounds alone, so here it is asked itself.
TEST_CASE("noise bends within its bounds") {
    const auto check = [](Op op, double (*noise)(double, double, double)) {
        Scenery s;
        const double proved = bend(s, s.call(op, s.g.mul(s.p, s.n(3))), -100, 100).proved;
        double seen = 0;
        proof::Dice dice{5};
        const double h = 1e-4;
        for (int i = 0; i < 400'000; ++i) {
            std::array<double, 3> p{}, u{};
            double size = 0;
            for (std::size_t c = 0; c < 3; ++c) {
                p[c] = 200 * dice.next() - 100;
                u[c] = 2 * dice.next() - 1;
                size += u[c] * u[c];
            }
            const auto at = [&](double way) {
                const double k = way / std::sqrt(size);
                return noise(3 * (p[0] + k * u[0]), 3 * (p[1] + k * u[1]), 3 * (p[2] + k * u[2]));
            };
            seen = std::max(seen, std::fabs(at(h) + at(-h) - 2 * at(0)) / (h * h));
        }
        INFO("seen " << seen << ", proved " << proved);
        CHECK(seen <= proved);
        CHECK(seen >= 0.4 * proved);
    };
    check(Op::Perlin, sem::perlin<double>);
    check(Op::ValueNoise, sem::value_noise<double>);
}

TEST_CASE("what is straight does not bend, what has kinks has no bound") {
    Scenery s;
    CHECK(bend(s, s.g.add(s.g.mul(s.x, s.n(3)), s.y), -1, 1).proved == 0);
    CHECK(bend(s, s.call(Op::Floor, s.n(2.5)), -1, 1).proved == 0);
    for (NodeId kink : {s.call(Op::Abs, s.x), s.g.make(Op::Min, {s.x, s.y}), s.length(s.p),
                        s.call(Op::Fract, s.x), s.call(Op::Worley, s.p),
                        s.sin(s.g.sub(s.g.make(Op::Mod, {s.x, s.n(1)}), s.n(0.5)))})
        CHECK(std::isinf(bend(s, kink, -1, 1).proved));
}

// M = b + 1/(c - a - D) with the least D >= L^2/(2M).
// Steps that the field does not see have no slope, and there it has a ridge.
TEST_CASE("what steps unseen bends as sharply as it may") {
    Scenery s;
    const NodeId ridge = s.g.mul(s.x, s.call(Op::Sign, s.x)), flat = s.g.add(ridge, s.y);
    CHECK(bend(s, ridge, -0.5, 0.5).proved == ir::rounding::infinity);
    CHECK(bend(s, flat, -0.5, 0.5).proved == ir::rounding::infinity);
    CHECK(bend(s, flat, 0.2, 0.8).proved == 0);
}

TEST_CASE("a component that stands in a vector twice bends twice") {
    Scenery s;
    const NodeId waves = s.sin(s.g.mul(s.p, s.n(6)));
    const std::array<int, 3> xxx{0, 0, 0};
    const NodeId sum = s.g.make(Op::Dot, {s.g.swizzle(waves, xxx), s.g.vec3(1, 1, 1)});
    const Bend b = bend(s, sum, -0.4, 0.4);
    CHECK(b.seen > 100); // 3 * 36
    CHECK(b.seen <= b.proved);
}

TEST_CASE("a displaced sphere's second derivative") {
    Scenery s;
    const NodeId waves = s.g.mul(s.n(0.1), s.sin(s.g.mul(s.x, s.n(10))));
    const ShapeFact &fact = s.prove(s.add(ShapeKind::Displace, {s.sphere(1)}, {waves}));
    const double slope = fact.lipschitz_sup, m = fact.curvature;
    CHECK(slope == Approx(2).epsilon(1e-3));
    const double depth = slope * slope / (2 * m);
    CHECK(m == Approx(10 + 1 / (1 - 0.1 - depth)).epsilon(1e-3));
}
TEST_CASE("cores: what a displaced shape has to be") {
    const auto curved = [](const std::function<ShapeId(Scenery &)> &build) {
        Scenery s;
        const NodeId waves = s.g.mul(s.n(0.05), s.sin(s.g.mul(s.x, s.n(10))));
        return std::isfinite(s.prove(s.add(ShapeKind::Displace, {build(s)}, {waves})).curvature);
    };
    const auto rounded = [](Scenery &s, double r) {
        return s.add(ShapeKind::Offset, {s.box(1, 1, 1)}, {s.n(r)});
    };
    CHECK(curved([&](Scenery &s) { return rounded(s, 0.4); }));
    CHECK(curved(
        [&](Scenery &s) { return s.add(translated(s.g, rounded(s, 0.4), s.g.vec3(1, 0, 0))); }));
    CHECK(curved([&](Scenery &s) {
        return s.add(ShapeKind::Union, {rounded(s, 0.4), s.sphere(0.7)});
    }));
    // A torus as it is written, and a length of what is squeezed.
    const auto ring = [](Scenery &s, double squeezed) {
        const NodeId out = s.g.sub(s.length(s.g.swizzle(s.p, std::array{0, 2})), s.n(1));
        const NodeId q = s.g.make(Op::Make, Type::Vec2, {out, s.g.mul(s.y, s.n(squeezed))});
        return s.leaf(s.g.sub(s.length(q), s.n(0.5)));
    };
    CHECK(curved([&](Scenery &s) { return ring(s, 1); }));
    CHECK(curved([&](Scenery &s) { return ring(s, 0.7); }));
    CHECK_FALSE(curved([&](Scenery &s) { return ring(s, 1.3); }));
    CHECK_FALSE(curved([&](Scenery &s) { // coordinates that are not apart: x, and x + y
        const NodeId q = s.g.make(Op::Make, Type::Vec2, {s.x, s.g.add(s.x, s.y)});
        return s.leaf(s.g.sub(s.length(q), s.n(0.5)));
    }));
    CHECK_FALSE(curved([&](Scenery &s) { // not a distance: it rises to both sides of x = -1
        const NodeId q =
            s.g.make(Op::Make, Type::Vec2, {s.g.sub(s.call(Op::Abs, s.x), s.n(-1)), s.y});
        return s.leaf(s.g.sub(s.length(q), s.n(1.5)));
    }));
    CHECK_FALSE(curved([&](Scenery &s) { return s.box(1, 1, 1); }));
    CHECK_FALSE(curved([&](Scenery &s) {
        return s.add(ShapeKind::Union, {rounded(s, 0.4), s.box(2, 2, 2)});
    }));
    CHECK_FALSE(curved([&](Scenery &s) {
        return s.add(ShapeKind::Intersection, {rounded(s, 0.4), s.sphere(0.7)});
    }));
    CHECK_FALSE(curved([&](Scenery &s) { return s.add(ShapeKind::Complement, {s.sphere(1)}); }));
    CHECK_FALSE(curved([&](Scenery &s) { // an inset: its corners are no distance
        return s.add(ShapeKind::Offset, {s.box(3, 3, 3)}, {s.n(-0.3)});
    }));
}
