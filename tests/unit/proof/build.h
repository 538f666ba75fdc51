// Scenes made by hand, for the proof's tests.
#pragma once

#include "ir/maps.h"
#include "proof/field.h"
#include "proof/prove.h"

#include <cmath>
#include <string>

namespace fathom::test {

using namespace fathom::ir;

struct Scenery {
    Scene scene;
    Graph &g = scene.graph;
    NodeId p = g.point();
    NodeId x = g.component(p, 0), y = g.component(p, 1), z = g.component(p, 2);

    NodeId n(double value) { return g.number(value); }
    NodeId call(Op op, NodeId a) { return g.make(op, {a}); }
    NodeId sin(NodeId a) { return call(Op::Sin, a); }
    NodeId cos(NodeId a) { return call(Op::Cos, a); }
    NodeId length(NodeId a) { return call(Op::Length, a); }
    NodeId vec(NodeId a, NodeId b, NodeId c) { return g.make(Op::Make, Type::Vec3, {a, b, c}); }

    ShapeId leaf(NodeId field, int dims = 3) {
        Shape shape;
        shape.kind = ShapeKind::Leaf;
        shape.dims = static_cast<std::uint8_t>(dims);
        shape.args = {field};
        return scene.shapes.add(shape);
    }
    // A library shape with claims, as the checker makes one.
    ShapeId claimed(std::string name, NodeId field, NodeId lo, NodeId hi,
                    std::array<NodeId, 3> moment_arm = {}, int dims = 3) {
        Library library;
        library.name = std::move(name);
        library.has_claims = true;
        library.claims.kind = FieldKind::Exact;
        library.claims.lo = lo;
        library.claims.hi = hi;
        library.claims.symmetric = {true, true, true};
        library.claims.moment_arm = moment_arm;
        scene.shapes.libraries.push_back(library);
        Shape shape;
        shape.kind = ShapeKind::Library;
        shape.dims = static_cast<std::uint8_t>(dims);
        shape.children = {leaf(field, dims)};
        shape.payload = static_cast<std::uint32_t>(scene.shapes.libraries.size() - 1);
        return scene.shapes.add(shape);
    }
    ShapeId sphere(double r) {
        return claimed("sphere", g.sub(length(p), n(r)), g.vec3(-r, -r, -r), g.vec3(r, r, r),
                       {n(0), n(0), n(0)});
    }
    ShapeId box(double sx, double sy, double sz) { // full sizes
        double a = sx / 2, b = sy / 2, c = sz / 2;
        NodeId q = g.sub(call(Op::Abs, p), g.vec3(a, b, c));
        NodeId outside = length(g.make(Op::Max, {q, g.vec3(0, 0, 0)}));
        NodeId most = g.make(
            Op::Max, {g.component(q, 0), g.make(Op::Max, {g.component(q, 1), g.component(q, 2)})});
        NodeId field = g.add(outside, g.make(Op::Min, {most, n(0)}));
        return claimed("box", field, g.vec3(-a, -b, -c), g.vec3(a, b, c),
                       {n(std::max(b, c)), n(std::max(a, c)), n(std::max(a, b))});
    }
    ShapeId plane() {
        Library library;
        library.name = "plane";
        library.has_claims = true;
        library.claims.kind = FieldKind::Exact;
        scene.shapes.libraries.push_back(library);
        Shape shape;
        shape.kind = ShapeKind::Library;
        shape.children = {leaf(y)};
        shape.payload = static_cast<std::uint32_t>(scene.shapes.libraries.size() - 1);
        return scene.shapes.add(shape);
    }
    ShapeId add(ShapeKind kind, std::vector<ShapeId> children, std::vector<NodeId> args = {},
                std::uint32_t payload = 0) {
        Shape shape;
        shape.kind = kind;
        shape.dims = scene.shapes[children[0]].dims;
        shape.children = std::move(children);
        shape.args = std::move(args);
        shape.payload = payload;
        return scene.shapes.add(shape);
    }
    ShapeId add(Shape shape) { return scene.shapes.add(std::move(shape)); }
    ShapeId within(ShapeId child, Region region) {
        scene.shapes.regions.push_back(std::move(region));
        return add(ShapeKind::Within, {child}, {},
                   static_cast<std::uint32_t>(scene.shapes.regions.size() - 1));
    }
    Region ball(double r) {
        Region region;
        region.kind = RegionKind::Ball;
        region.center = g.vec3(0, 0, 0);
        region.size = n(r);
        return region;
    }
    NodeId parameter(double lo, double hi) {
        Param param;
        param.has_range = true;
        param.lo = {lo}, param.hi = {hi}, param.value = param.initial = {lo};
        scene.params.push_back(param);
        return g.param(static_cast<std::uint32_t>(scene.params.size() - 1), Type::Float);
    }
    const ShapeFact &prove(ShapeId id, Diagnostics &diagnostics,
                           const proof::Options &options = {}) {
        scene.top_level = {{id, {}}};
        scene.root = id;
        proof::prove(scene, diagnostics, options);
        return scene.facts[id.index];
    }
    const ShapeFact &prove(ShapeId id) {
        Diagnostics diagnostics;
        return prove(id, diagnostics);
    }
    proof::FieldBound bound(NodeId field, proof::Cell box = {}) {
        proof::Work work;
        proof::Flattening context{g, work};
        proof::Ranges ranges = proof::ranges_of(scene, work);
        return proof::bound_field(context, ranges, field, {box, nullptr}, {});
    }
};

inline proof::Cell cube(double r) {
    using ir::Interval;
    return {{Interval(-r, r), Interval(-r, r), Interval(-r, r)}};
}

inline bool has(const Diagnostics &diagnostics, Code code) {
    for (const Diagnostic &d : diagnostics.items())
        if (d.code == code) return true;
    return false;
}
inline std::string said(const Diagnostics &diagnostics) {
    std::string out;
    for (const Diagnostic &d : diagnostics.items()) {
        out += std::string(code_name(d.code)) + ": " + d.message + "\n";
        for (const std::string &note : d.notes) out += "  note: " + note + "\n";
        if (d.fix) out += "  help: " + d.fix->message + "\n";
    }
    return out;
}

} // namespace fathom::test
