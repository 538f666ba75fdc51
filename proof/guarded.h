// What is known of a number inside the arm of a choice that compares it: a rewriting of expressions.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

namespace fathom::proof {

// An arm of a choice whose condition holds there, or does not, with what divides, and what has a
// root, a logarithm or a power, kept where the condition says that it is: of
// `if r < 0.25 { a } else { b / r }` the second arm is b / max(r, 0.25), which is the same wherever
// it is taken, and has no pole anywhere else (docs/lipschitz.md, 2).
ir::NodeId on_its_side(ir::Graph &graph, ir::NodeId condition, bool holds, ir::NodeId arm,
                       Work &work);

// Whether it is never below 0, whatever its arguments are: sizes, squares, and what is made of such.
bool is_never_negative(const ir::Graph &graph, ir::NodeId id, int depth = 8);

} // namespace fathom::proof
