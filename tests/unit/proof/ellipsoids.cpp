// The distance from an ellipsoid to first order (proof/ellipsoids.h): no steeper than what is proved,
// nearly as steep, and nothing else is taken for it.
#include "proof/ellipsoids.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

// The length of the gradient of k0 (k0 - 1)/k1 at v, by the rules of differentiation.
struct At {
    double k0 = 0, k1 = 0, slope = 0;
};
At at(const std::array<double, 3> &a, const std::array<double, 3> &v) {
    At out;
    for (std::size_t i = 0; i < 3; ++i) {
        out.k0 += std::pow(a[i] * v[i], 2);
        out.k1 += std::pow(a[i] * a[i] * v[i], 2);
    }
    out.k0 = std::sqrt(out.k0), out.k1 = std::sqrt(out.k1);
    for (std::size_t i = 0; i < 3; ++i) {
        const double by_k0 = std::pow(a[i], 2) * v[i] / out.k0,
                     by_k1 = std::pow(a[i], 4) * v[i] / out.k1;
        out.slope += std::pow((2 * out.k0 - 1) / out.k1 * by_k0 -
                                  out.k0 * (out.k0 - 1) / (out.k1 * out.k1) * by_k1,
                              2);
    }
    out.slope = std::sqrt(out.slope);
    return out;
}

struct Quotient {
    Scenery s;
    Graph &g = s.g;
    NodeId r = g.vec3(0.5, 0.4, 0.7), k0 = s.length(g.div({s.p, r})),
           k1 = s.length(g.div({s.p, g.mul(r, r)}));
    NodeId one = g.number(1);
};

} // namespace

TEST_CASE("no ellipsoid is steeper than proved, for single numbers and for ranges of them") {
    proof::Dice dice{7};
    double least_excess = 1e9;
    for (int round = 0; round < 3000; ++round) {
        const double apart = round % 3 == 0 ? 1.2 : round % 3 == 1 ? 3 : 30;
        const auto wide = [&](double x) { return ir::Interval(x * 0.97, x * 1.02); };
        std::array<double, 3> a{};
        for (double &x : a) x = std::pow(apart, dice.next()) * 2;
        double steepest = 0;
        ir::Interval k0(1e9, 0), k1(1e9, 0);
        std::array<ir::Interval, 3> numbers{}, ranges{};
        for (std::size_t i = 0; i < 3; ++i) numbers[i] = a[i], ranges[i] = wide(a[i]);
        const double reach = std::pow(10, 2 * dice.next() - 0.7);
        for (int k = 0; k < 60; ++k) {
            std::array<double, 3> v{};
            for (std::size_t i = 0; i < 3; ++i)
                v[i] = (dice.next() - 0.5) * (k % 4 == 3 && i != 0 ? 0.1 : 1);
            const At there = at(a, v);
            for (double &x : v) x *= (reach + 0.3 * dice.next()) / there.k0;
            const At found = at(a, v);
            steepest = std::max(steepest, found.slope);
            k0 = {std::min(k0.lo, found.k0), std::max(k0.hi, found.k0)};
            k1 = {std::min(k1.lo, found.k1), std::max(k1.hi, found.k1)};
            // A cell that is this point: the excess is what the theorem loses.
            const double alone = proof::slope_of_ellipsoid(found.k0, found.k1, numbers);
            CHECK(found.slope <= alone);
            if (apart > 20) least_excess = std::min(least_excess, alone / found.slope);
        }
        CHECK(steepest <= proof::slope_of_ellipsoid(k0, k1, numbers));
        CHECK(steepest <= proof::slope_of_ellipsoid(k0, k1, ranges));
        CHECK(steepest <=
              proof::slope_of_ellipsoid({k0.lo, ir::rounding::infinity}, {0, k1.hi}, ranges));
    }
    CHECK(least_excess < 1.1);
    // Radii that are alike to 2 in squares: as flat as a distance, outside.
    const std::array<ir::Interval, 3> alike{1 / 0.5, 1 / 0.4, 1 / 0.55};
    CHECK(proof::slope_of_ellipsoid({1, 50}, {0, 500}, alike) < 1 + 1e-6);
    CHECK_FALSE(std::isfinite(proof::slope_of_ellipsoid({0, 50}, {0, 500}, alike)));
}

TEST_CASE("an ellipsoid is seen however it is written, and nothing else is taken for one") {
    Quotient q;
    Graph &g = q.g;
    const auto less = [&](double by) { return g.sub(q.k0, g.number(by)); };
    const auto seen = [&](NodeId id) { return proof::ellipsoid(g, id); };
    const auto found = seen(g.div({g.mul(q.k0, less(1)), q.k1}));
    REQUIRE(found);
    CHECK((found->k0 == q.k0 && found->k1 == q.k1 && found->by == 1));
    REQUIRE(found->inverse.size() == 3);
    for (int i = 0; i < 3; ++i) {
        const double radius = std::array{0.5, 0.4, 0.7}[std::size_t(i)];
        CHECK(g.as_number(found->inverse[std::size_t(i)]).value_or(0) == Approx(1 / radius));
    }
    CHECK(seen(g.mul(less(1), g.div({q.k0, q.k1}))));
    CHECK(seen(g.mul(g.number(-0.5), g.div({g.mul(less(1), q.k0), q.k1})))->by == -0.5);
    CHECK_FALSE(seen(g.div({g.mul(q.k0, less(0.9)), q.k1})));
    CHECK_FALSE(seen(g.div({g.mul(q.k0, g.add(q.k0, q.one)), q.k1})));
    CHECK_FALSE(seen(g.div({less(1), q.k1})));
    CHECK_FALSE(seen(g.div({g.mul(q.k1, less(1)), q.k1})));
    // Another power or another point: the radii's inverses are then not what was found, or none.
    const NodeId other = q.s.length(g.div({g.sub(q.s.p, g.vec3(0.1, 0, 0)), g.mul(q.r, q.r)}));
    CHECK_FALSE(seen(g.div({g.mul(q.k0, less(1)), other})));
    const NodeId turned = q.s.length(g.div({g.swizzle(q.s.p, std::array{1, 0, 2}), q.r}));
    CHECK_FALSE(seen(g.div({g.mul(q.k0, less(1)), turned})));
    // A radius that reads the point.
    const NodeId wide = g.add(q.one, g.mul(q.s.x, q.s.x)), by_point = g.splat(wide, ir::Type::Vec3);
    const NodeId k0 = q.s.length(g.div({q.s.p, by_point})),
                 k1 = q.s.length(g.div({q.s.p, g.mul(by_point, by_point)}));
    CHECK_FALSE(seen(g.div({g.mul(k0, g.sub(k0, q.one)), k1})));
}

TEST_CASE("outside it is kept as it is, and has no pole inside") {
    Quotient q;
    Graph &g = q.g;
    const NodeId f = g.div({g.mul(q.k0, g.sub(q.k0, q.one)), q.k1});
    const NodeId kept = proof::kept_outside(g, *proof::ellipsoid(g, f));
    REQUIRE(proof::ellipsoid(g, kept));
    const auto value = [&](NodeId of, std::array<double, 3> v) {
        const NodeId found = ir::substitute(g, of, {{q.s.p, g.vec3(v[0], v[1], v[2])}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    };
    proof::Dice dice{13};
    for (int i = 0; i < 4000; ++i) {
        std::array<double, 3> v{};
        for (double &x : v) x = 1.4 * (dice.next() - 0.5);
        const double expected = value(q.k0, v) >= 1 ? value(f, v) : 0;
        CHECK(value(kept, v) == Approx(expected).margin(1e-12));
    }
    CHECK(q.s.bound(kept, cube(2)).lipschitz < 1.2);
    // Kept by other numbers it is another field.
    const auto with = [&](double of_k0, double of_k1) {
        const NodeId k0 = g.make(Op::Max, {q.k0, g.number(of_k0)}),
                     k1 = g.make(Op::Max, {q.k1, g.number(of_k1)});
        return g.div({g.mul(k0, g.sub(k0, q.one)), k1});
    };
    CHECK_FALSE(proof::ellipsoid(g, with(0.9, 1 / 0.7)));
    CHECK_FALSE(proof::ellipsoid(g, with(1, 2)));
    CHECK_FALSE(proof::ellipsoid(
        g, g.div({g.mul(q.k0, g.sub(q.k0, q.one)), g.make(Op::Max, {q.k1, g.number(1 / 0.7)})})));
}

TEST_CASE("a field with an ellipsoid is no steeper than proved") {
    for (const double third : {0.45, 0.7, 1.5}) {
        Scenery s;
        Graph &g = s.g;
        const NodeId size = s.parameter(0.4, 0.5), r = s.vec(size, g.number(third), g.number(0.4)),
                     q = g.sub(s.p, g.vec3(0.1, -0.2, 0.3)), k0 = s.length(g.div({q, r})),
                     k1 = s.length(g.div({q, g.mul(r, r)})),
                     f = g.div({g.mul(k0, g.sub(k0, g.number(1))), k1});
        const proof::Cell box{{ir::Interval(0.9, 2), ir::Interval(-2, 2), ir::Interval(-2, 2)}};
        const double bound = s.bound(f, box).lipschitz;
        proof::Dice dice{3};
        double steepest = 0;
        for (int i = 0; i < 20'000; ++i) {
            const std::array<double, 3> radii{0.4 + 0.1 * dice.next(), third, 0.4};
            std::array<double, 3> a{}, v{};
            for (std::size_t k = 0; k < 3; ++k) a[k] = 1 / radii[k];
            v = {0.8 + 1.1 * dice.next(), 4 * dice.next() - 1.8, 4 * dice.next() - 2.3};
            steepest = std::max(steepest, at(a, v).slope);
        }
        INFO(third);
        CHECK(steepest <= bound);
        CHECK(bound <= 1.35 * steepest);
    }
}
