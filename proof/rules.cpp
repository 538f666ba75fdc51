#include "proof/rules.h"

#include "ir/interval.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::up;

double sigma(double s) {
    s = std::fabs(s);
    return s == 0 ? 1 : up((s + std::sqrt(s * s + 4)) / 2, 4);
}

// [[1, 0], [b, a]]: singular values squared are the roots of x^2 - (1 + a^2 + b^2) x + a^2.
double lower_triangle_norm(double a, double b) {
    double sum = 1 + a * a + b * b;
    double root = std::sqrt(std::max(sum * sum - 4 * a * a, 0.0));
    return up(std::sqrt((sum + root) / 2), 8);
}

} // namespace fathom::proof
