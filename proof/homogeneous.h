// Fields that grow along each ray from the origin as the distance does, as cones, norms and sums of
// them do: the same slope holds all along a ray (docs/lipschitz.md, 2.48).
#pragma once

#include "proof/field.h"

#include <optional>

namespace fathom::proof {

// Is the field, but for what is the same for all points and added last, f with f(k p) = k f(p) for all
// k > 0? For any without calls.
bool is_homogeneous(const ir::Graph &graph, NodeId field);

// The slope that such a field has nowhere more than, found on the faces of a cube about the origin;
// nothing for other fields, or where none below `known`, which is proved or stated, is found.
// Of slopes seen `seen` is known.
std::optional<double> bound_along_rays(Flattening &context, const Ranges &ranges, NodeId field,
                                       const Budget &budget, double known, double seen);

} // namespace fathom::proof
