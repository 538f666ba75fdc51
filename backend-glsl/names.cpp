#include "backend-glsl/names.h"

#include "backend-glsl/targets.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom::glsl {

namespace {

// Sorted. Keywords, words reserved for later, types and built-in functions of both dialects
// (GLSL 4.50, 3.6 and 8; GLSL ES 3.00, 3.8 and 8).
// clang-format off
constexpr auto reserved = std::to_array<std::string_view>({
    "Hit", "abs", "acos", "acosh", "active", "all", "any", "asin", "asinh", "asm", "atan", "atanh", "atomicAdd",
    "atomicAnd", "atomicCompSwap", "atomicCounter", "atomicExchange", "atomicMax", "atomicMin", "atomicOr",
    "atomicXor", "atomic_uint", "attribute", "barrier", "bitCount", "bitfieldExtract", "bitfieldInsert",
    "bitfieldReverse", "bool", "break", "buffer", "bvec2", "bvec3", "bvec4", "case", "cast", "ceil", "centroid",
    "clamp", "class", "coherent", "common", "const", "continue", "cos", "cosh", "cross", "dFdx", "dFdxCoarse",
    "dFdxFine", "dFdy", "dFdyCoarse", "dFdyFine", "default", "defined", "degrees", "determinant", "discard",
    "distance", "dmat2", "dmat3", "dmat4", "do", "dot", "double", "dvec2", "dvec3", "dvec4", "else", "enum", "equal",
    "exp", "exp2", "extern", "external", "faceforward", "false", "filter", "findLSB", "findMSB", "fixed", "flat",
    "float", "floatBitsToInt", "floatBitsToUint", "floor", "fma", "for", "fract", "frexp", "ftransform", "fvec2",
    "fvec3", "fvec4", "fwidth", "fwidthCoarse", "fwidthFine", "goto", "greaterThan", "greaterThanEqual",
    "groupMemoryBarrier", "half", "highp", "hvec2", "hvec3", "hvec4", "if", "image1D", "image1DArray", "image2D",
    "image2DArray", "image2DMS", "image2DMSArray", "image2DRect", "image3D", "imageAtomicAdd", "imageAtomicAnd",
    "imageAtomicCompSwap", "imageAtomicExchange", "imageAtomicMax", "imageAtomicMin", "imageAtomicOr",
    "imageAtomicXor", "imageBuffer", "imageCube", "imageCubeArray", "imageLoad", "imageSamples", "imageSize",
    "imageStore", "imulExtended", "in", "inline", "inout", "input", "int", "intBitsToFloat", "interface",
    "interpolateAtCentroid", "interpolateAtOffset", "interpolateAtSample", "invariant", "inverse", "inversesqrt",
    "isampler1D", "isampler2D", "isampler2DArray", "isampler3D", "isamplerBuffer", "isamplerCube", "isinf", "isnan",
    "ivec2", "ivec3", "ivec4", "layout", "ldexp", "length", "lessThan", "lessThanEqual", "log", "log2", "long", "lowp",
    "main", "mat2", "mat2x2", "mat2x3", "mat2x4", "mat3", "mat3x2", "mat3x3", "mat3x4", "mat4", "mat4x2", "mat4x3",
    "mat4x4", "matrixCompMult", "max", "mediump", "memoryBarrier", "memoryBarrierAtomicCounter", "memoryBarrierBuffer",
    "memoryBarrierImage", "memoryBarrierShared", "min", "mix", "mod", "modf", "namespace", "noinline", "noise1",
    "noise2", "noise3", "noise4", "noperspective", "normalize", "not", "notEqual", "out", "outerProduct", "output",
    "packDouble2x32", "packHalf2x16", "packSnorm2x16", "packSnorm4x8", "packUnorm2x16", "packUnorm4x8", "partition",
    "patch", "pow", "precise", "precision", "public", "radians", "readonly", "reflect", "refract", "resource",
    "restrict", "return", "round", "roundEven", "sample", "sampler1D", "sampler1DArray", "sampler1DArrayShadow",
    "sampler1DShadow", "sampler2D", "sampler2DArray", "sampler2DArrayShadow", "sampler2DMS", "sampler2DMSArray",
    "sampler2DRect", "sampler2DRectShadow", "sampler2DShadow", "sampler3D", "sampler3DRect", "samplerBuffer",
    "samplerCube", "samplerCubeArray", "samplerCubeArrayShadow", "samplerCubeShadow", "shared", "short", "sign", "sin",
    "sinh", "sizeof", "smooth", "smoothstep", "sqrt", "static", "step", "struct", "subroutine", "superp", "switch",
    "tan", "tanh", "template", "texelFetch", "texelFetchOffset", "texture", "texture1D", "texture2D", "texture3D",
    "textureCube", "textureGather", "textureGatherOffset", "textureGatherOffsets", "textureGrad", "textureGradOffset",
    "textureLod", "textureLodOffset", "textureOffset", "textureProj", "textureProjGrad", "textureProjGradOffset",
    "textureProjLod", "textureProjLodOffset", "textureProjOffset", "textureQueryLevels", "textureQueryLod",
    "textureSamples", "textureSize", "this", "transpose", "true", "trunc", "typedef", "uaddCarry", "uimage2D", "uint",
    "uintBitsToFloat", "umulExtended", "uniform", "union", "unpackDouble2x32", "unpackHalf2x16", "unpackSnorm2x16",
    "unpackSnorm4x8", "unpackUnorm2x16", "unpackUnorm4x8", "unsigned", "usampler1D", "usampler2D", "usampler2DArray",
    "usampler3D", "usamplerBuffer", "usamplerCube", "using", "usubBorrow", "uvec2", "uvec3", "uvec4", "varying",
    "vec2", "vec3", "vec4", "void", "volatile", "while", "writeonly",
});
// clang-format on
static_assert(std::ranges::is_sorted(reserved));

bool is_word(char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9');
}

std::string legal(std::string_view wanted) {
    std::string name;
    for (char c : wanted) {
        if (is_word(c))
            name += c;
        else if (!name.empty() && name.back() != '_')
            name += '_'; // `__` is reserved everywhere
    }
    if (name.empty()) name = "f";
    if (name[0] >= '0' && name[0] <= '9') name.insert(0, 1, 'n');
    if (name.starts_with("gl_") || name.starts_with("GL_") || name.starts_with("fathom_") ||
        name.starts_with("webgl_"))
        name.insert(0, "my_");
    return name;
}

} // namespace

bool is_reserved(std::string_view name) {
    if (std::ranges::binary_search(reserved, name)) return true;
    return std::ranges::any_of(all_targets(), [&](Target target) {
        std::string_view rest = traits_of(target).reserved;
        while (!rest.empty()) {
            const std::size_t end = std::min(rest.find(' '), rest.size());
            if (rest.substr(0, end) == name) return true;
            rest.remove_prefix(std::min(end + 1, rest.size()));
        }
        return false;
    });
}

std::string Names::unique(std::string_view wanted) {
    std::string base = legal(wanted);
    std::string name = base;
    const char *joint = base.back() == '_' ? "" : "_";
    for (int i = 2; is_reserved(name) || taken_.contains(name); ++i)
        name = fmt::format("{}{}{}", base, joint, i);
    taken_.insert(name);
    return name;
}

std::string Names::numbered(char prefix) {
    std::string name;
    do name = fmt::format("{}{}", prefix, next_++);
    while (taken_.contains(name));
    taken_.insert(name);
    return name;
}

} // namespace fathom::glsl
