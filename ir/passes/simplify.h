// Cheap identities of a node that is about to be made: x + 0, x * 1, x * 0, min(x, x), a swizzle of
// a Make, a Select with a constant condition, … In come an op and its arguments, which are simple
// already; out goes a node of the same value. It never looks below the arguments' own arguments,
// and never computes on constants (fold.h does).
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// The simpler node; none where there is no such.
NodeId simplified(Graph &graph, Op op, Type type, std::span<const NodeId> args,
                  std::uint32_t payload);

} // namespace fathom::ir
