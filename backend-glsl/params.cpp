#include "backend-glsl/params.h"

#include "backend-glsl/html.h"
#include "base/text.h"

#include <algorithm>
#include <array>

namespace fathom::glsl {
namespace {

std::string tuple_text(const ir::Param &param, const std::array<double, 4> &numbers) {
    if (param.type == ir::Type::Bool) return numbers[0] != 0 ? "true" : "false";
    const auto size = static_cast<std::size_t>(ir::components(param.type));
    if (size == 1) return format_shortest(numbers[0]);
    std::string text = "[";
    for (std::size_t i = 0; i < size; ++i) text += (i ? ", " : "") + format_shortest(numbers[i]);
    return text + "]";
}

std::string padded(std::string text, std::size_t width) {
    text.resize(std::max(width, text.size()), ' ');
    return text + "  ";
}

} // namespace

std::string value_text(const ir::Param &param) { return tuple_text(param, param.value); }

std::string range_text(const ir::Param &param) {
    return param.has_range ? tuple_text(param, param.lo) + ".." + tuple_text(param, param.hi) : "";
}

std::string fixed_params_comment(const ir::Scene &scene,
                                 const std::function<std::string(Span)> &place) {
    std::string text;
    for (const ir::Param &param : scene.params) {
        if (!param.structural) continue;
        text += "//   " + param.name + " = " + value_text(param);
        if (param.has_range) text += " in " + range_text(param);
        const std::string where = place ? place(param.origin) : "";
        text += (where.empty() ? "" : "  (" + where + ")") + "\n";
    }
    if (text.empty()) return "";
    return "// Constants here, since they decide what there is; for other values compile the scene "
           "again,\n// with -D NAME=VALUE:\n" +
           text;
}

std::string defaults_comment(const std::vector<Default> &defaults) {
    if (defaults.empty()) return "";
    Default widths{"type", "name", "default", "range"};
    const auto widen = [](std::string &widest, const std::string &text) {
        if (text.size() > widest.size()) widest = text;
    };
    for (const Default &d : defaults)
        widen(widths.name, d.name), widen(widths.type, d.type), widen(widths.value, d.value);
    const auto line = [&](const Default &d) {
        std::string text = "//   " + padded(d.name, widths.name.size()) +
                           padded(d.type, widths.type.size()) +
                           padded(d.value, widths.value.size()) + d.range;
        text.erase(text.find_last_not_of(' ') + 1);
        return text + "\n";
    };
    std::string text = "// Uniforms have no defaults in GLSL ES. With these a host shows the "
                       "scene's first view:\n" +
                       line({"type", "name", "default", "range"});
    for (const Default &d : defaults) text += line(d);
    return text;
}

void note_fixed_params(const ir::Scene &scene, const Options &options, Diagnostics &diagnostics) {
    const TargetTraits &target = traits_of(options.target);
    std::map<std::string, double> chosen; // by the page's reader
    if (target.form == Form::Page && options.rebuild) chosen = page_values(scene).front();
    for (const ir::Param &param : scene.params) {
        if (!param.structural || chosen.contains(param.name)) continue;
        diagnostics
            .add(Code::FixedParam, param.origin,
                 "each value of `" + param.name + "` is a scene of its own, so the `" +
                     target.name + "` text holds it as a constant, " + value_text(param))
            .help("`-D " + param.name + "=…` writes the text for another value" +
                  (param.has_range ? " of " + range_text(param) : ""));
    }
}

} // namespace fathom::glsl
