// The kernels of kernels.def over ranges: what each *float* evaluation of a kernel lies within when
// its inputs lie within theirs. No number is exact here, every statement is about the floats that
// the point kernels compute:
//
//   Rounding is monotone. So where an operation is correctly rounded and monotone in each input
//   (+ - * / sqrt min max floor), the same operation on the right ends of the ranges encloses its
//   floats to the bit, and nothing has to be rounded outward. What is built from several such, and
//   only as a real function monotone, or is computed by a polynomial, is widened by `few` parts of
//   its size, several times its error.
//
// Ints and truths are ranges of numbers too: of ints only those up to 2^24 are kept apart (a float
// holds them exactly), a truth is 0..1. A range with an end that is no number is everything, and
// everything stays so as long as a NaN could come of it. Compiled once for each instruction set.
#pragma once

#include "backend-cpu/kernels/kernel_rows.h"

#include <limits>

namespace fathom::cpu::FATHOM_ISA {

// A closed interval of floats, lo <= hi; ends may be infinite.
struct Range {
    float lo, hi;
};

namespace range {

inline constexpr float endless = std::numeric_limits<float>::infinity();
inline constexpr float few = 1e-6f;      // some eight units in the last place
inline constexpr float whole = 16777216; // 2^24

inline float lesser(float a, float b) { return b < a ? b : a; }
inline float greater(float a, float b) { return a < b ? b : a; }
inline float size(Range a) { return greater(-a.lo, a.hi); } // max |x|

inline Range tidy(float lo, float hi) {
    return {lo == lo ? lo : -endless, hi == hi ? hi : endless};
}
inline Range everything() { return {-endless, endless}; }
inline bool is_everything(Range a) { return a.lo == -endless && a.hi == endless; }
inline Range hull(Range a, Range b) { return {lesser(a.lo, b.lo), greater(a.hi, b.hi)}; }
inline Range widen(Range a, float by) { return tidy(a.lo - by, a.hi + by); }
inline Range widen(Range a) { // by a few parts of its ends, and the least floats
    return tidy(a.lo - (few * sem::abs(a.lo) + 1e-37f), a.hi + (few * sem::abs(a.hi) + 1e-37f));
}
inline Range within(Range a, float lo, float hi) { // what is known of a from elsewhere
    return {lesser(greater(a.lo, lo), hi), greater(lesser(a.hi, hi), lo)};
}

inline Range neg(Range a) { return {-a.hi, -a.lo}; }
inline Range add(Range a, Range b) { return tidy(a.lo + b.lo, a.hi + b.hi); }
inline Range sub(Range a, Range b) { return tidy(a.lo - b.hi, a.hi - b.lo); }
inline Range mul(Range a, Range b) {
    const float p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    const bool bad = p != p || q != q || r != r || s != s; // 0 times an infinity
    const float lo = lesser(lesser(p, q), lesser(r, s)), hi = greater(greater(p, q), greater(r, s));
    return {bad ? -endless : lo, bad ? endless : hi};
}
inline Range div(Range a, Range b) {
    const float p = a.lo / b.lo, q = a.lo / b.hi, r = a.hi / b.lo, s = a.hi / b.hi;
    const bool bad = (b.lo <= 0 && b.hi >= 0) || p != p || q != q || r != r || s != s;
    const float lo = lesser(lesser(p, q), lesser(r, s)), hi = greater(greater(p, q), greater(r, s));
    return {bad ? -endless : lo, bad ? endless : hi};
}
inline Range minimum(Range a, Range b) { return {lesser(a.lo, b.lo), lesser(a.hi, b.hi)}; }
inline Range maximum(Range a, Range b) { return {greater(a.lo, b.lo), greater(a.hi, b.hi)}; }
inline Range abs(Range a) { return {greater(greater(a.lo, -a.hi), 0), size(a)}; }
inline Range square(Range a) {
    const Range m = abs(a);
    return {m.lo * m.lo, m.hi * m.hi};
}
inline Range sqrt(Range a) { return {sem::sqrt(a.lo), sem::sqrt(a.hi)}; }
inline Range length(Range x, Range y) { return sqrt(add(square(x), square(y))); }
inline Range length(Range x, Range y, Range z) {
    return sqrt(add(add(square(x), square(y)), square(z)));
}
inline Range ball(Range x, Range y, Range z, Range cx, Range cy, Range cz, Range r) {
    return sub(length(sub(x, cx), sub(y, cy), sub(z, cz)), r);
}

// One of our functions, which are right to a few units, that rises or falls.
template <class F> Range rising(F f, Range a) { return widen(tidy(f(a.lo), f(a.hi))); }
template <class F> Range falling(F f, Range a) { return widen(tidy(f(a.hi), f(a.lo))); }

// x - y*floor(x/y). In one period of a fixed y it rises with x, step by step. Else it lies between
// 0 and y, but for the rounding of x/y and of y*floor(x/y), both parts of x.
inline Range mod(Range x, Range y) {
    const float n = std::floor(x.lo / y.lo);
    if (y.lo == y.hi && y.lo > 0 && n == std::floor(x.hi / y.lo))
        return tidy(x.lo - y.lo * n, x.hi - y.lo * n);
    const float rounding = few * (size(x) + size(y));
    const Range zero_to_y = {lesser(y.lo, 0) - rounding, greater(y.hi, 0) + rounding};
    const Range all = y.lo <= 0 && y.hi >= 0 ? hull(zero_to_y, x) : zero_to_y; // x mod 0 = x
    return tidy(all.lo, all.hi);
}

// Along each of its arguments pow rises or falls all the way, for bases of 0 and above; so it is
// extreme at corners. Other bases: whole exponents alone.
inline Range pow(Range x, Range y) {
    const auto positive = [&](Range base) {
        const float p = power_of_size(base.lo, y.lo), q = power_of_size(base.lo, y.hi),
                    r = power_of_size(base.hi, y.lo), s = power_of_size(base.hi, y.hi);
        if (p != p || q != q || r != r || s != s) return everything();
        return widen({lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s))});
    };
    if (x.lo >= 0) return positive(x);
    if (y.lo != y.hi || std::floor(y.lo) != y.lo || y.lo < 0) return everything();
    const Range size = positive(abs(x));
    if (std::floor(y.lo * 0.5f) == y.lo * 0.5f) return size;
    const Range below = positive({0, -x.lo}), above = positive({0, greater(x.hi, 0)});
    return {-below.hi, x.hi < 0 ? -positive({-x.hi, -x.lo}).lo : above.hi};
}

// Products are correctly rounded, so whole powers rise to the bit with |x|.
template <int n> Range power(Range a) {
    const Range x = n % 2 == 0 ? abs(a) : a;
    return {cpu::FATHOM_ISA::power<n>(x.lo), cpu::FATHOM_ISA::power<n>(x.hi)};
}

// Over a box without the origin the angle is extreme at corners, unless the box crosses the
// negative x axis, where it is discontinuous.
inline Range atan2(Range y, Range x) {
    if ((x.lo <= 0 && y.lo <= 0 && y.hi >= 0) || is_everything(x) || is_everything(y))
        return {-3.1416f, 3.1416f};
    const float p = arctangent(y.lo, x.lo), q = arctangent(y.lo, x.hi), r = arctangent(y.hi, x.lo),
                s = arctangent(y.hi, x.hi);
    return widen(tidy(lesser(lesser(p, q), lesser(r, s)), greater(greater(p, q), greater(r, s))),
                 4e-6f);
}
// cos over lo..hi: extreme at the ends and at the multiples of pi between, 1 at even ones.
// Multiples are counted generously.
inline Range cosine_of(double lo, double hi) {
    constexpr double pi = 3.14159265358979323846;
    if (!(hi - lo < 2 * pi && lo > -1e9 && hi < 1e9)) return {-1 - few, 1 + few};
    const double slack = 1e-7 * (1 + sem::abs(lo) + sem::abs(hi));
    const double before = std::floor((lo - slack) / pi), last = std::floor((hi + slack) / pi);
    const float a = static_cast<float>(std::cos(lo)), b = static_cast<float>(std::cos(hi));
    const bool even = std::floor(last / 2) * 2 == last, some = last > before,
               both = last > before + 1;
    return {(both || (some && !even) ? -1 : lesser(a, b)) - few,
            (both || (some && even) ? 1 : greater(a, b)) + few};
}
inline Range cos(Range a) { return cosine_of(a.lo, a.hi); }
inline Range sin(Range a) {
    constexpr double half_pi = 1.57079632679489661923;
    return cosine_of(a.lo - half_pi, a.hi - half_pi);
}
inline Range tan(Range a) { // rises between its poles at pi/2 + k pi
    constexpr double pi = 3.14159265358979323846;
    const double from = std::floor(a.lo / pi + 0.5 - 1e-6), to = std::floor(a.hi / pi + 0.5 + 1e-6);
    if (from != to || size(a) > 1e4f) return everything();
    return rising([](float x) { return functions::tan(x); }, a);
}

inline Range inversesqrt(Range a) { return {sem::inversesqrt(a.hi), sem::inversesqrt(a.lo)}; }
inline Range exp(Range a) {
    return rising([](float x) { return functions::exp(x); }, a);
}
inline Range exp2(Range a) {
    return rising([](float x) { return functions::exp2(x); }, a);
}
inline Range log(Range a) {
    return widen(rising([](float x) { return functions::log(x); }, a), few);
}
inline Range log2(Range a) {
    return widen(rising([](float x) { return functions::log2(x); }, a), few);
}
inline Range asin(Range a) {
    return rising([](float x) { return functions::asin(x); }, a);
}
inline Range acos(Range a) {
    return widen(falling([](float x) { return functions::acos(x); }, a), few);
}
inline Range atan(Range a) {
    return rising([](float x) { return arctangent(x); }, a);
}
inline Range sinh(Range a) {
    return rising([](float x) { return functions::sinh(x); }, a);
}
inline Range cosh(Range a) {
    return rising([](float x) { return functions::cosh(x); }, abs(a));
}
inline Range tanh(Range a) {
    return rising([](float x) { return functions::tanh(x); }, a);
}

inline Range mix(Range a, Range b, Range t) {
    const Range sum = add(mul(a, sub({1, 1}, t)), mul(b, t));
    const Range both = widen(hull(a, b), few * greater(size(a), size(b)));
    const bool mean = t.lo >= 0 && t.hi <= 1;
    return mean ? within(sum, both.lo, both.hi) : sum;
}
inline Range smoothstep(Range lo, Range hi, Range x) {
    const bool plain = lo.lo == lo.hi && hi.lo == hi.hi && lo.lo < hi.lo;
    const float a = plain ? sem::smoothstep(lo.lo, hi.lo, x.lo) : 0.0f,
                b = plain ? sem::smoothstep(lo.lo, hi.lo, x.hi) : 1.0f;
    return {a - few, b + few};
}

// -- ints
inline Range integer(Range a) { return size(a) <= whole ? a : everything(); }
inline Range integer(float lo, float hi) { return integer(Range{lo, hi}); }

// -- truths
inline Range truth(bool certain, bool possible) {
    return {certain ? 1.0f : 0.0f, possible ? 1.0f : 0.0f};
}
inline Range less(Range a, Range b) { return truth(a.hi < b.lo, a.lo < b.hi); }
inline Range less_equal(Range a, Range b) { return truth(a.hi <= b.lo, a.lo <= b.hi); }
inline Range equal(Range a, Range b) {
    return truth(a.lo == a.hi && b.lo == b.hi && a.lo == b.lo, a.lo <= b.hi && b.lo <= a.hi);
}
inline Range opposite(Range a) { return {1 - a.hi, 1 - a.lo}; }
inline Range select(Range c, Range a, Range b) {
    const Range both = hull(a, b), no = c.hi < 1 ? b : both;
    return c.lo > 0 ? a : no;
}

// -- vectors
inline Range dot(Range ax, Range ay, Range bx, Range by) { return add(mul(ax, bx), mul(ay, by)); }
inline Range dot(Range ax, Range ay, Range az, Range bx, Range by, Range bz) {
    return add(dot(ax, ay, bx, by), mul(az, bz));
}
// A component over a length whose square is `squares`; where squares run under floats lose digits.
inline Range normalized(Range x, Range squares) {
    const float limit = squares.lo > 1e-30f ? 1 + few : 2.0f;
    const Range by = {1 / sem::sqrt(squares.hi), 1 / sem::sqrt(squares.lo)};
    const Range one = squares.lo > 1e-30f ? mul(x, by) : everything();
    return within(widen(one), -limit, limit);
}

// -- noise: its certified range, where floats still have fractions
inline Range noise(Range x, Range y, Range z, float lo, float hi) {
    const bool fine = size(x) < 1e4f && size(y) < 1e4f && size(z) < 1e4f;
    return {fine ? lo : -endless, fine ? hi : endless};
}
template <class... R> bool points(R... a) { return ((a.lo == a.hi) && ...); }

// -- blends: all but Columns rise with both operands and fall with r. Where the operands are r
// apart all over the ranges, a blend is the lesser one to the bit (blends.h): the term that is
// taken away is 0.
inline bool apart(Range a, Range b, Range r) {
    return greater(b.lo - a.hi, a.lo - b.hi) >= greater(r.hi, 0);
}
template <class F> Range blended(F blend, Range a, Range b, Range r) {
    const float lo = blend(a.lo, b.lo, r.hi), hi = blend(a.hi, b.hi, r.lo);
    const float reach = greater(r.hi, 0);
    const Range some = tidy(lo - few * (sem::abs(lo) + reach), hi + few * (sem::abs(hi) + reach)),
                exact = minimum(a, b);
    const bool is_exact = apart(a, b, r);
    return {is_exact ? exact.lo : some.lo, is_exact ? exact.hi : lesser(some.hi, exact.hi)};
}
inline Range blend_smooth(Range a, Range b, Range r) {
    return blended([](float x, float y, float k) { return sem::blend_smooth(x, y, k); }, a, b, r);
}

} // namespace range
} // namespace fathom::cpu::FATHOM_ISA
