// How long an expression takes at most, so that what could not be answered in any time is refused
// before it is evaluated. In comes an expression, out goes a number. It says nothing of how dear an
// operation is: cost.h does.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// How many operations, loops by their largest number of iterations and calls by what they call.
double operations(const Graph &graph, NodeId root);
constexpr double max_operations = 1e7; // of one point: beyond it no picture ever ends

} // namespace fathom::ir
