// Jumps of a field, as they are told: two near points with other values. A search by trying, which
// proves nothing.
#pragma once

#include "proof/field.h"
#include "proof/machine.h"

namespace fathom::proof {

inline Cell at_point(const std::array<double, 3> &p) {
    return {{Interval(p[0]), Interval(p[1]), Interval(p[2])}};
}

// Two near points on both sides of a jump, for its report: about `out.where`, else about one of some
// hundred places of the box; without a jump that is seen, the former. Params are in the middle of
// their ranges, and the time is the first.
void find_sides(const Tape &tape, Ranges ranges, FieldBound &out, double scale,
                const std::array<bool, 3> &reads, const Cell &box, const Zone *zone);

} // namespace fathom::proof
