// The check of a whole text by glslang, in what its target's host puts around it.
#pragma once

#include "backend-glsl/emit.h"
#include "backend-glsl/validate.h"

namespace fathom::glsl {

// Whether the text is valid; says so where it is not. `words`: the text as SPIR-V, for a target
// that is made of it.
bool good_text(const std::string &text, Stage stage, const Options &options,
               std::vector<std::uint32_t> &words, Diagnostics &diagnostics);

} // namespace fathom::glsl
