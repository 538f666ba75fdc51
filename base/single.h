// The range of single precision, in which every field is computed.
#pragma once

#include <cmath>

namespace fathom {

constexpr double largest_single = 0x1.fffffep127; // 3.4028235e38
constexpr double smallest_normal = 0x1p-126;      // 1.1754944e-38: the least that is not subnormal

// A number that rounds to one of single precision, or is smaller than all of them.
inline bool fits_single(double x) { return std::abs(x) < 0x1.ffffffp127; }

// The nearest number of single precision. Through memory, as g++ 12 at -O2 leaves the rounding out of
// loops that it makes vectors of.
inline double to_single(double x) {
    volatile float nearest = static_cast<float>(x);
    return static_cast<double>(nearest);
}

// What is smaller than every normal number is 0, as on graphics cards.
inline double flushed(double x) { return std::abs(x) < smallest_normal ? 0 : x; }

// The lengths that single precision can square, and divide by the square of. Solids lie within the
// longest, and are no thinner than the shortest.
constexpr double longest = 1e18, shortest = 1e-18;

} // namespace fathom
