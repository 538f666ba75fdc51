#include "backend-glsl/small_tables.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace fathom::glsl {

namespace {

constexpr std::string_view desktop_head = "#version 330 core\n";

// The functions of 3.30 that texts of ours use and 1.30 lacks, with bodies that do something else:
// nothing is run. What they would be in constant expressions they are not, which is refused.
constexpr std::string_view small_head = R"(#version 130
#extension GL_ARB_explicit_attrib_location : require
int floatBitsToInt(float x) { return 0; }
ivec2 floatBitsToInt(vec2 x) { return ivec2(0); }
ivec3 floatBitsToInt(vec3 x) { return ivec3(0); }
ivec4 floatBitsToInt(vec4 x) { return ivec4(0); }
uint floatBitsToUint(float x) { return 0u; }
uvec2 floatBitsToUint(vec2 x) { return uvec2(0u); }
uvec3 floatBitsToUint(vec3 x) { return uvec3(0u); }
uvec4 floatBitsToUint(vec4 x) { return uvec4(0u); }
float intBitsToFloat(int x) { return 0.0; }
vec2 intBitsToFloat(ivec2 x) { return vec2(0.0); }
vec3 intBitsToFloat(ivec3 x) { return vec3(0.0); }
vec4 intBitsToFloat(ivec4 x) { return vec4(0.0); }
float uintBitsToFloat(uint x) { return 0.0; }
vec2 uintBitsToFloat(uvec2 x) { return vec2(0.0); }
vec3 uintBitsToFloat(uvec3 x) { return vec3(0.0); }
vec4 uintBitsToFloat(uvec4 x) { return vec4(0.0); }
mat2 inverse(mat2 m) { return m; }
mat3 inverse(mat3 m) { return m; }
mat4 inverse(mat4 m) { return m; }
float determinant(mat2 m) { return 0.0; }
float determinant(mat3 m) { return 0.0; }
float determinant(mat4 m) { return 0.0; }
)";

template <std::size_t n>
bool begins_with_any(std::string_view word, const std::array<std::string_view, n> &starts) {
    return std::ranges::any_of(starts, [&](auto start) { return word.starts_with(start); });
}

// What 1.30 knows and 3.30 does not, words that 3.30 alone reserves, and what tells them apart.
bool tells_apart(std::string_view word) {
    constexpr auto in_both = std::to_array<std::string_view>(
        {"gl_FragCoord", "gl_FragDepth", "gl_FrontFacing", "gl_PointCoord"});
    constexpr auto words = std::to_array<std::string_view>(
        {"attribute", "extension", "ftransform", "invariant", "patch", "varying", "version"});
    constexpr auto starts = std::to_array<std::string_view>(
        {"GL_", "texture1D", "texture2D", "texture3D", "textureCube", "shadow1D", "shadow2D"});
    constexpr auto samplers = std::to_array<std::string_view>({"Buffer", "2DRect", "2DMS"});
    if (word.starts_with("gl_")) return std::ranges::find(in_both, word) == in_both.end();
    if (std::ranges::find(words, word) != words.end() || begins_with_any(word, starts) ||
        word.find("__") != word.npos)
        return true;
    const std::size_t sampler = word.find("sampler"); // samplerBuffer, isampler2DRect, sampler2DMS
    return sampler <= 1 && begins_with_any(word.substr(sampler + 7), samplers);
}

bool is_letter(char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; }
bool in_word(char c) { return is_letter(c) || (c >= '0' && c <= '9'); }

} // namespace

std::optional<std::string> for_small_tables(const std::string &text) {
    if (!text.starts_with(desktop_head)) return std::nullopt;
    const std::string_view rest = std::string_view(text).substr(desktop_head.size());
    for (std::size_t i = 0; i < rest.size();) {
        std::size_t end = i + 1;
        if (!is_letter(rest[i])) { // of a number the letters, too, which are none of those words
            i = end;
            continue;
        }
        while (end < rest.size() && in_word(rest[end])) ++end;
        if (tells_apart(rest.substr(i, end - i))) return std::nullopt;
        i = end;
    }
    std::string result(small_head);
    result += rest;
    return result;
}

} // namespace fathom::glsl
