// The meaning of every scalar op, once, as templates over the number type; all evaluators and the
// folding of constants are made from these (vectors are by component). Total: every argument has a
// stated result. Noise and blends stand in headers of their own. Knows nothing of graphs.
//
// T is float, double, or someone's dual number or interval with + - * /, comparison, `plain`, and
// floor, sqrt, sin, … by ADL. Choices are written as ?: on values already computed, so that loops
// over batches vectorise.
#pragma once

#include "ir/blends.h"
#include "ir/noise.h"

#include <cmath>
#include <cstdint>
#include <limits>

namespace fathom::ir::sem {

// -- ints: 32 bits, saturating

// The nearest int: where 32 bits do not suffice, the first or last one; 0 for NaN. Truncates.
constexpr std::int32_t saturate(double x) {
    return x >= 2147483647.0    ? std::numeric_limits<std::int32_t>::max()
           : x <= -2147483648.0 ? std::numeric_limits<std::int32_t>::min()
           : x != x             ? 0
                                : static_cast<std::int32_t>(x);
}
constexpr std::int32_t int_add(std::int32_t x, std::int32_t y) {
    return saturate(double(x) + double(y));
}
constexpr std::int32_t int_sub(std::int32_t x, std::int32_t y) {
    return saturate(double(x) - double(y));
}
constexpr std::int32_t int_mul(std::int32_t x, std::int32_t y) {
    return saturate(double(x) * double(y));
}
constexpr std::int32_t int_neg(std::int32_t x) { return saturate(-double(x)); }
// Truncates; x/0 = 0.
constexpr std::int32_t int_div(std::int32_t x, std::int32_t y) {
    return y == 0 ? 0 : saturate(double(x) / double(y));
}
// x - y*floor(x/y): the sign of y; x mod 0 = x (Knuth's convention).
constexpr std::int32_t int_mod(std::int32_t x, std::int32_t y) {
    if (y == 0 || y == -1) return y == 0 ? x : 0;
    const std::int32_t rest = x % y;
    return rest != 0 && (rest < 0) != (y < 0) ? rest + y : rest;
}

// -- arithmetic

template <class T> T min(T x, T y) { return y < x ? y : x; }
template <class T> T max(T x, T y) { return x < y ? y : x; }
template <class T> T abs(T x) { return x < T(0) ? -x : x; }
template <class T> T sign(T x) { return x < T(0) ? T(-1) : (T(0) < x ? T(1) : T(0)); }
template <class T> T step(T edge, T x) { return x < edge ? T(0) : T(1); }
template <class T> T clamp(T x, T lo, T hi) {
    const T low = x < lo ? lo : x;
    return hi < low ? hi : low;
}
template <class T> T mix(T a, T b, T t) { return a * (T(1) - t) + b * t; }
template <class T> T fract(T x) {
    using std::floor;
    return x - floor(x);
}
// Halves upward, so that it is the same on every machine.
template <class T> T round(T x) {
    using std::floor;
    return floor(x + T(0.5));
}

// x - y*floor(x/y): the sign of y, 0 <= result/y < 1. x mod 0 = x (Knuth's convention).
template <class T> T mod(T x, T y) {
    using std::floor;
    const T divisor = y == T(0) ? T(1) : y;
    const T rest = x - y * floor(x / divisor);
    return y == T(0) ? x : rest;
}

// t^2 (3 - 2t), t = clamp((x - lo)/(hi - lo), 0, 1); slope at most 1.5/|hi - lo|. lo = hi: step(lo,
// x).
template <class T> T smoothstep(T lo, T hi, T x) {
    const T width = lo == hi ? T(1) : hi - lo;
    const T t = clamp((x - lo) / width, T(0), T(1));
    return lo == hi ? step(lo, x) : t * t * (T(3) - T(2) * t);
}

// -- powers and roots

// x^y from |x|^y.
template <class T> T power_of(T x, T y, T power) {
    using std::floor;
    const T half = y * T(0.5);
    const bool whole = floor(y) == y, even = floor(half) == half;
    return x < T(0) ? (whole ? (even ? power : -power) : T(0)) : power;
}
// Defined for all arguments:
//   x > 0   exp(y log x)
//   x = 0   1 for y = 0, 0 for y > 0, +infinity for y < 0
//   x < 0   whole y: |x|^y, negated where y is odd (so x^2 and x^3 are what they look like);
//           other y: 0
template <class T> T pow(T x, T y) {
    using std::pow;
    return power_of(x, y, pow(abs(x), y));
}

template <class T> T sqrt(T x) { // 0 below 0
    using std::sqrt;
    return sqrt(max(x, T(0)));
}
template <class T> T inversesqrt(T x) { return T(1) / sem::sqrt(x); } // +infinity at 0 and below
template <class T> T exp(T x) {
    using std::exp;
    return exp(x);
}
template <class T> T exp2(T x) {
    using std::exp2;
    return exp2(x);
}
template <class T> T log(T x) { // -infinity at 0 and below
    using std::log;
    return log(max(x, T(0)));
}
template <class T> T log2(T x) {
    using std::log2;
    return log2(max(x, T(0)));
}

// -- angles

template <class T> T sin(T x) {
    using std::sin;
    return sin(x);
}
template <class T> T cos(T x) {
    using std::cos;
    return cos(x);
}
template <class T> T tan(T x) {
    using std::tan;
    return tan(x);
}
template <class T> T asin(T x) {
    using std::asin;
    return asin(clamp(x, T(-1), T(1)));
}
template <class T> T acos(T x) {
    using std::acos;
    return acos(clamp(x, T(-1), T(1)));
}
template <class T> T atan(T x) {
    using std::atan;
    return atan(x);
}
// The angle of (x, y) in (-pi, pi]; 0 at the origin. The sign of a zero means nothing: adding +0
// takes it away.
template <class T> T atan2(T y, T x) {
    using std::atan2;
    return atan2(y + T(0), x + T(0));
}

// -- hyperbolic functions

template <class T> T sinh(T x) {
    using std::sinh;
    return sinh(x);
}
template <class T> T cosh(T x) {
    using std::cosh;
    return cosh(x);
}
template <class T> T tanh(T x) {
    using std::tanh;
    return tanh(x);
}

// -- vectors

// What a vector of that squared length is multiplied by to be normalised: 0 for the zero vector.
template <class T> T normalizer(T squared_length) {
    using std::sqrt;
    const T some = T(0) < squared_length ? squared_length : T(1);
    return T(0) < squared_length ? T(1) / sqrt(some) : T(0);
}

// floor, ceil and trunc are the functions of those names in <cmath>, or those found by ADL.

// A division by zero is IEEE's (an infinity, or NaN for 0/0). NaN in gives an unspecified number
// out.

} // namespace fathom::ir::sem
