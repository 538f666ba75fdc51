// Jumps that cancel: fields that are continuous although a `floor`, a `%` or an angle inside them
// jumps, as own value noise, `p - round(p)` and polar copies by `atan` are. Decided on expressions,
// never by sampling.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <unordered_set>
#include <vector>

namespace fathom::proof {

struct Cell;

// The steps (Floor, Ceil, Round, Fract, Mod, Atan2) below `root` whose jumps `root` is proved not
// to see: it has one value on both sides of each border. Enters no loops; calls should have been
// written out before (written_out). Holds for the points of `region`, if one is given.
std::unordered_set<ir::NodeId> cancelling_steps(ir::Graph &graph, ir::NodeId root,
                                                const Cell *region, Work &work);

// Does the expression, its calls included, hold such a step?
bool has_steps(const ir::Graph &graph, ir::NodeId root);

// All that the body of a loop is made of, the loops in it included.
std::vector<ir::NodeId> in_body(const ir::Graph &graph, ir::NodeId loop);

// The same expression with every call replaced by its function's body; `root` itself where that
// would be very large.
ir::NodeId written_out(ir::Graph &graph, ir::NodeId root);

} // namespace fathom::proof
