// The area of a surface in boxes in which it is a graph: across a plane there is one place of it at
// most (docs/measure.md, 2).
#pragma once

#include "mesh/slopes.h"

namespace fathom::mesh {

using Real3 = std::array<double, 3>;

// A number that is proved to lie between two others.
struct Enclosure {
    double lo = 0, hi = 0;
};

// A direction along which the field rises all over a box. The surface in it has at least the area of
// its projection along that direction, and at most so many times as much.
struct Slant {
    Real3 along{};
    double most = 1;
};
// Of a number by what its slopes lie within; none where it may not rise.
std::optional<Slant> slant_of(const Linear &linear);
// Of the field. None is known. `linear`: of the same box.
std::optional<Slant> slant_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                              const Point &lo, const Point &hi, const Linear &linear);

// What of a box's faces is solid, from smaller boxes that the box consists of.
struct Graph {
    Point lo{}, hi{};
    std::array<std::array<Enclosure, 2>, 3> solid{}; // areas, by axis and end

    void add_inside(const Point &from, const Point &to);
    // An open box: by a plane, if its field is all but linear.
    void add_open(const Point &from, const Point &to, const std::optional<Linear> &linear);
    // Of the surface in the box.
    Enclosure area(const Slant &slant) const;
};

// … of the place in a box where such a number is 0.
Enclosure area_of_sheet(const Point &lo, const Point &hi, const Linear &sheet);

// The share of a box, by half its sides, in which value + slope · p <= 0, p from its middle: of the
// simplices that a plane cuts off at its corners, added and taken away. Between two numbers, for what
// slopes of next to nothing may take. (Barrow and Smith 1979.)
std::array<double, 2> share_below(double value, const std::array<double, 3> &slope,
                                  const Real3 &half);
// Of a box that holds floats: the share at least and at most where the field is not positive.
Enclosure share_of(const Point &lo, const Point &hi, const Linear &linear);

} // namespace fathom::mesh
