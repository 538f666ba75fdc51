// What counts as rounding (proof/enclosed.h): by values, whatever numbers stand before what is large or
// tiny, near and far.
#include "proof/enclosed.h"
#include "build.h"
#include "proof/continuity.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Sides : Scenery {
    NodeId power(NodeId a, int n) { return g.make(Op::Pow, {a, g.number(n)}); }
    NodeId times(double by, NodeId a) { return g.mul(g.number(by), a); }
    bool are_same(NodeId a, NodeId more) { return proof::same(g, a, g.add(a, more)); }
};

} // namespace

TEST_CASE("a number is enclosed at a distance") {
    Sides s;
    const Interval side(-2, 2);
    proof::Enclosed box(s.g, nullptr, {side, side, side});
    const auto most = [&](NodeId id) { return box.of(id).magnitude(); };
    const double radius = 6371000;
    const NodeId drop = s.times(radius, s.g.sub(s.n(1), s.cos(s.times(1 / radius, s.x))));
    CHECK(most(drop) < 1e-6);
    CHECK(most(s.length(s.p)) < 3.5);
    CHECK(most(s.times(1e-12, s.call(Op::Abs, s.times(1e12, s.z)))) < 2.1);
    CHECK(most(s.call(Op::Exp, s.times(30, s.x))) > 1e26);
    CHECK_FALSE(box.of(s.call(Op::Log, s.x)).finite());
}

TEST_CASE("what is added to a side is rounding by its values alone") {
    Sides s;
    const NodeId ball = s.g.sub(s.length(s.p), s.n(1000));
    CHECK_FALSE(s.are_same(ball, s.times(9e-10, s.power(s.z, 4))));
    CHECK_FALSE(s.are_same(s.y, s.times(1e-12, s.call(Op::Abs, s.times(1e12, s.z)))));
    CHECK_FALSE(s.are_same(
        s.y, s.times(1e-12, s.g.make(Op::Min, {s.times(1e12, s.z), s.times(1e12, s.x)}))));
    CHECK_FALSE(s.are_same(s.y, s.times(1e-13, s.call(Op::Exp, s.g.add(s.n(30), s.z)))));
    CHECK(s.are_same(s.g.add(ball, s.z), s.times(1e-16, s.z)));
    CHECK(proof::same(s.g, s.g.add(s.times(0.1, s.x), s.times(0.2, s.x)), s.times(0.3, s.x)));
}
