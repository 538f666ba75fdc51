// How the numbers that a tape computes on its way change with the place, all over one box: which of
// them rise or fall along an axis for sure, so that where they are nearly one number is thin.
#pragma once

#include "mesh/field.h"

namespace fathom::mesh {

struct Level {
    Register where;
    float lo = 0, hi = 0;             // what it lies within in the box
    double slope = 0;                 // along one axis it changes at least so fast, always one way,
    double error = 0;                 // … and its floats are no farther than this from that
    std::array<double, 3> gradient{}; // about
};

// The numbers of which such an axis is known, in the order of the tape. `boxes` is memory.
std::vector<Level> levels_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                             const Point &lo, const Point &hi);

} // namespace fathom::mesh
