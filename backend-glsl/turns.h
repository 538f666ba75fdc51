// How many turns of loops the fields of a text take. Mesa's llvmpipe ends a shader after 65,536 of
// them, all its loops together: a host that draws by passes gives a draw no more steps than fit.
#pragma once

#include "backend-glsl/module.h"

namespace fathom::glsl {

// In one evaluation of the costliest of the scene's fields, at most.
Turns turns_of(const Module &module);

} // namespace fathom::glsl
