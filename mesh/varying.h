// Numbers over a box of which the slopes are enclosed, and what kernels make of them.
#pragma once

#include "mesh/field.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {

struct Interval {
    double lo = 0, hi = 0;
};
inline Interval operator+(Interval a, Interval b) { return {a.lo + b.lo, a.hi + b.hi}; }
inline Interval operator*(Interval a, Interval b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}
inline Interval hull(Interval a, Interval b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
inline double size(Interval a) { return std::max(std::fabs(a.lo), std::fabs(a.hi)); }

// Along the axes, and along one more direction that is asked for (else nothing changes along it).
constexpr std::size_t directions = 4;

// Some of the numbers of a tape, by their ids, in order; 0 in places that are not needed.
struct Ids {
    bool known = false;
    std::array<std::uint32_t, 3> of{};
    bool operator==(const Ids &) const = default;
};

// A number over a box: its range, what its slopes along the directions lie within wherever it has any
// (it is continuous), and how far its floats are from the real number at most.
struct Varying {
    bool known = false;
    Interval range;
    std::array<Interval, directions> slope{};
    double error = 0;
    // Where it may jump its slopes are those beside that; its floats may be the other side's as far
    // as this from there.
    bool jumps = false;
    double beyond = 0;
    bool several = false; // it has alternatives (alternatives.h)
    std::uint32_t id = 0; // the same of copies of one number; 0: it has none yet
    // It is the greatest of these (of itself where they are not known), and of others that are not
    // above 0 anywhere in the box.
    Ids greatest{};
    // It is 0 where none of these numbers is above 0, or else 0 where one is; where it is not, it has
    // these slopes and this error. Of a number alone both parts together are that number.
    struct Half {
        Ids of{}; // not known: it is none
        bool above = false;
        std::array<Interval, directions> slope{};
        double error = 0;
    } half{};
};

// f(a, b, …) of which the partial derivatives lie within `by`; its own rounding is part of the sizes
// of `terms`, what is added up.
Varying chained(std::initializer_list<std::pair<const Varying *, Interval>> parts, double terms);
// What kernels of one output give; others are not known.
Varying through(cpu::Kernel kernel, const std::vector<Varying> &in);
// The sine of an angle, or its cosine.
Varying wave_of(const Varying &angle, bool cosine);

} // namespace fathom::mesh
