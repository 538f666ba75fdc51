// Jumps of a field, as they are told: two near points with other values. A search by trying, which
// proves nothing.
#pragma once

#include "proof/crossings.h"

namespace fathom::proof {

// Two near points on both sides of a jump, for its report: at `out.where`, else near it, else at
// one of some hundred places of the box; without a jump that is seen, those at `out.where`. Params
// are in the middle of their ranges, and the time is the first.
void find_sides(const Tape &tape, Ranges ranges, FieldBound &out, double scale,
                const std::array<bool, 3> &reads, const Cell &box, const Zone *zone);

} // namespace fathom::proof
