// A scene made ready to be looked at: its programs, frame and lights, and cells where shapes are many.
#include "backend-cpu/trace/rays.h"

#include <algorithm>
#include <cmath>

namespace fathom::cpu {

namespace {

float number_of(const ir::Scene &scene, ir::NodeId id, double time) {
    return static_cast<float>(ir::value_of(scene, id, time)[0]);
}

// Whether a surface looks different with another normal.
bool reads_normal(const ir::Graph &graph, const ir::Surface &surface) {
    for (ir::NodeId root : {surface.diffuse, surface.specular, surface.exponent, surface.emission})
        for (ir::NodeId var : graph.free_vars(root))
            if (var == surface.normal) return true;
    return false;
}

// Smaller cells have shorter tapes, but fewer points of a tile fall into each: measured.
constexpr double cell_pixels = 16;

// What holds all that rays can come to.
void prune(Stage &stage, Prune how) {
    if (how == Prune::Never) return;
    const ir::Scene &scene = *stage.scene;
    Program distance = compile(scene, scene.distance, Choices::Apart);
    if (how == Prune::Auto &&
        whole_tape(prune_program_of(distance, stage.inputs)).shapes < prune_from)
        return;
    stage.distance = std::move(distance);
    stage.hit = compile(scene, scene.hit, Choices::Apart);
    const ir::Frame &frame = stage.frame;
    Cube cube;
    double side = 2.1 * frame.far;
    glm::dvec3 middle = frame.center;
    if (frame.boxed) {
        side = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            side = std::max(side, 1.001 * (frame.hi[i] - frame.lo[i]));
            middle[i] = (frame.hi[i] + frame.lo[i]) / 2;
        }
    }
    const double pixel = frame.pixel * (stage.view.orthographic ? 1 : stage.view.focus);
    const double cell = cell_pixels * pixel;
    PruneSettings settings;
    settings.depth = std::clamp(static_cast<int>(std::ceil(std::log2(side / cell) / 2)), 1, 10);
    side = std::max(side, std::ldexp(cell, 2 * settings.depth));
    cube.side = static_cast<float>(side);
    for (std::size_t i = 0; i < 3; ++i) cube.lo[i] = static_cast<float>(middle[i] - side / 2);
    stage.pruning = std::make_shared<Pruning>(stage.distance, stage.inputs, cube, settings);
    settings.far_cells = false;
    stage.hit_pruning = std::make_shared<Pruning>(stage.hit, stage.inputs, cube, settings);
    if (!stage.shaded_apart) return;
    stage.shaded = compile(scene, scene.shaded, Choices::Apart);
    stage.shaded_pruning = std::make_shared<Pruning>(stage.shaded, stage.inputs, cube, settings);
}

} // namespace

float shapes_of(const ir::Scene &scene) {
    return whole_tape(prune_program_of(compile(scene, scene.distance, Choices::Apart), {})).shapes;
}

Stage prepare(const ir::Scene &scene, const ir::View &view, int width, int height, double time,
              Prune how) {
    Stage stage;
    stage.scene = &scene;
    stage.width = width;
    stage.height = height;
    stage.view = view;
    stage.budget = ir::budget_of(scene);
    stage.frame = ir::frame_of(scene, view, height);
    stage.inputs = inputs_of(scene, time);
    stage.distance = compile(scene, scene.distance);
    stage.hit = compile(scene, scene.hit);
    stage.shaded_apart = scene.shaded != scene.distance;
    if (stage.shaded_apart) stage.shaded = compile(scene, scene.shaded);
    prune(stage, how);
    stage.has_safe_radius = scene.safe_radius && !stage.pruning;
    if (stage.has_safe_radius) stage.safe_radius = compile(scene, scene.safe_radius);
    stage.has_background = static_cast<bool>(scene.background_function);
    if (stage.has_background) stage.background = compile(scene, scene.background_function);
    for (const ir::Surface &surface : scene.surfaces) {
        const ir::NodeId params[] = {surface.point, surface.normal, surface.extra};
        const ir::NodeId results[] = {surface.diffuse, surface.specular, surface.exponent,
                                      surface.emission};
        stage.surfaces.push_back(compile(scene, params, results));
        stage.local_normals = stage.local_normals || reads_normal(scene.graph, surface);
    }
    stage.lights = ir::lights_of(scene, time, view);
    const ir::Lighting &lighting = scene.lighting;
    const auto ambient = ir::value_of(scene, lighting.ambient, time);
    for (std::size_t c = 0; c < 3; ++c) stage.shading.ambient[c] = static_cast<float>(ambient[c]);
    stage.shading.ambient_occlusion = number_of(scene, lighting.ambient_occlusion, time);
    stage.shading.shadow_darkness = number_of(scene, lighting.shadow_darkness, time);
    stage.shading.soft_shadows = number_of(scene, lighting.soft_shadows, time);
    stage.shading.specular_intensity = number_of(scene, lighting.specular_intensity, time);
    stage.shading.fill = number_of(scene, lighting.fill, time);
    if (lighting.occlusion_reach)
        stage.shading.occlusion_reach = number_of(scene, lighting.occlusion_reach, time);
    if (!(stage.shading.occlusion_reach > 0))
        stage.shading.occlusion_reach = static_cast<float>(stage.frame.occlusion_reach);
    return stage;
}

Worker::Worker(const Stage &s)
    : stage(s), distance(make_scratch(s.distance, s.inputs)), hit(make_scratch(s.hit, s.inputs)) {
    if (s.shaded_apart) shaded = make_scratch(s.shaded, s.inputs);
    if (s.has_safe_radius) safe_radius = make_scratch(s.safe_radius, s.inputs);
    if (s.has_background) background = make_scratch(s.background, s.inputs);
    for (const Program &surface : s.surfaces) surfaces.push_back(make_scratch(surface, s.inputs));
    if (s.pruning) evaluator.emplace(*s.pruning, s.inputs);
    if (s.hit_pruning) hit_evaluator.emplace(*s.hit_pruning, s.inputs);
    if (s.shaded_pruning) shaded_evaluator.emplace(*s.shaded_pruning, s.inputs);
}

} // namespace fathom::cpu
