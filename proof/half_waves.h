// Two lattices half a period apart, as grids of hexagons are made of: |w(x - m/2)| = m/2 - |w(x)|
// for the wave w of period m (forms.h). Decided on expressions.
#pragma once

#include "ir/graph.h"

namespace fathom::proof {

// The same value by |w| alone, where an expression has two such waves, makes a choice and is the same
// whichever sign each component of either has (docs/lipschitz.md, 2.24); else `root`.
ir::NodeId with_half_waves(ir::Graph &graph, ir::NodeId root);

} // namespace fathom::proof
