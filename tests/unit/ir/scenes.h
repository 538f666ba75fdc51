// Scenes built by hand, for tests of the lowering: facts as the analysis would state them.
#pragma once

#include "ir/lower/lower.h"
#include "ir/maps.h"
#include "tests/support/reference_eval.h"

#include <functional>

namespace fathom::test {

using namespace ir;
using P = std::array<double, 3>;

struct Random { // reproducible
    std::uint64_t state = 1;
    double next() {
        state = state * 6364136223846793005ull + 1442695040888963407ull;
        return static_cast<double>(state >> 11) / 9007199254740992.0;
    }
    double in(double lo, double hi) { return lo + (hi - lo) * next(); }
    P point(double r) { return {in(-r, r), in(-r, r), in(-r, r)}; }
};

struct Builder {
    Scene scene;
    Graph &g = scene.graph;

    NodeId n(double x) { return g.number(x); }
    NodeId v(double x, double y, double z) { return g.vec3(x, y, z); }

    ShapeId add(Shape shape) { return scene.shapes.add(std::move(shape)); }
    ShapeId add(ShapeKind kind, std::vector<ShapeId> children, std::vector<NodeId> args = {},
                std::uint32_t payload = 0, std::uint8_t dims = 3) {
        Shape shape;
        shape.kind = kind;
        shape.dims = dims;
        shape.children = std::move(children);
        shape.args = std::move(args);
        shape.payload = payload;
        return add(std::move(shape));
    }
    ShapeId leaf(NodeId field, std::uint8_t dims = 3) {
        return add(ShapeKind::Leaf, {}, {field}, 0, dims);
    }
    ShapeId sphere(NodeId radius) { return leaf(g.sub(g.make(Op::Length, {g.point()}), radius)); }
    ShapeId sphere(double radius) { return sphere(n(radius)); }
    ShapeId circle(double radius) {
        return leaf(g.sub(g.make(Op::Length, {g.point(Type::Vec2)}), n(radius)), 2);
    }
    ShapeId box(double x, double y, double z) {
        const NodeId d = g.sub(g.make(Op::Abs, {g.point()}), v(x / 2, y / 2, z / 2));
        const NodeId out = g.make(Op::Length, {g.make(Op::Max, {d, v(0, 0, 0)})});
        const NodeId maximum = g.make(
            Op::Max, {g.make(Op::Max, {g.component(d, 0), g.component(d, 1)}), g.component(d, 2)});
        return leaf(g.add(out, g.make(Op::Min, {maximum, n(0)})));
    }
    ShapeId moved(ShapeId child, double x, double y, double z) {
        return add(translated(g, child, v(x, y, z)));
    }
    ShapeId painted(ShapeId child, NodeId diffuse, ShapeKind kind = ShapeKind::Paint) {
        scene.shapes.materials.push_back({diffuse, v(1, 1, 1), n(32), v(0, 0, 0)});
        return add(kind, {child}, {},
                   static_cast<std::uint32_t>(scene.shapes.materials.size() - 1));
    }
    ShapeId within(ShapeId child, Region region) {
        scene.shapes.regions.push_back(std::move(region));
        return add(ShapeKind::Within, {child}, {},
                   static_cast<std::uint32_t>(scene.shapes.regions.size() - 1));
    }
    ShapeId lattice(ShapeId child, P cell, P count, NodeId id = {}, bool mirrored = false) {
        Repetition r;
        for (std::size_t i = 0; i < 3; ++i) r.along[i] = cell[i] > 0;
        r.mirrored = mirrored;
        r.id = id;
        scene.shapes.repetitions.push_back(r);
        return add(ShapeKind::Repeat, {child},
                   {v(cell[0], cell[1], cell[2]), v(count[0], count[1], count[2])},
                   static_cast<std::uint32_t>(scene.shapes.repetitions.size() - 1));
    }
    ShapeId ring(ShapeId child, int count, int axis, NodeId id = {}) {
        Repetition r;
        r.polar = true;
        r.axis = axis;
        r.id = id;
        scene.shapes.repetitions.push_back(r);
        return add(ShapeKind::Repeat, {child}, {g.integer(count)},
                   static_cast<std::uint32_t>(scene.shapes.repetitions.size() - 1));
    }

    ShapeFact &fact(ShapeId id) {
        if (scene.facts.size() < scene.shapes.size()) scene.facts.resize(scene.shapes.size());
        return scene.facts[id.index];
    }
    // Lowers with `root`; facts not stated say: bound 1.
    const Scene &lowered(ShapeId root) {
        scene.root = root;
        scene.top_level = {{root, {}}};
        fact(root);
        scene.camera.given = true; // else there are functions to frame it, too
        lower(scene);
        return scene;
    }
};

inline double length(P p) { return std::sqrt(p[0] * p[0] + p[1] * p[1] + p[2] * p[2]); }
inline P minus(P a, P b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline double box_distance(P p, P size) {
    double out = 0, maximum = -1e30;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = std::abs(p[i]) - size[i] / 2;
        out += d > 0 ? d * d : 0;
        maximum = std::max(maximum, d);
    }
    return std::sqrt(out) + std::min(maximum, 0.0);
}

} // namespace fathom::test
