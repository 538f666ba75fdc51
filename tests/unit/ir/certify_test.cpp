// Proofs by branch and bound of the constants in noise.h that no one else has published: those of
// simplex noise and of spot noise, and all bends. Coarse enough to take a moment; each bound holds
// for every choice of gradients, weights and places.
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
template <class F> bool holds_in_simplex(double limit, long maximum, F bound) {
    std::vector<std::array<V, 4>> rest{simplex_corners()};
    for (long cells = 0; !rest.empty(); ++cells) {
        if (cells == maximum) return false;
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
    const double peak = 1 / std::sqrt(5.0), maximum = 96 / (25 * std::sqrt(5.0));
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
                const double minimum = std::max({lo, -hi, 0.0}),
                             maximum = std::max(std::abs(lo), std::abs(hi));
                near += minimum * minimum;
                far += maximum * maximum;
            }
            // The distances of all p in the piece.
            near = std::max(std::sqrt(near) - radius, 0.0), far = std::sqrt(far) + radius;
            if (near >= 1) continue;
            steep += near > peak ? slope(near) : far < peak ? slope(far) : maximum;
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

namespace {

// Values and first two derivatives of the quintic and of 1 less it, each least and greatest.
struct Range {
    double lo = 0, hi = 0;
    double magnitude() const { return std::max(std::abs(lo), std::abs(hi)); }
};
Range operator+(Range a, Range b) { return {a.lo + b.lo, a.hi + b.hi}; }
Range operator*(Range a, Range b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return {std::min(std::min(p, q), std::min(r, s)), std::max(std::max(p, q), std::max(r, s))};
}
Range operator*(double s, Range a) {
    return s < 0 ? Range{s * a.hi, s * a.lo} : Range{s * a.lo, s * a.hi};
}
using Fades = std::array<std::array<std::array<Range, 3>, 2>, 3>; // by axis, corner, derivative

// Over the cube about c, in 0..1/2 along each axis: there all three grow, but for the second, which
// falls from 1/2 - sqrt(3)/6 on.
Fades fades(V c, double half) {
    const auto second = [](double t) { return 60 * t * (1 - t) * (1 - 2 * t); };
    const auto first = [](double t) { return 30 * t * t * (1 - t) * (1 - t); };
    const double top = 0.5 - std::sqrt(3.0) / 6;
    Fades out;
    for (std::size_t i = 0; i < 3; ++i) {
        const double a = c[i] - half, b = c[i] + half;
        const Range value{sem::fade(a), sem::fade(b)}, slope{first(a), first(b)},
            bend{std::min(second(a), second(b)),
                 a <= top && top <= b ? second(top) : std::max(second(a), second(b))};
        out[i][1] = {value, slope, bend};
        out[i][0] = {Range{1, 1} + -1 * value, -1 * slope, -1 * bend};
    }
    return out;
}

// The most that the second derivative along u can be in the cube, whatever the corners hold. With w
// a corner's weight, along u w' and w'': of a gradient g there the part w (g.d) has the second
// derivative g.(w'' d + 2 w' u); of a value v in 0..1 the part is w'' v, and as all w'' add up to
// 0, the most is half of the sum of their sizes.
double bend_along(V u, V c, double half, bool gradients) {
    const Fades f = fades(c, half);
    double all = 0;
    for (std::size_t corner = 0; corner < 8; ++corner) {
        const std::array<std::size_t, 3> at{corner & 1, corner >> 1 & 1, corner >> 2};
        const auto &x = f[0][at[0]], &y = f[1][at[1]], &z = f[2][at[2]];
        const Range flat = x[0] * y[0];
        const Range slope =
            u[0] * (x[1] * y[0] * z[0]) + u[1] * (x[0] * y[1] * z[0]) + u[2] * (flat * z[1]);
        const Range bend = u[0] * u[0] * (x[2] * y[0] * z[0]) + u[1] * u[1] * (x[0] * y[2] * z[0]) +
                           u[2] * u[2] * (flat * z[2]) + 2 * u[0] * u[1] * (x[1] * y[1] * z[0]) +
                           2 * u[0] * u[2] * (x[1] * y[0] * z[1]) +
                           2 * u[1] * u[2] * (x[0] * y[1] * z[1]);
        if (!gradients) {
            all += bend.magnitude() / 2;
            continue;
        }
        V g{};
        for (std::size_t i = 0; i < 3; ++i) {
            const double d = c[i] - double(at[i]);
            g[i] = (bend * Range{d - half, d + half} + 2 * u[i] * slope).magnitude();
        }
        all += by_gradients(g);
    }
    return all;
}

// For the symmetric matrix H of second derivatives and a unit u at an angle a from the direction in
// which |u.Hu| is greatest, |u.Hu| >= cos(2a) times that. So directions that lie everywhere within
// a of one another, and each below limit*cos(2a), prove the limit. By mirrors a corner's eighth of
// the cell and half of the directions do; by permutations those with |ux| >= |uy| >= |uz|.
bool bends_less(double limit, int grid, long maximum, bool gradients) {
    for (int j = 0; j < grid; ++j)
        for (int k = -j - 1; k <= j; ++k)
            for (double sign : {1.0, -1.0}) {
                const double y = (j + 0.5) / grid, z = (k + 0.5) / grid;
                const V u = times(1 / size({1, y, z}), {1, sign * y, z});
                double angle = 0;
                for (int c = 0; c < 4; ++c) {
                    const V v{1, sign * (y + (c & 1 ? 0.5 : -0.5) / grid),
                              z + (c & 2 ? 0.5 : -0.5) / grid};
                    angle = std::max(angle, std::acos(std::min(dot(u, v) / size(v), 1.0)));
                }
                const double along = limit * std::cos(2 * angle) * (1 - 1e-9);
                std::vector<std::pair<V, double>> rest{{{0.25, 0.25, 0.25}, 0.25}};
                while (!rest.empty()) {
                    const auto [p, half] = rest.back();
                    rest.pop_back();
                    if (--maximum < 0) return false;
                    if (bend_along(u, p, half, gradients) <= along) continue;
                    for (int c = 0; c < 8; ++c) {
                        const double h = half / 2;
                        rest.push_back(
                            {sum(p, {c & 1 ? h : -h, c & 2 ? h : -h, c & 4 ? h : -h}), h});
                    }
                }
            }
    return true;
}

} // namespace

// What is seen: the gradients and values that make it are among those that corners have.
TEST_CASE("gradient noise's second derivatives along lines") {
    const V steepest = times(1 / size({1, 1, 0.978}), {-1, 1, 0.978});
    CHECK(bend_along(steepest, {0.3992, 0.3992, 0.5}, 0, true) > 14.46);
    CHECK(bends_less(sem::perlin_bend, 9, 8'000'000, true));
}
TEST_CASE("value noise's second derivatives along lines") {
    CHECK(bend_along({std::sqrt(0.5), -std::sqrt(0.5), 0}, {0.5, 0.5, 0.145}, 0, false) > 7.03);
    CHECK(bends_less(sem::value_noise_bend, 9, 2'000'000, false));
}
