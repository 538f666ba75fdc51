// Numbers and powers of Lipschitz functions (machine_raised.cpp): slopes at all points, which are not
// exceeded and nearly reached, though the powers' own have no bound.
#include "build.h"

#include "tests/support/effort.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <functional>
#include <random>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Falling {
    Scenery s;
    Graph &g = s.g;
    NodeId n(double x) { return g.number(x); }
    NodeId square(NodeId v) { return g.make(Op::Dot, {v, v}); }
    NodeId r2() { return square(s.p); }
    NodeId inverse(NodeId of) { return g.div(n(1), of); }
};

struct FallingField {
    const char *name;
    std::function<NodeId(Falling &)> of;
    double steepest;
};
const std::vector<FallingField> falling_fields{
    {"a Gaussian", [](Falling &b) { return b.s.call(Op::Exp, b.g.neg(b.r2())); }, 0.857764},
    {"of a narrow one, by a power of 2",
     [](Falling &b) { return b.s.call(Op::Exp2, b.g.mul(b.n(-4), b.r2())); },
     0.857764 * 2 * std::sqrt(std::log(2.0))},
    {"raised by a number in the exponent",
     [](Falling &b) { return b.s.call(Op::Exp, b.g.sub(b.n(1), b.g.div(b.r2(), b.n(0.25)))); },
     0.857764 * 2 * std::exp(1.0)},
    {"the inverse of 1 and a square", [](Falling &b) { return b.inverse(b.g.add(b.n(1), b.r2())); },
     0.649519},
    {"the inverse root of 4 and a square",
     [](Falling &b) { return b.s.call(Op::InverseSqrt, b.g.add(b.r2(), b.n(4))); }, 0.3849 / 4},
    {"a negative power",
     [](Falling &b) {
         return b.g.make(Op::Pow, {b.g.add(b.n(1), b.g.mul(b.s.x, b.s.x)), b.n(-1.5)});
     },
     0.858650},
    {"the inverse of 1 and a fourth power",
     [](Falling &b) {
         const NodeId x2 = b.g.mul(b.s.x, b.s.x);
         return b.inverse(b.g.add(b.g.mul(x2, x2), b.n(1)));
     },
     1.0651},
    {"the logarithm of 1 and a square",
     [](Falling &b) { return b.s.call(Op::Log, b.g.add(b.n(1), b.r2())); }, 1},
    {"the root of a number and two squares",
     [](Falling &b) {
         const NodeId squares = b.g.add(b.g.mul(b.s.x, b.s.x), b.g.mul(b.s.z, b.s.z));
         return b.s.call(Op::Sqrt, b.g.add(b.n(1), squares));
     },
     1},
    {"a sigmoid",
     [](Falling &b) {
         const NodeId e = b.s.call(Op::Exp, b.g.mul(b.n(-4), b.s.x));
         return b.inverse(b.g.add(b.n(1), e));
     },
     1},
    {"the exponential of an exponential",
     [](Falling &b) { return b.s.call(Op::Exp, b.g.neg(b.s.call(Op::Exp, b.s.x))); },
     std::exp(-1.0)},
    {"two Gaussians far apart",
     [](Falling &b) {
         const NodeId q = b.g.sub(b.s.p, b.g.vec3(9, 0, 0));
         return b.g.add(b.s.call(Op::Exp, b.g.neg(b.r2())),
                        b.s.call(Op::Exp, b.g.neg(b.square(q))));
     },
     0.857764},
};

} // namespace

TEST_CASE("what falls as a power grows has a slope at all points") {
    for (const auto &[name, of, steepest] : falling_fields) {
        INFO(name);
        Falling b;
        const proof::FieldBound found = b.s.bound(of(b));
        CHECK(found.lipschitz >= steepest * 0.9999);
        CHECK(found.lipschitz <= steepest * 1.1);
    }
}

TEST_CASE("what grows as a power, or falls to where it is 0, has none") {
    Falling b;
    for (const NodeId field :
         {b.s.call(Op::Exp, b.r2()), b.s.call(Op::Sqrt, b.g.add(b.n(1), b.g.mul(b.r2(), b.r2()))),
          b.inverse(b.r2()), b.inverse(b.g.sub(b.n(1), b.r2())), b.inverse(b.g.add(b.s.x, b.n(1)))})
        CHECK_FALSE(b.s.bound(field).lipschitz < 1e6);
}

TEST_CASE("no sum of what falls is steeper than proved, whatever it is made of") {
    std::mt19937 random(7);
    const auto any = [&](double lo, double hi) {
        return std::uniform_real_distribution(lo, hi)(random);
    };
    for (int trial = 0; trial < effort(100); ++trial) {
        Falling b;
        Graph &g = b.g;
        NodeId sum = b.n(0);
        for (int i = 0; i < 3; ++i) {
            const NodeId q = g.sub(b.s.p, g.vec3(any(-1, 1), any(-1, 1), any(-1, 1)));
            const NodeId u = g.component(q, 0), v = g.component(q, 1);
            const NodeId turned = g.add(g.mul(b.n(any(-2, 2)), u), g.mul(b.n(any(-2, 2)), v));
            NodeId w = any(0, 1) < 0.5 ? b.square(q) : g.mul(turned, turned);
            if (any(0, 1) < 0.3) w = g.add(w, g.mul(v, v));
            if (any(0, 1) < 0.3) w = g.mul(w, w);
            w = g.mul(b.n(any(0.1, 4)), w);
            const NodeId up = g.add(w, b.n(any(0.05, 2)));
            const std::array falls{
                b.inverse(up),
                g.div(g.component(q, 2), g.mul(up, up)),
                g.div(b.s.sin(g.mul(b.n(3), u)), up),
                b.s.call(Op::Exp, g.sub(b.n(any(-1, 1)), w)),
                b.s.call(Op::Log, up),
                g.make(Op::Pow, {up, b.n(any(-3, -0.2))}),
            };
            sum = g.add(sum, g.mul(b.n(any(-1, 1)), falls[std::size_t(any(0, 5.999))]));
        }
        const double bound = b.s.bound(sum, cube(3)).lipschitz;
        INFO(trial);
        REQUIRE(bound < 1e6);
        Reference reference(b.s.scene);
        const auto value = [&](const std::array<double, 3> &at) {
            reference.point = at;
            return reference.number(sum);
        };
        double steepest = 0;
        for (int k = 0; k < 400; ++k) {
            const std::array<double, 3> at{any(-3, 3), any(-3, 3), any(-3, 3)};
            double squares = 0;
            for (std::size_t axis = 0; axis < 3; ++axis) {
                auto lo = at, hi = at;
                lo[axis] -= 1e-5, hi[axis] += 1e-5;
                squares += std::pow((value(hi) - value(lo)) / 2e-5, 2);
            }
            steepest = std::max(steepest, std::sqrt(squares));
        }
        CHECK(steepest <= bound * (1 + 1e-6));
    }
}

TEST_CASE("what a number keeps off 0, or is written in another order, falls as well") {
    Falling b;
    Graph &g = b.g;
    const NodeId x = b.s.x;
    const auto bound = [&](NodeId field) { return b.s.bound(field).lipschitz; };
    CHECK(bound(b.s.call(Op::Exp, g.mul(g.neg(x), x))) < 0.86);
    CHECK(bound(b.s.call(Op::Exp, g.mul(g.mul(b.n(-2), x), x))) < 1.22);
    CHECK(bound(b.s.call(Op::Exp, g.div(g.mul(x, g.neg(x)), b.n(4)))) < 0.43);
    // 1/max(r*r, 1/4) is steepest at r = 1/2
    CHECK(bound(b.inverse(g.make(Op::Max, {b.r2(), b.n(0.25)}))) == Approx(16).epsilon(0.06));
    CHECK(bound(b.inverse(g.make(Op::Clamp, {b.r2(), b.n(0.25), b.n(4)}))) ==
          Approx(16).epsilon(0.06));
    // min(r*r, -1) is -1, and no square: the exponential of what is below is no steeper for it
    const NodeId below = g.make(Op::Min, {b.r2(), b.n(-1)});
    CHECK(bound(g.add(below, b.s.call(Op::Exp, g.neg(b.r2())))) < 0.87);
}

TEST_CASE("what leaves single precision where rays go has no bound, though its slope has one") {
    Falling b;
    Graph &g = b.g;
    const auto softplus = [&](double rate) {
        const NodeId e = b.s.call(Op::Exp, g.mul(b.n(rate), b.s.x));
        return g.div(b.s.call(Op::Log, g.add(b.n(1), e)), b.n(rate));
    };
    const proof::FieldBound everywhere = b.s.bound(softplus(3)),
                            nearby = b.s.bound(softplus(3), cube(10));
    CHECK_FALSE(everywhere.lipschitz < 1e6);
    CHECK(everywhere.trouble == proof::Trouble::Overflow);
    CHECK(nearby.lipschitz == Approx(1).epsilon(0.05));
}

TEST_CASE(
    "a vector over what falls, and its logarithm, are as steep as all their components together") {
    Falling b;
    Graph &g = b.g;
    const NodeId ones = g.vec3(1, 1, 1), up = g.add(b.n(1), b.r2()), e = b.s.call(Op::Exp, b.s.x);
    const auto bound = [&](NodeId field) { return b.s.bound(field, cube(2)).lipschitz; };
    const double root = std::sqrt(3.0);
    const auto splat = [&](NodeId x) { return b.s.vec(x, x, x); };
    CHECK(bound(b.s.length(g.div(ones, up))) >= root * 0.6495);
    CHECK(bound(b.s.length(g.div(ones, e))) >= root * std::exp(2.0) * 0.999);
    CHECK(bound(b.s.length(b.s.call(Op::Log, splat(up)))) >= root * 0.999);
    CHECK(bound(b.s.length(b.s.call(Op::Log, g.mul(ones, g.add(b.n(1), e))))) >=
          root / (1 + std::exp(-2.0)) * 0.999);
    CHECK(bound(b.s.length(g.div(b.s.p, up))) >= 0.999);
}

TEST_CASE("a sum of two fourth powers falls as one does") {
    Falling b;
    Graph &g = b.g;
    const auto fourth = [&](NodeId x) { return g.make(Op::Pow, {x, b.n(4)}); };
    const NodeId sum = g.add(fourth(b.s.x), fourth(b.s.y));
    CHECK(b.s.bound(b.s.call(Op::Exp, g.neg(sum))).lipschitz < 2.5);
}
