// The rules by kind of shape: bounds, boxes, kinds, and what is reported.
#include "build.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

TEST_CASE("rigid motions and uniform scales keep an exact distance") {
    Scenery s;
    ShapeId box = s.box(1.2, 5, 1.2);
    ShapeId moved = s.add(translated(s.g, box, s.g.vec3(1, 2, 3)));
    ShapeId turned = s.add(rotated(s.g, moved, rotation(s.g, s.g.vec3(0, 1, 0), s.n(0.5))));
    ShapeId scaled3 = s.add(scaled(s.g, turned, s.g.splat(s.n(3), Type::Vec3)));
    const ShapeFact &f = s.prove(scaled3);
    CHECK(f.kind == FieldKind::Exact);
    CHECK(f.lipschitz_sup == 1);
    CHECK(f.bounds.lo[1] == Approx(3 * -0.5).epsilon(1e-4));
    CHECK(f.bounds.hi[1] == Approx(3 * 4.5).epsilon(1e-5));
    ShapeId flat = s.add(scaled(s.g, box, s.g.vec3(1, 2, 1)));
    const ShapeFact &g = s.prove(flat);
    CHECK(g.kind == FieldKind::Bound);
    CHECK(g.lipschitz_sup == 1);
    CHECK(g.bounds.hi[1] == Approx(5).epsilon(1e-5));
}

TEST_CASE("a twist costs its shear at the moment arm, and nothing at rate 0") {
    Scenery s;
    ShapeId box = s.box(1.2, 5, 1.2);
    NodeId rate = s.parameter(0, 2);
    ShapeId twist = s.add(twisted(s.g, box, rate, 1));
    Diagnostics d;
    const ShapeFact &f = s.prove(twist, d);
    INFO(said(d));
    CHECK(d.items().empty());
    CHECK(f.lipschitz_sup == Approx(proof::sigma(1.2)).epsilon(1e-5));
    CHECK(s.g.reads(f.lipschitz).params);
    CHECK(f.bounds.hi[0] == Approx(0.6 * std::sqrt(2.0)).epsilon(1e-4));
    CHECK(f.moment_arm[1] == Approx(0.6).epsilon(1e-6));
    CHECK(f.guard);
    ShapeId bend = s.add(bent(s.g, box, s.n(0.2), 1, 0));
    CHECK(s.prove(bend).lipschitz_sup == Approx(1 + 0.2 * 2.5).epsilon(1e-5));
    ShapeId taper = s.add(tapered(s.g, box, s.n(0.3), s.n(-2.5), s.n(2.5), 1));
    double l = s.prove(taper).lipschitz_sup;
    INFO("taper " << l);
    CHECK(l > 1);
    CHECK(l < 1.75);
}

TEST_CASE("a twist of what is not near the axis wants a region") {
    Scenery s;
    ShapeId twist = s.add(twisted(s.g, s.plane(), s.n(1), 1));
    Diagnostics d;
    CHECK(std::isinf(s.prove(twist, d).lipschitz_sup));
    CHECK(has(d, Code::NeedsRegion));
    CHECK(d.items().size() == 1);
    Diagnostics e;
    ShapeId inside = s.within(s.add(twisted(s.g, s.plane(), s.n(1), 1)), s.ball(2));
    const ShapeFact &f = s.prove(inside, e);
    INFO(said(e));
    CHECK(e.items().empty());
    CHECK(f.lipschitz_sup == Approx(proof::sigma(2)).epsilon(1e-4));
    CHECK(f.bounds.hi[0] == Approx(2).epsilon(1e-4));
}

TEST_CASE("a displacement adds its slope") {
    Scenery s;
    NodeId k = s.n(9);
    NodeId f = s.g.mul(s.n(0.12), s.g.mul(s.sin(s.g.mul(s.x, k)),
                                          s.g.mul(s.sin(s.g.mul(s.y, k)), s.sin(s.g.mul(s.z, k)))));
    ShapeId rough = s.add(ShapeKind::Displace, {s.sphere(0.6)}, {f});
    Diagnostics d;
    const ShapeFact &fact = s.prove(rough, d);
    INFO(said(d));
    CHECK(fact.lipschitz_sup >= 1 + 0.12 * 9 * (1 - 1e-9));
    CHECK(fact.lipschitz_sup <= 1 + 0.12 * 9 * 1.13);
    CHECK(fact.bounds.hi[0] >= 0.72);
    CHECK(fact.bounds.hi[0] < 0.73);
}

TEST_CASE("blends by profile") {
    Scenery s;
    ShapeId a = s.sphere(1), b = s.add(translated(s.g, s.sphere(1), s.g.vec3(1.5, 0, 0)));
    for (Profile profile : {Profile::Smooth, Profile::Round, Profile::Chamfer, Profile::Stairs}) {
        ShapeId blend = s.add(ShapeKind::Blend, {a, b}, {s.n(0.4), s.n(3)},
                              static_cast<std::uint32_t>(profile));
        const ShapeFact &f = s.prove(blend);
        CHECK(f.lipschitz_sup == 1);
        CHECK(f.bounds.lo[0] == Approx(-1).epsilon(1e-4));
        CHECK(f.bounds.hi[0] == Approx(2.5).epsilon(1e-4));
    }
    ShapeId columns = s.add(ShapeKind::Blend, {a, b}, {s.n(0.4), s.n(3)},
                            static_cast<std::uint32_t>(Profile::Columns));
    CHECK(s.prove(columns).lipschitz_sup == Approx(std::sqrt(2.0)).epsilon(1e-6));
    ShapeId norm = s.add(ShapeKind::PseudoNorm, {a, b}, {s.n(4)});
    CHECK(s.prove(norm).lipschitz_sup == Approx(std::pow(2.0, 0.25)).epsilon(1e-6));
    // An intersection is a blend of complements and keeps its bounds.
    ShapeId both =
        s.add(ShapeKind::Complement,
              {s.add(ShapeKind::Blend,
                     {s.add(ShapeKind::Complement, {a}), s.add(ShapeKind::Complement, {b})},
                     {s.n(0.2), s.n(0)}, static_cast<std::uint32_t>(Profile::Smooth))});
    const ShapeFact &f = s.prove(both);
    CHECK(f.bounds.lo[0] == Approx(0.5).epsilon(1e-4));
    CHECK(f.bounds.hi[0] == Approx(1).epsilon(1e-4));
}

TEST_CASE("repetition evaluates as few copies as are enough") {
    Scenery s;
    auto repeat = [&](ShapeId child, double cell, bool mirrored = false, NodeId id = {}) {
        Repetition r;
        r.along = {true, false, true};
        r.mirrored = mirrored;
        r.id = id;
        s.scene.shapes.repetitions.push_back(r);
        return s.add(ShapeKind::Repeat, {child}, {s.g.vec3(cell, 0, cell), s.g.vec3(1e9, 1, 1e9)},
                     static_cast<std::uint32_t>(s.scene.shapes.repetitions.size() - 1));
    };
    const auto plan = [&](ShapeId id) { return s.prove(id).repeat; };
    CHECK(plan(repeat(s.box(1, 1, 1), 1.6)).neighbors == std::array{1, 0, 1});
    ShapeId aside = s.add(translated(s.g, s.sphere(0.3), s.g.vec3(0.4, 0, 0)));
    CHECK(plan(repeat(aside, 1.6)).neighbors == std::array{2, 0, 1});
    CHECK(plan(repeat(s.box(2.4, 1, 1), 1.6)).neighbors == std::array{3, 0, 1});
    CHECK(plan(repeat(aside, 1.6, true)).neighbors == std::array{1, 0, 1});
    const ShapeId fills = s.box(1, 1, 1), over = s.box(1 + 8e-6, 1, 1); // by 4e-6 of the cell
    for (const bool mirrored : {false, true}) {
        CHECK(plan(repeat(fills, 1, mirrored)).neighbors == std::array{1, 0, 1});
        CHECK(plan(repeat(over, 1, mirrored)).neighbors == std::array{3, 0, 1});
    }
    NodeId id = s.g.fresh_var(Type::Vec3);
    NodeId hash = s.call(Op::Hash, id);
    ShapeId differs = s.add(translated(s.g, s.box(0.5, 1, 0.5), s.vec(s.n(0), hash, s.n(0))));
    const ShapeFact &f = s.prove(repeat(differs, 1.6, false, id));
    CHECK(f.repeat.neighbors == std::array{2, 0, 2});
    CHECK(f.repeat.guard);
    CHECK(f.bounds.hi[1] == Approx(1.5).epsilon(1e-4));
    Diagnostics d;
    s.prove(repeat(s.box(30, 1, 1), 1), d);
    CHECK(has(d, Code::RepeatLimit));
    Diagnostics e;
    s.prove(repeat(s.plane(), 1), e);
    CHECK(has(e, Code::NeedsRegion));
}

TEST_CASE("one cause, one report, with its place and the ways out") {
    Scenery s;
    ShapeId bad = s.leaf(s.g.sub(s.g.div(s.n(1), s.length(s.p)), s.n(2)));
    ShapeId region = s.within(bad, s.ball(2));
    ShapeId twist = s.add(twisted(s.g, region, s.n(1), 1));
    Diagnostics d;
    CHECK(std::isinf(s.prove(twist, d).lipschitz_sup));
    INFO(said(d));
    CHECK(d.items().size() == 1);
    CHECK(has(d, Code::FieldSingular));
    CHECK(d.items()[0].fix);
}

TEST_CASE("a region that keeps off the singular place is enough") {
    Scenery s;
    Region region = s.ball(2), hole;
    hole.kind = RegionKind::Ball;
    hole.center = s.g.vec3(0, 0, 0);
    hole.size = s.n(0.4);
    region.less = {hole};
    ShapeId ok = s.within(s.leaf(s.g.sub(s.g.div(s.n(1), s.length(s.p)), s.n(2))), region);
    Diagnostics d;
    const ShapeFact &f = s.prove(ok, d);
    const double l = f.lipschitz_sup;
    INFO(said(d));
    CHECK(l >= 6.25);
    CHECK(l < 6.25 * 2.12 * 1.2); // what a blend would use; a step pays the way round alone
    CHECK(f.detour == Approx(1.5708).epsilon(1e-4));
}

TEST_CASE("a field that is steep in its corners keeps its bound cell by cell") {
    Scenery s;
    NodeId xx = s.g.mul(s.x, s.x), x6 = s.g.mul(xx, s.g.mul(xx, xx));
    NodeId f = s.g.sub(s.g.add(x6, s.g.add(s.g.mul(s.y, s.y), s.g.mul(s.z, s.z))), s.n(0.5));
    ShapeId steep = s.within(s.leaf(f), s.ball(2));
    s.prove(steep);
    REQUIRE(s.scene.cells.contains(steep));
    const CellBounds &cells = s.scene.cells.at(steep);
    CHECK(s.scene.facts[steep.index].lipschitz_sup > 6 * 32); // 6 x^5 at x = 2
    // In the middle, where the surface is, not much above 2.
    const std::size_t nx = std::size_t(cells.count[0]), ny = std::size_t(cells.count[1]);
    CHECK(cells.lipschitz[(nx / 2) + nx * ((ny / 2) + ny * (std::size_t(cells.count[2]) / 2))] < 3);
    // In the corner nothing is near: how far is known there, and of the middle it is not.
    CHECK(cells.way.front() > 1);
    CHECK(cells.way[(nx / 2) + nx * ((ny / 2) + ny * (std::size_t(cells.count[2]) / 2))] == 0);
    // About as steep everywhere: one bound for all.
    ShapeId wave = s.within(s.leaf(s.sin(s.g.mul(s.x, s.n(3)))), s.ball(2));
    s.prove(wave);
    CHECK(!s.scene.cells.contains(wave));
}

// Found by random compositions: each was wrong once.
TEST_CASE("what an offset moves, a moment arm and a blend's gap count") {
    Scenery s;
    auto circle = [&](double r) {
        return s.claimed("circle", s.g.sub(s.length(s.g.point(Type::Vec2)), s.n(r)),
                         s.g.vec(std::array{-r, -r}), s.g.vec(std::array{r, r}),
                         {NodeId(), NodeId(), s.n(0)}, 2);
    };
    // A disc of radius 1.1, though the circle that its gradient points away from has 0.1.
    Shape disc;
    disc.kind = ShapeKind::Extrude;
    disc.children = {s.add(ShapeKind::Offset, {circle(0.1)}, {s.n(1)})};
    disc.args = {s.n(0.1)};
    CHECK(s.prove(s.add(twisted(s.g, s.add(disc), s.n(3), 0))).lipschitz_sup >=
          proof::sigma(3 * 1.1) * (1 - 1e-6));
    // The one is 5 above its distance: so far apart are the two.
    ShapeId none = s.add(ShapeKind::Offset, {s.sphere(0.1)}, {s.n(-5)});
    NodeId weight = s.g.add(s.n(0.5), s.g.mul(s.n(0.5), s.sin(s.g.mul(s.n(4), s.x))));
    CHECK(s.prove(s.add(ShapeKind::Lerp, {none, s.sphere(0.1)}, {weight})).lipschitz_sup >
          1 + 2 * 5 * 0.99);
}

TEST_CASE("boxes hold what tapers draw to the axis, and what offsets make of nothing") {
    Scenery s;
    ShapeId off = s.add(translated(s.g, s.sphere(0.5), s.g.vec3(0, 1, 0.5)));
    const ShapeFact f = s.prove(s.add(tapered(s.g, off, s.n(0.3), s.n(-0.3), s.n(0.2), 2)));
    CHECK(f.bounds.lo[1] <= 0.3 * 0.5 + 1e-9);
    CHECK(f.bounds.hi[1] >= 1.5);
    // Two balls that do not touch have nothing in common, yet their fields' maximum can be grown.
    ShapeId apart =
        s.add(ShapeKind::Intersection,
              {s.sphere(0.5), s.add(translated(s.g, s.sphere(0.5), s.g.vec3(1.2, 0, 0)))});
    const ShapeFact g = s.prove(s.add(ShapeKind::Offset, {apart}, {s.n(0.4)}));
    CHECK(!g.bounds.empty());
    CHECK(g.bounds.lo[0] <= 0.6 - 0.3);
    CHECK(g.bounds.hi[0] >= 0.6 + 0.3);
}

TEST_CASE("what is assumed is tested") {
    Scenery s;
    Shape shape;
    shape.kind = ShapeKind::Leaf;
    shape.args = {s.g.sub(s.length(s.p), s.n(1))};
    shape.assumed = 0.5;
    Diagnostics d;
    s.prove(s.add(shape), d);
    CHECK(has(d, Code::LipschitzViolated));
    shape.assumed = 1.5;
    Diagnostics e;
    const ShapeFact &f = s.prove(s.add(shape), e);
    CHECK(e.items().empty());
    CHECK(f.status == ProofStatus::Proved); // and assumed where it is not proved: check/stated.cpp
    CHECK(f.lipschitz_sup == 1);
    shape.assumed = 0;
    shape.estimate = 0.8;
    Diagnostics g;
    CHECK(s.prove(s.add(shape), g).status == ProofStatus::Estimated);
    INFO(said(g));
    CHECK(has(g, Code::EstimatedField));
}

TEST_CASE("contracts, lower bounds, cost") {
    Scenery s;
    ShapeId twist = s.add(twisted(s.g, s.box(1, 1, 1), s.n(3), 1));
    s.scene.shapes.contracts.push_back({1, {}});
    Diagnostics d;
    s.prove(s.add(ShapeKind::Contract, {twist}, {}, 0), d);
    INFO(said(d));
    CHECK(has(d, Code::LipschitzContract));
    CHECK(!d.items()[0].notes.empty());
    Diagnostics e;
    s.prove(s.add(ShapeKind::Shell, {twist}, {s.n(0.1)}), e);
    CHECK(has(e, Code::LowerBound));
    Diagnostics f;
    s.prove(s.add(ShapeKind::Shell, {s.box(1, 1, 1)}, {s.n(0.1)}), f);
    CHECK(f.items().empty());
    Diagnostics g;
    s.prove(s.add(twisted(s.g, s.box(4, 1, 4), s.n(4), 1)), g);
    CHECK(has(g, Code::Costly));
}

TEST_CASE("the explanation names the operation that costs") {
    Scenery s;
    ShapeId twist = s.add(twisted(s.g, s.box(1, 1, 1), s.n(3), 1));
    ShapeId all =
        s.add(ShapeKind::Union, {s.sphere(1), s.add(translated(s.g, twist, s.g.vec3(3, 0, 0)))});
    s.prove(all);
    proof::Explanation e = proof::explain(s.scene);
    CHECK(e.operation == "union");
    REQUIRE(e.children.size() == 2);
    CHECK(e.children[1].worst);
    const proof::Explanation &t = e.children[1].children[0];
    CHECK(t.operation == "twist");
    CHECK(t.share == Approx(1));
    CHECK(t.factor == Approx(proof::sigma(1.5)).epsilon(1e-5));
}

TEST_CASE("what has bounds but no moment arm is deformed within its own box") {
    Scenery s;
    ShapeId flat = s.add(scaled(s.g, s.sphere(1), s.g.vec3(1, 0.3, 0.5)));
    ShapeId bend = s.add(bent(s.g, flat, s.n(0.7), 0, 1));
    Diagnostics d;
    const ShapeFact &f = s.prove(bend, d);
    INFO(said(d));
    CHECK(!d.has_errors());
    CHECK(f.local);
    CHECK(f.lipschitz_sup < 1 + 0.7 * 1.7);
    CHECK(!s.scene.facts[flat.index].local);
}

TEST_CASE("a fold is bounded by what it gathers") {
    Scenery s;
    Graph &g = s.g;
    ShapeId ball = s.add(translated(g, s.sphere(0.5), g.vec3(1, 0, 0)));
    ShapeId mirror = s.add(folded(g, ball, mirror_point(g, s.p, 0)));
    CHECK(s.prove(mirror).bounds.lo[0] == Approx(-1.5).epsilon(1e-4));
    ShapeId longer = s.add(folded(
        g, s.sphere(0.5), g.sub(s.p, g.make(Op::Clamp, {s.p, g.vec3(-1, 0, 0), g.vec3(1, 0, 0)}))));
    CHECK(s.prove(longer).bounds.hi[0] == Approx(1.5).epsilon(1e-4));
    // The thesis's fold, written for any axis: p + (|d| - d) n, d = dot(p, n).
    NodeId n = g.vec3(0.6, 0.8, 0), along = g.make(Op::Dot, {s.p, n});
    NodeId q = g.add(s.p, g.mul(g.sub(s.call(Op::Abs, along), along), n));
    double reach = s.prove(s.add(folded(g, ball, q))).bounds.hi[0];
    CHECK(reach >= 1.5);
    CHECK(reach < 1.7);
}

TEST_CASE("a region's holes have to leave a way round them") {
    Scenery s;
    Region region = s.ball(2), hole;
    hole.kind = RegionKind::Ball;
    hole.center = s.g.vec3(1.8, 0, 0);
    hole.size = s.n(0.5);
    region.less = {hole};
    Diagnostics d;
    s.prove(s.within(s.leaf(s.g.sub(s.length(s.p), s.n(1))), region), d);
    CHECK(has(d, Code::NeedsRegion));
}

TEST_CASE("turns within turns do not inflate the bounds") {
    Scenery s;
    const auto turn = [&](ShapeId child, double angle, NodeId axis) {
        return s.add(rotated(s.g, child, rotation(s.g, axis, s.n(angle))));
    };
    const NodeId about_y = s.g.vec3(0, 1, 0), about_z = s.g.vec3(0, 0, 1);
    ShapeId round = s.add(translated(s.g, s.box(2, 2, 2), s.g.vec3(5, 0, 0)));
    for (int i = 0; i < 8; ++i) round = turn(round, 3.14159265358979 / 4, about_z);
    const Box whole = s.prove(round).bounds; // back where it began
    CHECK(whole.lo[0] <= 4);
    CHECK(whole.hi[0] >= 6);
    CHECK(whole.lo[0] >= 5 - std::sqrt(3.0) - 1e-4);
    CHECK(whole.hi[0] <= 5 + std::sqrt(3.0) + 1e-4);
    CHECK(whole.hi[1] <= std::sqrt(3.0) + 1e-4);

    // A tree: each limb 1 long with two smaller ones, leaning 0.6 to both sides, at its end.
    ShapeId tree = s.add(translated(s.g, s.box(0.2, 1, 0.2), s.g.vec3(0, 0.5, 0)));
    double reach = 1; // no point is further from the root than all the lengths, half a limb's
                      // diagonal and what the blends add
    for (int depth = 0; depth < 4; ++depth) {
        std::vector<ShapeId> parts = {
            s.add(translated(s.g, s.box(0.2, 1, 0.2), s.g.vec3(0, 0.5, 0)))};
        for (double lean : {-0.6, 0.6})
            parts.push_back(s.add(translated(s.g, turn(turn(tree, lean, about_z), depth, about_y),
                                             s.g.vec3(0, 1, 0))));
        tree = s.add(ShapeKind::Blend, parts, {s.n(0.05), s.n(3)},
                     static_cast<std::uint32_t>(Profile::Smooth));
        reach += 1;
    }
    const Box tall = s.prove(tree).bounds;
    INFO(tall.lo[0] << ".." << tall.hi[0] << ", " << tall.lo[1] << ".." << tall.hi[1] << ", "
                    << tall.lo[2] << ".." << tall.hi[2]);
    CHECK(tall.lo[1] <= 0);
    CHECK(tall.hi[1] >= 1 + std::cos(0.6));
    // A blend of what was turned adds more than its radius: the corners of what grew turn outward.
    CHECK(tall.hi[1] <= reach + 0.7);
    CHECK(std::max(-tall.lo[0], tall.hi[0]) <= reach);
}
