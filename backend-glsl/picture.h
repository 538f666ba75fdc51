// Whole texts: a picture (the scene's functions, the marcher, the entry point of the target) or a
// field alone.
#pragma once

#include "backend-glsl/assemble.h"

namespace fathom::glsl {

// `inputs`: the uniforms that the text declares.
std::string picture_text(const Module &module, const SceneText &scene, std::vector<Input> &inputs);
std::string field_text(const Module &module, const SceneText &scene, std::vector<Input> &inputs);

// The comment that says what a text is of.
std::string written_by(const Options &options);

} // namespace fathom::glsl
