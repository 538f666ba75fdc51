// Proofs by branch and bound of the constants in noise.h that no one else has published: those of
// simplex noise and of spot noise. Coarse enough to take a moment; each bound holds for every
// choice of gradients, weights and places.
#include "ir/noise.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <vector>

using namespace fathom::ir;

namespace {

using V = std::array<double, 3>;
V sum(V a, V b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
V times(double s, V a) { return {s * a[0], s * a[1], s * a[2]}; }
V less(V a, V b) { return sum(a, times(-1, b)); }
double dot(V a, V b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double size(V a) { return std::sqrt(dot(a, a)); }

// max g.w over the 12 gradients (+-1, +-1, 0) and its permutations: the two greatest of |w|.
double by_gradients(V w) {
    const double a = std::abs(w[0]), b = std::abs(w[1]), c = std::abs(w[2]);
    return a + b + c - std::min({a, b, c});
}

// One tetrahedron of the simplex lattice; the others are its images under permutations and
// translations, which keep the set of gradients.
std::array<V, 4> simplex_corners() {
    std::array<V, 4> corners{{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {1, 1, 1}}};
    for (V &c : corners) c = less(c, times((c[0] + c[1] + c[2]) / 6, {1, 1, 1}));
    return corners;
}

// Whether bound(centre, radius) <= limit everywhere in the tetrahedron, halving the longest edge
// where it is not yet. Counted.
template <class F> bool holds_in_simplex(double limit, long most, F bound) {
    std::vector<std::array<V, 4>> rest{simplex_corners()};
    for (long cells = 0; !rest.empty(); ++cells) {
        if (cells == most) return false;
        std::array<V, 4> t = rest.back();
        rest.pop_back();
        const V centre = times(0.25, sum(sum(t[0], t[1]), sum(t[2], t[3])));
        double radius = 0, longest = 0;
        for (const V &v : t) radius = std::max(radius, size(less(v, centre)));
        if (bound(centre, radius) <= limit) continue;
        std::size_t a = 0, b = 1;
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t j = i + 1; j < 4; ++j)
                if (const double l = size(less(t[i], t[j])); l > longest) longest = l, a = i, b = j;
        const V middle = times(0.5, sum(t[a], t[b]));
        std::array<V, 4> u = t;
        t[a] = u[b] = middle;
        rest.push_back(t);
        rest.push_back(u);
    }
    return true;
}

} // namespace

// A corner's part is h = S s^4 (g.d), s = 1/2 - d^2. grad h = S s^3 (s g - 8 (g.d) d), at most S
// sqrt2 s^3 max(s, |s - 8d^2|); its derivative is at most S sqrt2 (24 s^3 |d| + 48 s^2 |d|^3). Here
// each corner's worst gradient counts, whatever its direction: that proves 9.1. With one common
// direction for all four (the maximum over 1,500 directions on the half-sphere, divided by the
// cosine of their covering angle, 0.065) the same search over 722,000 cells proves 7.4.
TEST_CASE("simplex noise's slope, coarsely") {
    const std::array<V, 4> corners = simplex_corners();
    const double scale = sem::simplex_scale * std::sqrt(2.0);
    CHECK(holds_in_simplex(9.1, 400000, [&](V x, double radius) {
        double slope = 0, bend = 0;
        for (const V &c : corners) {
            const double q = dot(less(x, c), less(x, c)), d = std::sqrt(q),
                         s = std::max(0.5 - q, 0.0);
            slope += s * s * s * std::max(s, std::abs(s - 8 * q));
            const double near = std::max(d - radius, 0.0), far = d + radius,
                         t = std::max(0.5 - near * near, 0.0);
            bend += 24 * t * t * t * far + 48 * t * t * far * far * far;
        }
        return scale * (slope + radius * bend);
    }));
}

// The values' sum at a cell's centre, and the slope proved above for the rest of it.
TEST_CASE("simplex noise's range") {
    const std::array<V, 4> corners = simplex_corners();
    CHECK(holds_in_simplex(1.05, 400000, [&](V x, double radius) { // 1.0 takes 1.3 million cells
        double value = 0;
        for (const V &c : corners) {
            const V d = less(x, c);
            const double s = std::max(0.5 - dot(d, d), 0.0);
            value += s * s * s * s * by_gradients(d);
        }
        return sem::simplex_scale * value + radius * 9.1;
    }));
}

// Over p in a cell: what one spot in each of the 27 cells can do at most, by the least and greatest
// distance to the cell. A spot's slope 6t(1-t^2)^2 is greatest at t^2 = 1/5 and itself changes by
// at most 6 where it grows, 4.8 where it falls; by symmetry an eighth of the cell does.
TEST_CASE("spot noise's slope and range") {
    const double peak = 1 / std::sqrt(5.0), most = 96 / (25 * std::sqrt(5.0));
    const auto slope = [](double t) { return 6 * t * (1 - t * t) * (1 - t * t); };
    struct Cell {
        V p;
        double half;
    };
    std::vector<Cell> rest{{{0.25, 0.25, 0.25}, 0.25}};
    long cells = 0;
    while (!rest.empty() && ++cells < 400000) {
        const Cell cell = rest.back();
        rest.pop_back();
        double steep = 0, high = 0;
        const double radius = cell.half * std::sqrt(3.0);
        for (int k = 0; k < 27; ++k) {
            const int at[3] = {k % 3 - 1, k / 3 % 3 - 1, k / 9 - 1};
            double near = 0, far = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double lo = at[i] - cell.p[i], hi = lo + 1;
                const double least = std::max({lo, -hi, 0.0}),
                             greatest = std::max(std::abs(lo), std::abs(hi));
                near += least * least;
                far += greatest * greatest;
            }
            // The distances of all p in the piece.
            near = std::max(std::sqrt(near) - radius, 0.0), far = std::sqrt(far) + radius;
            if (near >= 1) continue;
            steep += near > peak ? slope(near) : far < peak ? slope(far) : most;
            high += std::pow(1 - near * near, 3);
        }
        if (steep <= sem::spot_slope && high <= sem::spot_range) continue;
        for (int k = 0; k < 8; ++k) {
            const double h = cell.half / 2;
            rest.push_back({{cell.p[0] + (k & 1 ? h : -h), cell.p[1] + (k & 2 ? h : -h),
                             cell.p[2] + (k & 4 ? h : -h)},
                            h});
        }
    }
    CHECK(rest.empty());
}
