#include "backend-glsl/reflection.h"

#include "backend-glsl/module.h"
#include "base/encode.h"
#include "base/text.h"

#include <fmt/format.h>

namespace fathom::glsl {
namespace {

template <class Numbers> std::string list(const Numbers &numbers, std::size_t count) {
    std::string text;
    for (std::size_t i = 0; i < count; ++i) text += (i ? ", " : "") + format_shortest(numbers[i]);
    return "[" + text + "]";
}

std::size_t components_of(const ir::Param &param) {
    return static_cast<std::size_t>(ir::components(param.type));
}

std::string param_json(const ir::Param &param) {
    std::string text = fmt::format(", \"param\": {}, \"label\": {}, \"color\": {}",
                                   for_json(param.name), for_json(param.label), param.is_color);
    if (!param.unit.empty()) text += fmt::format(", \"unit\": {}", for_json(param.unit));
    if (param.has_range)
        text += fmt::format(", \"range\": [{}, {}]", list(param.lo, components_of(param)),
                            list(param.hi, components_of(param)));
    return text;
}

std::string texture_json(const char *format, int width, int height, int depth) {
    return fmt::format(", \"format\": \"{}\", \"size\": [{}, {}, {}]", format, width, height,
                       depth);
}

std::string input_json(const ir::Scene &scene, const Output &output, const Input &input) {
    std::string text =
        fmt::format("{{\"name\": {}, \"type\": {}", for_json(input.name), for_json(input.type));
    if (input.place >= 0)
        text +=
            fmt::format(", \"{}\": {}", input.value.empty() ? "binding" : "location", input.place);
    if (!input.value.empty())
        text += fmt::format(", \"default\": {}", list(input.value, input.value.size()));
    if (!input.meaning.empty()) text += fmt::format(", \"meaning\": {}", for_json(input.meaning));
    for (const Uniform &uniform : output.uniforms)
        if (uniform.name == input.name) text += param_json(scene.params[uniform.param]);
    for (const Sampler &sampler : output.images)
        if (const ir::ImageData &image = scene.images[sampler.index]; sampler.name == input.name)
            text += texture_json("RGBA32F", image.width, image.height, 1);
    for (const Sampler &sampler : output.grids)
        if (const ir::GridData &grid = scene.grids[sampler.index]; sampler.name == input.name)
            text += texture_json("R32F", grid.size[0], grid.size[1], grid.size[2]);
    if (input.type == "samplerBuffer")
        text += fmt::format(", \"format\": \"RGBA32F\", \"texels\": {}", output.tables.size() / 4);
    return text + "}";
}

// One item a line.
std::string lines(const std::vector<std::string> &items) {
    if (items.empty()) return "[]";
    return fmt::format("[\n    {}\n  ]", fmt::join(items, ",\n    "));
}

} // namespace

std::string reflection_json(const ir::Scene &scene, const Options &options, const Output &output) {
    const TargetTraits &target = traits_of(options.target);
    std::vector<std::string> uniforms, constants;
    for (const Input &input : output.inputs) uniforms.push_back(input_json(scene, output, input));
    for (const ir::Param &param : scene.params)
        if (param.structural || !target.hosted)
            constants.push_back(fmt::format("{{\"value\": {}, \"type\": \"{}\"{}}}",
                                            list(param.value, components_of(param)),
                                            glsl_type(param.type), param_json(param)));
    return fmt::format(
        "{{\n  \"version\": 1,\n  \"target\": {},\n  \"entry\": {},\n"
        "  \"reads_time\": {},\n  \"time_end\": {},\n  \"uniforms\": {},\n"
        "  \"constants\": {}\n}}\n",
        for_json(target.name),
        for_json(options.field_only && target.form == Form::Text ? "sdf" : target.main),
        output.reads_time, format_shortest(scene.render.time_end), lines(uniforms),
        lines(constants));
}

} // namespace fathom::glsl
