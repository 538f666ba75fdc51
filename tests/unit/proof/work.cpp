// The proof's cost, in counted work: it does not depend on the machine, and grows with the scene,
// not with its square.
#include "build.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

TEST_CASE("a hundred deformed parts and three fields of one's own") {
    Scenery s;
    Graph &g = s.g;
    std::vector<ShapeId> parts;
    for (int i = 0; i < 100; ++i) {
        ShapeId part = s.box(0.5 + 0.01 * i, 2, 0.5);
        if (i % 4 == 0) part = s.add(twisted(g, part, s.n(1 + 0.01 * i), 1));
        if (i % 4 == 1) part = s.add(bent(g, part, s.n(0.3), 1, 0));
        if (i % 4 == 2) part = s.add(tapered(g, part, s.n(0.5), s.n(-1), s.n(1), 1));
        if (i % 4 == 3)
            part = s.add(ShapeKind::Displace, {part},
                         {g.mul(s.n(0.02), s.sin(g.mul(s.x, s.n(3 + i))))});
        parts.push_back(s.add(translated(g, part, g.vec3(i % 10, 0, i / 10))));
    }
    for (double k : {1.0, 2.0, 3.0}) {
        NodeId q = g.mul(s.p, s.n(k));
        parts.push_back(
            s.within(s.leaf(g.make(Op::Dot, {s.sin(q), s.cos(g.swizzle(q, std::array{2, 0, 1}))})),
                     s.ball(1 + k)));
    }
    ShapeId all = s.add(ShapeKind::Union, parts);
    Diagnostics d;
    const ShapeFact &f = s.prove(all, d);
    CHECK(d.items().empty());
    CHECK(std::isfinite(f.lipschitz_sup));
    proof::FieldBound b =
        s.bound(g.make(Op::Dot, {s.sin(s.p), s.cos(g.swizzle(s.p, std::array{2, 0, 1}))}));
    CHECK(b.evaluations < 40'000);
}
