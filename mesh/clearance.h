// How far two solids are apart: by pairs of boxes that may hold points of them, nearest first
// (docs/measure.md, 3).
#pragma once

#include "mesh/measure.h"

namespace fathom::mesh {

struct Clearance {
    Failure failure = Failure::None;
    Enclosure distance;          // 0 to 0: they have points in common
    std::array<Point, 2> near{}; // a point of each, `distance.hi` from each other
    bool used_bound = false;     // the proved bound, besides intervals
};

// Of two scenes at one time. At most one of them may have no end. The enclosure is as narrow as
// `tolerance`, or as a counted amount of work makes it.
Clearance clearance(const ir::Scene &a, const ir::Scene &b, double time, double tolerance,
                    Progress &progress);

} // namespace fathom::mesh
