// How long an expression takes at most, so that what could not be answered in any time is refused
// before it is evaluated. In come expressions, out goes a number. It says nothing of how dear an
// operation is: cost.h does.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// How many operations, loops by their largest number of iterations and calls by what they call.
double operations(const Graph &graph, NodeId root);
double operations(const Graph &graph, std::vector<NodeId> roots); // what they share counts once
// How many functions the expressions call, each counted once.
std::size_t functions_called(const Graph &graph, std::vector<NodeId> roots);

} // namespace fathom::ir
