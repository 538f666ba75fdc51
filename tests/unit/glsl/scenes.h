// Lowered scenes made by hand, for the tests of what comes after the lowering.
#pragma once

#include "ir/lower/lower.h"
#include "ir/scene.h"

#include <cmath>
#include <functional>

namespace fathom::scenes {

using namespace fathom::ir;

inline NodeId sphere_distance(Graph &g, NodeId p, NodeId center, NodeId radius) {
    return g.sub(g.make(Op::Length, {g.sub(p, center)}), radius);
}

inline Surface plain_surface(Graph &g, double r, double green, double b) {
    Surface s;
    s.point = g.fresh_var(Type::Vec3);
    s.normal = g.fresh_var(Type::Vec3);
    s.extra = g.fresh_var(Type::Vec4);
    s.diffuse = g.vec3(r, green, b);
    s.specular = g.vec3(1, 1, 1);
    s.exponent = g.number(32);
    s.emission = g.vec3(0, 0, 0);
    return s;
}

// Everything but the field: lights, a surface for each paint and the last for the unpainted, a dark
// background.
inline void add_appearance(Scene &scene, int paints, Box bounds) {
    Graph &g = scene.graph;
    for (int i = 0; i <= paints; ++i)
        scene.surfaces.push_back(
            plain_surface(g, i == paints ? 0.8 : 0.2 + 0.6 * i / std::max(paints, 1), 0.5, 0.3));
    const NodeId direction = g.fresh_var(Type::Vec3);
    Function background{"background", {}, {direction}, g.vec3(0.02, 0.03, 0.05)};
    scene.background_function = g.add_function(background);
    scene.lighting.ambient = g.vec3(0.2, 0.2, 0.2);
    scene.lighting.ambient_occlusion = g.number(1);
    scene.lighting.shadow_darkness = g.number(0.5);
    scene.lighting.soft_shadows = g.number(0.03);
    scene.lighting.specular_intensity = g.number(0.4);
    scene.bounds = scene.extent = bounds;
    ShapeFact fact;
    fact.bounds = bounds;
    Shape leaf;
    scene.root = scene.shapes.add(leaf);
    scene.facts.resize(scene.root.index + 1);
    scene.facts[scene.root.index] = fact;
}

inline Box cube(double half) { return {{-half, -half, -half}, {half, half, half}}; }

// A scene of one expression in p.
inline Scene of_field(const std::function<NodeId(Graph &, NodeId p)> &field, Box bounds = cube(1)) {
    Scene scene;
    Graph &g = scene.graph;
    const NodeId p = g.fresh_var(Type::Vec3);
    scene.distance = g.add_function({"scene", {}, {p}, field(g, p)});
    const NodeId q = g.fresh_var(Type::Vec3);
    const NodeId distance = g.call(scene.distance, {&q, 1});
    const NodeId extra = g.vec(std::array{0.0, 0.0, 0.0, 0.0});
    const NodeId hit = g.make(Op::MakeHit, Type::Hit, {distance, g.integer(-1), q, extra});
    scene.hit = g.add_function({"scene_hit", {}, {q}, hit});
    add_appearance(scene, 0, bounds);
    return scene;
}

inline Scene sphere(double radius = 1) {
    return of_field(
        [&](Graph &g, NodeId p) {
            return sphere_distance(g, p, g.vec3(0, 0, 0), g.number(radius));
        },
        cube(radius));
}

// `count` spheres on a spiral whose places, radii and colours stand in a table, united in a loop;
// painted from the table.
inline Scene table_of_spheres(int count, bool smooth = false) {
    Scene scene;
    Graph &g = scene.graph;
    Table table{count, 7, {}};
    for (int i = 0; i < count; ++i) {
        const double angle = 2.399963 * i, height = 1 - 2 * (i + 0.5) / count,
                     ring = std::sqrt(1 - height * height);
        for (double v : {2 * ring * std::cos(angle), 2 * height, 2 * ring * std::sin(angle),
                         0.15 + 0.05 * (i % 3), 0.5 + 0.5 * std::cos(angle), 0.5 + 0.5 * height,
                         0.5 + 0.5 * std::sin(angle)})
            table.data.push_back(static_cast<float>(v));
    }
    const TableId rows = g.add_table(table);
    const auto sphere_at = [&](NodeId p, NodeId index) {
        return sphere_distance(g, p,
                               g.make(Op::TableRead, Type::Vec3, {index}, table_slot(rows, 0)),
                               g.make(Op::TableRead, Type::Float, {index}, table_slot(rows, 3)));
    };
    {
        const NodeId p = g.fresh_var(Type::Vec3), index = g.fresh_var(Type::Int),
                     minimum = g.fresh_var(Type::Float);
        const NodeId d = sphere_at(p, index);
        const NodeId next =
            smooth ? g.make(Op::Blend, Type::Float, {g.number(0.1), g.number(0), minimum, d})
                   : g.make(Op::Union, Type::Float, {minimum, d});
        Loop record{g.integer(count), index, {minimum}, {next}, {}, count};
        const LoopId id = g.add_loop(record);
        const NodeId loop = g.make(Op::Loop, Type::Float, {g.number(1e9)}, id.index);
        scene.distance =
            g.add_function({"spheres", {}, {p}, g.make(Op::LoopResult, Type::Float, {loop}, 0)});
    }
    {
        const NodeId p = g.fresh_var(Type::Vec3), index = g.fresh_var(Type::Int),
                     nearest = g.fresh_var(Type::Hit);
        const NodeId color = g.make(Op::TableRead, Type::Vec3, {index}, table_slot(rows, 4));
        const NodeId extra = g.make(
            Op::Make, Type::Vec4,
            {g.component(color, 0), g.component(color, 1), g.component(color, 2), g.number(0)});
        const NodeId hit =
            g.make(Op::MakeHit, Type::Hit, {sphere_at(p, index), g.integer(0), p, extra});
        const NodeId next = g.make(Op::NearestHit, Type::Hit, {nearest, hit});
        const LoopId id = g.add_loop({g.integer(count), index, {nearest}, {next}, {}, count});
        const NodeId none =
            g.make(Op::MakeHit, Type::Hit,
                   {g.number(1e9), g.integer(-1), p, g.vec(std::array{0.0, 0.0, 0.0, 0.0})});
        const NodeId loop = g.make(Op::Loop, Type::Hit, {none}, id.index);
        scene.hit =
            g.add_function({"spheres_hit", {}, {p}, g.make(Op::LoopResult, Type::Hit, {loop}, 0)});
    }
    add_appearance(scene, 1, cube(2.25));
    Surface &painted = scene.surfaces[0];
    painted.diffuse = g.swizzle(painted.extra, std::array{0, 1, 2});
    return scene;
}

} // namespace fathom::scenes
