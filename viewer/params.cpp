#include "viewer/params.h"
#include "base/srgb.h"

#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace fathom::viewer {
namespace {

std::size_t count_of(const ir::Param &param) {
    return static_cast<std::size_t>(ir::components(param.type));
}

bool in_range(const ir::Param &param, const std::array<double, 4> &value) {
    if (!param.has_range) return true;
    for (std::size_t i = 0; i < count_of(param); ++i)
        if (value[i] < param.lo[i] || value[i] > param.hi[i]) return false;
    return true;
}

bool in_gamut(const ir::Param &color) { // else eight bits a channel cannot hold it
    return std::all_of(color.value.begin(), color.value.begin() + 3,
                       [](double channel) { return channel >= 0 && channel <= 1; });
}

std::string hex_text(const ir::Param &color) {
    std::string text = "#";
    for (std::size_t i = 0; i < 3; ++i)
        text += fmt::format("{:02x}", std::lround(srgb_of_linear(color.value[i]) * 255));
    return text;
}

// The fewest digits that give the same float again, so that 30deg is not 30.0000008deg.
std::string angle_text(double value, const std::string &unit) {
    const auto wanted = static_cast<float>(value);
    if (unit.empty() || value == 0) return format_shortest(wanted);
    const double of_one = unit == "deg" ? std::numbers::pi / 180 : 2 * std::numbers::pi;
    for (int digits = 1; digits < 10; ++digits) {
        const std::string text = fmt::format("{:.{}g}", wanted / of_one, digits);
        const double again = parse_number(text).value_or(0) * of_one;
        if (static_cast<float>(again) == wanted && text.find('e') == text.npos) return text + unit;
    }
    return format_shortest(wanted);
}

} // namespace

bool changed(const ir::Param &param) {
    return !std::equal(param.value.begin(),
                       param.value.begin() + static_cast<std::ptrdiff_t>(count_of(param)),
                       param.initial.begin());
}

void carry_over(const std::vector<ir::Param> &before, std::vector<ir::Param> &fresh) {
    for (ir::Param &param : fresh)
        for (const ir::Param &old : before)
            if (old.name == param.name && old.type == param.type &&
                old.is_color == param.is_color && old.initial == param.initial && changed(old) &&
                in_range(param, old.value))
                param.value = old.value;
}

bool drop_outdated(const std::vector<ir::Param> &before, const std::vector<ir::Param> &fresh,
                   std::vector<driver::Override> &values) {
    return std::erase_if(values, [&](const driver::Override &value) {
               auto named = [&](const ir::Param &param) { return param.name == value.name; };
               auto old = std::find_if(before.begin(), before.end(), named);
               auto now = std::find_if(fresh.begin(), fresh.end(), named);
               return old != before.end() && now != fresh.end() && old->initial != now->initial;
           }) > 0;
}

std::vector<driver::Override> structural_values(const std::vector<ir::Param> &params) {
    std::vector<driver::Override> values;
    for (const ir::Param &param : params)
        if (param.structural && changed(param)) values.push_back({param.name, value_text(param)});
    return values;
}

std::string value_text(const ir::Param &param, const driver::Notation &notation) {
    if (param.type == ir::Type::Bool) return param.value[0] != 0 ? "true" : "false";
    if (param.type == ir::Type::Int) return format_shortest(param.value[0]);
    if (param.is_color && notation.hex && in_gamut(param)) return hex_text(param);
    auto number = [&](std::size_t i) {
        if (param.is_color)
            return format_shortest(static_cast<float>(srgb_of_linear(param.value[i])));
        return angle_text(param.value[i], notation.unit);
    };
    if (count_of(param) == 1) return number(0);
    std::string text = param.is_color ? "rgb(" : "[";
    for (std::size_t i = 0; i < count_of(param); ++i) text += (i ? ", " : "") + number(i);
    return text + (param.is_color ? ")" : "]");
}

} // namespace fathom::viewer
