// The interpreter's own exp, log, pow and hyperbolic functions against the C library's in double
// precision: over every 997th float, and all of them by FATHOM_EFFORT=997.
#include "backend-cpu/kernels/elementary.h"

#include "backend-cpu/kernels/kernel_rows.h"
#include "backend-cpu/kernels/kernels.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <random>

using namespace fathom::cpu::base;

namespace {

constexpr float infinity = std::numeric_limits<float>::infinity();

// In units in the last place that a float of the exact value's size has.
double units_off(float got, double exact) {
    if (std::isnan(exact)) return std::isnan(got) ? 0 : 1e9;
    if (static_cast<float>(exact) == got) return 0.5;
    const double size = std::abs(exact);
    if (!(size < 0x1p128)) return 1e9;
    int exponent = 0;
    std::frexp(size, &exponent);
    const double unit = std::ldexp(1.0, std::max(exponent - 24, -149));
    return std::abs((std::isinf(got) ? std::copysign(0x1p128, got) : double(got)) - exact) / unit;
}

struct Worst {
    double units = 0;
    float at = 0;
};
template <class Ours, class Exact> Worst worst(Ours ours, Exact exact) {
    Worst found;
    const auto stride = static_cast<std::uint64_t>(std::max(1, 997 / fathom::test::effort(1)));
    for (std::uint64_t bits = 0; bits < 0x1'0000'0000; bits += stride) {
        const auto x = std::bit_cast<float>(static_cast<std::uint32_t>(bits));
        const double units = units_off(ours(x), exact(double{x}));
        if (units > found.units) found = {units, x};
    }
    return found;
}

#define CHECK_UNITS(most, ours, exact)                                                             \
    do {                                                                                           \
        const Worst found = worst([](float x) { return ours; }, [](double x) { return exact; });   \
        INFO(#ours << " of " << found.at);                                                         \
        CHECK(found.units < most);                                                                 \
    } while (false)

} // namespace

TEST_CASE("exp, log and hyperbolic functions are right to 0.6 units in the last place") {
    CHECK_UNITS(0.6, functions::exp(x), std::exp(x));
    CHECK_UNITS(0.6, functions::exp2(x), std::exp2(x));
    CHECK_UNITS(0.6, functions::log(x), std::log(x < 0 ? 0 : x));
    CHECK_UNITS(0.6, functions::log2(x), std::log2(x < 0 ? 0 : x));
    CHECK_UNITS(0.6, functions::sinh(x), std::sinh(x));
    CHECK_UNITS(0.6, functions::cosh(x), std::cosh(x));
    CHECK_UNITS(0.6, functions::tanh(x), std::tanh(x));
}

TEST_CASE("pow is right to 0.6 units in the last place for any base and exponent") {
    std::mt19937 random{static_cast<std::mt19937::result_type>(fathom::test::seed())};
    std::uniform_real_distribution<float> exponent(-30, 30), wide(-149, 128), near(-1e-3f, 1e-3f);
    double most = 0;
    for (int i = 0; i < fathom::test::effort(500'000); ++i) {
        const float x = i % 3 == 0 ? 1 + near(random) : std::exp2(wide(random));
        const float by = i % 7 == 0 ? 1e5f * near(random) : exponent(random);
        const float y = i % 5 == 0 ? std::round(by) : by;
        const double units = units_off(functions::pow(x, y), std::pow(double{x}, double{y}));
        if (units > most) {
            most = units;
            UNSCOPED_INFO(x << " ^ " << y << ": " << units);
        }
    }
    CHECK(most < 0.6);
}

TEST_CASE("pow of 0, 1, negative numbers and infinities is what the language says") {
    const auto pow = [](float x, float y) { return functions::pow(x, y); };
    for (const float x : {-infinity, -2.5f, -1.0f, -0.0f, 0.0f, 1e-45f, 0.5f, 1.0f, 3.0f, infinity})
        for (const float y : {-infinity, -3.0f, -2.0f, -1.0f, -0.5f, -1e-40f, 0.0f, 0.5f, 1.0f,
                              2.0f, 3.0f, 1e30f, infinity}) {
            CAPTURE(x, y);
            const float want = static_cast<float>(fathom::ir::sem::pow(double{x}, double{y}));
            const float got = pow(x, y);
            const bool end = want == 0 || std::isinf(want); // the sign of a zero means nothing
            CHECK((end ? std::abs(got) == std::abs(want) : got == want));
        }
    CHECK(functions::log(0.0f) == -infinity);
    CHECK(functions::log(-1.0f) == -infinity);
    CHECK(functions::log2(infinity) == infinity);
    CHECK(functions::exp(-infinity) == 0);
    CHECK(functions::exp2(-149.0f) == 1e-45f);
    CHECK(functions::tanh(infinity) == 1);
}

TEST_CASE("inverse functions and the tangent are right to the units that the proof takes") {
    double sine = 0, cosine = 0, tangent = 0;
    const auto far_from = [](float got, double exact) {
        return std::abs(got - exact) * 0x1p23 / std::max(1.0, std::abs(exact));
    };
    for (int i = -1'000'000; i <= 1'000'000; ++i) {
        const float share = static_cast<float>(i) * 1e-6f;
        const float x =
            i % 2 == 0 ? share : std::copysign(1 - std::exp2(-40 * std::abs(share)), share);
        sine = std::max(sine, far_from(functions::asin(x), std::asin(double{x})));
        cosine = std::max(cosine, far_from(functions::acos(x), std::acos(double{x})));
        const float angle = i % 2 == 0 ? 3 * share : 1000 * share;
        const double t = std::tan(double{angle});
        tangent = std::max(tangent, std::abs(functions::tan(angle) - t) * 0x1p23 / (1 + t * t) /
                                        (4 + std::abs(angle)));
    }
    CHECK(sine < 2.5);
    CHECK(cosine < 2.5);
    CHECK(tangent < 1);
    CHECK(functions::asin(7.0f) == Approx(1.5707963f));
    CHECK(functions::acos(-7.0f) == Approx(3.1415927f));
    CHECK(functions::asin(1e-30f) == 1e-30f);
}

TEST_CASE("whole powers are products, each rounded once") {
    CHECK(power<2>(3.0f) == 9);
    CHECK(power<5>(-3.0f) == -243);
    CHECK(power<7>(1.1f) == Approx(std::pow(1.1, 7)).epsilon(4e-7));
    CHECK(power<8>(-2.0f) == 256);
}
