// Gives every loop of a function its own variables. Two Loop nodes may share one Loop record (the
// same loop begun with other values); as text they are two loops, and a node of the body stands in
// both.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom::glsl {

struct ClonedLoops {
    ir::Graph graph;               // a copy with the loops taken apart
    std::vector<ir::NodeId> roots; // in it
};

// Nothing where no loop is shared, which is the common case.
std::optional<ClonedLoops> clone_shared_loops(const ir::Graph &graph,
                                              std::span<const ir::NodeId> roots);

} // namespace fathom::glsl
