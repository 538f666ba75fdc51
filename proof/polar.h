// Points turned about an axis by way of their angle: |q| cos(a), |q| sin(a) with a made of the
// angle of q is q turned, and has no singular axis (docs/lipschitz.md, 2.9). Knows nothing of
// tapes.
#pragma once

#include "ir/graph.h"

#include <unordered_set>
#include <utility>
#include <vector>

namespace fathom::proof {

struct Turned {
    ir::NodeId root; // as given, where there is nothing to write anew
    // Of each wave of an angle that was written as one of its steps: the wave, and the step.
    std::vector<std::pair<ir::NodeId, ir::NodeId>> steps;
};
Turned without_angles(ir::Graph &graph, ir::NodeId root);

// The angles (Atan2) that the field reads through these steps alone.
std::unordered_set<ir::NodeId> stepped_angles(const ir::Graph &graph, ir::NodeId root,
                                              const std::unordered_set<ir::NodeId> &steps);

// |v| of acos(v.y / |v|), which is the angle between v and an axis, or of asin(v.y / |v|), 90 degrees
// less that (docs/lipschitz.md, 2.35); nothing where it is no such.
std::optional<ir::NodeId> angle_to_axis(ir::Graph &graph, ir::NodeId angle);

} // namespace fathom::proof
