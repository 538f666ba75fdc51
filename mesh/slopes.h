// How the numbers that a tape computes on its way change with the place, all over one box: which of
// them rise or fall along an axis for sure, so that where they are nearly one number is thin.
#pragma once

#include "mesh/field.h"
#include "mesh/slope_run.h"

#include <optional>

namespace fathom::mesh {

struct Level {
    Register where;
    float lo = 0, hi = 0;             // what it lies within in the box
    double slope = 0;                 // along one axis it changes at least so fast, always one way,
    double error = 0;                 // … and its floats are no farther than this from that
    std::array<double, 3> gradient{}; // about
    std::array<std::array<double, 2>, 3> slopes{}; // along each axis: between these
    std::array<float, 2> middle{};                 // its float at middle_point lies between these
};

// What another number lies within where one does, as far as both change alike over a box: two planes
// that were turned each by itself are one but for rounding.
struct Tie {
    double share = 0;      // so much the other one changes with this one,
    double lo = 0, hi = 0; // … and its float less that lies between these
    double width() const { return hi - lo; }
};
Tie tie_of(const Level &level, const Level &other, const Point &lo, const Point &hi);

// The numbers of which such an axis is known, in the order of the tape. `boxes` is memory.
std::vector<Level> levels_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                             const Point &lo, const Point &hi);

// The field in a box, as it is cut off at bounds. None where it is not known how it changes.
// `boxes` is memory.
std::optional<Linear> linear_over(Evaluator &evaluator, const cpu::ShortTape &tape,
                                  cpu::Boxes &boxes, const Point &lo, const Point &hi);

// The same, and how fast the field rises along a direction at least, all over the box.
struct Rising {
    Linear linear;
    double least = 0;
};
std::optional<Rising> rising_over(Evaluator &evaluator, const cpu::ShortTape &tape,
                                  cpu::Boxes &boxes, const Point &lo, const Point &hi,
                                  const std::array<double, 3> &along);

// After `rising_over` had none, with the same tape: why the field's slopes are not known.
struct Unknown {
    enum class Why {
        Step,     // of that step no slopes are known there
        TooLong,  // the tape
        Jump,     // the field may jump there: its bound is not proved
        NoNumber, // it is not finite
    } why = Why::NoNumber;
    Missing missing{};
    bool operator==(const Unknown &) const = default;
};
Unknown why_unknown(const Evaluator &evaluator, const cpu::ShortTape &tape);

// What the surface in a box is part of. Not known where the field's bound is not proved: it may jump.
struct Border {
    Zeros zeros;                  // of the field
    std::optional<Linear> linear; // as linear_over has it
    // The one sheet of these, or its negative, if the field is below 0 wherever it is for sure, and
    // above 0 wherever it is.
    std::optional<Linear> like;
};
Border border_over(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                   const Point &lo, const Point &hi);

// How fast the field rises along a direction at least, all over a box; none where that is not known.
std::optional<double> least_slope_along(Evaluator &evaluator, const cpu::ShortTape &tape,
                                        cpu::Boxes &boxes, const Point &lo, const Point &hi,
                                        const std::array<double, 3> &along);

// Whether a number is 0 somewhere: there angles, signs and sizes that are made of it have their cuts.
inline bool has_cut(const Level &level) { return level.lo < 0 && level.hi > 0; }

// The cosine between the directions in which two numbers change, without its sign.
double cosine(const Level &x, const Level &y);

// Those that are worth a look, in the order of the tape. Of many rather the earliest one of each
// direction, on which the others of that direction are likely to depend; then those of directions in
// which no slope that was seen points, as one of the planes that meet in a corner may lie: of these
// first those that have cuts. `slopes`: the field's at some places of the box, from 1 on.
std::vector<Level> chosen_levels(const std::vector<Level> &levels,
                                 const std::array<std::vector<float>, 4> &slopes);

} // namespace fathom::mesh
