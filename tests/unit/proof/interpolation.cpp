// Numbers interpolated by the fractions of the point: for all that they may be, nothing is steeper
// than what is proved, and the steepest nearly is.
#include "proof/interpolation.h"
#include "build.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

std::optional<proof::Interpolation> interpolation(Graph &graph, NodeId scalar) {
    proof::Work work;
    proof::SteepnessOfWeights known;
    return proof::interpolation(graph, scalar, known, work);
}

// A weight as an expression, as a function, and by its slope.
struct Weight {
    const char *name;
    std::function<NodeId(Graph &, NodeId)> node;
    std::function<double(double)> value, slope;
    double near; // the steepest slope, of what is proved, at least
};

NodeId times(Graph &g, std::initializer_list<NodeId> factors) {
    NodeId out = g.number(1);
    for (NodeId factor : factors) out = g.mul(out, factor);
    return out;
}

const std::vector<Weight> weights{
    {"itself", [](Graph &, NodeId f) { return f; }, [](double f) { return f; },
     [](double) { return 1.0; }, 0.999},
    {"a cubic",
     [](Graph &g, NodeId f) {
         return times(g, {f, f, g.sub(g.number(3), g.mul(g.number(2), f))});
     },
     [](double f) { return f * f * (3 - 2 * f); }, [](double f) { return 6 * f * (1 - f); }, 0.998},
    {"smoothstep",
     [](Graph &g, NodeId f) {
         return g.make(Op::Smoothstep, {g.number(0), g.number(1), f});
     },
     [](double f) { return f * f * (3 - 2 * f); }, [](double f) { return 6 * f * (1 - f); }, 0.998},
    {"a quintic",
     [](Graph &g, NodeId f) {
         const NodeId inner = g.sub(g.mul(g.number(6), f), g.number(15));
         return times(g, {f, f, f, g.add(g.mul(f, inner), g.number(10))});
     },
     [](double f) { return f * f * f * (f * (6 * f - 15) + 10); },
     [](double f) { return 30 * f * f * (1 - f) * (1 - f); }, 0.99},
};

// Numbers at the corners of a cell, each a hash of the cell moved by another way.
struct Lattice {
    Scenery s;
    NodeId cell = s.call(Op::Floor, s.p), fraction = s.call(Op::Fract, s.p);
    NodeId corner(unsigned which) {
        return s.call(Op::Hash, s.g.make(Op::Dot, {cell, s.g.vec3(1, 57, 113 + which)}));
    }
    NodeId weight(const Weight &of, int axis) {
        return of.node(s.g, s.g.component(fraction, axis));
    }
    // By means of means, from the given axis down.
    NodeId means(const Weight &by, int axis, unsigned which = 0) {
        if (axis < 0) return corner(which);
        return s.g.make(Op::Mix, {means(by, axis - 1, which),
                                  means(by, axis - 1, which | 1u << axis), weight(by, axis)});
    }
    // By products of weights.
    NodeId products(const Weight &by, int axes) {
        NodeId sum = s.n(0);
        for (unsigned which = 0; which < 1u << axes; ++which) {
            NodeId term = corner(which);
            for (int axis = 0; axis < axes; ++axis) {
                const NodeId w = weight(by, axis);
                term = s.g.mul(term, which >> axis & 1 ? w : s.g.sub(s.n(1), w));
            }
            sum = s.g.add(sum, term);
        }
        return sum;
    }
};

// The steepest slope of all whose corners are 0 or 1, by trying places; the norm of a slope is
// convex in each corner, so others are no steeper.
double steepest(const Weight &by, int axes) {
    constexpr int places = 24;
    double most = 0;
    int count = 1;
    for (int axis = 0; axis < axes; ++axis) count *= places + 1;
    for (int place = 0; place < count; ++place) {
        std::array<double, 3> w{}, slope{};
        for (int axis = 0, rest = place; axis < axes; ++axis, rest /= places + 1) {
            const double f = double(rest % (places + 1)) / places;
            w[std::size_t(axis)] = by.value(f), slope[std::size_t(axis)] = by.slope(f);
        }
        std::array<std::array<double, 8>, 3> part{}; // of the slope along an axis, a corner's
        for (unsigned which = 0; which < 1u << axes; ++which)
            for (std::size_t along = 0; along < std::size_t(axes); ++along) {
                double product = 1;
                for (std::size_t axis = 0; axis < std::size_t(axes); ++axis) {
                    const bool far = which >> axis & 1;
                    product *= axis == along ? (far ? slope[axis] : -slope[axis])
                                             : (far ? w[axis] : 1 - w[axis]);
                }
                part[along][which] = product;
            }
        for (unsigned corners = 0; corners < 1u << (1u << axes); ++corners) {
            double square = 0;
            for (std::size_t along = 0; along < std::size_t(axes); ++along) {
                double sum = 0;
                for (unsigned which = 0; which < 1u << axes; ++which)
                    if (corners >> which & 1) sum += part[along][which];
                square += sum * sum;
            }
            most = std::max(most, square);
        }
    }
    return std::sqrt(most);
}

} // namespace

TEST_CASE("interpolated numbers are no steeper than proved, and nearly that") {
    for (const Weight &by : weights)
        for (int axes = 1; axes <= 3; ++axes) {
            INFO(by.name << ", " << axes);
            const double most = steepest(by, axes);
            Lattice a, b;
            const auto means = interpolation(a.s.g, a.means(by, axes - 1)),
                       products = interpolation(b.s.g, b.products(by, axes));
            REQUIRE(means);
            REQUIRE(products);
            CHECK(means->corners.size() == 1u << axes);
            CHECK(products->corners.size() == 1u << axes);
            CHECK(means->along.size() == std::size_t(axes));
            CHECK(most <= means->steepness);
            CHECK(most >= by.near * means->steepness);
            CHECK(products->steepness == Approx(means->steepness));
        }
}

TEST_CASE("corners are what they were, however they are written") {
    Lattice l;
    Graph &g = l.s.g;
    const NodeId a = l.corner(0), b = l.corner(1), u = l.weight(weights[1], 0);
    const auto sum = interpolation(g, g.add(a, g.mul(g.sub(b, a), u)));
    REQUIRE(sum);
    CHECK(sum->corners == std::vector<NodeId>{a, b});
    const auto back = interpolation(g, g.add(g.mul(a, u), g.mul(b, g.sub(l.s.n(1), u))));
    REQUIRE(back);
    const auto less = interpolation(g, g.add(a, g.mul(g.neg(g.add(g.neg(b), a)), u)));
    REQUIRE(less);
    CHECK(less->corners == std::vector<NodeId>{a, b});
    CHECK(back->corners == std::vector<NodeId>{b, a});
}

TEST_CASE("what is no interpolation between numbers that stand still is not taken for one") {
    Lattice l;
    Graph &g = l.s.g;
    const NodeId a = l.corner(0), b = l.corner(1);
    const NodeId f = g.component(l.fraction, 0), h = g.component(l.fraction, 1);
    const auto mix = [&](NodeId x, NodeId y, NodeId t) {
        return interpolation(g, g.make(Op::Mix, {x, y, t}));
    };
    const auto number = [&](double x) { return g.number(x); };
    REQUIRE(mix(a, b, f));
    CHECK(!mix(a, b, g.mul(number(4), g.mul(f, g.sub(number(1), f)))));   // 0 at both ends
    CHECK(!mix(a, b, g.sub(g.mul(number(2), f), g.mul(f, g.mul(f, f))))); // above 1 between
    CHECK(!mix(a, l.s.x, f));                                             // moves with the point
    CHECK(!mix(a, g.mul(b, f), f));                                       // twice the same weight
    CHECK(!mix(a, g.mul(b, g.mul(h, h)), g.mul(f, h)));                   // two weights of one axis
    CHECK(!mix(a, b, g.mul(f, l.s.call(Op::Abs, f))));                    // no polynomial
    CHECK(!mix(a, b, l.s.y));
    CHECK(!interpolation(g, a)); // no fraction
    CHECK(!interpolation(g, f)); // no step
}
