// Closed intervals of doubles that round outward: an operation's result holds every value that the
// operation takes on its arguments. Functions are found by argument-dependent look-up, so that a
// template written for numbers (ir/semantics.h) works on intervals too. An interval may reach to
// infinity. Knows nothing of graphs.
//
// Rounding: IEEE operations are right to half a unit in the last place and get one outward; the C
// library's functions are taken to be right to 4 (glibc's documented errors for these are at most
// 2) and get 8.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

namespace fathom::ir {

// A closed interval, lo <= hi; ends may be infinite.
struct Interval {
    double lo = 0, hi = 0;

    constexpr Interval() = default;
    constexpr Interval(double x) : lo(x), hi(x) {} // NOLINT: a number is an interval
    constexpr Interval(double lo_, double hi_) : lo(lo_), hi(hi_) {}
    static constexpr Interval everything() {
        return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    bool is_point() const { return lo == hi; }
    bool finite() const { return std::isfinite(lo) && std::isfinite(hi); }
    bool contains(double x) const { return lo <= x && x <= hi; }
    double width() const { return hi - lo; }
    double middle() const;
    double magnitude() const { return std::max(std::fabs(lo), std::fabs(hi)); } // max |x|
    double mignitude() const { return contains(0) ? 0 : std::min(std::fabs(lo), std::fabs(hi)); }
    friend constexpr bool operator==(Interval, Interval) = default;
};

namespace rounding {
constexpr double infinity = std::numeric_limits<double>::infinity();
// |x| 2^-52 is at least one unit in the last place of x; the least subnormal covers zero.
inline double down(double x, double units = 1) {
    if (x == infinity) return std::numeric_limits<double>::max();
    if (x == -infinity) return x;
    return x - (std::fabs(x) * (units * 0x1p-52) + std::numeric_limits<double>::denorm_min());
}
inline double up(double x, double units = 1) { return -down(-x, units); }
inline double times(double a, double b) {
    return a == 0 || b == 0 ? 0 : a * b;
} // 0 * infinity is 0 here
constexpr double library = 8;
// Evaluators count in single precision: beyond the one is infinity, below the other 0.
constexpr double max_single = 1e38, min_single = 1.2e-38;
constexpr double max_squared = 1e18; // of a vector: what its length's square holds
} // namespace rounding

inline double Interval::middle() const {
    if (lo == -rounding::infinity) return hi == rounding::infinity ? 0 : std::min(2 * hi, hi - 1);
    if (hi == rounding::infinity) return std::max(2 * lo, lo + 1);
    return lo + (hi - lo) / 2;
}

inline Interval outward(double lo, double hi, double units = 1) {
    if (std::isnan(lo)) lo = -rounding::infinity;
    if (std::isnan(hi)) hi = rounding::infinity;
    return {rounding::down(lo, units), rounding::up(hi, units)};
}
inline Interval hull(Interval a, Interval b) {
    return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)};
}
// Of two enclosures of one value; where rounding has set them apart, the second is kept.
inline Interval meet(Interval a, Interval b) {
    Interval r{std::max(a.lo, b.lo), std::min(a.hi, b.hi)};
    return r.lo <= r.hi ? r : b;
}

inline Interval operator-(Interval a) { return {-a.hi, -a.lo}; }
inline Interval operator+(const Interval &a, const Interval &b) {
    if (a.lo == 0 && a.hi == 0) return b; // exact, and common in gradients
    if (b.lo == 0 && b.hi == 0) return a;
    const Interval sum(a.lo + b.lo, a.hi + b.hi), out = outward(sum.lo, sum.hi);
    return {sum.lo == 0 ? 0 : out.lo, sum.hi == 0 ? 0 : out.hi}; // a sum of 0 is exact
}
inline Interval operator-(Interval a, Interval b) { return a + (-b); }
// By numbers, not intervals: pairs of doubles just written are slow to read again as one.
inline Interval product(double a, double b, double c, double d) { // [a, b] * [c, d]
    double p = a * c, q = a * d, r = b * c, s = b * d;
    if (std::isnan(p + q + r + s)) // a 0 times an infinity, perhaps
        p = rounding::times(a, c), q = rounding::times(a, d), r = rounding::times(b, c),
        s = rounding::times(b, d);
    return outward(std::min(std::min(p, q), std::min(r, s)),
                   std::max(std::max(p, q), std::max(r, s)));
}
inline Interval operator*(const Interval &a, const Interval &b) {
    if ((a.lo == 0 && a.hi == 0) || (b.lo == 0 && b.hi == 0)) return 0.0;
    if (a.lo == 1 && a.hi == 1) return b;
    if (b.lo == 1 && b.hi == 1) return a;
    return product(a.lo, a.hi, b.lo, b.hi);
}
inline Interval operator/(Interval a, Interval b) {
    if (b.contains(0)) return a.lo == 0 && a.hi == 0 ? Interval(0.0) : Interval::everything();
    if (b.lo == 1 && b.hi == 1) return a;
    auto over = [](double x, double y) {
        return std::isinf(y) ? (std::isinf(x) ? NAN : 0.0) : x / y;
    };
    double p = over(a.lo, b.lo), q = over(a.lo, b.hi), r = over(a.hi, b.lo), s = over(a.hi, b.hi);
    if (std::isnan(p + q + r + s)) return Interval::everything();
    return outward(std::min(std::min(p, q), std::min(r, s)),
                   std::max(std::max(p, q), std::max(r, s)));
}
inline Interval &operator+=(Interval &a, Interval b) { return a = a + b; }

inline Interval min(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::min(a.hi, b.hi)}; }
inline Interval max(Interval a, Interval b) { return {std::max(a.lo, b.lo), std::max(a.hi, b.hi)}; }
inline Interval abs(Interval a) {
    if (a.lo >= 0) return a;
    if (a.hi <= 0) return -a;
    return {0, a.magnitude()};
}
inline Interval square(Interval a) {
    Interval m = abs(a);
    Interval r = outward(m.lo * m.lo, m.hi * m.hi);
    return {std::max(r.lo, 0.0), r.hi};
}
inline Interval sqrt(Interval a) { // 0 below 0
    double lo = std::max(a.lo, 0.0), hi = std::max(a.hi, 0.0);
    Interval r = outward(std::sqrt(lo), std::sqrt(hi));
    return {std::max(r.lo, 0.0), r.hi};
}
inline Interval inversesqrt(Interval a) {
    return a.lo <= 0 ? Interval(0, rounding::infinity) : Interval(1.0) / sqrt(a);
}
inline Interval floor(Interval a) { return {std::floor(a.lo), std::floor(a.hi)}; }
inline Interval ceil(Interval a) { return {std::ceil(a.lo), std::ceil(a.hi)}; }
inline Interval trunc(Interval a) { return {std::trunc(a.lo), std::trunc(a.hi)}; }

inline Interval monotone(double (*f)(double), Interval a) {
    return outward(f(a.lo), f(a.hi), rounding::library);
}
inline Interval exp(Interval a) {
    Interval r = monotone(std::exp, a);
    return {std::max(r.lo, 0.0), r.hi};
}
inline Interval exp2(Interval a) {
    Interval r = monotone(std::exp2, a);
    return {std::max(r.lo, 0.0), r.hi};
}
inline Interval log(Interval a) { // of the positive part
    return a.hi <= 0 ? Interval::everything()
                     : outward(std::log(std::max(a.lo, 0.0)), std::log(a.hi), rounding::library);
}
inline Interval log2(Interval a) {
    return a.hi <= 0 ? Interval::everything()
                     : outward(std::log2(std::max(a.lo, 0.0)), std::log2(a.hi), rounding::library);
}
inline Interval sinh(Interval a) { return monotone(std::sinh, a); }
inline Interval cosh(Interval a) {
    Interval m = abs(a);
    Interval r = monotone(std::cosh, m);
    return {std::max(r.lo, 1.0), r.hi};
}
inline Interval tanh(Interval a) { return meet({-1, 1}, monotone(std::tanh, a)); }
inline Interval atan(Interval a) { return monotone(std::atan, a); }
inline Interval asin(Interval a) {
    return monotone(std::asin, {std::clamp(a.lo, -1.0, 1.0), std::clamp(a.hi, -1.0, 1.0)});
}
inline Interval acos(Interval a) {
    double lo = std::clamp(a.lo, -1.0, 1.0), hi = std::clamp(a.hi, -1.0, 1.0);
    return outward(std::acos(hi), std::acos(lo), rounding::library);
}

// cos has its maxima at 2 pi k and its minima between them; k is counted a little generously, so
// that a rounded quotient never loses one.
inline Interval cos(Interval a) {
    constexpr double tau = 6.283185307179586476925;
    if (!a.finite() || a.width() >= tau || a.magnitude() > 1e9) return {-1, 1};
    double slack = 1e-15 * (1 + a.magnitude());
    double from = (a.lo - slack) / tau, to = (a.hi + slack) / tau;
    double x = std::cos(a.lo), y = std::cos(a.hi);
    Interval r = outward(std::min(x, y), std::max(x, y), rounding::library);
    if (std::floor(to) >= std::ceil(from)) r.hi = 1;
    if (std::floor(to - 0.5) >= std::ceil(from - 0.5)) r.lo = -1;
    return {std::max(r.lo, -1.0), std::min(r.hi, 1.0)};
}
inline Interval sin(Interval a) {
    constexpr double tau = 6.283185307179586476925;
    if (!a.finite() || a.width() >= tau || a.magnitude() > 1e9) return {-1, 1};
    double slack = 1e-15 * (1 + a.magnitude());
    double from = (a.lo - slack) / tau - 0.25, to = (a.hi + slack) / tau - 0.25;
    double x = std::sin(a.lo), y = std::sin(a.hi);
    Interval r = outward(std::min(x, y), std::max(x, y), rounding::library);
    if (std::floor(to) >= std::ceil(from)) r.hi = 1;
    if (std::floor(to - 0.5) >= std::ceil(from - 0.5)) r.lo = -1;
    return {std::max(r.lo, -1.0), std::min(r.hi, 1.0)};
}

inline Interval tan(Interval a) {
    return cos(a).contains(0) ? Interval::everything() : monotone(std::tan, a);
}

// The slopes of the functions of ir/ops.def; everything where there is none, or no bound.
namespace slope {
inline Interval sqrt(Interval a) {
    if (a.hi < 0) return 0.0;
    return a.lo <= 0 ? Interval::everything() : Interval(0.5) / ir::sqrt(a);
}
inline Interval inversesqrt(Interval a) {
    return a.lo <= 0 ? Interval::everything() : Interval(-0.5) / (a * ir::sqrt(a));
}
inline Interval exp(Interval a) { return ir::exp(a); }
inline Interval exp2(Interval a) {
    return ir::exp2(a) * Interval(0.69314718055994528, 0.69314718055994534);
}
inline Interval log(Interval a) {
    return a.lo < rounding::min_single ? Interval::everything() : Interval(1.0) / a;
}
inline Interval log2(Interval a) {
    return a.lo < rounding::min_single ? Interval::everything()
                                       : Interval(1.4426950408889632, 1.4426950408889636) / a;
}
inline Interval sin(Interval a) { return ir::cos(a); }
inline Interval cos(Interval a) { return -ir::sin(a); }
inline Interval tan(Interval a) {
    const Interval t = ir::tan(a);
    return t.finite() ? Interval(1.0) + square(t) : Interval::everything();
}
inline Interval asin(Interval a) { // of the clamped argument
    if (a.lo >= 1 || a.hi <= -1) return 0.0;
    if (a.lo <= -1 || a.hi >= 1) return Interval::everything();
    return Interval(1.0) / ir::sqrt(Interval(1.0) - square(a));
}
inline Interval acos(Interval a) { return -slope::asin(a); }
inline Interval atan(Interval a) { return Interval(1.0) / (Interval(1.0) + square(a)); }
inline Interval sinh(Interval a) { return ir::cosh(a); }
inline Interval cosh(Interval a) { return ir::sinh(a); }
inline Interval tanh(Interval a) {
    return meet(Interval(0, 1), Interval(1.0) - square(ir::tanh(a)));
}
} // namespace slope

// x^n for a whole n >= 0.
inline Interval whole_power(Interval a, double n) {
    if (n == 0) return 1.0;
    if (n == 1) return a;
    if (n == 2) return square(a);
    Interval base = std::fmod(n, 2) == 0 ? abs(a) : a;
    return outward(std::pow(base.lo, n), std::pow(base.hi, n), rounding::library);
}
// x^y for x >= 0 (the part of `a` below 0 is left out).
inline Interval positive_power(Interval a, Interval y) {
    double lo = std::max(a.lo, 0.0), hi = std::max(a.hi, 0.0);
    double p = std::pow(lo, y.lo), q = std::pow(lo, y.hi), r = std::pow(hi, y.lo),
           s = std::pow(hi, y.hi);
    if (std::isnan(p + q + r + s)) return Interval::everything();
    Interval v = outward(std::min(std::min(p, q), std::min(r, s)),
                         std::max(std::max(p, q), std::max(r, s)), rounding::library);
    if (lo <= 1 && hi >= 1) v = hull(v, 1.0);
    return {std::max(v.lo, 0.0), v.hi};
}

} // namespace fathom::ir
