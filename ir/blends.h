// The blend profiles and the seams: what joins two distances near the line where their surfaces
// meet. For unions; intersections and differences negate (a & b = -blend(-a, -b)). Knows nothing of
// graphs.
//
// All profiles but Columns have the form min(a, b) - g(|a - b|), with g = 0 from r on and slope g'
// in [-1, 0]. So they are exactly min where the two differ by r or more, and their weights, 1 + g'
// on the lesser and -g' on the greater, are positive and sum to 1: the gradient is a mean of the
// operands', L = max(La, Lb). g follows from the contour that the name promises between two
// perpendicular walls a = 0 and b = 0: the point with d = |a - b| on it has lesser coordinate g(d).
// (The usual forms, length(r-a, r-b) and (a+b-r)*sqrt(1/2), have the same contour, but slope
// sqrt 2.)
#pragma once

#include <cmath>

namespace fathom::ir::sem {

template <class T> T minimum(T a, T b) { return b < a ? b : a; }
template <class T> T maximum(T a, T b) { return a < b ? b : a; }
template <class T> T gap(T a, T b) { return a < b ? b - a : a - b; } // |a - b|

constexpr float min_radius = 1e-9f; // in place of 0, where a radius divides

// Quilez' quadratic: g = (k - d)^2 / 4k. dg/dk in [0, 1/4]. At d = 0 it is k/4.
template <class T> T blend_smooth(T a, T b, T k) {
    const T h = maximum(k - gap(a, b), T(0));
    const T scale =
        T(0.25) / maximum(k, T(min_radius)); // one division where k is the same for many
    return minimum(a, b) - h * h * scale;
}

// A fillet: the quarter circle of radius r about (r, r). With u = r - m, where m is the lesser
// coordinate, u^2 + (u - d)^2 = r^2, so u = (d + sqrt(2r^2 - d^2))/2 and g = r - u. g' = -(1 -
// d/sqrt(2r^2 - d^2))/2 in [-1/2, 0].
template <class T> T blend_round(T a, T b, T r) {
    using std::sqrt;
    const T radius = maximum(r, T(0)), d = minimum(gap(a, b), radius);
    const T u = T(0.5) * (d + sqrt(maximum(T(2) * radius * radius - d * d, T(0))));
    return minimum(a, b) - maximum(radius - u, T(0));
}

// The line a + b = r, which cuts r off both walls: g = (r - d)/2.
template <class T> T blend_chamfer(T a, T b, T r) {
    return minimum(a, b) - T(0.5) * maximum(r - gap(a, b), T(0));
}

// n steps between (0, r) and (r, 0): n treads and n + 1 risers of s = r/(n+1). The contour is a + b
// = r - w(d), w the triangle wave of height s that is 0 at d = r, r - 2s, …; so g = (r - d - w)/2,
// g' is 0 or -1.
template <class T> T blend_stairs(T a, T b, T r, T n) {
    using std::floor;
    const T s = maximum(r, T(min_radius)) / (maximum(floor(n + T(0.5)), T(0)) + T(1));
    const T d = gap(a, b), x = (maximum(r, T(0)) - d) / (s + s);
    const T turn = x - floor(x);                         // 0..1 through one step
    const T wave = (s + s) * minimum(turn, T(1) - turn); // 0..s
    return minimum(a, b) - T(0.5) * maximum(maximum(r, T(0)) - d - wave, T(0));
}

// n columns of radius c side by side on the chamfer a + b = r - 2c, c = r*sqrt2 / (2(n-1) + sqrt2),
// as in hg_sdf. Their circles keep below r in a and b, hence again exactly min where a and b differ
// by r or more; but the distance to a circle weighs the gradients by a unit vector: L = sqrt(La^2 +
// Lb^2).
template <class T> T blend_columns(T a, T b, T r, T n) {
    using std::floor;
    using std::sqrt;
    const T root2(1.41421356237309504880), half_root2(0.70710678118654752440);
    const T count = maximum(floor(n + T(0.5)), T(1));
    const T radius = maximum(r, T(0));
    const T c = radius * root2 / (T(2) * (count - T(1)) + root2);
    const T line = maximum(radius - (c + c) - gap(a, b), T(0)); // the chamfer behind them
    const T across = (a + b - (radius - (c + c))) * half_root2, along = (b - a) * half_root2;
    const T half = T(0.5) * (count - T(1));
    const T k =
        floor(along / maximum(c + c, T(min_radius)) + half + T(0.5)); // the nearest column's number
    const T y = along - (c + c) * (minimum(maximum(k, T(0)), count - T(1)) - half);
    const T column = sqrt(across * across + y * y) - c;
    return minimum(minimum(a, b) - T(0.5) * line, column);
}

// Hart 1996: superelliptic union within distance 1 of both: 1 - |((1-a)+, (1-b)+)|_p, and min
// further out. Written with the greater term divided out, so that no power overflows. By Hoelder L
// = (La^p + Lb^p)^(1/p). p is at least 1.
template <class T> T pseudonorm(T a, T b, T exponent) {
    using std::pow;
    const T p = maximum(exponent, T(1));
    const T u = maximum(T(1) - a, T(0)), v = maximum(T(1) - b, T(0));
    const T larger = maximum(u, v), ratio = minimum(u, v) / maximum(larger, T(min_radius));
    return maximum(T(1), minimum(a, b)) - larger * pow(T(1) + pow(ratio, p), T(1) / p);
}

} // namespace fathom::ir::sem
