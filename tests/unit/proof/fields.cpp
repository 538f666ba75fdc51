// What the analysis makes of field expressions.
#include "build.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;
using proof::Cell;

TEST_CASE("a length has slope 1 everywhere, also at 0") {
    Scenery s;
    auto b = s.bound(s.g.sub(s.length(s.p), s.n(1)));
    CHECK(b.lipschitz == Approx(1).epsilon(1e-12));
    CHECK(b.evaluations < 40);
}

TEST_CASE("a square root of squares is a length") {
    Scenery s;
    NodeId q = s.g.add(s.g.mul(s.x, s.x), s.g.add(s.g.mul(s.z, s.z), s.n(0.01)));
    auto b = s.bound(s.call(Op::Sqrt, q));
    CHECK(b.lipschitz == Approx(1).epsilon(1e-6));
    auto c = s.bound(s.call(Op::Sqrt, s.g.add(s.g.mul(s.x, s.x), s.g.mul(s.y, s.y))));
    CHECK(c.lipschitz == Approx(1).epsilon(1e-6));
}

TEST_CASE("the gyroid everywhere, by its period") {
    Scenery s;
    NodeId k = s.n(1 / 0.35);
    NodeId q = s.g.mul(s.p, k);
    NodeId f = s.g.make(Op::Dot, {s.sin(q), s.cos(s.g.swizzle(q, std::array{2, 0, 1}))});
    NodeId shell = s.g.sub(s.g.mul(s.call(Op::Abs, f), s.n(0.35)), s.n(0.05));
    auto b = s.bound(shell);
    INFO("evaluations " << b.evaluations << " sampled " << b.sampled);
    CHECK(b.lipschitz >= std::sqrt(3.0) * (1 - 1e-9));
    CHECK(b.lipschitz <= std::sqrt(3.0) * 1.12);
    auto c = s.bound(shell, cube(1.5));
    INFO("evaluations " << c.evaluations << " sampled " << c.sampled);
    CHECK(c.lipschitz <= std::sqrt(3.0) * 1.12);
}

TEST_CASE("waves of % are continuous behind an even function, and jump otherwise") {
    Scenery s;
    NodeId m = s.g.splat(s.n(2), Type::Vec3);
    NodeId a = s.g.sub(s.g.make(Op::Mod, {s.p, m}), s.g.splat(s.n(1), Type::Vec3));
    auto b = s.bound(s.g.sub(s.length(a), s.n(0.5)));
    CHECK(b.lipschitz == Approx(1).epsilon(1e-9));
    auto jump = s.bound(s.g.component(a, 0));
    CHECK(std::isinf(jump.lipschitz));
    CHECK(jump.trouble == proof::Trouble::Jump);
    CHECK(std::fabs(jump.value_a - jump.value_b) == Approx(2).epsilon(1e-3));
    auto off =
        s.bound(s.length(s.g.sub(s.g.make(Op::Mod, {s.p, m}), s.g.splat(s.n(0.9), Type::Vec3))));
    CHECK(std::isinf(off.lipschitz));
}

TEST_CASE("the Menger field, a loop whose scale changes by turn, has slope 1") {
    Scenery s;
    Graph &g = s.g;
    NodeId a = s.call(Op::Abs, s.p);
    NodeId most = g.make(
        Op::Max, {g.component(a, 0), g.make(Op::Max, {g.component(a, 1), g.component(a, 2)})});
    Loop record;
    record.count = g.integer(4);
    record.max_count = 4;
    record.index = g.fresh_var(Type::Int);
    NodeId d = g.fresh_var(Type::Float), scale = g.fresh_var(Type::Float);
    record.vars = {d, scale};
    NodeId cell = g.sub(g.make(Op::Mod, {g.mul(s.p, scale), g.splat(s.n(2), Type::Vec3)}),
                        g.splat(s.n(1), Type::Vec3));
    NodeId next = g.mul(scale, s.n(3));
    NodeId r =
        s.call(Op::Abs, g.sub(g.splat(s.n(1), Type::Vec3), g.mul(s.call(Op::Abs, cell), s.n(3))));
    NodeId rx = g.component(r, 0), ry = g.component(r, 1), rz = g.component(r, 2);
    auto max = [&](NodeId u, NodeId v) { return g.make(Op::Max, {u, v}); };
    auto min = [&](NodeId u, NodeId v) { return g.make(Op::Min, {u, v}); };
    NodeId c = g.div(g.sub(min(max(rx, ry), min(max(ry, rz), max(rz, rx))), s.n(1)), next);
    record.next = {max(d, c), next};
    LoopId id = g.add_loop(record);
    NodeId node = g.make(Op::Loop, Type::Float, {g.sub(most, s.n(1)), s.n(1)}, id.index);
    NodeId result = g.make(Op::LoopResult, Type::Float, {node}, 0);
    auto b = s.bound(result, cube(1));
    INFO("evaluations " << b.evaluations);
    CHECK(b.lipschitz == Approx(1).epsilon(1e-9));
}

TEST_CASE("division by a length is singular at the origin, and not away from it") {
    Scenery s;
    NodeId f = s.g.sub(s.g.div(s.n(1), s.length(s.p)), s.n(2));
    auto b = s.bound(f, cube(2));
    CHECK(std::isinf(b.lipschitz));
    CHECK(b.trouble == proof::Trouble::Singular);
    CHECK(std::fabs(b.where[0]) < 1e-3);
    auto away = s.bound(f, {{Interval(1, 2), Interval(-2, 2), Interval(-2, 2)}});
    CHECK(away.lipschitz >= 1);
    CHECK(away.lipschitz < 1.06);
    auto root = s.bound(s.call(Op::Sqrt, s.x));
    CHECK(root.trouble == proof::Trouble::Singular);
}

TEST_CASE("what is singular between both sides of a step alone is told from a singular place") {
    Scenery s;
    Graph &g = s.g;
    // An angle about the middle of each cell, far from the border, on which its hull holds all.
    NodeId q = g.sub(
        g.make(Op::Mod, {g.add(s.p, g.splat(s.n(1.5), Type::Vec3)), g.splat(s.n(3), Type::Vec3)}),
        g.splat(s.n(1.5), Type::Vec3));
    NodeId u = g.component(q, 0), v = g.component(q, 1),
           r = g.make(Op::Length, {g.make(Op::Make, Type::Vec2, {u, v})});
    NodeId wave = s.cos(g.mul(s.n(16), g.make(Op::Atan2, {v, u})));
    auto inside = [&](NodeId from) { return g.make(Op::Smoothstep, {s.n(0.05), s.n(0.3), from}); };
    auto b = s.bound(g.sub(r, g.mul(g.mul(s.n(0.02), wave), inside(r))), cube(4));
    CHECK(std::isinf(b.lipschitz));
    CHECK(b.trouble == proof::Trouble::Singular);
    CHECK(b.came_near);
    CHECK(b.each_side);
    // A root of a maximum is singular on one side of the border.
    auto root = s.bound(s.call(Op::Sqrt, g.make(Op::Max, {s.x, s.n(0)})), cube(2));
    CHECK(root.trouble == proof::Trouble::Singular);
    CHECK_FALSE(root.each_side);
    // 1/x beside 0, where its hull holds as much, is singular on both sides.
    auto pole = s.bound(g.div(s.n(1), g.make(Op::Min, {s.call(Op::Abs, s.x), s.n(1)})), cube(2));
    CHECK(pole.trouble == proof::Trouble::Singular);
    CHECK(pole.came_near);
    CHECK_FALSE(pole.each_side);
}

TEST_CASE("a singular place is told within the region, whichever period it was found in") {
    Scenery s;
    auto b = s.bound(s.call(Op::Sqrt, s.sin(s.x)),
                     {{Interval(20, 30), Interval(-1, 1), Interval(-1, 1)}});
    CHECK(b.trouble == proof::Trouble::Singular);
    CHECK(b.where[0] >= 20);
    CHECK(b.where[0] <= 30);
    CHECK(std::sin(b.where[0]) < 1e-6);
}

TEST_CASE("a field that steepens without limit says so") {
    Scenery s;
    auto b = s.bound(s.g.mul(s.x, s.x));
    CHECK(std::isinf(b.lipschitz));
    CHECK(b.at_infinity);
    CHECK(s.bound(s.g.mul(s.x, s.x), cube(2)).lipschitz == Approx(4));
}

TEST_CASE("sin(x)/x is smooth at 0") {
    Scenery s;
    auto b = s.bound(s.g.div(s.sin(s.x), s.x), cube(9));
    CHECK(b.lipschitz >= 0.436);
    CHECK(b.lipschitz < 0.46);
}

TEST_CASE("an if whose arms agree on the border is continuous") {
    Scenery s;
    Graph &g = s.g;
    NodeId zero = s.n(0);
    NodeId fold = g.make(Op::Select, {g.make(Op::Less, {s.x, zero}), g.neg(s.x), s.x});
    CHECK(s.bound(fold).lipschitz == Approx(1));
    NodeId l = s.length(s.p), one = s.n(1);
    NodeId smooth =
        g.make(Op::Select, {g.make(Op::Less, {l, one}), g.mul(l, l), g.sub(g.mul(s.n(2), l), one)});
    auto b = s.bound(smooth, cube(2));
    CHECK(b.lipschitz >= 2);
    CHECK(b.lipschitz < 2.2);
    NodeId linear =
        g.make(Op::Select, {g.make(Op::Less, {g.mul(s.n(2), s.x), one}), s.x, g.sub(one, s.x)});
    CHECK(s.bound(linear).lipschitz == Approx(1));
    NodeId jump = g.make(Op::Select, {g.make(Op::Less, {s.x, zero}), s.n(1), s.x});
    auto bad = s.bound(jump);
    CHECK(bad.trouble == proof::Trouble::Jump);
    CHECK(std::fabs(bad.value_a - bad.value_b) == Approx(1).epsilon(1e-3));
}

TEST_CASE("noise uses its certified constants") {
    Scenery s;
    NodeId f = s.g.mul(s.call(Op::Perlin, s.g.mul(s.p, s.n(4))), s.n(0.03));
    auto b = s.bound(f);
    CHECK(b.lipschitz == Approx(0.03 * 4 * 3.7542).epsilon(1e-6));
    CHECK(b.value.hi == Approx(0.03 * 1.0364).epsilon(1e-6));
}

TEST_CASE("a cut-off hides what lies above it") {
    Scenery s;
    NodeId steep = s.g.sub(s.g.mul(s.length(s.p), s.g.mul(s.length(s.p), s.length(s.p))), s.n(1));
    auto b = s.bound(s.g.make(Op::Min, {steep, s.n(0.2)}));
    INFO("evaluations " << b.evaluations);
    CHECK(b.lipschitz >= 3 * std::pow(1.2, 2.0 / 3) * 0.99);
    CHECK(b.lipschitz < 3 * std::pow(1.2, 2.0 / 3) * 1.12);
}

TEST_CASE("rotations by an angle that varies are as steep as their shear") {
    Scenery s;
    Graph &g = s.g;
    NodeId angle = g.mul(s.y, s.n(2)), c = s.cos(angle), w = s.sin(angle);
    NodeId q = s.vec(g.sub(g.mul(s.x, c), g.mul(s.z, w)), s.y, g.add(g.mul(s.x, w), g.mul(s.z, c)));
    auto b = s.bound(q, {{Interval(-0.5, 0.5), Interval(-1, 1), Interval(-0.5, 0.5)}});
    INFO("evaluations " << b.evaluations << " sampled " << b.sampled);
    double truth = proof::sigma(2 * std::sqrt(0.5));
    CHECK(b.lipschitz >= truth * (1 - 1e-6));
    CHECK(b.lipschitz < truth * 1.1);
}

TEST_CASE("one side of a mirror is enough to look at, and both sides' values are told") {
    Scenery s;
    const proof::Cell box{
        {proof::Interval(-1.4, 1.4), proof::Interval(-1.4, 1.4), proof::Interval(-1.4, 1.4)}};
    auto waves = [&](double shift) {
        auto wave = [&](NodeId x) { return s.sin(s.g.add(x, s.n(shift))); };
        return s.g.mul(wave(s.x), s.g.mul(wave(s.y), wave(s.z)));
    };
    const proof::FieldBound odd = s.bound(waves(0), box), none = s.bound(waves(0.01), box);
    CHECK(odd.evaluations * 3 < none.evaluations);
    CHECK(odd.lipschitz == Approx(none.lipschitz).epsilon(0.06));
    CHECK(odd.value.contains(-0.95));
    CHECK(odd.value.contains(0.95));
    // An even one has its values once: a length is not below 0.
    CHECK(s.bound(s.g.add(s.g.mul(s.x, s.x), s.length(s.p)), box).value.lo >= -1e-9);
}

TEST_CASE("a box as everyone writes it is no steeper than a distance") {
    Scenery s;
    Graph &g = s.g;
    NodeId q = g.sub(s.call(Op::Abs, s.p), g.vec3(0.5, 0.3, 0.4)), zero = g.vec3(0, 0, 0);
    NodeId outside = s.length(g.make(Op::Max, {q, zero}));
    auto inside = [&](NodeId most) { return g.make(Op::Min, {most, s.n(0)}); };
    NodeId yz = g.make(Op::Max, {g.component(q, 1), g.component(q, 2)});
    NodeId all = g.make(Op::Max, {g.component(q, 0), yz});
    auto b = s.bound(g.add(outside, inside(all)));
    CHECK(b.lipschitz == Approx(1).epsilon(1e-9));
    // With a component forgotten it is another field, which is steeper.
    CHECK(s.bound(g.add(inside(yz), outside)).lipschitz > 1.3);
}

TEST_CASE("a distance from a line and the way along it are at right angles") {
    Scenery s;
    Graph &g = s.g;
    const auto times = [&](double by, NodeId of) { return g.mul(s.n(by), of); };
    const NodeId d = g.make(Op::Make, Type::Vec3, {s.n(2.0 / 7), s.n(3.0 / 7), s.n(6.0 / 7)});
    const NodeId along = g.make(Op::Dot, {s.p, d});
    const NodeId way = g.mul(d, g.splat(along, Type::Vec3));
    const NodeId from = s.length(g.sub(s.p, way));
    const auto turned = [&](NodeId r, NodeId y) {
        const NodeId size = g.make(Op::Abs, {y});
        return s.length(g.make(
            Op::Make, Type::Vec2,
            {g.add(times(0.6, r), times(0.8, size)), g.sub(times(0.8, r), times(0.6, size))}));
    };
    CHECK(s.bound(turned(from, along)).lipschitz == Approx(1).epsilon(1e-7));
    // from a point, which the way along does change
    auto point = s.bound(turned(s.length(s.p), along));
    CHECK(point.lipschitz >= point.sampled);
    CHECK(point.lipschitz > 1.2);
    // along another line
    auto other = s.bound(turned(from, s.x));
    CHECK(other.lipschitz >= other.sampled);
    CHECK(other.lipschitz > 1.05);
    CHECK(other.lipschitz < 1.5);
}

TEST_CASE("a norm of powers of directions is as steep as their matrix, or as the steepest one") {
    Scenery s;
    Graph &g = s.g;
    const auto norm_of = [&](const std::vector<NodeId> &parts, double n) {
        NodeId sum;
        for (const NodeId part : parts) {
            const NodeId power = g.make(Op::Pow, {s.call(Op::Abs, part), s.n(n)});
            sum = sum ? g.add(sum, power) : power;
        }
        return s.bound(g.make(Op::Pow, {sum, s.n(1 / n)}), cube(2)).lipschitz;
    };
    const NodeId sum = g.add(s.x, s.y), difference = g.sub(s.x, s.y);
    CHECK(norm_of({sum, difference}, 4) == Approx(std::sqrt(2.0)).epsilon(1e-6));
    CHECK(norm_of({s.x, g.mul(s.n(1.001), s.x)}, 20) >= std::pow(2, 1 / 20.0));
    CHECK(norm_of({s.x, g.mul(s.n(1.001), s.x)}, 20) <= std::pow(2, 1 / 20.0) * 1.0011);
    const NodeId b = g.add(g.mul(s.n(0.6), s.y), g.mul(s.n(0.8), s.z)),
                 c = g.sub(g.mul(s.n(0.6), s.y), g.mul(s.n(0.8), s.z));
    const double three = norm_of({s.x, b, c}, 3); // steepest along z: (2 * 0.8^3)^(1/3)
    CHECK(three >= std::cbrt(2 * 0.512));
    CHECK(three <= std::sqrt(2.0) * 0.8 * (1 + 1e-6));
}
