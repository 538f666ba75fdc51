// What is a number because vectors over their lengths are unit vectors: compared with values.
#include "proof/unit_vectors.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

// Frames of random vectors, as people write them, or nearly.
struct Frames {
    Scenery s;
    proof::Dice dice;
    std::vector<NodeId> params;

    explicit Frames(std::uint64_t seed) : dice{seed} {
        for (int i = 0; i < 3; ++i) params.push_back(s.parameter(0.1, 2));
    }
    int pick(int n) { return int(dice.next() * n); }
    NodeId scalar() {
        const NodeId param = params[std::size_t(pick(3))];
        switch (pick(6)) {
        case 0: return s.n(double(pick(9)) / 4 - 1);
        case 1: return s.cos(param);
        case 2: return s.sin(param);
        case 3: return s.g.add(s.n(0.1), s.g.mul(s.n(0.7), param));
        case 4: return s.g.mul(param, param);
        default: return param;
        }
    }
    NodeId vector() {
        std::vector<NodeId> parts;
        for (int i = 0; i < 3; ++i) parts.push_back(scalar());
        return s.g.make(Op::Make, Type::Vec3, parts);
    }
    NodeId unit(NodeId v) {
        if (pick(3) > 0) return s.call(Op::Normalize, v);
        const NodeId length =
            pick(2) == 0 ? s.length(v) : s.call(Op::Sqrt, s.g.make(Op::Dot, {v, v}));
        return s.g.div(v, s.g.splat(length, Type::Vec3));
    }
    NodeId cross(NodeId a, NodeId b) { return s.g.make(Op::Cross, {a, b}); }

    // A product of two of a frame's vectors.
    NodeId product() {
        const NodeId w = unit(vector()), up = pick(2) == 0 ? s.g.vec3(0, 1, 0) : vector(),
                     across = cross(w, up), u = pick(6) == 0 ? across : unit(across),
                     v = cross(u, pick(8) == 0 ? up : w);
        const std::array<NodeId, 4> all{u, v, w, pick(2) == 0 ? unit(vector()) : v};
        const NodeId a = all[std::size_t(pick(4))], b = all[std::size_t(pick(4))];
        return s.g.make(Op::Dot, {a, b});
    }
    double at(NodeId f, const std::array<double, 3> &values) {
        ir::Substitution map;
        for (std::size_t i = 0; i < 3; ++i) map[params[i]] = s.n(values[i]);
        const NodeId found = ir::substitute(s.g, f, map);
        REQUIRE(s.g.is_constant(found));
        return s.g.constant_of(found).value[0];
    }
};

} // namespace

TEST_CASE("products of frames are the numbers that they are said to be, and others are none") {
    int numbers = 0, varying = 0;
    for (std::uint64_t seed = 0; seed < 400; ++seed) {
        Frames frames(seed);
        const NodeId product = frames.product();
        if (frames.s.g.is_constant(product)) continue;
        const auto said = proof::number_of_units(frames.s.g, product);
        std::vector<double> found;
        for (int i = 0; i < 20; ++i)
            found.push_back(
                frames.at(product, {0.1 + 1.9 * frames.dice.next(), 0.1 + 1.9 * frames.dice.next(),
                                    0.1 + 1.9 * frames.dice.next()}));
        INFO(seed << ": " << said.value_or(-9) << ", " << found[0] << ", " << found[1]);
        for (const double x : found)
            if (said && std::isfinite(x)) CHECK(x == Approx(*said).margin(1e-6));
        numbers += said.has_value();
        varying += std::fabs(found[0] - found[1]) > 1e-3;
        if (std::fabs(found[0] - found[1]) > 1e-3) CHECK(!said);
    }
    CHECK(numbers > 120);
    CHECK(varying > 60);
}

TEST_CASE("what is next to a unit vector is no number") {
    Scenery s;
    const NodeId k = s.parameter(0, 1e10);
    // 1e-18 k^2 is little beside 1, as a number before a factor, and much for large k
    const NodeId a = s.g.make(Op::Make, Type::Vec2, {s.n(1), s.g.mul(s.n(1e-9), k)}),
                 u = s.call(Op::Normalize, a), x = s.g.component(u, 0);
    CHECK(!proof::number_of_units(s.g, s.g.mul(x, x)));
    CHECK(proof::number_of_units(s.g, s.g.make(Op::Dot, {u, u})) == 1.0);
}

// Single precision makes a direction of its own rounding, at right angles to nothing.
TEST_CASE("what is 0 by its making is over its length at right angles to nothing") {
    Scenery s;
    const NodeId k = s.parameter(-0.2, 0.6), t = s.parameter(0, 7);
    const NodeId up = s.vec(s.sin(t), s.n(1), k), w = s.call(Op::Normalize, up);
    const auto beside = [&](NodeId d) {
        const NodeId along = s.g.make(Op::Dot, {w, d});
        return s.call(Op::Normalize, s.g.sub(d, s.g.mul(w, s.g.splat(along, Type::Vec3))));
    };
    for (const NodeId d : {up, w, s.g.mul(up, s.g.splat(s.n(2.5), Type::Vec3))}) {
        const NodeId u = beside(d), v = s.g.make(Op::Cross, {w, u});
        for (const NodeId other : {w, u, v})
            CHECK(!proof::number_of_units(s.g, s.g.make(Op::Dot, {u, other})));
        const NodeId q = s.g.make(Op::MatMul, {s.g.make(Op::Make, Type::Mat3, {u, v, w}), s.p});
        CHECK(s.bound(s.length(q), cube(2)).lipschitz > 1.3);
    }
    const NodeId u = beside(s.g.vec3(0, 0, 1));
    CHECK(proof::number_of_units(s.g, s.g.make(Op::Dot, {u, w})) == 0.0);
}

TEST_CASE("a field in a frame of unit vectors is as steep as it is") {
    Scenery s;
    const NodeId time = s.parameter(0, 7), h = s.parameter(0.2, 1);
    const NodeId cosine = s.cos(time), sine = s.sin(time);
    const NodeId d = s.g.make(Op::Make, Type::Vec3, {s.g.mul(s.n(2), cosine), h, sine}),
                 w = s.call(Op::Normalize, d),
                 u = s.call(Op::Normalize, s.g.make(Op::Cross, {w, s.g.vec3(0, 1, 0)})),
                 v = s.g.make(Op::Cross, {u, w});
    std::vector<NodeId> parts;
    for (const NodeId axis : {u, v, w}) parts.push_back(s.g.make(Op::Dot, {s.p, axis}));
    const NodeId q = s.g.make(Op::Make, Type::Vec3, parts),
                 f = s.length(s.g.sub(s.call(Op::Abs, q), s.g.vec3(0.2, 0.3, 0.4)));
    CHECK(s.bound(f, cube(2)).lipschitz <= 1 + 1e-6);
}
