// Params whose ranges the proof refuses, and that stand at their present values instead, where it
// does not: `semantics.md`, 25. In comes what was said of the ranges; the driver compiles again.
#pragma once

#include "base/diagnostic.h"
#include "ir/scene.h"

#include <vector>

namespace fathom::driver {

// Where the params with a range are declared that the refused shapes read. None where an error is
// of something else than a field that is not proved, which no value of a param mends; and none where
// one of them reaches a shape that the scene `asked` the proof about, since the solid may not depend
// on what was proved.
std::vector<Span> unproved_ranges(const ir::Scene &refused, const Diagnostics &errors,
                                  const std::vector<ir::ShapeId> &asked);

// Warns in `out` of each field that was refused for the ranges of the params declared at `params`.
void warn_of_ranges(const ir::Scene &refused, const Diagnostics &errors,
                    const std::vector<Span> &params, Diagnostics &out);

} // namespace fathom::driver
