// exp, log, pow and the hyperbolic functions of floats as straight arithmetic, so that loops over
// them vectorise. All of it is computed in double precision and rounded once, at the end: each is
// right to 0.6 units in the last place of a float, subnormal ones included (tests/unit/cpu/
// elementary_test.cpp asks all floats), and the same in every instruction set, since nothing here
// may be contracted or reordered. The polynomials are minimax fits of ours, their errors given.
#pragma once

#include <bit>
#include <cstdint>
#include <limits>

#ifndef FATHOM_ISA
#define FATHOM_ISA base
#endif

namespace fathom::cpu::FATHOM_ISA {

inline constexpr double log_of_2 = 0.693147180559945309417;
inline constexpr double no_float = 200; // 2^200 and e^200 are no floats; e^-200 rounds to 0

inline double within_floats(double x) { // NaN stays what it is
    x = x < -no_float ? -no_float : x;
    return x > no_float ? no_float : x;
}

// e^rest - 1 and 2^whole, |rest| <= log(2)/2: all that e^x = 2^whole e^rest is made of.
struct Growth {
    double rest, scale;
};

// `whole` is a small whole number plus 1.5 * 2^52, so that its last bits are that number's.
inline Growth growth(double rest, double whole) {
    // (e^r - 1)/r = 1 + r Q(r), error 4.7e-10
    const double q = 1.99075877266297e-04 * rest + 1.3933652192531015e-03;
    const double tail =
        0.5000000013469784 +
        rest * (0.16666666756474335 +
                rest * (0.04166646489897016 + rest * (8.3332860022666e-03 + rest * q)));
    const auto bits = (std::bit_cast<std::uint64_t>(whole) + 1023) << 52;
    return {rest + rest * rest * tail, std::bit_cast<double>(bits)};
}
inline constexpr double to_whole = 6755399441055744.0; // adding 1.5 * 2^52 rounds to a whole number

inline Growth growth_of_e(double x) { // |x| <= no_float
    constexpr double high = 0.693147180369123816490, low = 1.90821492927058770002e-10;
    const double whole = x * (1 / log_of_2) + to_whole, n = whole - to_whole;
    return growth((x - n * high) - n * low, whole);
}
inline double power_of_e(double x) {
    const Growth g = growth_of_e(x);
    return g.scale + g.scale * g.rest;
}
inline double power_of_e_less_1(double x) {
    const Growth g = growth_of_e(x);
    return (g.scale - 1) + g.scale * g.rest;
}
inline double power_of_2(double x) { // |x| <= no_float
    const double whole = x + to_whole;
    const Growth g = growth((x - (whole - to_whole)) * log_of_2, whole);
    return g.scale + g.scale * g.rest;
}

// x = 2^n m with m in sqrt(1/2)..sqrt(2), of x > 0; log m = 2 atanh s = 2 s + s^3 L(s^2),
// s = (m - 1)/(m + 1), error 3.4e-11 s.
struct Logarithm {
    double whole, rest; // log x = whole log(2) + rest
};
inline Logarithm logarithm(double x) {
    constexpr std::uint64_t one = 0x3ff0000000000000, root_half = 0x3fe6a09e667f3bcd,
                            exponent = 0xfff0000000000000, two_to_52 = 0x4330000000000000;
    const auto bits = std::bit_cast<std::uint64_t>(x);
    const std::uint64_t above = bits - root_half + one; // its exponent is that of m + 1023
    const auto m = std::bit_cast<double>(bits - (above & exponent) + one);
    const double n = std::bit_cast<double>((above >> 52) | two_to_52) - (4503599627370496.0 + 1023);
    const double s = (m - 1) / (m + 1), u = s * s;
    const double l = 0.6666666655297427 +
                     u * (0.4000012279127651 + u * (0.28550732867450723 + u * 0.23332498092065648));
    return {n, s + s + s * u * l};
}
// 0 and infinity have no exponent of their own.
inline double with_ends(double log, double x) {
    constexpr double endless = std::numeric_limits<double>::infinity();
    log = x > 0 ? log : -endless;
    return x < endless ? log : x; // infinity, NaN
}
inline double log_to_2(double x) {
    const Logarithm l = logarithm(x);
    return with_ends(l.whole + l.rest * (1 / log_of_2), x);
}

// -- the functions of ir/semantics.h; the arguments of logarithms are 0 and above

inline float exponential(float x) { return static_cast<float>(power_of_e(within_floats(x))); }
inline float exponential2(float x) { return static_cast<float>(power_of_2(within_floats(x))); }
inline float logarithm_e(float x) {
    const Logarithm l = logarithm(x);
    return static_cast<float>(with_ends(l.whole * log_of_2 + l.rest, x));
}
inline float logarithm_2(float x) { return static_cast<float>(log_to_2(x)); }

// size^y, size >= 0
inline float power_of_size(float size, float y) {
    const double exponent = y * log_to_2(size);
    const auto power = static_cast<float>(power_of_2(within_floats(exponent)));
    const bool one = (y == 0) | (size == 1); // also 0 times an infinity
    return one ? 1.0f : power;
}

// With g = e^|x| - 1: sinh |x| = (g + g/(g + 1))/2, tanh |x/2| = g/(g + 2); no digit is lost at 0.
inline float sine_hyperbolic(float x) {
    const double g = power_of_e_less_1(within_floats(x < 0 ? -x : x));
    const auto size = static_cast<float>(0.5 * (g + g / (g + 1)));
    return x < 0 ? -size : size;
}
inline float cosine_hyperbolic(float x) {
    const double e = power_of_e(within_floats(x));
    return static_cast<float>(0.5 * (e + 1 / e));
}
inline float tangent_hyperbolic(float x) {
    const double g = power_of_e_less_1(within_floats(2.0 * (x < 0 ? -x : x)));
    const auto size = static_cast<float>(g / (g + 2));
    return x < 0 ? -size : size;
}

} // namespace fathom::cpu::FATHOM_ISA
