// One self-contained WebGL 2 page around a GLSL ES 3.00 text by passes: controls for the params, the
// camera and the time (docs/web.md). Loads nothing: its policy forbids it.
#pragma once

#include "backend-glsl/emit.h"

namespace fathom::glsl {

// `output`: what the text reads.
std::string html_page(const ir::Scene &scene, const Options &options, const Output &output,
                      const std::string &fragment);

} // namespace fathom::glsl
