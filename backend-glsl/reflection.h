// What a host has to know of a text that was emitted, as JSON.
#pragma once

#include "backend-glsl/emit.h"

namespace fathom::glsl {

// `output` is what `emit` made of the scene by the options.
std::string reflection_json(const ir::Scene &scene, const Options &options, const Output &output);

} // namespace fathom::glsl
