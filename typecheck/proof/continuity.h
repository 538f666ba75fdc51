// Do the two arms of a choice agree where the choice turns? Decided on the expressions, never by sampling.
#pragma once

#include "ir/graph.h"

namespace fathom::proof {

// True where `condition ? a : b` is proved continuous across the condition's border, given that a and b are.
bool arms_agree(ir::Graph &graph, ir::NodeId condition, ir::NodeId a, ir::NodeId b);

} // namespace fathom::proof
