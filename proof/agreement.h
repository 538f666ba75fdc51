// Are two sides of a border one number in every case: whatever the hashes of cells are, and wherever
// unknown numbers are in their ranges (docs/lipschitz.md, 2.32)?
#pragma once

#include "proof/border_ranges.h"

namespace fathom::proof {

// `notes`: what is known of the numbers that both are made of. False is no proof of the contrary:
// large sides are not compared, and no others for longer than `comparisons` allow.
bool sides_agree(Graph &graph, NodeId a, NodeId b, const Notes &notes, Comparisons &comparisons,
                 Work &work);

} // namespace fathom::proof
