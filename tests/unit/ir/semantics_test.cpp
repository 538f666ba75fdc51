// What the ops promise: totality, ranges, slopes, the blends' support and contours, the hash's
// mixing.
#include "ir/semantics.h"
#include "tests/unit/ir/scenes.h"

#include <catch2/catch.hpp>

#include <set>

using namespace fathom;
using namespace fathom::test;

namespace {

template <class F> double slope(F f, P p) {
    const double e = 1e-5;
    double squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        P a = p, b = p;
        a[i] += e, b[i] -= e;
        squares += std::pow((f(a[0], a[1], a[2]) - f(b[0], b[1], b[2])) / (2 * e), 2);
    }
    return std::sqrt(squares);
}

// Continuous, within its range, and no steeper than certified; `steepest` of the bound is reached.
template <class F> void keeps(F f, double lo, double hi, double bound, double steepest) {
    Random random;
    double maximum = 0;
    for (int i = 0; i < 60000; ++i) {
        const P p = random.point(50);
        const double v = f(p[0], p[1], p[2]);
        if (v < lo || v > hi) FAIL("out of range: " << v);
        const double s = slope(f, p);
        if (s > bound * (1 + 1e-6)) FAIL("too steep: " << s);
        maximum = std::max(maximum, s);
    }
    CHECK(maximum >= steepest * bound);
}

} // namespace

TEST_CASE("mod, pow, atan and their like are total") {
    CHECK(sem::mod(-1.0, 3.0) == 2);
    CHECK(sem::mod(1.0, -3.0) == -2);
    CHECK(sem::mod(5.0, 0.0) == 5);
    CHECK(sem::pow(-2.0, 3.0) == -8);
    CHECK(sem::pow(-2.0, 2.0) == 4);
    CHECK(sem::pow(-2.0, 0.5) == 0);
    CHECK(sem::pow(0.0, 2.0) == 0);
    CHECK(sem::pow(0.0, 0.0) == 1);
    CHECK(std::isinf(sem::pow(0.0, -1.0)));
    CHECK(sem::sqrt(-1.0) == 0);
    CHECK(sem::asin(2.0) == Approx(std::asin(1.0)));
    CHECK(sem::acos(-2.0) == Approx(std::acos(-1.0)));
    CHECK(sem::atan2(0.0, 0.0) == 0);
    CHECK(sem::atan2(-0.0, -0.0) == 0);
    CHECK(sem::atan2(-0.0, -1.0) == Approx(std::acos(-1.0)));
    CHECK(sem::smoothstep(1.0, 1.0, 0.5) == 0);
    CHECK(sem::smoothstep(1.0, 1.0, 1.0) == 1);
    CHECK(sem::smoothstep(0.0, 2.0, 1.0) == 0.5);
    CHECK(sem::round(-0.5) == 0);
    CHECK(sem::round(0.5) == 1);
    CHECK(sem::sign(-0.0) == 0);
}

TEST_CASE("noise: range, slope, and how near the bound is") {
    keeps(sem::perlin<double>, -sem::perlin_range, sem::perlin_range, sem::perlin_slope, 0.75);
    keeps(sem::simplex<double>, -sem::simplex_range, sem::simplex_range, sem::simplex_slope, 0.7);
    keeps(sem::value_noise<double>, 0, 1, sem::value_noise_slope, 0.75);
    keeps(sem::worley<double>, 0, 1, sem::worley_slope, 0.99);
    const auto spots = [](double x, double y, double z) {
        return sem::spot_noise(x, y, z, 0.8, 1.0);
    };
    keeps(spots, -sem::spot_range, sem::spot_range, sem::spot_slope / 0.8, 0.05);
}

TEST_CASE("Perlin's slope of 3.75 is reached at a cell's centre") {
    // For some cell among many: all eight gradients point along one diagonal pair.
    double maximum = 0;
    for (int i = 0; i < 100000; ++i)
        maximum = std::max(maximum, slope(sem::perlin<double>,
                                          {i % 100 + 0.5, i / 100 % 100 + 0.5, i / 10000 + 0.5}));
    CHECK(maximum > 0.85 * 3.75);
    CHECK(maximum <= 3.75 + 1e-6);
}

TEST_CASE("noise is the same in float and double, seamless at cell walls, and defined far out") {
    Random random;
    for (int i = 0; i < 20000; ++i) {
        const P p = random.point(20);
        const float x = float(p[0]), y = float(p[1]), z = float(p[2]);
        CHECK(sem::perlin(x, y, z) == Approx(sem::perlin<double>(x, y, z)).margin(2e-5));
        CHECK(sem::simplex(x, y, z) == Approx(sem::simplex<double>(x, y, z)).margin(2e-4));
        CHECK(sem::worley(x, y, z) == Approx(sem::worley<double>(x, y, z)).margin(2e-5));
        CHECK(sem::value_noise(x, y, z) == Approx(sem::value_noise<double>(x, y, z)).margin(2e-5));
    }
    for (double far : {1e10, -1e10, 1e300}) CHECK(std::isfinite(sem::perlin(far, far, far)));
    CHECK(sem::perlin(3.0, -7.0, 12.0) == 0);
}

TEST_CASE("worley is min(1, distance to the nearest point), by search twice as wide") {
    Random random;
    int cut = 0;
    for (int i = 0; i < 20000; ++i) {
        const P p = random.point(30);
        double minimum = 1;
        const std::array<int, 3> cell{int(std::floor(p[0])), int(std::floor(p[1])),
                                      int(std::floor(p[2]))};
        for (int a = -2; a <= 2; ++a)
            for (int b = -2; b <= 2; ++b)
                for (int c = -2; c <= 2; ++c) {
                    const auto at = sem::worley_point<double>(
                        sem::hash_lattice(std::uint32_t(cell[0] + a), std::uint32_t(cell[1] + b),
                                          std::uint32_t(cell[2] + c), 0x1b56c4e9u));
                    minimum =
                        std::min(minimum, length(minus(p, {cell[0] + a + at.x, cell[1] + b + at.y,
                                                           cell[2] + c + at.z})));
                }
        CHECK(sem::worley(p[0], p[1], p[2]) == Approx(minimum));
        cut += minimum >= 1;
    }
    CHECK(cut < 60); // of 20,000
}

TEST_CASE("the hash: neighbours are independent, and equal numbers hash equal") {
    CHECK(sem::hash_word(0.0f) == sem::hash_word(-0.0f));
    std::set<std::uint32_t> seen;
    int n = 0;
    double mean = 0, beside = 0;
    for (int x = -20; x < 20; ++x)
        for (int y = -20; y < 20; ++y)
            for (int z = -20; z < 20; ++z, ++n) {
                const std::uint32_t h =
                    sem::hash_lattice(std::uint32_t(x), std::uint32_t(y), std::uint32_t(z), 0u);
                seen.insert(h);
                const double u = sem::unit<double>(h) - 0.5;
                const double w =
                    sem::unit<double>(sem::hash_lattice(std::uint32_t(x + 1), std::uint32_t(y),
                                                        std::uint32_t(z), 0u)) -
                    0.5;
                mean += u;
                beside += u * w * 12;
            }
    CHECK(seen.size() + 8 > std::size_t(n));
    CHECK(std::abs(mean / n) < 0.005);  // deviation 0.29/sqrt(64000) = 0.0011
    CHECK(std::abs(beside / n) < 0.02); // deviation 0.004
    // One bit in moves half the bits out.
    double flips = 0;
    for (std::uint32_t i = 0; i < 3200; ++i)
        flips +=
            std::popcount(sem::scramble(i * 77u) ^ sem::scramble((i * 77u) ^ (1u << (i % 32))));
    CHECK(flips / 3200 == Approx(16).margin(0.3));
}

TEST_CASE("blends: min outside their support, never above it, and as steep as said") {
    const auto all = [](int profile, double a, double b) {
        switch (static_cast<Profile>(profile)) {
        case Profile::Smooth: return sem::blend_smooth(a, b, 0.7);
        case Profile::Round: return sem::blend_round(a, b, 0.7);
        case Profile::Chamfer: return sem::blend_chamfer(a, b, 0.7);
        case Profile::Stairs: return sem::blend_stairs(a, b, 0.7, 3.0);
        case Profile::Columns: return sem::blend_columns(a, b, 0.7, 3.0);
        }
        return 0.0;
    };
    Random random;
    for (int profile = 0; profile < 5; ++profile) {
        const bool columns = static_cast<Profile>(profile) == Profile::Columns;
        double steepest = 0;
        for (int i = 0; i < 20000; ++i) {
            const double a = random.in(-2, 2), b = random.in(-2, 2);
            const double v = all(profile, a, b);
            CHECK(v <= std::min(a, b));
            if (std::abs(a - b) >= 0.7) CHECK(v == std::min(a, b));
            CHECK(v == Approx(all(profile, b, a)).margin(1e-12));
            // The sum of the weights' sizes: the slope where both gradients are parallel.
            const double e = 1e-7;
            const double wa = (all(profile, a + e, b) - v) / e,
                         wb = (all(profile, a, b + e) - v) / e;
            steepest =
                std::max(steepest, columns ? std::hypot(wa, wb) : std::abs(wa) + std::abs(wb));
        }
        CHECK(steepest == Approx(1).margin(1e-4));
    }
}

TEST_CASE("blends have the contour that they are named for") {
    const double r = 0.7;
    // Between the walls a = 0 and b = 0: points of the fillet's circle, of the chamfer's line, of
    // the steps, of the columns.
    for (double t = 0.05; t < 1.55; t += 0.1) {
        const double a = r - r * std::cos(t), b = r - r * std::sin(t);
        CHECK(sem::blend_round(a, b, r) == Approx(0).margin(1e-12));
    }
    for (double t = 0; t <= 1; t += 0.125)
        CHECK(sem::blend_chamfer(t * r, (1 - t) * r, r) == Approx(0).margin(1e-12));
    // Two steps: treads at b = 2r/3 for a in 0..r/3, and at b = r/3 for a in r/3..2r/3.
    for (double t = 0.01; t < 0.33; t += 0.05) {
        CHECK(sem::blend_stairs(t * r, 2 * r / 3, r, 2.0) == Approx(0).margin(1e-12));
        CHECK(sem::blend_stairs(r / 3 + t * r, r / 3, r, 2.0) == Approx(0).margin(1e-12));
    }
    // The columns' outermost reach is a tangent of a circle of radius c, and none comes past r.
    const double c = r * std::sqrt(2.0) / (4 + std::sqrt(2.0)), line = (r - 2 * c) / 2;
    CHECK(sem::blend_columns(line + c / std::sqrt(2.0), line + c / std::sqrt(2.0), r, 3.0) ==
          Approx(0).margin(1e-12));
    CHECK(sem::blend_smooth(r / 4, r / 4, r) == Approx(0).margin(1e-12));
}

TEST_CASE("blends with no radius are min") {
    for (double a : {-1.0, 0.3})
        for (double b : {-0.5, 0.3}) {
            CHECK(sem::blend_smooth(a, b, 0.0) == std::min(a, b));
            CHECK(sem::blend_round(a, b, 0.0) == std::min(a, b));
            CHECK(sem::blend_chamfer(a, b, 0.0) == std::min(a, b));
            CHECK(sem::blend_stairs(a, b, 0.0, 3.0) == std::min(a, b));
            CHECK(sem::blend_columns(a, b, 0.0, 3.0) == std::min(a, b));
        }
}
