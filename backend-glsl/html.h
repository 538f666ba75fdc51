// One self-contained WebGL 2 page around a GLSL ES 3.00 text: orbit, zoom, sliders for the params.
// Loads nothing.
#pragma once

#include "backend-glsl/emit.h"

namespace fathom::glsl {

std::string html_page(const ir::Scene &scene, const Options &options,
                      const std::vector<Uniform> &uniforms, const std::string &fragment);

} // namespace fathom::glsl
