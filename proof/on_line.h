// Inequalities in which everything hangs on one number t: by halving t's range. Decides what
// elimination (cases.h) does not, as it knows t*t and the roots of what t makes. Knows nothing of
// graphs.
#pragma once

#include "ir/interval.h"
#include "proof/cases.h"

#include <optional>
#include <vector>

namespace fathom::proof {

// A coordinate of a point that a fold keeps in a sector about an axis, or the second one's size.
struct Sector {
    enum Part : std::uint8_t { X, Y, SizeOfY };
    Part part;
    std::uint32_t of;   // one number for equal points
    ir::Interval angle; // no wider than half a turn
};

struct LineAtom {
    bool never_negative = false;
    std::optional<Sum> square;         // of a root: what it is the root of
    std::optional<Sum> below;          // … which, if it may be below 0, counts as 0 there
    std::optional<ir::Interval> range; // of its own, where it is known
    bool held = false;                 // the same for all points: a param, the time, made of these
    // Of a / d, where d is an atom: d, and a.
    std::optional<std::pair<std::uint32_t, Sum>> quotient;
    std::optional<Sum> inverse_of; // of 1 / b: b, of which the first number is 1, never 0
    std::optional<Sector> sector;
};

// Do a and b differ nowhere where no row is below 0, by more than `granted` of their terms? All
// atoms but one have to be roots of sums of that one, whose range is known. `work` counts up by
// the intervals looked at, and ends it at `most_work_on_lines`. True is a proof, false is none.
bool agree_on_line(const std::vector<Sum> &rows, const Sum &a, const Sum &b,
                   const std::vector<LineAtom> &atoms, int &work);

constexpr int most_work_on_lines = 60'000; // of one field

} // namespace fathom::proof
