// How many turns of loops the fields of a text take. Mesa's llvmpipe ends a shader after 65,536 of
// them, all its loops together: a host that draws by passes gives a draw no more steps than fit.
#pragma once

#include "backend-glsl/module.h"

namespace fathom::glsl {

// A long loop runs in groups of a few turns. Drivers write such a short inner loop out where its
// body is short, which is faster, and keeps within those turns. 1: no groups; 0: groups of
// most_together that do not fill the loop, where no large ones do.
constexpr int most_together = 8;
int turns_together(const ir::Graph &graph, const ir::Loop &loop);

// In one evaluation of the costliest of the scene's fields, at most.
Turns turns_of(const Module &module);

} // namespace fathom::glsl
