// The fixed words of the language, for programs that colour texts: what the reader of words itself
// goes by. The library's names are not among them (typecheck/check.h).
#pragma once

#include <string_view>
#include <vector>

namespace fathom::lang {

struct Vocabulary {
    std::vector<std::string_view> keywords;          // "and", …: never a name
    std::vector<std::string_view> keywords_in_place; // "as", "limit": names elsewhere
    std::vector<std::string_view> types;             // "float", …; the library's own left out
    std::vector<std::string_view> units;             // "deg", …: behind a number
    std::vector<std::string_view> signs;             // "=>", …; no sign before one that begins it
};
Vocabulary vocabulary();

// What a type of another language is called here, as `vec3` for HLSL's `float3`; else as it is.
std::string_view our_type(std::string_view type); // foreign/answers.cpp
// Whether shaders call the distance of all they draw so: `map`, `sceneSDF`, `GetDist`.
bool names_a_scene(std::string_view name); // foreign/fields.cpp

} // namespace fathom::lang
