// Whether what the tapes compute, in float32, is what the walk over the graph computes, in double.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::test {

// Where a jump lies between the two, or a number is badly conditioned, the walk itself moves as much
// near the point: that is how far they may differ.
template <typename F> bool agree(double found, const std::array<double, 3> &p, const F &truth) {
    const double exact = truth(p);
    if (std::isnan(exact) && std::isnan(found)) return true;
    double spread = 1e-4 * (1 + std::abs(exact));
    if (std::abs(found - exact) <= spread) return true;
    for (double step : {1e-6, 1e-5, 1e-4})
        for (int i = 0; i < 14; ++i) {
            std::array<double, 3> near = p;
            for (std::size_t k = 0; k < 3; ++k) {
                if (i < 6 && static_cast<std::size_t>(i / 2) != k) continue;
                near[k] += ((i < 6 ? i : i >> k) & 1 ? step : -step) * (1 + std::abs(p[k]));
            }
            spread = std::max(spread, 2 * std::abs(truth(near) - exact));
            if (std::isnan(spread)) return true;
        }
    return std::abs(found - exact) <= spread;
}

} // namespace fathom::test
