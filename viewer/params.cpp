#include "viewer/params.h"

#include "base/text.h"

#include <algorithm>
#include <cmath>

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

std::string value_text(const ir::Param &param) {
    if (param.type == ir::Type::Bool) return param.value[0] != 0 ? "true" : "false";
    auto number = [&](std::size_t i) {
        double value = param.is_color ? srgb_of_linear(param.value[i]) : param.value[i];
        return format_shortest(static_cast<float>(value));
    };
    if (count_of(param) == 1)
        return param.type == ir::Type::Int ? format_shortest(param.value[0]) : number(0);
    std::string text = param.is_color ? "rgb(" : "[";
    for (std::size_t i = 0; i < count_of(param); ++i) text += (i ? ", " : "") + number(i);
    return text + (param.is_color ? ")" : "]");
}

// IEC 61966-2-1.
double srgb_of_linear(double value) {
    return value <= 0.0031308 ? 12.92 * value : 1.055 * std::pow(value, 1 / 2.4) - 0.055;
}
double linear_of_srgb(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

} // namespace fathom::viewer
