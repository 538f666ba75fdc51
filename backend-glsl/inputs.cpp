#include "backend-glsl/inputs.h"

#include "backend-glsl/template.h"

#include <fmt/format.h>

namespace fathom::glsl {

namespace {

// How a target whose host does not set our uniforms holds an input of the frame.
enum class Held { Constant, Global, Nowhere };

struct FrameInput {
    const char *type, *name;
    std::string value;           // for the first view
    std::vector<double> numbers; // the same
    Held held;
    const char *meaning; // with its unit
};

std::vector<double> numbers_of(const glm::dvec3 &v) { return {v.x, v.y, v.z}; }

std::string param_value(const ir::Param &param) {
    return literal({param.type, {param.value[0], param.value[1], param.value[2], param.value[3]}});
}

} // namespace

bool is_fixed(const ir::Param &param, const Options &options) {
    return param.structural && options.instruments == Instruments::None;
}

std::string Inputs::defaults() const {
    return target_.lists_defaults && options_.instruments == Instruments::None
               ? defaults_comment(declared_)
               : "";
}

std::string Inputs::uniform(Input input, const std::string &value, const std::string &range) {
    const std::string declaration = "uniform " + input.type + " " + input.name;
    declared_.push_back({input.type, input.name, value, range});
    if (target_.locations) input.place = location_++;
    uniforms_.push_back(std::move(input));
    if (target_.locations)
        return fmt::format("layout(location = {}) {};\n", location_ - 1, declaration);
    const bool bare = target_.es || options_.instruments != Instruments::None || value.empty();
    return declaration + (bare ? "" : " = " + value) + ";\n";
}

std::string Inputs::sampler(const std::string &type, const std::string &name) {
    const std::string place =
        target_.locations ? fmt::format("layout(binding = {}) ", binding_) : "";
    uniforms_.push_back({type, name, {}, "", target_.locations ? binding_++ : -1});
    return place + "uniform " + type + " " + name + ";\n";
}

std::string Inputs::own_inputs(bool picture) const {
    if (!*target_.inputs) return "";
    return expand(target_.inputs,
                  {{"PICTURE", picture ? "1" : ""}, {"TIME", module_.reads_time ? "1" : ""}});
}

std::string Inputs::time() {
    if (!target_.hosted)
        return module_.reads_time ? std::string("#define fathom_time ") + target_.time + "\n" : "";
    if (!module_.reads_time && options_.field_only) return "";
    return uniform({"float", "fathom_time", {options_.time}, "the time, in seconds"},
                   float_literal(options_.time));
}

std::string Inputs::params() {
    std::string text, constants;
    for (const auto &[index, name] : module_.params) {
        const ir::Param &param = scene_.params[index];
        const std::string value = param_value(param), type = glsl_type(param.type),
                          constant = "const " + type + " " + name + " = " + value + ";";
        if (!target_.hosted && !is_fixed(param, options_)) {
            std::string words = range_text(param);
            if (!param.label.empty() && param.label != param.name)
                words += (words.empty() ? "" : "  ") + param.label;
            constants += words.empty() ? constant + "\n" : constant + " " + comment(words);
            continue;
        }
        if (!param.label.empty() && options_.instruments == Instruments::None)
            text += comment(param.label);
        if (is_fixed(param, options_))
            text += constant + "\n";
        else
            text +=
                uniform({type,
                         name,
                         {param.value.begin(), param.value.begin() + ir::components(param.type)},
                         ""},
                        value, range_text(param));
    }
    if (constants.empty()) return text;
    return "\n// The params, with their ranges: any other number of the range may stand here.\n" +
           constants + text;
}

std::string Inputs::samplers() {
    std::string text;
    if (!module_.texels.empty())
        text += "// A texture buffer of RGBA32F texels: the file written beside this text.\n" +
                sampler("samplerBuffer", "fathom_tables");
    for (const auto &[index, name] : module_.images) text += sampler("sampler2D", name);
    for (const auto &[index, name] : module_.grids) text += sampler("sampler3D", name);
    return text;
}

// What a reader may change stands first.
std::string Inputs::of_field() {
    std::string text = target_.hosted ? "" : params();
    text += own_inputs(false);
    text += time();
    if (target_.hosted) text += params();
    return text + samplers();
}

std::string Inputs::of_picture(const ir::View &view) {
    const glm::dvec3 sun = scene_.lights.empty()
                               ? ir::lights_of(scene_, options_.time, view)[0].position
                               : glm::dvec3{0, 1, 0};
    const FrameInput all[] = {
        {"vec2",
         "fathom_resolution",
         "vec2(1280.0, 720.0)",
         {1280, 720},
         Held::Global,
         "the picture's size, in pixels"},
        {"vec2",
         "fathom_offset",
         "vec2(0.5)",
         {0.5, 0.5},
         Held::Nowhere,
         "the sample's place in its pixel, 0 to 1"},
        {"vec3", "fathom_origin", vec3_literal(view.origin), numbers_of(view.origin), Held::Global,
         "the eye, in the scene's units"},
        {"vec3", "fathom_right", vec3_literal(view.right), numbers_of(view.right), Held::Global,
         "the view's axis to the right, of length 1"},
        {"vec3", "fathom_up", vec3_literal(view.up), numbers_of(view.up), Held::Global,
         "the view's axis upwards, of length 1"},
        {"vec3", "fathom_forward", vec3_literal(view.forward), numbers_of(view.forward),
         Held::Global, "the direction of view, of length 1"},
        {"float",
         "fathom_extent",
         float_literal(view.extent),
         {view.extent},
         Held::Constant,
         "half the picture's height: at distance 1 from the eye, or in units where orthographic"},
        {"float",
         "fathom_focus",
         float_literal(view.focus),
         {view.focus},
         Held::Constant,
         "the distance of what is looked at, in the scene's units"},
        {"int",
         "fathom_orthographic",
         view.orthographic ? "1" : "0",
         {view.orthographic ? 1.0 : 0.0},
         Held::Constant,
         "1: rays are parallel"},
        {"vec3", "fathom_sun", vec3_literal(sun), numbers_of(sun), Held::Constant,
         "the direction towards the sun of a scene without lights, of length 1"},
        {"int",
         "fathom_mode",
         "0",
         {0},
         Held::Constant,
         "what is drawn: 0 the picture, 1 steps as colours, 2 (steps, t, paint, end), 3 linear "
         "colours"}};
    std::string text = (target_.hosted ? "" : params()) + "\n" + own_inputs(true);
    for (const FrameInput &i : all) {
        if (target_.hosted)
            text += uniform({i.type, i.name, i.numbers, i.meaning}, i.value);
        else if (i.held == Held::Constant)
            text += std::string("const ") + i.type + " " + i.name + " = " + i.value + ";\n";
        else if (i.held == Held::Global)
            text += std::string(i.type) + " " + i.name + ";\n";
    }
    text += time();
    if (target_.hosted) text += params();
    return text + samplers();
}

} // namespace fathom::glsl
