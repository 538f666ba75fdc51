// The angle to an axis, as spherical coordinates have it: acos(p.y / length(p)) (polar.h).
#include "build.h"

#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <random>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Spherical {
    Scenery s;
    Graph &g = s.g;
    NodeId r = s.length(s.p);
    NodeId theta = s.call(Op::Acos, g.div(s.y, r));
    double bound(NodeId field, const proof::Cell &cell) { return s.bound(field, cell).lipschitz; }
};
// Across the axis, at this height at least.
proof::Cell above(double from) {
    return {{Interval(-1, 1), Interval(from, from + 2), Interval(-1, 1)}};
}

} // namespace

TEST_CASE("an angle to an axis is no steeper than 1 over the length, also on the axis") {
    Spherical b;
    Graph &g = b.g;
    CHECK(b.bound(b.theta, above(0.5)) == Approx(2).epsilon(0.06));
    CHECK(b.bound(b.s.call(Op::Asin, g.div(b.s.y, b.r)), above(1)) == Approx(1).epsilon(0.06));
    const NodeId kept = g.make(Op::Clamp, {g.div(b.s.y, b.r), g.number(-1), g.number(1)});
    CHECK(b.bound(b.s.call(Op::Acos, kept), above(1)) == Approx(1).epsilon(0.06));
    // of a flat vector, moved
    const NodeId q = g.make(Op::Make, Type::Vec2, {g.sub(b.s.x, g.number(0.25)), b.s.y});
    const NodeId flat = b.s.call(Op::Acos, g.div(b.s.y, b.s.length(q)));
    CHECK(b.bound(flat, above(1)) == Approx(1).epsilon(0.06));
    // everywhere above a plane
    const proof::Cell endless{
        {Interval::everything(), Interval(2, ir::rounding::infinity), Interval::everything()}};
    CHECK(b.bound(g.mul(b.r, b.theta), endless) < 6);
}

TEST_CASE("what is no angle to an axis is as steep on it as it is") {
    Spherical b;
    Graph &g = b.g;
    const auto acos = [&](NodeId a, NodeId length) { return b.s.call(Op::Acos, g.div(a, length)); };
    CHECK_FALSE(b.bound(b.theta, above(-0.5)) < 1e6); // the origin
    CHECK_FALSE(b.bound(acos(g.mul(g.number(1.2), b.s.y), b.r), above(1)) < 1e6);
    const NodeId moved = g.sub(b.s.p, g.vec3(0.25, 0, 0));
    const NodeId beside = g.make(Op::Make, Type::Vec2, {b.s.x, g.mul(g.number(0.9), b.s.y)});
    CHECK(b.bound(acos(b.s.y, b.s.length(moved)), above(1)) < 1.06);
    CHECK_FALSE(b.bound(acos(b.s.y, b.s.length(beside)), above(1)) < 1e6);
    CHECK_FALSE(b.bound(acos(b.s.y, g.make(Op::Max, {b.r, g.number(1.5)})), above(1)) < 1e6);
}

TEST_CASE("fields of spherical coordinates are no steeper than proved") {
    std::mt19937 random(5);
    const auto any = [&](double lo, double hi) {
        return std::uniform_real_distribution(lo, hi)(random);
    };
    for (int trial = 0; trial < 40; ++trial) {
        Spherical b;
        Graph &g = b.g;
        const NodeId wave = b.s.sin(g.mul(g.number(any(1, 8)), b.theta));
        const NodeId field =
            trial % 2 ? g.add(b.r, g.mul(g.number(any(0.1, 1)), wave)) : g.mul(b.r, wave);
        const double bound = b.bound(field, above(0.5));
        REQUIRE(bound < 1e3);
        Reference reference(b.s.scene);
        const auto value = [&](const std::array<double, 3> &at) {
            reference.point = at;
            return reference.number(field);
        };
        for (int k = 0; k < 300; ++k) {
            const double near = std::pow(10, any(-5, 0)), apart = std::pow(10, any(-4, 0));
            const std::array<double, 3> p{near * any(-1, 1), any(0.5, 2.5), near * any(-1, 1)};
            std::array<double, 3> q = p;
            double way = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double lo = i == 1 ? 0.5 : -1, hi = i == 1 ? 2.5 : 1;
                q[i] = std::clamp(p[i] + std::min(near, apart) * any(-1, 1), lo, hi);
                way += (q[i] - p[i]) * (q[i] - p[i]);
            }
            CHECK(std::fabs(value(p) - value(q)) <= bound * std::sqrt(way) * (1 + 1e-9) + 1e-9);
        }
    }
}
