// Quotients whose divisor is multiplied by what their numerator is, as the fields of fractals are
// that carry a scale along (docs/lipschitz.md, 2.45). Decided on expressions; the machine bounds them.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

namespace fathom::proof {

// Is something that varies a factor of both, however deep below sums, choices and folds?
bool are_scaled_alike(const ir::Graph &graph, ir::NodeId numerator, ir::NodeId divisor, Work &work);

// Is there such a quotient outside of loops?
bool divides_by_scale(const ir::Graph &graph, ir::NodeId field, Work &work);

// Is there a loop, and a quotient by what varies?
bool may_divide_by_scale(const ir::Graph &graph, ir::NodeId field);

} // namespace fathom::proof
