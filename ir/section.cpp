#include "ir/section.h"

#include <cmath>

namespace fathom::ir {

namespace {

// #e5793f, linear: warm, and no colour that solids have unless they are painted.
constexpr std::array<double, 3> face_color{0.7835, 0.1912, 0.0497};

std::uint32_t add_face_material(Scene &scene) {
    Graph &g = scene.graph;
    Material face;
    face.diffuse = g.vec3(face_color[0], face_color[1], face_color[2]);
    face.specular = g.vec3(0, 0, 0); // a cut is dull
    face.exponent = g.number(32);
    face.emission = g.vec3(0, 0, 0);
    scene.shapes.materials.push_back(face);
    return static_cast<std::uint32_t>(scene.shapes.materials.size() - 1);
}

} // namespace

void cut_open(Scene &scene, const Section &section) {
    if (scene.top_level.empty()) return;
    Graph &g = scene.graph;
    const NodeId along = g.component(g.point(), section.axis);
    const std::uint32_t material = add_face_material(scene);
    const Span origin = scene.top_level.front().span;
    Shape kept;
    kept.kind = ShapeKind::Intersection;
    kept.children.push_back(scene.root);
    kept.origin = origin;
    const auto cut = [&](NodeId field) {
        Shape half;
        half.kind = ShapeKind::Leaf;
        half.args.push_back(field);
        half.origin = origin;
        Shape painted;
        painted.kind = ShapeKind::Repaint;
        painted.payload = material;
        painted.children.push_back(scene.shapes.add(std::move(half)));
        painted.origin = origin;
        kept.children.push_back(scene.shapes.add(std::move(painted)));
    };
    if (std::isfinite(section.to)) {
        const NodeId end = g.number(section.to);
        cut(g.sub(along, end));
    }
    if (std::isfinite(section.from)) {
        const NodeId end = g.number(section.from);
        cut(g.sub(end, along));
    }
    scene.root = scene.shapes.add(std::move(kept));
    scene.top_level = {{scene.root, origin}};
}

} // namespace fathom::ir
