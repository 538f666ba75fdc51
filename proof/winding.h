// Fields whose points turn about an axis by an angle that varies: twists, ropes, helices. Seen from
// coordinates that turn with the angle the field is as steep, and there the angle's value is of no
// account (docs/lipschitz.md, 2.26). Knows nothing of tapes.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {

struct Winding {
    ir::NodeId field; // as it is followed: waves that turn nothing are those of another angle
    int axis = 1;
    std::unordered_map<ir::NodeId, double> angles; // each differs by that number from the first one
    std::unordered_set<ir::NodeId> waves;          // all sines and cosines that the field reads
};
// Of a field without calls and loops; nothing where it reads more of the point than its distance from
// the axis, the coordinate along it, and the pairs x cos a + z sin a, z cos a - x sin a of one angle.
std::optional<Winding> winding_of(ir::Graph &graph, ir::NodeId field);

} // namespace fathom::proof
