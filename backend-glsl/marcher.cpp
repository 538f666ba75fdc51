// See marcher.h. The GLSL stands in templates/; names and order follow ir/shading.h, which explains.
#include "backend-glsl/marcher.h"

#include "backend-glsl/module.h"
#include "backend-glsl/template.h"
#include "ir/shading.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::glsl {

namespace {

constexpr int check_steps_a_step = 40; // of the probe

std::string flag(bool on) { return on ? "1" : ""; }

Values values_of(const MarcherOptions &options) {
    namespace shading = ir::shading;
    const std::string far = "100.0 * max(" + float_literal(options.radius) +
                            ", length(fathom_origin - " + options.center + "))";
    return {
        {"BOXED", flag(options.boxed)},
        {"STEEP", flag(options.steep)},
        {"HAS_SAFE_RADIUS", flag(options.has_safe_radius)},
        // Of a field that costs little, two copies are quicker than the loop round one.
        {"APART", flag(options.cheap && !options.cached)},
        {"SKIP_SHADING", flag(options.skip_shading)},
        {"LOCAL_NORMALS", flag(options.local_normals)},
        {"PICK", flag(options.pick)},
        {"CACHED", flag(options.cached)},
        {"FAR_CELLS", flag(options.far_cells)},
        {"AROUND", flag(options.around)},
        {"ONE_LIGHT", flag(options.lights == 1)},
        {"NEAR", options.steep ? "near" : "d"},
        {"AND_PRESENT", options.cached ? " && !fathom_absent" : ""},
        {"UNLIT", options.lights == 1 ? "return color" : "continue"},
        {"LIGHTS", fmt::to_string(options.lights)},
        {"SUN_REACH", options.boxed ? "max(fathom_box(q, l).y, 0.0)" : "fathom_far"},
        {"FAR", options.far > 0 ? float_literal(options.far) : far},
        {"RADIUS", float_literal(options.radius)},
        {"LO", options.lo},
        {"HI", options.hi},
        {"EPSILON", float_literal(options.epsilon)},
        {"MAX_STEPS", fmt::to_string(options.max_steps)},
        {"ZERO", options.zero},
        {"FLOAT_SLACK", float_literal(shading::float_slack)},
        {"NORMAL_SLACK", float_literal(shading::normal_slack)},
        {"MIN_SLOPE", float_literal(shading::min_slope)},
        {"RELAXATION", float_literal(shading::relaxation)},
        {"FLATTEST", float_literal(shading::flattest)},
        {"NEARER_PART", float_literal(shading::nearer)},
        {"BENT_RELAXATION", float_literal(shading::bent_relaxation)},
        {"ALL_TAPS", fmt::to_string(4 + shading::occlusion_samples)},
        {"OCCLUSION_TOTAL", float_literal(1 - std::ldexp(1.0, -shading::occlusion_samples))},
        {"OCCLUSION_REACH",
         float_literal(shading::occlusion_reach * options.radius / shading::occlusion_samples)},
        {"SHADOW_STEPS", fmt::to_string(options.max_steps)},
        {"SHADOW_BIAS", float_literal(shading::shadow_bias)},
        {"MIN_ANGLE", float_literal(shading::min_angle)},
        {"CHECK_STEPS", fmt::to_string(check_steps_a_step * options.max_steps)},
    };
}

} // namespace

std::string marcher_text(const MarcherOptions &options) {
    const Values values = values_of(options);
    return (options.pick ? "\nlayout(location = 1) out vec4 fathom_pick;\n" : "") +
           expand("march", values) + (options.steep ? "" : expand("corner", values)) +
           expand("shade", values) + expand("picture", values);
}

std::string probe_text(const MarcherOptions &options) {
    const Values values = values_of(options);
    return expand("march", values) + expand("probe", values);
}

} // namespace fathom::glsl
