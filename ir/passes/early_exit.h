// Loops that end as soon as nothing in them changes any more: an escape-time fractal written as
// `for i in 0..n { if length(z) <= 2 { z = … } }` computes its body only while the guard holds. In
// come the loops of a graph, out go the same values; it touches no loop whose guard reads the
// index, and none whose body costs less than the way out.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// After the proof, which follows the form that was written.
void end_loops_early(Graph &graph);

} // namespace fathom::ir
