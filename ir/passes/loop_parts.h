// The parts of a loop that need less than the whole. A loop whose state is a vector of a distance
// and a material (`acc = smooth(acc, vec4(d, color))`) computes the distance from distances alone.
// In come a Loop's node and one of its variables; out goes that variable's last value, in which
// such a component is the result of a loop of its own.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// The last value of loop variable k. A component has a loop of its own where its next value reads
// no other component of the variable, and another component's reads it: what goes by itself and
// leads the rest. The components of a point that is folded do not lead each other.
NodeId loop_result(Graph &graph, NodeId loop, std::size_t k);

} // namespace fathom::ir
