// Fields of what is moved, turned or folded: a field that reads the point through a vector alone is
// no steeper than that of the vector's place times the vector (docs/lipschitz.md, 2.28).
#pragma once

#include "proof/field.h"

#include <optional>

namespace fathom::proof {

// Is this bound of a field so near the slopes seen that no other way is tried? Of what reads a param or
// the time all that it may be is seen at once.
bool is_near(const ir::Graph &graph, NodeId field, const FieldBound &bound);

// A bound of a field that reads the point through a distance, from a point or an axis, and at most one
// coordinate beside it: it is searched in fewer dimensions. Nothing where there is none, or where
// that is not near the slopes seen.
std::optional<FieldBound> bound_by_distance(Flattening &context, const Ranges &ranges, NodeId field,
                                            const Domain &domain, const Budget &budget);

// A bound of the field by its parts that read the point through a vector; nothing where there are
// none, or where none of them can be proved. More work is spent on a field that is else refused.
// The context gets what is known of the parts as of cached fields.
std::optional<FieldBound> bound_by_parts(Flattening &context, const Ranges &ranges, NodeId field,
                                         const Domain &domain, const Budget &budget, bool refused);

} // namespace fathom::proof
