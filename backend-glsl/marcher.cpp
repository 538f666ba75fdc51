// See marcher.h. Names and order follow ir/look.h, which explains; backend-cpu/trace/march.cpp is
// this file's sibling.
#include "backend-glsl/marcher.h"

#include "backend-glsl/fill.h"
#include "backend-glsl/module.h"
#include "ir/look.h"

#include <cmath>
#include <utility>
#include <vector>

namespace fathom::glsl {

namespace {

constexpr const char *lengths = R"(
// ---- how rays are marched and points are shaded ----

float fathom_slack, fathom_pixel, fathom_far, fathom_tolerance_base, fathom_tolerance_slope;
int fathom_steps = 0;
int fathom_paint = -2; // of what the ray hit

void fathom_lengths() {
    fathom_slack = $FLOAT_SLACK * (length(fathom_origin) + $RADIUS);
    fathom_pixel = 2.0 * fathom_extent / fathom_resolution.y;
    fathom_far = $FAR;
    bool parallel = fathom_orthographic != 0;
    fathom_tolerance_base = (parallel ? min($EPSILON * fathom_focus, 0.5 * fathom_pixel) : 0.0) + fathom_slack;
    fathom_tolerance_slope = parallel ? 0.0 : min($EPSILON, 0.5 * fathom_pixel);
}

float fathom_tolerance(float t) {
    return fathom_tolerance_base + fathom_tolerance_slope * t;
}

float fathom_arm(float t) {
    return fathom_tolerance(t) + $NORMAL_SLACK * fathom_slack;
}
)";

// Drivers write a function out at each of its calls. So the points of a gradient are asked in one
// loop, whose bound the compiler cannot see, and what goes with them in the same.
constexpr const char *corner = R"(
vec3 fathom_corner(int i) {
    return 0.577350269 * (2.0 * vec3(float(((i + 3) >> 1) & 1), float((i >> 1) & 1), float(i & 1)) - 1.0);
}
)";

// Of a field that costs little, two copies are quicker than the loop round one.
constexpr const char *near_cheap = R"(
// The field at p in d; and, where that is at most `limit`, the true distance |f| / |grad f|, since
// the field was divided by a bound; else d again.
float fathom_near(vec3 p, float h, float limit, out float d) {
$ASK_CHEAP    if (!(d <= limit)) return d;
    vec3 sum = vec3(0.0);
    for (int i = $ZERO; i < 4; ++i) {
        vec3 e = fathom_corner(i);
        sum += e * sdf(p + h * e);
    }
    return d / clamp(length(0.75 / h * sum), $LEAST_SLOPE, 1.0);
}
)";

constexpr const char *near_steep = R"(
// The field at p in d; and, where that is at most `limit`, the true distance |f| / |grad f|, since
// the field was divided by a bound; else d again.
float fathom_near(vec3 p, float h, float limit, out float d) {
    vec3 sum = vec3(0.0);
    for (int i = $ZERO; i < 5$AND_PRESENT; ++i) {
        vec3 e = i == 0 ? vec3(0.0) : fathom_corner(i - 1);
$ASK_NEAR        if (i == 0) {
            d = f;
$KEEP_SPAN            if (!(d <= limit)) return d;
            continue;
        }
        sum += e * f;
    }
    return d / clamp(length(0.75 / h * sum), $LEAST_SLOPE, 1.0);
}
)";

constexpr const char *box = R"(
// Where a ray enters and leaves the box that holds everything.
vec2 fathom_box(vec3 origin, vec3 direction) {
    vec3 safe = mix(direction, vec3(1e-20), lessThan(abs(direction), vec3(1e-20)));
    vec3 a = ($LO - origin) / safe;
    vec3 b = ($HI - origin) / safe;
    vec3 first = min(a, b);
    vec3 last = max(a, b);
    return vec2(max(first.x, max(first.y, first.z)), min(last.x, min(last.y, last.z)));
}
)";

constexpr const char *march = R"(
// Enhanced sphere tracing. The distance of the hit along the ray, or -1.
float fathom_march(vec3 origin, vec3 direction, float begin, float end) {
    float t = begin;
    float before = 0.0;
    float stride = 0.0;
    float d = 0.0;
$REACHED_BEFORE    int steps = 0;
$KEPT_RESUME    for (; steps < $MAX_STEPS && t <= end + fathom_slack; ++steps) {
$FAR_CELLS        vec3 p = origin + t * direction;
        bool last = steps == $MAX_STEPS - 1;
        float reach = fathom_tolerance(t);
        if (last) reach = max(reach, fathom_orthographic != 0 ? fathom_pixel : fathom_pixel * t);
$KEPT_WIDTH        $SAMPLE_MARCH;
$KEPT_STOP        if (!last && stride > before + max(d, 0.0)$NOT_REACHED) {
$NEARER            continue;
        }
        if ($REACHED) {
            fathom_steps = steps + 1;
            return t + d;
        }
        d = max(d, 0.25 * fathom_slack);
        float next = d;
$BENT        if (stride > 0.0)
            next += $RELAXATION * d * max(stride + d - before, 0.0) / max(stride - d + before, $FLATTEST * stride);
        float proved = max(end, t + d);
        next = min(next, proved - t);
        before = d;
$KEEP_REACHED        stride = next;
        t = min(t + next, proved);
    }
    fathom_steps = steps;
    return -1.0;
}
)";

constexpr const char *shadow = R"(
// How much of a light arrives: marched from the light towards the point (thesis, 4.2.1).
float fathom_shadow(vec3 q, vec3 l, float reach, float angle, float margin, float h) {
    float s = reach;
    float before = 0.0;
    float shadow = 1.0;
    for (int i = $ZERO; i < $SHADOW_STEPS && s > margin; ++i) {
$FAR_SHADOW        vec3 p = q + s * l;
$ASK_EXACT        $SAMPLE_SHADOW;
$ASKED_EXACT$KEPT_STOP        float y = before > 0.0 ? 0.5 * near * d / before : 0.0;
        float c = sqrt(max(near * near - y * y, 0.0));
        shadow = min(shadow, c / (angle * (s + y)));
        if (near <= 0.0 || shadow < 0.00390625) return 0.0;
        before = d;
        s -= max(d, 0.25 * fathom_slack);
    }
    return shadow * shadow * (3.0 - 2.0 * shadow);
}
)";

// The gradient's four points and, along the normal that they give, the occlusion's five.
constexpr const char *together = R"(    for (int i = $ZERO; i < $TAPS$AND_PRESENT; ++i) {
        vec3 e = fathom_corner(i);
$SAMPLE_SHADE$CLOSED        g += e * f;
        if (i < 3) continue;
        g *= 0.75 / h;
        slope = length(g);
        if (slope > 0.0) n = g / slope;
    }
)";

// The same in two loops: quicker where two copies of the field cost little.
constexpr const char *gradient_apart = R"(    for (int i = $ZERO; i < 4; ++i) {
        vec3 e = fathom_corner(i);
        g += e * sdf(p + h * e);
    }
    g *= 0.75 / h;
    slope = length(g);
    if (slope > 0.0) n = g / slope;
)";
constexpr const char *occlusion_apart = R"(    for (int i = $ZERO + 4; i < taps; ++i) {
        float x = $OCCLUSION_REACH * float(i - 3)$AND_D;
        weight *= 0.5;
        open -= weight * clamp(1.0 - $NEAR_X / x, 0.0, 1.0);
    }
)";

constexpr const char *shade_head = R"(
vec3 fathom_shade(vec3 origin, vec3 direction, float t) {
    vec3 p = origin + t * direction;
    float h = fathom_arm(t);
    vec3 g = vec3(0.0);
    vec3 n = -direction;
    float slope = 0.0;
$OPEN$SURROUNDINGS)";

// The weights of the occlusion's samples are 1/2, 1/4, …
constexpr const char *shade_open = R"(    fathom_Lighting look = fathom_lighting();
    int taps = look.ambient_occlusion > 0.0 ? $ALL_TAPS : 4;
    float open = 1.0;
    float weight = look.ambient_occlusion / $OCCLUSION_TOTAL;
)";
constexpr const char *sample_plain = R"(        float x = $OCCLUSION_REACH * float(i - 3);
        float f = sdf(p + (i < 4 ? h * e : x * n));
)";
constexpr const char *sample_near = R"(        float x = $OCCLUSION_REACH * float(i - 3), d;
        float f = fathom_near(p + (i < 4 ? h * e : x * n), h, i < 4 ? -1e30 : x, d);
)";
constexpr const char *shade_closed = R"(        if (i >= 4) {
            weight *= 0.5;
            open -= weight * clamp(1.0 - f / x, 0.0, 1.0);
            continue;
        }
)";

constexpr const char *one_hit = R"(    Hit s = fathom_hit(p);
    fathom_paint = s.paint;
$PICK_HIT    fathom_Material m = fathom_material(s, n);
)";

// The normal in the paint's own space.
constexpr const char *two_hits = R"(    Hit s;
    vec3 ahead = vec3(0.0);
    for (int i = $ZERO + 1; i >= 0; --i) {
        s = fathom_hit(p + float(i) * h * n);
        if (i == 1) ahead = s.point;
    }
    fathom_paint = s.paint;
$PICK_HIT    vec3 turned = ahead - s.point;
    float size = length(turned);
    fathom_Material m = fathom_material(s, size > 0.0 ? turned / size : n);
)";

constexpr const char *shade_phong =
    R"(    vec3 color = open * m.diffuse * look.ambient + m.emission;
    float margin = $SHADOW_BIAS * fathom_tolerance(t);
    vec3 q = p + margin * n;
    float angle = max(look.soft_shadows, $LEAST_ANGLE);
$EACH_LIGHT        vec3 way = light.directional ? light.position : light.position - q;
        float away = length(way);
        vec3 l = away > 0.0 ? way / away : n;
        float facing = dot(n, l);
        if (facing <= 0.0) $UNLIT;
        float seen = 1.0;
        if (look.shadow_darkness > 0.0) {
            float reach = light.directional ? $SUN_REACH : away;
            seen -= look.shadow_darkness * (1.0 - fathom_shadow(q, l, reach, angle, margin, h));
        }
        vec3 r = 2.0 * facing * n - l;
        float gleam = max(-dot(r, direction), 0.0);
        gleam = gleam > 0.0 ? look.specular_intensity * pow(gleam, m.exponent) : 0.0;
        color += seen * light.color * (facing * m.diffuse + gleam * m.specular);
    }
    return color;
}
)";

constexpr const char *each_light = R"(    for (int i = $ZERO; i < $LIGHTS; ++i) {
        fathom_Light light = fathom_light(i);
)";
constexpr const char *one_light = R"(    {
        fathom_Light light = fathom_light(0);
)";

constexpr const char *output = R"(
vec3 fathom_encode(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

// Blue for few steps, through green and yellow to red for all that are allowed.
vec3 fathom_heat(int steps) {
    float x = log2(1.0 + float(steps)) / log2(1.0 + float($MAX_STEPS));
    return clamp(vec3(2.0 * x - 0.6, 1.6 - abs(3.2 * x - 1.6), 1.0 - 2.2 * x), 0.0, 1.0);
}

// `place`: in pixels from the top left of the picture.
vec4 fathom_picture(vec2 place) {
$RAY    float t = end < begin ? -1.0 : fathom_march(origin, direction, begin, end);
$PICK_RAY    if (fathom_mode == 1) return vec4(fathom_heat(fathom_steps), 1.0);
    vec3 color = t < 0.0 ? fathom_background(direction) : fathom_shade(origin, direction, t);
    if (fathom_mode == 2) return vec4(float(fathom_steps), t, float(fathom_paint), t < 0.0 ? 0.0 : 1.0);
    return vec4(fathom_mode == 3 ? color : fathom_encode(color), 1.0);
}
)";

// The ray of a place in the picture, and between which distances it can meet anything.
constexpr const char *ray = R"(    fathom_lengths();
    float u = (2.0 * place.x / fathom_resolution.x - 1.0) * fathom_resolution.x / fathom_resolution.y;
    float v = 1.0 - 2.0 * place.y / fathom_resolution.y;
    vec3 aside = fathom_extent * (u * fathom_right + v * fathom_up);
    vec3 origin = fathom_origin;
    vec3 direction = fathom_forward;
    if (fathom_orthographic != 0) origin += aside;
    else direction = normalize(direction + aside);
    float begin = 0.0;
    float end = fathom_far;
$CLIP)";

// What a click, the outline and the colours of steps and slopes are read from (emit.h).
constexpr const char *pick_output = "\nlayout(location = 1) out vec4 fathom_pick;\n";
constexpr const char *pick_ray = "    fathom_pick = vec4(0.0, t, float(fathom_steps), 0.0);\n";
constexpr const char *pick_hit = "    fathom_pick.x = float(fathom_part);\n"
                                 "    fathom_pick.w = slope;\n";

// Where the field says how far it reaches by curvature (look.h).
constexpr const char *span_global =
    "\nfloat fathom_span; // how far the last of the distances reaches\n";
constexpr const char *nearer_by_ball = "            t += before - stride;\n"
                                       "            stride = before;\n";
constexpr const char *nearer_by_reach =
    R"(            float to = reached + $NEARER_PART * min(fathom_span, reached);
            if (!(d > 0.0)) to = min(reached, stride * before / (before - d) - 0.5 * fathom_tolerance(t));
            to = max(before, min(to, stride));
            t += to - stride;
            stride = to;
)";
constexpr const char *bent_step = R"(        float span = max(fathom_span, d);
        if (span > d) {
            next = span;
            if (stride > 0.0) {
                float change = (span * span - reached * reached) / stride;
                next = change < -span ? span * span / -change - 0.5 * fathom_tolerance(t)
                                      : span + $BENT_RELAXATION * (span + change);
                next = max(next, d);
            }
        } else
)";

// Where a kept value is absent the pixel is left to the text that computes all, so that what the
// ray sees is one field (docs/noise-cache.md): its loops end at once.
constexpr const char *kept_width =
    "        fathom_width = fathom_orthographic != 0 ? fathom_pixel : fathom_pixel * t;\n"
    "        fathom_step(t, before, stride, steps);\n";
// What was reached by curvature is not remembered: 0 proves less, and costs a step.
constexpr const char *kept_resume = "    fathom_resume(t, before, stride, steps);\n";
constexpr const char *kept_stop = "        if (fathom_absent) break;\n";

// Through far cells first, all rays together; then the field is asked, once. A step is what asks
// it.
constexpr const char *far_cells =
    R"(        while (t <= end) {
            vec2 clear = fathom_clear(origin + t * direction, direction, fathom_tolerance(t));
            if (!(clear.y > 0.0 && stride <= before + clear.x)) break;
            t += clear.y;
            before = 0.0;
            stride = 0.0;
        }
        if (t > end + fathom_slack) break;
)";
// What is farther than the shadow's edge as it is now changes nothing.
constexpr const char *far_shadow =
    R"(        for (vec2 clear; s > margin; s -= clear.y) {
            clear = fathom_clear(q + s * l, -l, max(shadow * angle * s, margin));
            if (!(clear.y > 0.0)) break;
            before = 0.0;
        }
        if (s <= margin) break;
)";

// Beyond the cells a value that is not exact shades nothing.
constexpr const char *ask_exact =
    R"(        if (fathom_outside(p)) {
            float off = fathom_off(p);
            float edge = max(shadow * angle * s, margin);
            if (off > 2.0 * edge && off < fathom_endless(p)) {
                s -= off - edge;
                before = 0.0;
                continue;
            }
        }
        fathom_exact = true;
)";
constexpr const char *asked_exact = "        fathom_exact = false;\n";

using Values = std::map<std::string, std::string, std::less<>>;

Values values_of(const MarcherOptions &options) {
    namespace look = ir::look;
    const std::string clip = "    vec2 inside = fathom_box(origin, direction);\n"
                             "    begin = max(begin, inside.x);\n"
                             "    end = min(end, inside.y);\n";
    const std::string far = "100.0 * max(" + float_literal(options.radius) +
                            ", length(fathom_origin - " + options.center + "))";
    // A field that reaches is asked in fathom_near alone, so that there is one copy of it.
    const bool steep = options.steep, apart = options.cheap && !options.kept;
    Values values{
        {"SAMPLE_MARCH",
         steep ? "float near = fathom_near(p, fathom_arm(t), reach, d)" : "d = sdf(p)"},
        {"REACHED", std::string(steep ? "near" : "d") + " <= reach"},
        {"SAMPLE_SHADOW", steep ? "float d, near = fathom_near(p, h, shadow * angle * s, d)"
                                : "float d = sdf(p), near = d"},
        {"SUN_REACH", options.boxed ? "max(fathom_box(q, l).y, 0.0)" : "fathom_far"},
        {"RAY", ray},
        {"CLIP", options.boxed ? clip : ""},
        {"FAR", options.far > 0 ? float_literal(options.far) : far},
        {"RADIUS", float_literal(options.radius)},
        {"CENTER", options.center},
        {"LO", options.lo},
        {"HI", options.hi},
        {"EPSILON", float_literal(options.epsilon)},
        {"MAX_STEPS", std::to_string(options.max_steps)},
        {"ZERO", options.zero},
        {"EACH_LIGHT", options.lights == 1 ? one_light : each_light},
        {"UNLIT", options.lights == 1 ? "return color" : "continue"},
        {"LIGHTS", std::to_string(options.lights)},
        {"FLOAT_SLACK", float_literal(look::float_slack)},
        {"NORMAL_SLACK", float_literal(look::normal_slack)},
        {"LEAST_SLOPE", float_literal(look::least_slope)},
        {"RELAXATION", float_literal(look::relaxation)},
        {"FLATTEST", float_literal(look::flattest)},
        {"OPEN", options.skip_shading ? "" : shade_open},
        {"TAPS", options.skip_shading ? "4" : "taps"},
        {"SAMPLE_SHADE", options.skip_shading ? "        float f = sdf(p + h * e);\n"
                         : steep              ? sample_near
                                              : sample_plain},
        {"CLOSED", options.skip_shading ? "" : shade_closed},
        {"SURROUNDINGS",
         apart ? std::string(gradient_apart) + (options.skip_shading ? "" : occlusion_apart)
               : together},
        {"AND_D", steep ? ", d" : ""},
        {"NEAR_X", steep ? "fathom_near(p + x * n, h, x, d)" : "sdf(p + x * n)"},
        {"ALL_TAPS", std::to_string(4 + look::occlusion_samples)},
        {"OCCLUSION_TOTAL", float_literal(1 - std::ldexp(1.0, -look::occlusion_samples))},
        {"OCCLUSION_REACH",
         float_literal(look::occlusion_reach * options.radius / look::occlusion_samples)},
        {"PICK_RAY", options.pick ? pick_ray : ""},
        {"PICK_HIT", options.pick ? pick_hit : ""},
        {"SHADOW_STEPS", std::to_string(look::shadow_steps)},
        {"SHADOW_BIAS", float_literal(look::shadow_bias)},
        {"LEAST_ANGLE", float_literal(look::least_angle)},
    };
    const bool reach = options.reaches;
    values["ASK_CHEAP"] =
        reach ? "    vec2 f = fathom_reach(p);\n    d = f.x;\n    fathom_span = f.y;\n"
              : "    d = sdf(p);\n";
    values["ASK_NEAR"] =
        reach ? "        vec2 both = fathom_reach(p + h * e);\n        float f = both.x;\n"
              : "        float f = sdf(p + h * e);\n";
    values["KEEP_SPAN"] = reach ? "            fathom_span = both.y;\n" : "";
    values["REACHED_BEFORE"] = reach ? "    float reached = 0.0;\n" : "";
    values["NOT_REACHED"] = reach ? " && !(d > 0.0 && stride <= reached + fathom_span)" : "";
    values["NEARER"] = reach ? nearer_by_reach : nearer_by_ball;
    values["NEARER_PART"] = float_literal(look::nearer);
    values["BENT"] = reach ? bent_step : "";
    values["BENT_RELAXATION"] = float_literal(look::bent_relaxation);
    values["KEEP_REACHED"] = reach ? "        reached = span;\n" : "";
    for (const char *part : {"NEARER", "BENT"}) values[part] = fill(values[part], values);
    values["FAR_CELLS"] = options.far_cells ? far_cells : "";
    values["FAR_SHADOW"] = options.far_cells ? far_shadow : "";
    values["ASK_EXACT"] = options.around ? ask_exact : "";
    values["ASKED_EXACT"] = options.around ? asked_exact : "";
    values["KEPT_WIDTH"] = options.kept ? kept_width : "";
    values["KEPT_RESUME"] = options.kept ? kept_resume : "";
    values["KEPT_STOP"] = options.kept ? kept_stop : "";
    values["AND_PRESENT"] = options.kept ? " && !fathom_absent" : "";
    for (const char *part : {"RAY", "OPEN", "SAMPLE_SHADE", "CLOSED", "SURROUNDINGS", "EACH_LIGHT"})
        values[part] = fill(values[part], values);
    return values;
}

std::string march_form(const MarcherOptions &options) {
    std::string text = lengths;
    if (options.reaches) text += span_global;
    if (options.steep)
        text += std::string(corner) + (options.cheap && !options.kept ? near_cheap : near_steep);
    if (options.boxed) text += box;
    return text + march;
}

} // namespace

std::string marcher_text(const MarcherOptions &options) {
    std::string text = march_form(options);
    if (!options.steep) text += corner;
    if (!options.skip_shading) text += shadow;
    text += shade_head;
    text += options.local_normals ? two_hits : one_hit;
    text += options.skip_shading ? "    return m.diffuse + m.emission;\n}\n" : shade_phong;
    text += output;
    return (options.pick ? pick_output : "") + fill(text, values_of(options));
}

std::string march_text(const MarcherOptions &options) {
    return fill(march_form(options), values_of(options));
}

std::string ray_text(const MarcherOptions &options) { return fill(ray, values_of(options)); }

} // namespace fathom::glsl
