// Sums and products of two numbers, by the angle between their gradients (machine_arithmetic.cpp;
// docs/lipschitz.md, 2.49): where one has a kink and the other none, no steeper than proved.
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Parts {
    Scenery s;
    Graph &g = s.g;
    NodeId two(NodeId a, NodeId b) { return s.length(g.make(Op::Make, Type::Vec2, {a, b})); }
    double value(NodeId field, const std::array<double, 3> &at) {
        const NodeId found = ir::substitute(g, field, {{s.p, g.vec3(at[0], at[1], at[2])}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    }
    std::vector<NodeId> kinks() {
        const NodeId moved = g.sub(s.x, s.n(0.02));
        return {two(s.x, s.z),
                two(s.x, s.y),
                two(moved, s.z),
                s.length(s.p),
                s.call(Op::Abs, s.x),
                s.call(Op::Abs, g.add(s.x, s.y)),
                g.make(Op::Max, {s.x, s.z})};
    }
    std::vector<NodeId> smooth() {
        const NodeId away = s.length(g.sub(s.p, g.vec3(0.2, 1, 0.1))), x2 = g.mul(s.x, s.x);
        return {s.y, away,   g.sub(s.n(0.3), s.x), s.sin(g.mul(s.n(2), s.y)),
                x2,  s.n(1), g.mul(s.x, s.y),      g.add(s.z, g.mul(s.n(0.5), s.x))};
    }
};

double chance(int i, int k) {
    const double x = std::sin(i * 12.9898 + k * 78.233) * 43758.5453;
    return x - std::floor(x);
}

// Between near points of the cube, many of them near its middle and its axes.
double steepest(Parts &parts, NodeId field, double r) {
    double out = 0;
    for (int i = 0; i < 250; ++i) {
        std::array<double, 3> a{}, b{};
        double run = 0;
        for (int k = 0; k < 3; ++k) {
            const auto at = std::size_t(k);
            const double near = chance(i, k + 6) < 0.4 ? 1e-3 : 1;
            a[at] = r * near * (2 * chance(i, k) - 1) * 0.9;
            b[at] = a[at] + 1e-2 * r * (2 * chance(i, k + 3) - 1) * near;
            run += std::pow(a[at] - b[at], 2);
        }
        const double rise = std::fabs(parts.value(field, a) - parts.value(field, b));
        out = std::max(out, rise / std::sqrt(run));
    }
    return out;
}

} // namespace

TEST_CASE("no sum or product of two is steeper than by the angle between their gradients") {
    Parts parts;
    Graph &g = parts.g;
    const auto kinks = parts.kinks(), smooth = parts.smooth();
    constexpr double r = 0.05;
    int field = 0;
    for (const NodeId kink : kinks)
        for (const NodeId other : smooth)
            for (const bool times : {false, true}) {
                const double by = 4 * chance(++field, 20) - 2;
                const NodeId scaled = g.mul(g.number(by), kink),
                             more = times ? g.mul(g.add(scaled, g.number(1)), other)
                                          : g.sub(scaled, other),
                             sum = g.add(more, g.mul(g.number(0.7),
                                                     kinks[std::size_t(field) % kinks.size()]));
                INFO(field);
                const double bound = parts.s.bound(sum, cube(r)).lipschitz,
                             seen = steepest(parts, sum, r);
                CHECK(seen <= bound * (1 + 1e-6) + 1e-9);
            }
}

TEST_CASE("a kink beside what is smooth is as steep as both at their angle") {
    Parts parts;
    Graph &g = parts.g;
    Scenery &s = parts.s;
    const NodeId axis = parts.two(s.x, s.z), half = g.mul(s.n(0.5), s.y);
    const auto bound = [&](NodeId field) { return s.bound(field, cube(2)).lipschitz; };
    const NodeId twice = g.mul(s.n(2), axis);
    // on the axis 2 across it, and 1/2 and 1 along it
    const NodeId less = g.sub(twice, half);
    CHECK(s.bound(g.sub(less, s.length(s.p))).lipschitz == Approx(2.5).epsilon(1e-3));
    // 1.25 along y, and up to 1 across it: where the second kink is far, as in the cube's corner
    const NodeId away = s.length(g.sub(s.p, g.vec3(0, 9, 0)));
    CHECK(bound(g.sub(axis, g.mul(s.n(0.75), away))) <= 1.4);
    CHECK(bound(g.mul(axis, s.sin(s.y))) <= 2.1 * std::sqrt(2.0));
}
