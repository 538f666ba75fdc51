// Vectors along themselves (proof/radial.h): no steeper than what is proved, and nearly as steep.
#include "proof/radial.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Folding {
    Scenery s;
    Graph &g = s.g;
    NodeId square = g.make(Op::Dot, {s.p, s.p}), size = s.length(s.p), one = g.number(1);
    NodeId clamp(NodeId x, double lo, double hi) {
        return g.make(Op::Clamp, {x, g.number(lo), g.number(hi)});
    }
    std::array<double, 3> value(NodeId vector, std::array<double, 3> at) {
        const NodeId found = ir::substitute(g, vector, {{s.p, g.vec3(at[0], at[1], at[2])}});
        REQUIRE(g.is_constant(found));
        const ir::Constant &c = g.constant_of(found);
        return {c.value[0], c.value[1], c.value[2]};
    }
    double bound(NodeId vector) { // of its length less a number, in a ball about a far point
        const NodeId field = s.length(g.sub(vector, g.vec3(0.3, 5, 0.1)));
        proof::Work work;
        proof::Flattening context{g, work};
        const proof::Ranges ranges = proof::ranges_of(s.scene, work);
        proof::Domain domain;
        domain.box = {{ir::Interval(-2, 2), ir::Interval(-2, 2), ir::Interval(0.3, 2)}};
        return proof::bound_field(context, ranges, field, domain, {}).lipschitz;
    }
};

struct Fold {
    const char *name;
    std::function<NodeId(Folding &)> factor;
};
const std::vector<Fold> folds{
    {"an inversion", [](Folding &f) { return f.g.div(f.one, f.square); }},
    {"a direction", [](Folding &f) { return f.g.div(f.one, f.size); }},
    {"a fold by clamp", [](Folding &f) { return f.clamp(f.g.div(f.one, f.square), 1, 4); }},
    {"a fold by max",
     [](Folding &f) {
         return f.g.div(f.g.number(1.2), f.g.make(Op::Max, {f.square, f.g.number(0.2)}));
     }},
    {"a fold of two", [](Folding &f) {
         return f.g.make(Op::Min, {f.g.div(f.g.number(2), f.size),
                                   f.g.div(f.g.number(3), f.clamp(f.square, 0.5, 2))});
     }}};

} // namespace

TEST_CASE("a vector along itself is as steep as its factor") {
    for (const auto &[name, factor] : folds) {
        INFO(name);
        Folding f;
        const NodeId made = f.g.mul(f.s.p, factor(f));
        const auto found = proof::radial(f.g, made);
        REQUIRE(found);
        CHECK((found->vector == f.s.p && !found->divides));
        double steepest = 0;
        for (int i = 0; i < 4000; ++i) {
            const auto in = [&](int k, double lo, double hi) {
                const double x = std::sin(i * 12.9898 + k * 78.233) * 43758.5453;
                return lo + (hi - lo) * (x - std::floor(x));
            };
            const double near = in(6, 0, 1); // to where the factors are greatest
            const std::array<double, 3> a{in(0, -2, 2) * near, in(1, -2, 2) * near,
                                          0.3 + in(2, 0, 1.7) * near * near};
            std::array<double, 3> b = a;
            for (int k = 0; k < 3; ++k) b[std::size_t(k)] += 1e-4 * in(3 + k, -1, 1);
            const auto u = f.value(made, a), v = f.value(made, b);
            double run = 0, rise = 0;
            for (std::size_t k = 0; k < 3; ++k)
                run += std::pow(a[k] - b[k], 2), rise += std::pow(u[k] - v[k], 2);
            steepest = std::max(steepest, std::sqrt(rise / run));
        }
        const double bound = f.bound(made);
        CHECK(steepest <= bound * (1 + 1e-3)); // by differences
        CHECK(bound <= 1.3 * steepest);
    }
}

TEST_CASE("what is not along itself, or grows with its length, is none") {
    Folding f;
    Graph &g = f.g;
    const NodeId inverse = g.div(f.one, f.square);
    CHECK(proof::radial(g, g.div(f.s.p, g.splat(f.square, Type::Vec3))));
    CHECK(proof::radial(g, g.mul(f.s.x, inverse)));
    CHECK_FALSE(proof::radial(g, g.mul(g.add(f.s.p, g.vec3(1, 0, 0)), inverse)));
    CHECK_FALSE(proof::radial(g, g.mul(g.swizzle(f.s.p, std::array{0, 0, 1}), inverse)));
    CHECK_FALSE(proof::radial(g, g.mul(f.s.p, f.square)));
    CHECK_FALSE(proof::radial(g, g.mul(f.s.p, g.mul(inverse, inverse))));
    CHECK_FALSE(proof::radial(g, g.mul(f.s.p, g.add(inverse, f.one))));
    CHECK_FALSE(proof::radial(g, g.mul(f.s.p, g.div(f.one, g.add(f.square, f.one)))));
    CHECK_FALSE(proof::radial(g, g.mul(f.s.p, g.div(f.s.x, f.square))));
}
