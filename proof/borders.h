// Choices whose sides meet: an `if`, a `sign` or a `step` turns, and the field has one value there
// all the same, as a distance times a sign that turns where the distance is 0 has, and the arms of
// a round cone. Proved by cases on the border, never by sampling (docs/lipschitz.md, 2).
#pragma once

#include "proof/tape.h"

namespace fathom::proof {

// The choices (Select, Sign, Step) below `root` whose turning `root` is proved not to see. Enters
// no loops; calls should have been written out before (written_out). Counts its work, so that the
// answer is the same everywhere.
Meeting meeting_choices(Flattening &context, ir::NodeId root);

// Does the expression, its calls included, hold a choice that would be looked at?
bool has_choices(const ir::Graph &graph, ir::NodeId root);

} // namespace fathom::proof
