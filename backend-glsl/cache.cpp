// What a picture's shader reads cached fields by; see cache.h.
#include "backend-glsl/cache_text.h"
#include "backend-glsl/module.h"
#include "backend-glsl/template.h"

#include <fmt/format.h>

namespace fathom::glsl {

namespace {

const char *components_of(ir::Type type) {
    if (type == ir::Type::Vec3) return ".xyz";
    return type == ir::Type::Vec4 ? "" : ".x";
}

} // namespace

std::string cache_look_up(std::span<const CachedText> fields) {
    Values values = cache_numbers();
    values["COUNT"] = fmt::to_string(fields.size());
    return expand("cache_look_up", values);
}

std::string cache_reader(const CachedText &field, std::size_t number) {
    return expand("cache_reader", {{"TYPE", glsl_type(field.type)},
                                   {"READER", field.function + "_cached"},
                                   {"FUNCTION", field.function},
                                   {"CELL", float_literal(field.cell)},
                                   {"NUMBER", fmt::to_string(number)},
                                   {"POOL", field.type == ir::Type::Float ? "fathom_cache_pool"
                                                                          : "fathom_cache_wide"},
                                   {"PART", components_of(field.type)}});
}

std::string with_cache(const std::string &text, const char *defined) {
    const std::size_t line = text.find('\n') + 1; // after the version
    return text.substr(0, line) + "#define " + defined + "\n" + text.substr(line);
}

} // namespace fathom::glsl
