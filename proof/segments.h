// Vectors moved along a direction by how far they lie along it: the way to the nearest point of a
// segment, v - b clamp(v.b / b.b, 0, 1), as capsules have it, folds, v - 2 n min(v.n, 0), and what is
// moved by component, v - b [clamp(v_x / b_x, 0, 1), 1].
#pragma once

#include "ir/graph.h"

#include <optional>

namespace fathom::proof {

struct Moved {
    ir::NodeId v, b;
    double norm = 1; // no steeper than v by more than this, where b does not vary
};
std::optional<Moved> moved_along(ir::Graph &graph, ir::NodeId vector);

} // namespace fathom::proof
