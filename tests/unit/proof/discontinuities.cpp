// Jumps that cancel, and those that do not.
#include "build.h"

#include "proof/discontinuities.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;
using proof::Cell;

namespace {

// mix(hash(i), hash(i + 1), f) with i = floor(x) and the fraction given.
NodeId lattice_noise(Scenery &s, NodeId fraction, double next = 1) {
    NodeId i = s.call(Op::Floor, s.x);
    NodeId a = s.g.make(Op::Hash, Type::Float, {i});
    NodeId b = s.g.make(Op::Hash, Type::Float, {s.g.add(i, s.n(next))});
    return s.g.make(Op::Mix, {a, b, fraction});
}

} // namespace

TEST_CASE("noise of one's own, joined at the lattice, is continuous") {
    Scenery s;
    NodeId f = s.g.sub(s.x, s.call(Op::Floor, s.x));
    NodeId smooth = s.g.mul(s.g.mul(f, f), s.g.sub(s.n(3), s.g.mul(s.n(2), f)));
    for (NodeId fraction : {f, smooth, s.call(Op::Fract, s.x)}) {
        auto b = s.bound(lattice_noise(s, fraction), cube(3));
        CHECK(std::isfinite(b.lipschitz));
        CHECK(b.lipschitz >= b.sampled);
        CHECK(
            b.lipschitz <=
            7); // 1.5 in truth; where the lattice is crossed, all fractions are taken for possible
    }
}

TEST_CASE("noise that is not joined at the lattice jumps") {
    Scenery s;
    NodeId f = s.call(Op::Fract, s.x);
    CHECK(std::isinf(s.bound(lattice_noise(s, f, 2), cube(3)).lipschitz)); // the wrong neighbour
    CHECK(std::isinf(s.bound(lattice_noise(s, s.n(0.5)), cube(3)).lipschitz)); // no way between
    CHECK(std::isinf(s.bound(lattice_noise(s, s.g.mul(f, s.n(0.9))), cube(3)).lipschitz));
    NodeId late = s.call(Op::Fract, s.g.add(s.x, s.n(0.1)));
    CHECK(std::isinf(s.bound(lattice_noise(s, late), cube(3)).lipschitz));
    CHECK(std::isinf(s.bound(s.call(Op::Floor, s.x), cube(3)).lipschitz));
    CHECK(std::isinf(s.bound(s.g.sub(s.x, s.call(Op::Floor, s.x)), cube(3)).lipschitz));
}

TEST_CASE("the distance to the nearest lattice point has slope 1") {
    Scenery s;
    auto b = s.bound(s.length(s.g.sub(s.p, s.call(Op::Round, s.p))), cube(3));
    CHECK(b.lipschitz == Approx(1).epsilon(1e-9));
    auto off = s.bound(s.length(s.g.sub(s.p, s.call(Op::Ceil, s.p))), cube(3));
    CHECK(std::isinf(off.lipschitz));
}

TEST_CASE("copies round an axis by the angle join where they are as many as fit") {
    for (const double copies : {6.0, 5.0, 5.5}) {
        Scenery s;
        NodeId m = s.n(6.283185307179586 / copies);
        NodeId angle = s.g.add(s.g.make(Op::Atan2, {s.z, s.x}), s.n(0.3));
        NodeId a = s.g.sub(s.g.make(Op::Mod, {angle, m}), s.g.mul(m, s.n(0.5)));
        NodeId r = s.length(s.g.make(Op::Make, Type::Vec2, {s.x, s.z}));
        NodeId q = s.vec(s.g.sub(s.g.mul(r, s.cos(a)), s.n(1)), s.y, s.g.mul(r, s.sin(a)));
        Cell away{
            {Interval(-2, -0.5), Interval(-1, 1), Interval(-2, 2)}}; // across the cut, off the axis
        auto b = s.bound(s.length(q), away);
        INFO(copies << " copies");
        CHECK(std::isfinite(b.lipschitz) == (copies != 5.5));
    }
}

TEST_CASE("calls are written out before their steps are looked at") {
    Scenery s;
    NodeId v = s.g.fresh_var(Type::Float);
    ir::Function wave;
    wave.params = {v};
    wave.result = s.call(Op::Abs, s.g.sub(v, s.call(Op::Round, v)));
    ir::FunctionId id = s.g.add_function(wave);
    NodeId field = s.g.call(id, std::array{s.x});
    CHECK(proof::has_steps(s.g, field));
    CHECK(s.g[proof::written_out(s.g, field)].op != Op::Call);
    CHECK(s.bound(field, cube(2)).lipschitz == Approx(1).epsilon(1e-9));
}
