// Loops that end as soon as nothing in them changes any more: an escape-time fractal written as
// `for i in 0..n { if length(z) <= 2 { z = … } }` computes its body only while the guard holds, and
// so does one that begins with `if length(z) > 2 { break }`. In come the loops of a graph, out go
// the same values; it touches no loop whose guard reads the index, and none whose body costs less
// than the way out.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// Makes what end_loops_early will want as the loop's condition. Graph::add_loop calls it.
void make_exit_conditions(Graph &graph, const Loop &loop);

// After the proof, which follows the form that was written.
void end_loops_early(Graph &graph);

} // namespace fathom::ir
