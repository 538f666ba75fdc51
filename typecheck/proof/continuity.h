// Do the two arms of a choice agree where the choice turns? Decided on the expressions, never by sampling.
#pragma once

#include "ir/graph.h"

#include <optional>

namespace fathom::proof {

// True where `condition ? a : b` is proved continuous across the condition's border, given that a and b are.
bool arms_agree(ir::Graph &graph, ir::NodeId condition, ir::NodeId a, ir::NodeId b);

// a - b as a sum in which equal terms have cancelled; nothing where the expressions are too large.
std::optional<ir::NodeId> difference(ir::Graph &graph, ir::NodeId a, ir::NodeId b);

} // namespace fathom::proof
