// What a picture's shader reads kept fields by; see cache.h.
#include "backend-glsl/cache_text.h"
#include "backend-glsl/module.h"
#include "backend-glsl/template.h"

namespace fathom::glsl {

namespace {

const char *components_of(ir::Type type) {
    if (type == ir::Type::Vec3) return ".xyz";
    return type == ir::Type::Vec4 ? "" : ".x";
}

} // namespace

std::string cache_look_up(std::span<const KeptText> fields) {
    Values values = cache_numbers();
    values["COUNT"] = std::to_string(fields.size());
    return expand("cache_look_up", values);
}

std::string cache_reader(const KeptText &field, std::size_t number) {
    const bool wide = field.type != ir::Type::Float;
    const std::string type = glsl_type(field.type);
    return "\n" + type + " " + field.function +
           "_kept(vec3 p) {\n#ifdef FATHOM_CACHE\n    vec3 at;\n    if (fathom_kept(p, " +
           float_literal(static_cast<float>(field.cell)) + ", fathom_cache_fields[" +
           std::to_string(number) + "], at)) return textureLod(" +
           (wide ? "fathom_cache_wide" : "fathom_cache_pool") + ", at, 0.0)" +
           components_of(field.type) + ";\n    return " + type +
           "(0.0);\n#else\n#ifdef FATHOM_CACHE_LEARN\n    fathom_ask(p, " +
           float_literal(static_cast<float>(field.cell)) + ", fathom_cache_fields[" +
           std::to_string(number) + "]);\n#endif\n    return " + field.function +
           "(p);\n#endif\n}\n";
}

std::string cache_outputs() { return expand("cache_outputs", cache_numbers()); }

std::string cache_output() { return expand("cache_output", cache_numbers()); }

std::string with_cache(const std::string &text, const char *defined) {
    const std::size_t line = text.find('\n') + 1; // after the version
    return text.substr(0, line) + "#define " + defined + "\n" + text.substr(line);
}

} // namespace fathom::glsl
