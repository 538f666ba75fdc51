// Checks a shader's text with the glslang library, in process. The only file that includes glslang
// is validate.cpp.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fathom::glsl {

struct Complaint {
    int line = 0; // of the text, from 1; 0: of no line
    std::string message;
};

enum class Stage { Fragment, Compute };

// Which of glslang's tables a text is read by: those of the text's version, or smaller ones where
// they are enough to say that it is valid (small_tables.h).
enum class Tables { AsNeeded, All };

// A whole shader with its #version line. Nothing where it is valid.
std::optional<Complaint> validate(const std::string &text, Stage stage = Stage::Fragment,
                                  Tables tables = Tables::AsNeeded);

// The same text as SPIR-V for OpenGL 4.5 (GL_ARB_gl_spirv), or what is wrong with it.
struct SpirV {
    std::vector<std::uint32_t> words;
    std::optional<Complaint> complaint;
};
SpirV to_spirv(const std::string &text);

} // namespace fathom::glsl
