// The interpreter's own sin, cos, atan and atan2 against the C library's in double precision.
#include "backend-cpu/kernels/trigonometry.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <limits>

using namespace fathom::cpu::base;

TEST_CASE("sine and cosine are right to a float's precision, for large angles too") {
    double worst_sine = 0, worst_cosine = 0;
    for (const double range : {1.0, 10.0, 1e3, 1e6, 1e9})
        for (int i = -20'000; i <= 20'000; ++i) {
            const float x = static_cast<float>(range * i / 20'000);
            worst_sine = std::max(worst_sine, std::abs(sine(x) - std::sin(double{x})));
            worst_cosine = std::max(worst_cosine, std::abs(cosine(x) - std::cos(double{x})));
        }
    CHECK(worst_sine < 1.3e-7);
    CHECK(worst_cosine < 1.3e-7);
    CHECK(sine(0.0f) == 0.0f);
    CHECK(cosine(0.0f) == 1.0f);
    CHECK(sine(1e-20f) == 1e-20f);
}

TEST_CASE("sine and cosine together are what they are alone, to the bit") {
    std::size_t wrong = 0;
    for (std::uint32_t i = 0; i < 1'000'000; ++i) {
        const auto x = std::bit_cast<float>(i * 4294u); // of every size and sign
        if (!(std::abs(x) < 3e15f)) continue;           // beyond, a sine is that of some angle
        const auto [s, c] = sine_cosine(x);
        wrong += std::bit_cast<std::uint32_t>(s) != std::bit_cast<std::uint32_t>(sine(x)) ||
                 std::bit_cast<std::uint32_t>(c) != std::bit_cast<std::uint32_t>(cosine(x));
    }
    CHECK(wrong == 0);
}

TEST_CASE("sine and cosine stay within -1 and 1 for any number, and are none of none") {
    for (float x = 1; x < std::numeric_limits<float>::max() / 3; x *= 1.7f) {
        CHECK(std::abs(sine(x)) <= 1);
        CHECK(std::abs(cosine(-x)) <= 1);
    }
    CHECK(std::isnan(sine(std::numeric_limits<float>::infinity())));
    CHECK(std::isnan(cosine(std::numeric_limits<float>::quiet_NaN())));
}

TEST_CASE("angles are right all around, on the axes, and at the origin") {
    double worst = 0;
    for (int i = 0; i < 100'000; ++i) {
        const double angle = i * 6.283185307179586e-5, radius = std::exp((i % 37) - 18);
        const float x = static_cast<float>(radius * std::cos(angle)),
                    y = static_cast<float>(radius * std::sin(angle));
        worst = std::max(worst, std::abs(arctangent(y, x) - std::atan2(double{y}, double{x})));
        worst = std::max(worst, std::abs(arctangent(y) - std::atan(double{y})));
    }
    CHECK(worst < 3.5e-7);
    const float pi = 3.14159274f, infinity = std::numeric_limits<float>::infinity();
    CHECK(arctangent(0.0f, 0.0f) == 0);
    CHECK(arctangent(-0.0f, -0.0f) == 0);
    CHECK(arctangent(0.0f, -2.0f) == pi);
    CHECK(arctangent(-0.0f, -2.0f) == pi); // the sign of a zero means nothing
    CHECK(arctangent(3.0f, 0.0f) == Approx(pi / 2));
    CHECK(arctangent(infinity) == Approx(pi / 2));
    CHECK(arctangent(infinity, infinity) == Approx(pi / 4));
    CHECK(std::isnan(arctangent(std::numeric_limits<float>::quiet_NaN(), 1.0f)));
}
