// Numbers of which one is never above the other, as the least and the second of several are kept by
// `if`: what is chosen of such by comparing them is a `min` or `max`, which is continuous
// (docs/lipschitz.md, 2.37).
#pragma once

#include "ir/graph.h"

namespace fathom::proof {

// The same expression, with choices among numbers that are compared as their `min` and `max`.
ir::NodeId with_extremes_for_choices(ir::Graph &graph, ir::NodeId root);

} // namespace fathom::proof
