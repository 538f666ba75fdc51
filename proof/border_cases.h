// A claim about a choice's border, proved by cases. Knows nothing of whole fields.
#pragma once

#include "ir/graph.h"

namespace fathom::proof {

// `of` has one value for all sides of the choice (a Select, Sign or Step), where u = v and, with
// that comparison true or false, the choice's condition is not the same.
struct Claim {
    ir::NodeId of, choice;
    ir::NodeId comparison, u, v; // comparison: none of a Sign or Step
};

// True is a proof; false is none. `cases` counts up by the cases that were looked at.
bool is_proved(ir::Graph &graph, const Claim &claim, int &cases);

} // namespace fathom::proof
