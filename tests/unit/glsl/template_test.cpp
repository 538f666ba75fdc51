// Every template on its own: filled with harmless values, in a frame of what it needs around it, it
// is a shader that glslang takes, whatever flags are set.
#include "backend-glsl/targets.h"
#include "backend-glsl/template.h"
#include "backend-glsl/validate.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <random>
#include <set>

using namespace fathom;
using glsl::Stage;
using glsl::Values;

namespace {

const std::vector<std::string> flags{
    "BOXED",        "UNIT_SLOPE",   "MANY_SLOPES",   "EXACT",
    "SHADED_APART", "PASSES",       "COUNTED",       "HAS_SAFE_RADIUS",
    "APART",        "SKIP_SHADING", "LOCAL_NORMALS", "PICK",
    "CACHED",       "FAR_CELLS",    "AROUND",        "ONE_LIGHT",
    "BLENDED",      "PICTURE",      "FIELD_ONLY",    "TIME",
    "ES",           "LOCATIONS",    "MARKED",        "OWN",
    "UNPAINTED",    "PAINTED",      "LIT",           "CLASSIC",
    "SOFT",         "FOUR_OUTPUTS", "ESTIMATED",     "FILMS"};

constexpr const char *numbers[] = {"FAR",
                                   "EPSILON",
                                   "USUAL_EXTENT",
                                   "FLOAT_SLACK",
                                   "NORMAL_SLACK",
                                   "FLAT_FROM",
                                   "MIN_SLOPE",
                                   "FAINT",
                                   "BESIDE_ARMS",
                                   "BESIDE_REACH",
                                   "RELAXATION",
                                   "FLATTEST",
                                   "NEARER_PART",
                                   "BENT_RELAXATION",
                                   "JUMP",
                                   "GRAZE",
                                   "REFINED",
                                   "CALM",
                                   "CREASE",
                                   "DARK",
                                   "DARKEST",
                                   "DARK_LIGHT",
                                   "WIDEST",
                                   "PROBE",
                                   "PROBE_DEPTH",
                                   "ACROSS",
                                   "FILM_NEAR",
                                   "FILM_LOOK",
                                   "FILM_TURN",
                                   "FILM_FLAT",
                                   "NEAR_ENOUGH",
                                   "DESCENT_APART",
                                   "DESCENT_REACH",
                                   "DESCENT_SLOW",
                                   "DESCENT_FASTEST",
                                   "DESCENT_ACROSS",
                                   "DESCENT_LEAST",
                                   "FILM_LOWER",
                                   "CIRCLE_TURN",
                                   "CIRCLE_NARROWER",
                                   "CIRCLE_ACROSS",
                                   "OCCLUSION_FINE",
                                   "BEHIND",
                                   "LIFT",
                                   "KINKED",
                                   "SHARE",
                                   "CLOSED_FROM",
                                   "MARKS",
                                   "SHADOW_ARM",
                                   "NEARLY",
                                   "FINE",
                                   "LEAST_SHARE",
                                   "STEADY",
                                   "UNSEEN",
                                   "OCCLUSION_TOTAL",
                                   "OCCLUSION_SAMPLES",
                                   "OCCLUSION_REACH",
                                   "SHOULDER",
                                   "FADE_FROM",
                                   "ARM",
                                   "SHADOW_BIAS",
                                   "MIN_ANGLE",
                                   "MIN_WAY",
                                   "FAR_FROM",
                                   "RADIUS",
                                   "SLOPE",
                                   "BOUND",
                                   "AROUND",
                                   "ABOVE",
                                   "CELL"};

// What a flag decides beside its own `$if`, as the emitter has it.
void add_counts(Values &values) {
    for (const char *count : {"LIGHTS",         "MAX_STEPS",
                              "OCCLUSION_TAPS", "BESIDE_LOOKS",
                              "SURFACE_TAPS",   "REFINEMENTS",
                              "DEEP",           "NEARING",
                              "MANY_STEPS",     "DESCENT_STEPS",
                              "DESCENT_PLAIN",  "MOST_SLIDES",
                              "CHECK_STEPS",    "AGES",
                              "ROWS",           "COUNT",
                              "WISHES",         "SAMPLED",
                              "HIGHEST",        "HIGH_BITS",
                              "HIGH_MASK",      "PLACE_BITS",
                              "FILM_STEPS",     "FILM_LOOKS",
                              "FILM_STALLS",    "OCCLUSION_SLIDES",
                              "CIRCLES",        "CIRCLE_LOOKS",
                              "CIRCLES_LOOKS",  "CIRCLE_HALVINGS",
                              "HEAD",           "TAIL",
                              "LIMIT",          "INSERTED",
                              "EVICTED",        "DELETED",
                              "CROWDED",        "FULL",
                              "SWEPT",          "CHANGED",
                              "PAID",           "WASTED",
                              "LEFT",           "STEPS",
                              "MANY",           "REFUSED",
                              "STRIDE",         "LAST"})
        values.emplace(count, "2");
}

Values values_with(std::string_view name, const std::set<std::string> &on) {
    const auto is = [&](const char *flag) { return on.contains(flag); };
    Values values{
        {"SHADED", is("SHADED_APART") ? "fathom_shaded" : "sdf"},
        {"FOUR_OUTPUTS",
         is("FOUR_OUTPUTS") && name == "march" ? "1" : ""}, // others stand beside a pick
        {"AND_PRESENT", is("CACHED") ? " && !fathom_absent" : ""},
        {"UNLIT", is("ONE_LIGHT") ? "return color" : "continue"},
        {"SUN_REACH", is("BOXED") ? "max(fathom_box(q, l).y, 0.0)" : "fathom_far"},
        {"OUTSIDE", "fathom_off(p)"},
        {"VALUES", "    if (which == 0) return vec4(p.x);\n"},
        {"SHIFTS", "ivec3(0), ivec3(1)"},
        {"FIELD_SHIFT", "ivec3(5)"},
        {"CELLS", "float[2](1.0, 1.0)"},
        {"SLOPES", "float[2](1.0, 1.0)"},
        {"WIDE", "bool[2](true, false)"},
        {"SDF", "sdf"},
        {"VALUE", "value"},
        {"START", "start"},
        {"JOINED", "joined"},
        {"BLEND_RADIUS", "radius"},
        {"ZERO", "fathom_zero"},
        {"VERSION", "450"},
        {"WRITTEN_BY", "// a scene\n"},
        {"PROOF", "proved"},
        {"USE", "what to do"},
        {"FIXED_PARAMS", ""},
        {"BEGIN", "#version 450\n"},
        {"INPUTS", "const float one = 1.0;\n"},
        {"FUNCTIONS", "struct Hit { float distance; };\n"
                      "struct fathom_Material { vec3 diffuse; };\n"
                      "float sdf(vec3 p) { return one; }\n"},
        {"SHADING",
         "fathom_Material fathom_material(Hit s, vec3 n) { return fathom_Material(n); }\n"},
        {"STATEMENTS", "    float x = 1.0;\n"},
        {"LIST", "vec3(1.0), 1.0, x, 0.0, 0.0, 0.0, 1.0"},
        {"CASES", "    return fathom_Light(false, vec3(i), vec3(1.0));\n"},
        {"VARYING",
         "fathom_Material varying_one(vec3 p) { return fathom_Material(p, p, 1.0, p); }\n"},
        {"CHOICES", "    return varying_one(vec3(paint));\n"},
        {"TYPE", "float"},
        {"READER", "read"},
        {"FUNCTION", "sdf"},
        {"POOL", "fathom_cache_pool"},
        {"PART", ".x"},
        {"TEXT", ""},
        {"NO_ESTIMATE", ""},
        {"CROSSED", "< 0.0"},
        {"NUMBER", "1"},
    };
    values["HIT"] =
        name == "field" ? "Hit fathom_hit(vec3 p) { return Hit(1.0); }\n" : "fathom_hit";
    for (const char *vector :
         {"LO", "HI", "ORIGIN", "RIGHT", "UP", "FORWARD", "TARGET", "COLOR", "SOIL", "SKY"})
        values.emplace(vector, "vec3(1.0)");
    for (const char *number : numbers) values.emplace(number, "0.5");
    add_counts(values);
    for (const char *word : {"EMPTY", "NOWHERE", "PLACES"}) values.emplace(word, "7u");
    for (const std::string &flag : flags) values.emplace(flag, is(flag.c_str()) ? "1" : "");
    return values;
}

// What stands before and after a template to make a shader of it.
struct Frame {
    std::string before, after;
    Stage stage = Stage::Fragment;
};

const std::string version = "#version 450\n";
const std::string end = "void main() {}\n";
const std::string inputs = R"(
layout(location = 0) out vec4 out_color;
uniform vec2 fathom_resolution, fathom_offset;
uniform vec3 fathom_origin, fathom_right, fathom_up, fathom_forward;
uniform float fathom_extent, fathom_focus;
uniform int fathom_orthographic, fathom_mode, fathom_zero;
struct Hit { float distance; int paint; vec3 point; vec4 extra; };
struct fathom_Material { vec3 diffuse, specular, emission; float exponent; };
struct fathom_Lighting { vec3 ambient; float ambient_occlusion, soft_shadows, shadow_darkness, specular_intensity, fill, occlusion_reach; };
struct fathom_Light { bool directional; vec3 position, color; };
float sdf(vec3 p) { return length(p) - 1.0; }
float fathom_shaded(vec3 p) { return 2.0 * sdf(p); }
vec2 fathom_safe_radius(vec3 p) { return vec2(sdf(p)); }
Hit fathom_hit(vec3 p) { return Hit(sdf(p), 0, p, vec4(0.0)); }
fathom_Material fathom_material(Hit s, vec3 n) { return fathom_Material(n, n, n, 1.0); }
fathom_Lighting fathom_lighting() { return fathom_Lighting(vec3(0.0), 0.0, 0.0, 0.0, 0.0, 0.0, 1.0); }
fathom_Light fathom_light(int i) { return fathom_Light(true, vec3(1.0), vec3(1.0)); }
vec3 fathom_background(vec3 d) { return d; }
int fathom_part = 0;
)";
const std::string cells = R"(
bool fathom_exact;
vec2 fathom_clear(vec3 p, vec3 d, float margin) { return vec2(0.0); }
bool fathom_outside(vec3 p) { return false; }
float fathom_off(vec3 p) { return 0.0; }
float fathom_endless(vec3 p) { return 1.0; }
)";
const std::string cache = R"(
bool fathom_absent = false;
float fathom_width;
void fathom_step(float t, float before, float stride, int steps) {}
void fathom_resume(inout float t, inout float before, inout float stride, inout int steps) {}
)";
const std::string pick = "layout(location = 1) out vec4 fathom_pick;\n";
const std::string grid = R"(
uniform vec3 fathom_grid_lo, fathom_grid_size;
uniform int fathom_grid_side;
)";
const std::string scene_alone = R"(
struct Hit { float distance; int paint; vec3 point; vec4 extra; };
float sdf(vec3 p) { return p.x; }
)";
const std::string camera = R"(
vec2 fathom_resolution;
vec3 fathom_origin, fathom_right, fathom_up, fathom_forward;
const float fathom_focus = 1.0;
)";
const std::string drawn = "vec4 fathom_picture(vec2 place) { return place.xyxy; }\n";
// Of a march by passes, what the page's entry reads.
const std::string kept = R"(
uniform bool fathom_resumed;
uniform sampler2D fathom_kept_2;
bool fathom_goes_on = false;
vec4 fathom_keep_2;
vec4 fathom_kept(sampler2D kept) { return texelFetch(kept, ivec2(gl_FragCoord.xy), 0); }
)";
const std::string sampling = R"(
uniform int fathom_cache_bits = 0, fathom_cache_ages = 4;
uniform usampler3D fathom_cache_index;
)";

// A target's own inputs, globals and entry point, in what its host puts around them.
std::string with_entry(const glsl::TargetTraits &target, Values values) {
    std::string text;
    if (*target.inputs) text += glsl::expand(target.inputs, values);
    text += (target.hosted ? inputs.substr(inputs.find("uniform")) : camera) + drawn;
    if (!values.at("CACHED").empty())
        text += glsl::expand("cache_look_up", values) + "int fathom_steps = 0;\n";
    if (target.form == glsl::Form::Page) text += kept;
    text += glsl::expand(target.entry, values);
    if (!*target.host) return version + text;
    values["TEXT"] = text;
    return glsl::expand(target.host, values);
}

// What stands around a template, and needs its neighbours; none for what is a whole shader.
Frame frame_of(std::string_view name, const Values &values) {
    const std::string scene = version + inputs + cells + cache;
    const auto expanded = [&](const char *other) { return glsl::expand(other, values); };
    if (name == "march") return {scene, end};
    if (name == "corner" || name == "encode") return {version, end};
    if (name == "ray") return {scene + expanded("march") + "void ray(vec2 place) {\n", "}\n" + end};
    const std::string marched = scene + pick + expanded("march") + expanded("corner");
    if (name == "march_ahead")
        return {
            scene + expanded("march") +
                "void ahead(float t, float d, float before, float stride, float end, float span, "
                "float reached) {\n    bool aims;\n    float ahead = d, tolerance = 0.1, close = "
                "-1.0;\n",
            "}\n" + end};
    if (name == "shadow_ahead")
        return {marched + "void ahead(vec3 q, vec3 l, float s, bool mark, float shadow, float "
                          "angle, float margin) {\n    while (s > margin) {\n",
                "    }\n}\n" + end};
    if (name == "nearest") return {marched, end};
    const std::string searched = marched + expanded("nearest");
    if (name == "shadow") return {searched, end};
    if (name == "shade") return {searched + expanded("shadow"), end};
    if (name == "picture") return {searched + expanded("shadow") + expanded("shade"), end};
    if (name == "surface_tap")
        return {marched +
                    "void tap(int i, float f, vec3 e, float h) {\n    vec3 g = vec3(0.0), n = "
                    "g;\n    float slope = 0.0, bent = 0.0, own = 1.0, even = 1.0;\n"
                    "    float low = 0.0, high = 0.0, here = 0.0, middle = 0.0;\n"
                    "    bool found = false, behind = false, lifted = false;\n"
                    "    vec2 rise = vec2(0.0), rises = vec2(0.0);\n    vec3 above = e;\n"
                    "    int surface = 4;\n    vec3 direction = e;\n",
                "}\n" + end};
    if (name == "probe")
        return {version + inputs.substr(inputs.find("uniform")) + cells + cache + expanded("march"),
                ""};
    if (name == "prune_rows") return {version, end};
    if (name == "prune_far") return {version + expanded("prune_rows"), end};
    if (name == "prune_around")
        return {version +
                    "struct Hit { float distance; };\n"
                    "float fathom_endless(vec3 p) { return 1.0; }\n"
                    "float fathom_all(vec3 p) { return 1.0; }\n"
                    "Hit fathom_all_hit(vec3 p) { return Hit(1.0); }\n"
                    "Hit fathom_endless_hit(vec3 p) { return Hit(1.0); }\n" +
                    expanded("prune_rows"),
                end};
    if (name == "prune_make_far")
        return {version + grid + "float sdf(vec3 p) { return p.x; }\n", "", Stage::Compute};
    if (name == "prune_kernel")
        return {version + "float value(vec3 p, int row) { return p.x; }\n"
                          "float start(vec3 p) { return p.x; }\n"
                          "float joined(float acc, vec3 p, int row) { return acc; }\n"
                          "float radius(vec3 p) { return 0.0; }\n",
                "", Stage::Compute};
    if (name == "cache_hashing") return {version + sampling, end};
    if (name == "cache_known") return {version + sampling + expanded("cache_hashing"), end};
    if (name == "cache_counts")
        return {version + sampling +
                    "layout(r32ui) writeonly uniform uimage3D fathom_cache_free, "
                    "fathom_cache_changed;\n"
                    "layout(r32ui) coherent uniform uimageBuffer "
                    "fathom_cache_counts;\n" +
                    expanded("cache_hashing"),
                end};
    if (name == "cache_fill") return {version, ""};
    if (name == "cache_look_up" || name == "cache_outputs") return {version, end};
    if (name == "cache_output")
        return {version + "layout(location = 0) out vec4 color;\n" + expanded("cache_look_up") +
                    expanded("cache_outputs") + "int fathom_steps = 0;\nvoid main() {\n",
                "}\n"};
    if (name == "head" || name == "background" || name == "empty" || name == "lighting" ||
        name == "hit_type")
        return {name == "head" ? "" : version, end};
    if (name == "field") return {"", end};
    if (name == "field_main")
        return {version + scene_alone +
                    "struct fathom_Material { vec3 diffuse; };\n"
                    "fathom_Material material(vec3 p, vec3 n) { return fathom_Material(n); }\n",
                ""};
    if (name == "hit")
        return {version + scene_alone +
                    "Hit fathom_marked_hit(vec3 p) { return Hit(1.0, 0, p, vec4(0.0)); }\n",
                end};
    if (name == "lights") return {version + "uniform vec3 fathom_sun;\n", end};
    if (name == "materials") return {version + scene_alone, end};
    if (name == "first_view" || name == "turned_view")
        return {version + camera + "void view(vec3 back) {\n", "}\n" + end};
    if (name == "cache_reader") return {version + scene_alone + expanded("cache_look_up"), end};
    return {}; // a whole shader
}

bool of_target(std::string_view name) {
    return std::ranges::any_of(glsl::all_targets(), [&](glsl::Target target) {
        const glsl::TargetTraits &traits = glsl::traits_of(target);
        return name == traits.inputs || name == traits.entry || name == traits.host;
    });
}

} // namespace

TEST_CASE("a target's own templates are a shader together, whatever flags are set") {
    for (const glsl::Target target : glsl::all_targets())
        for (const std::set<std::string> &on : std::vector<std::set<std::string>>{
                 {}, {"TIME"}, {"LOCATIONS"}, {"LOCATIONS", "CACHED"}, {"LOCATIONS", "PICK"}})
            for (const bool picture : {true, false}) {
                const glsl::TargetTraits &traits = glsl::traits_of(target);
                std::set<std::string> flags_on = on;
                if (picture) flags_on.insert("PICTURE");
                Values values = values_with(traits.entry, flags_on);
                std::string text = version + end;
                if (picture) {
                    text = with_entry(traits, values);
                } else {
                    if (*traits.inputs)
                        text.insert(version.size(), glsl::expand(traits.inputs, values));
                    values["TEXT"] = text.substr(version.size());
                    if (*traits.host) text = glsl::expand(traits.host, values);
                }
                CAPTURE(traits.name, text);
                const auto complaint = glsl::validate(text);
                if (complaint) FAIL(complaint->line << ": " << complaint->message);
            }
}

TEST_CASE("every template is a shader on its own, whatever flags are set") {
    const char *const begins = "#define FATHOM_BEGINS\n";
    std::mt19937 random(1);
    for (const std::string_view name : glsl::template_names()) {
        // none, each alone, each left out, all, and some at random
        std::vector<std::set<std::string>> choices{{}, {flags.begin(), flags.end()}};
        for (const std::string &flag : flags) {
            choices.push_back({flag});
            choices.push_back({flags.begin(), flags.end()});
            choices.back().erase(flag);
        }
        for (int i = 0; i < 40; ++i) {
            choices.emplace_back();
            for (const std::string &flag : flags)
                if (random() % 2) choices.back().insert(flag);
        }
        std::set<std::string> tried;
        for (std::set<std::string> &on : choices) {
            if (on.contains("CACHED")) on.insert("LOCATIONS"); // there are several outputs
            const Values values = values_with(name, on);
            for (const char *defined :
                 {"", "#define FATHOM_CACHE\n", "#define FATHOM_CACHE_LEARN\n", begins}) {
                if (*defined && !name.starts_with(defined == begins ? "march" : "cache_")) continue;
                if (of_target(name)) continue; // below
                const Frame frame = frame_of(name, values);
                std::string text = frame.before + glsl::expand(name, values) + frame.after;
                text.insert(text.find("#version") == 0 ? text.find('\n') + 1 : 0, defined);
                if (!tried.insert(text).second) continue;
                CAPTURE(name, text);
                const auto complaint = glsl::validate(text, frame.stage);
                if (complaint) FAIL(complaint->line << ": " << complaint->message);
            }
        }
        CHECK(tried.empty() == of_target(name));
    }
}
