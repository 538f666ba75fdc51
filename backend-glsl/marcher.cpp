// See marcher.h. The GLSL stands in templates/; names and order follow ir/shading.h, which explains.
#include "backend-glsl/marcher.h"

#include "backend-glsl/module.h"
#include "backend-glsl/template.h"
#include "ir/shading.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::glsl {

namespace {

constexpr int check_steps = 16384;      // of the probe
constexpr int most_probed_steps = 4096; // of the march that it checks
constexpr int fewest_steps = 256;
constexpr double steps_a_length = 64;

std::string flag(bool on) { return on ? "1" : ""; }

std::string vec3_of(const std::array<float, 3> &v) { return vec3_literal({v[0], v[1], v[2]}); }

// How the surface is gone down to (shading.h, NEAREST).
Values descent_values() {
    namespace shading = ir::shading;
    return {
        {"DESCENT_STEPS", fmt::to_string(shading::descent_steps)},
        {"DESCENT_REACH", float_literal(shading::descent_reach)},
        {"DESCENT_PLAIN", fmt::to_string(shading::descent_plain)},
        {"DESCENT_SLOW", float_literal(shading::descent_slow)},
        {"DESCENT_FASTEST", float_literal(shading::descent_fastest)},
        {"DESCENT_ACROSS", float_literal(shading::descent_across)},
        {"DESCENT_LEAST", float_literal(shading::descent_least)},
        {"DESCENT_APART", float_literal(shading::descent_apart)},
    };
}

Values values_of(const MarcherOptions &options) {
    namespace shading = ir::shading;
    const std::string far = "100.0 * max(" + float_literal(options.radius) +
                            ", length(fathom_origin - " + options.center + "))";
    const bool many_slopes = !options.unit_slope;
    const int surface_taps = many_slopes ? 5 : 4;
    Values values{
        {"BOXED", flag(options.boxed)},
        {"UNIT_SLOPE", flag(options.unit_slope)},
        {"EXACT", flag(options.exact)},
        {"MANY_SLOPES", flag(many_slopes)},
        {"SHADED_APART", flag(options.shaded_apart)},
        {"ESTIMATED", flag(options.estimate > 0)},
        {"SHADED", options.shaded_apart ? "fathom_shaded" : "sdf"},
        {"PASSES", flag(options.passes)},
        {"FOUR_OUTPUTS", flag(options.four_outputs)},
        {"HAS_SAFE_RADIUS", flag(options.has_safe_radius)},
        // Of a field that costs little, two copies are quicker than the loop round one.
        {"APART", flag(options.skip_shading || (options.cheap && !options.cached))},
        {"SKIP_SHADING", flag(options.skip_shading)},
        {"CLASSIC", flag(options.classic)},
        {"SOFT", flag(!options.classic && !options.skip_shading)},
        {"LOCAL_NORMALS", flag(options.local_normals)},
        {"PICK", flag(options.pick)},
        {"CACHED", flag(options.cached)},
        {"FAR_CELLS", flag(options.far_cells)},
        {"AROUND", flag(options.around)},
        {"ONE_LIGHT", flag(options.lights == 1)},
        {"AND_PRESENT", options.cached ? " && !fathom_absent" : ""},
        {"UNLIT", options.lights == 1 ? "return color" : "continue"},
        {"COUNTED", flag(options.cached || options.passes)},
        {"LIGHTS", fmt::to_string(options.lights)},
        {"SUN_REACH", options.boxed ? "max(fathom_box(q, l).y, 0.0)" : "fathom_far"},
        {"FAR", options.far > 0 ? float_literal(options.far) : far},
        {"RADIUS", float_literal(options.radius)},
        {"LO", options.lo},
        {"HI", options.hi},
        {"EPSILON", float_literal(options.epsilon)},
        {"USUAL_EXTENT", float_literal(shading::usual_extent)},
        {"MAX_STEPS", fmt::to_string(options.max_steps)},
        {"ZERO", options.zero},
        {"FLOAT_SLACK", float_literal(shading::float_slack)},
        {"NORMAL_SLACK", float_literal(shading::normal_slack)},
        {"MIN_SLOPE", float_literal(shading::min_slope)},
        {"FAINT", float_literal(shading::faint)},
        {"BESIDE_ARMS", float_literal(shading::beside)},
        {"BESIDE_REACH", float_literal(shading::beside_reach)},
        {"BESIDE_LOOKS", fmt::to_string(shading::beside_looks)},
        {"RELAXATION", float_literal(shading::relaxation)},
        {"FLATTEST", float_literal(shading::flattest)},
        {"NEARER_PART", float_literal(shading::nearer)},
        {"BENT_RELAXATION", float_literal(shading::bent_relaxation)},
        {"GRAZE", float_literal(shading::graze)},
        {"JUMP", float_literal(shading::jump)},
        {"REFINED", float_literal(shading::refined)},
        {"SHADOW_ARM", float_literal(shading::shadow_arm)},
        {"CREASE", float_literal(shading::crease)},
        {"FLAT_FROM", float_literal(shading::flat_from)},
        {"CALM", float_literal(shading::calm)},
        {"NEARING", fmt::to_string(shading::nearing)},
        {"SHARE", float_literal(1 / std::max(options.estimate, 1.0))},
        {"DARK", float_literal(shading::dark / std::max(options.estimate, 1.0))},
        {"MARKS", float_literal(shading::marks)},
        {"CLOSED_FROM", float_literal(shading::closed_from)},
        {"REFINEMENTS", fmt::to_string(shading::refinements)},
        {"WIDEST", float_literal(shading::widest)},
        {"DARK_LIGHT", float_literal(shading::dark_light)},
        {"PROBE", float_literal(shading::probe)},
        {"PROBE_DEPTH", float_literal(shading::probe_depth)},
        {"LIFT", float_literal(shading::lift)},
        {"KINKED", float_literal(shading::kinked)},
        {"BEHIND", float_literal(shading::behind)},
        {"ACROSS", float_literal(shading::across)},
        {"DEEP", fmt::to_string(shading::deep)},
        {"FILMS", flag(options.films)},
        {"FILM_STEPS", fmt::to_string(shading::film_steps)},
        {"FILM_LOOKS", fmt::to_string(shading::film_looks)},
        {"FILM_NEAR", float_literal(shading::film_near)},
        {"FILM_LOOK", float_literal(shading::film_look)},
        {"FILM_LOWER", float_literal(shading::film_lower)},
        {"FILM_FLAT", float_literal(shading::film_flat)},
        {"FILM_TURN", float_literal(shading::film_turn)},
        {"CIRCLES", fmt::to_string(shading::circles)},
        {"CIRCLE_LOOKS", fmt::to_string(shading::circle_looks)},
        {"CIRCLES_LOOKS", fmt::to_string(2 * shading::circles * shading::circle_looks)},
        {"CIRCLE_HALVINGS", fmt::to_string(shading::circle_halvings)},
        {"CIRCLE_TURN", float_literal(shading::circle_turn)},
        {"CIRCLE_NARROWER", float_literal(shading::circle_narrower)},
        {"CIRCLE_ACROSS", float_literal(shading::circle_across)},
        {"DARKEST", float_literal(shading::darkest)},
        {"CROSSED", options.estimate > 0 ? "<= 0.0" : "< -0.25 * fathom_slack_at(t)"},
        {"NO_ESTIMATE", options.estimate > 0 ? " && d > 0.0" : ""},
        {"MANY_STEPS", fmt::to_string(shading::many_steps)},
        {"NEARLY", float_literal(shading::nearly)},
        {"OCCLUSION_FINE", float_literal(shading::occlusion_fine)},
        {"MOST_SLIDES", fmt::to_string(shading::most_slides)},
        {"OCCLUSION_SLIDES", fmt::to_string(shading::occlusion_slides)},
        {"NEAR_ENOUGH", float_literal(shading::near_enough)},
        {"FILM_STALLS", fmt::to_string(shading::film_stalls)},
        {"STEADY", float_literal(shading::steady)},
        {"LEAST_SHARE", float_literal(shading::least_share)},
        {"FINE", float_literal(shading::penumbra_fine)},
        {"UNSEEN", float_literal(shading::nowhere)},
        {"SURFACE_TAPS", fmt::to_string(surface_taps)},
        {"OCCLUSION_TAPS", fmt::to_string(shading::occlusion_samples)},
        {"OCCLUSION_TOTAL", float_literal(1 - std::ldexp(1.0, -shading::occlusion_samples))},
        {"OCCLUSION_REACH", float_literal(shading::occlusion_reach)},
        {"OCCLUSION_SAMPLES", float_literal(float{shading::occlusion_samples})},
        {"SOIL", vec3_of(shading::soil)},
        {"SKY", vec3_of(shading::sky)},
        {"SHOULDER", float_literal(shading::shoulder)},
        {"FADE_FROM", float_literal(shading::fade_from)},
        {"ARM", float_literal(shading::arm)},
        {"SHADOW_BIAS", float_literal(shading::shadow_bias)},
        {"MIN_ANGLE", float_literal(shading::min_angle)},
        {"CHECK_STEPS", fmt::to_string(check_steps)},
    };
    values.merge(descent_values());
    return values;
}

} // namespace

int steps_in_one_pass(double bound, double lengths) {
    const double steps = steps_a_length * std::max(bound, 1.0) * std::log(std::max(lengths, 2.0));
    return static_cast<int>(
        std::clamp(std::ceil(steps), double{fewest_steps}, double{ir::shading::budget}));
}

std::string marcher_text(const MarcherOptions &options) {
    const Values values = values_of(options);
    return (options.pick ? "\nlayout(location = 1) out vec4 fathom_pick;\n" : "") +
           expand("march", values) + expand("corner", values) + expand("nearest", values) +
           expand("shadow", values) + expand("shade", values) + expand("picture", values);
}

std::string probe_text(MarcherOptions options) {
    options.passes = false;
    options.max_steps = std::min(options.max_steps, most_probed_steps);
    const Values values = values_of(options);
    return expand("march", values) + expand("probe", values);
}

} // namespace fathom::glsl
