// Which surface shows: semantics.md, 22.
#include "ir/passes/verify.h"
#include "tests/unit/ir/scenes.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {
const P red{1, 0, 0}, green{0, 1, 0}, plain{0.448, 0.448, 0.448};
NodeId color(Builder &t, P c) { return t.v(c[0], c[1], c[2]); }
} // namespace

TEST_CASE("a union shows the nearer operand, the first on a tie") {
    Builder t;
    const ShapeId a = t.painted(t.moved(t.sphere(1), -2, 0, 0), color(t, red));
    const ShapeId b = t.painted(t.moved(t.sphere(1), 2, 0, 0), color(t, green));
    Reference r(t.lowered(t.add(ShapeKind::Union, {a, b})));
    CHECK(r.diffuse({-1, 0, 0}) == red);
    CHECK(r.diffuse({1, 0, 0}) == green);
    CHECK(r.diffuse({0, 1, 0}) == red);
}

TEST_CASE("an unpainted subtrahend shows the minuend's paint, a painted one its own") {
    for (bool painted : {false, true}) {
        Builder t;
        const ShapeId a = t.painted(t.sphere(1), color(t, red));
        ShapeId b = t.moved(t.sphere(1), 1, 0, 0);
        if (painted) b = t.painted(b, color(t, green));
        Reference r(
            t.lowered(t.add(ShapeKind::Intersection, {a, t.add(ShapeKind::Complement, {b})})));
        CHECK(r.diffuse({-1, 0, 0}) == red);
        CHECK(r.diffuse({0.01, 0, 0}) == (painted ? green : red));
    }
}

TEST_CASE("the same holds for smooth differences") {
    Builder t;
    const ShapeId a = t.painted(t.sphere(1), color(t, red));
    const ShapeId b = t.moved(t.sphere(1), 1, 0, 0);
    const ShapeId blend =
        t.add(ShapeKind::Blend, {t.add(ShapeKind::Complement, {a}), b}, {t.n(0.1), t.n(1)});
    const Scene &scene = t.lowered(t.add(ShapeKind::Complement, {blend}));
    REQUIRE(verify(scene) == "");
    Reference r(scene);
    CHECK(r.diffuse({-1, 0, 0}) == red);
    CHECK(r.diffuse({0.01, 0, 0}) == red);
    CHECK(r.hit({0.01, 0.2, 0}).distance == Approx(r.distance({0.01, 0.2, 0})));
}

TEST_CASE("an inner paint wins over an outer one; repaint overrides") {
    Builder t;
    const ShapeId some =
        t.add(ShapeKind::Union, {t.painted(t.moved(t.sphere(1), -2, 0, 0), color(t, red)),
                                 t.moved(t.sphere(1), 2, 0, 0)});
    SECTION("paint") {
        Reference r(t.lowered(t.painted(some, color(t, green))));
        CHECK(r.diffuse({-1, 0, 0}) == red);
        CHECK(r.diffuse({1, 0, 0}) == green);
    }
    SECTION("repaint") {
        Reference r(t.lowered(t.painted(some, color(t, green), ShapeKind::Repaint)));
        CHECK(r.diffuse({-1, 0, 0}) == green);
    }
    SECTION("neither") {
        Reference r(t.lowered(some));
        CHECK(r.diffuse({1, 0, 0}) == plain);
    }
}

TEST_CASE("a material turns with what is painted") {
    // Coloured by its own x, then moved and turned: the material sees the point before that.
    Builder t;
    const ShapeId ball =
        t.painted(t.sphere(1), t.g.splat(t.g.component(t.g.point(), 0), Type::Vec3));
    const ShapeId turned =
        t.add(rotated(t.g, ball, rotation(t.g, t.v(0, 0, 1), t.n(std::acos(0.0)))));
    const ShapeId moved = t.moved(turned, 5, 0, 0);
    const ShapeId grown =
        t.add(ShapeKind::Offset, {moved}, {t.n(0.1)}); // also through what is no min or max
    Reference r(t.lowered(grown));
    CHECK(r.diffuse({5, 0.7, 0})[0] == Approx(0.7)); // x turned to y
    CHECK(r.diffuse({5.7, 0, 0})[0] == Approx(0).margin(1e-12));
}

TEST_CASE("a flat paint and its point") {
    Builder t;
    t.scene.shapes.materials.push_back(
        {t.g.splat(t.g.component(t.g.point(Type::Vec2), 1), Type::Vec3), t.v(1, 1, 1), t.n(32),
         t.v(0, 0, 0)});
    const ShapeId flat = t.add(ShapeKind::Paint, {t.circle(1)}, {}, 0, 2);
    Reference r(t.lowered(t.add(ShapeKind::Extrude, {flat}, {t.n(1)})));
    CHECK(r.diffuse({0.3, 0.6, 0.4})[0] == Approx(0.6));
}

TEST_CASE("a material may read the ids of the repetitions around it") {
    // One id fits a hit's four floats; two, and two with a ring's, are packed.
    for (int depth : {1, 2, 3}) {
        Builder t;
        std::vector<NodeId> ids;
        NodeId sum = t.n(0);
        for (int i = 0; i < depth; ++i) {
            ids.push_back(t.g.fresh_var(Type::Vec3));
            sum = t.g.add(sum, t.g.mul(t.n(std::pow(7, i)), t.g.component(ids.back(), 0)));
        }
        ShapeId all = t.painted(t.sphere(0.01), t.g.splat(sum, Type::Vec3));
        double cell = 0.1;
        for (int i = 0; i < depth; ++i, cell *= 10) {
            all = t.lattice(all, {cell, 0, 0}, {1e9, 1e9, 1e9}, ids[static_cast<std::size_t>(i)]);
            t.fact(all).repeat.neighbors = {1, 0, 0};
        }
        const Scene &scene = t.lowered(all);
        REQUIRE(verify(scene) == "");
        Reference r(scene);
        Random random;
        for (int k = 0; k < 100; ++k) {
            double x = 0, expected = 0, size = 0.1;
            for (int i = 0; i < depth; ++i, size *= 10) {
                const double id = std::floor(random.in(-3, 4)); // -3 .. 3
                x += id * size;
                expected += std::pow(7, i) * id;
            }
            CHECK(r.diffuse({x, 0.005, 0})[0] == Approx(expected).margin(1e-9));
        }
    }
}

TEST_CASE("mixed materials follow the blend's weights") {
    Builder t;
    const ShapeId a = t.painted(t.moved(t.sphere(1), -0.8, 0, 0), color(t, red));
    const ShapeId b = t.painted(t.moved(t.sphere(1), 0.8, 0, 0), color(t, green));
    const ShapeId blend = t.add(ShapeKind::Blend, {a, b}, {t.n(0.5), t.n(1)});
    const Scene &scene = t.lowered(t.add(ShapeKind::Mixed, {blend}));
    REQUIRE(verify(scene) == "");
    Reference r(scene);
    CHECK(r.diffuse({-2, 0, 0}) == red);
    CHECK(r.diffuse({2, 0, 0}) == green);
    const P middle = r.diffuse({0, 0.7, 0});
    CHECK(middle[0] == Approx(0.5));
    CHECK(middle[1] == Approx(0.5));
    const double between = r.diffuse({0.1, 0.7, 0})[1];
    CHECK(between > 0.5);
    CHECK(between < 1);
}

TEST_CASE("the normal that a material wants follows from the hits' points") {
    Builder t;
    const NodeId normal = t.g.make(Op::Normal, Type::Vec3, std::span<const NodeId>{});
    const ShapeId ball = t.painted(t.sphere(1), normal);
    const ShapeId turned =
        t.add(rotated(t.g, ball, rotation(t.g, t.v(0, 0, 1), t.n(std::acos(0.0)))));
    const Scene &scene = t.lowered(turned);
    CHECK(scene.surfaces[0].reads_normal);
    Reference r(scene);
    const P p{0, 1, 0}, above{0, 1.001, 0}; // the world's normal is y; before the turn it was x
    const P local = minus(r.hit(above).point, r.hit(p).point);
    CHECK(local[0] / length(local) == Approx(1));
}
