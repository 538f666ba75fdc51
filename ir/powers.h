// Powers with whole constant exponents, which back ends compute by products: each rounds once, so
// that x^n is right to n - 1 half units, less than what proof/rounding.h allows any power. Functions
// by exp and log take longer and are less exact.
#pragma once

#include <vector>

namespace fathom::ir {

inline constexpr int largest_power = 8; // that a back end computes in one go

// x^n = ((x^a)^b)…: numbers in 2..largest_power whose product is n, the largest first. Empty where
// there are none, or n is no whole number in 2..64.
inline std::vector<int> power_factors(double n) {
    std::vector<int> factors;
    if (!(n >= 2 && n <= 64) || n != static_cast<int>(n)) return factors;
    int rest = static_cast<int>(n);
    for (int k = largest_power; k > 1; --k)
        for (; rest % k == 0; rest /= k) factors.push_back(k);
    if (rest != 1) factors.clear(); // a prime above
    return factors;
}

} // namespace fathom::ir
