// The nearest of several points, found one after another: what is done with it as a choice of vectors
// jumps nowhere where it is the length of it. Decided on expressions.
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"
#include "proof/work.h"

#include <array>

namespace fathom::proof {

struct Ranges;

// The length of one of two vectors, or of a vector that has its components, where the lengths alone
// agree where the choice turns: as the choice of the lengths, all over the expression below `root`. In
// the region, if one is given, what begins a search decides nothing: `best` is 1000 before the first.
ir::NodeId with_chosen_lengths(ir::Graph &graph, ir::NodeId root,
                               const std::array<ir::Interval, 3> *region, const Ranges *ranges,
                               Work &work);

} // namespace fathom::proof
