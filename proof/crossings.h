// Pairs of near points between which a decision of the field turns: a floor, a comparison, an
// angle's cut. Jumps lie there and nowhere else, however small they are beside what the field does
// between two points chosen at random. A search by trying, which proves nothing.
#pragma once

#include "proof/field.h"
#include "proof/machine.h"

#include <optional>

namespace fathom::proof {

inline Cell at_point(const std::array<double, 3> &p) {
    return {{Interval(p[0]), Interval(p[1]), Interval(p[2])}};
}

struct Pair {
    std::array<double, 3> a{}, b{};
    double length() const;
};

// Two points no further apart than `near` with other decisions, on the way between those of the
// pair; nothing where its ends have the same. Of a machine that reads values.
std::optional<Pair> turning(Machine &machine, Pair way, double near);

// Ways from all over a domain, of all lengths, which end where the field is evaluated.
struct SomeWays {
    Cell box;
    const Zone *zone = nullptr;
    std::array<bool, 3> reads{true, true, true}; // coordinates that matter
    Dice dice{0xc2055};

    std::array<double, 3> point();
    std::optional<Pair> next();
    // … of those whose ends are near a point, from a thousandth of `reach` to all of it.
    std::optional<Pair> next_near(const std::array<double, 3> &place, double reach);
    bool inside(const std::array<double, 3> &p) const;
};

// How far two points of a domain are apart that lie on both sides of a border.
double near_in(const Cell &box, const std::array<double, 3> &place);

// What the params and the time are for one test: all in the middle of their ranges, or at one end.
// Ids of copies and rows are whole numbers; of a time without an end the begin is taken.
enum class Held : std::uint8_t { Middle, First, Last };
Ranges held_at(const Tape &tape, Ranges ranges, Held held);
struct Told {
    bool params = false, time = false;
};
Told reads_of(const Tape &tape);

} // namespace fathom::proof
