#include "backend-glsl/picture.h"

#include "backend-glsl/cache_text.h"
#include "backend-glsl/inputs.h"
#include "backend-glsl/marcher.h"
#include "backend-glsl/template.h"
#include "base/encode.h"
#include "ir/passes/operations.h"
#include "ir/view.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::glsl {

namespace {

constexpr double cheap_field = 150; // operations

std::string shown(bool on) { return on ? "1" : ""; }

// What the text's version has to be, by what it uses; empty where its host says it.
std::string version_of(const Module &module, const TargetTraits &target) {
    if (target.version == 0) return "";
    if (target.es) return fmt::format("{} es", target.version);
    const int used = !module.pruned.empty() ? 430 : !module.cached.empty() ? 420 : 0;
    return fmt::format("{} core", std::max(target.version, used));
}

// What was proved of the scene, and on what that rests (docs/trusted.md).
std::string proof_of(const ir::Scene &scene) {
    using Kind = ir::Axiom::Kind;
    const auto many = [&](Kind kind) {
        return std::ranges::count(scene.axioms, kind, &ir::Axiom::kind);
    };
    if (many(Kind::Estimated) > 0) return "estimated";
    if (many(Kind::Assumed) > 0) return "assumed";
    const std::size_t axioms = scene.axioms.size();
    if (axioms == 0) return "proved";
    return "proved, on " + std::to_string(axioms) + (axioms == 1 ? " axiom" : " axioms");
}

std::string head(const Module &module) {
    const Options &options = module.options;
    const TargetTraits &target = traits_of(options.target);
    const std::string fixed =
        options.instruments != Instruments::None
            ? ""
            : fixed_params_comment(module.scene, [&](Span span) {
                  return options.place ? for_comment(options.place(span)) : std::string();
              });
    return expand("head", {{"VERSION", version_of(module, target)},
                           {"WRITTEN_BY", written_by(options)},
                           {"OWN", shown(options.instruments != Instruments::None)},
                           {"PROOF", proof_of(module.scene)},
                           {"FIELD_ONLY", shown(options.field_only)},
                           {"USE", target.use},
                           {"FIXED_PARAMS", fixed},
                           {"ES", shown(target.es)}});
}

std::string hit_function(const Module &module) {
    const ir::Scene &scene = module.scene;
    const int stride = module.options.part_stride;
    return expand("hit", {{"MARKED", shown(scene.hit && stride > 0)},
                          {"STRIDE", fmt::to_string(stride)},
                          {"PICK", shown(module.options.instruments == Instruments::Pick)},
                          {"UNPAINTED", shown(!scene.hit)}});
}

// How many steps a ray may take where there is one pass.
int steps_of(const Module &module, const ir::Frame &frame) {
    constexpr int most_through_cache = 4096; // while it is moved
    const ir::Scene &scene = module.scene;
    double bound = 1;
    for (const ir::ShapeFact &fact : scene.facts)
        if (std::isfinite(fact.lipschitz_sup)) bound = std::max(bound, fact.lipschitz_sup);
    const double lengths = (frame.boxed ? 2 * frame.radius : frame.far) /
                           (frame.tolerance_base + frame.tolerance_slope * frame.radius);
    int steps = steps_in_one_pass(bound, lengths);
    if (scene.render.max_steps > 0) steps = std::min(steps, scene.render.max_steps);
    return module.cached.empty() ? steps : std::min(steps, most_through_cache);
}

MarcherOptions marcher_options(const Module &module, const SceneText &text, const ir::View &view) {
    const ir::Scene &scene = module.scene;
    const ir::Frame frame = ir::frame_of(scene, view, 1080);
    MarcherOptions marcher;
    marcher.boxed = frame.boxed;
    marcher.unit_slope = frame.unit_slope;
    marcher.exact = frame.exact;
    marcher.films = frame.films;
    marcher.estimate = frame.estimate;
    marcher.shaded_apart = is_shaded_apart(scene);
    marcher.has_safe_radius = static_cast<bool>(scene.safe_radius);
    marcher.cheap = scene.distance &&
                    ir::operations(scene.graph, module.result_of(scene.distance)) <= cheap_field;
    marcher.skip_shading = scene.lighting.skip;
    marcher.classic = scene.lighting.classic;
    marcher.local_normals = text.local_normals;
    marcher.lights = text.lights;
    marcher.max_steps = steps_of(module, frame);
    marcher.epsilon = scene.render.epsilon;
    marcher.far = scene.render.far;
    marcher.radius = frame.radius;
    marcher.center = vec3_literal(frame.center);
    marcher.lo = vec3_literal(frame.lo);
    marcher.hi = vec3_literal(frame.hi);
    marcher.zero = traits_of(module.options.target).zero;
    marcher.pick = module.options.instruments == Instruments::Pick;
    marcher.cached = !module.cached.empty();
    marcher.passes = module.options.passes && !marcher.cached;
    marcher.four_outputs = traits_of(module.options.target).form == Form::Page;
    marcher.far_cells = module.far_cells;
    marcher.around = module.around;
    return marcher;
}

// The entry point, by the target's template.
std::string entry(const Module &module, const ir::View &view) {
    const TargetTraits &target = traits_of(module.options.target);
    const glm::dvec3 looked_at = view.origin + view.focus * view.forward;
    const bool cached = !module.cached.empty();
    const bool several = cached || module.options.instruments == Instruments::Pick;
    Values values = cache_numbers();
    values.insert({{"LOCATIONS", shown(target.locations || several)}, // of the outputs
                   {"CACHED", shown(cached)},
                   {"PASSES", shown(module.options.passes && !cached)},
                   {"ZERO", target.zero},
                   {"ORIGIN", vec3_literal(view.origin)},
                   {"RIGHT", vec3_literal(view.right)},
                   {"UP", vec3_literal(view.up)},
                   {"FORWARD", vec3_literal(view.forward)},
                   {"AROUND", float_literal(std::atan2(-view.forward[0], -view.forward[2]))},
                   {"ABOVE", float_literal(std::asin(std::clamp(-view.forward[1], -1.0, 1.0)))},
                   {"TARGET", vec3_literal(looked_at)}});
    return expand(target.entry, values);
}

} // namespace

std::string written_by(const Options &options) {
    return comment(options.title + ": written by fathom.");
}

std::string picture_text(const Module &module, const SceneText &scene, std::vector<Input> &all) {
    const ir::View view = ir::view_of(module.scene, module.options.time, 16.0 / 9.0);
    const MarcherOptions marcher = marcher_options(module, scene, view);
    Inputs inputs(module);
    const std::string declared = inputs.of_picture(view);
    all = inputs.uniforms();
    std::string before = head(module) + inputs.defaults() + declared;
    if (!module.pruned.empty()) before += prune_look_up(module.scene.bounds);
    before += scene.tables + scene.functions;
    if (module.far_cells) before += far_look_up(marcher.boxed ? "fathom_off(p)" : "0.0");
    if (module.options.instruments == Instruments::Probe) return before + probe_text(marcher);
    return before + hit_function(module) + scene.shading + marcher_text(marcher) +
           entry(module, view);
}

std::string field_text(const Module &module, const SceneText &scene, std::vector<Input> &all) {
    double bound = 0;
    for (const ir::TopLevel &top : module.scene.top_level)
        if (top.shape.index < module.scene.facts.size())
            bound = std::max(bound, module.scene.facts[top.shape.index].lipschitz_sup);
    Inputs inputs(module);
    const std::string declared = inputs.of_field();
    all = inputs.uniforms();
    return expand("field", {{"BEGIN", head(module) + inputs.defaults()},
                            {"INPUTS", declared},
                            {"BOUND", float_literal(bound > 0 ? bound : 1)},
                            {"FUNCTIONS", scene.tables + scene.functions},
                            {"HIT", hit_function(module)},
                            {"SHADING", scene.shading}});
}

} // namespace fathom::glsl
