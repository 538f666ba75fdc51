// Vectors over their lengths, of which frames are made: u = a/|a| has u . u = 1, and is at right
// angles to what a is. Decided on expressions, as sums of products. Knows nothing of cells.
#pragma once

#include "ir/graph.h"

#include <optional>

namespace fathom::proof {

// The number that a scalar is where each `normalize(a)`, each a / length(a) and each x / sqrt(s) in it
// is one, of a that is not 0; nothing where it is none, or that is not seen.
std::optional<double> number_of_units(ir::Graph &graph, ir::NodeId scalar);

} // namespace fathom::proof
