// Arithmetic and functions by component: sums, products, powers, waves, angles. Proofs:
// docs/lipschitz.md, 2.
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

namespace {

// x/tanh(x) = 1 + x^2/3 - x^4/45 + ... is convex, is at least |x|, and rises with |x|; its slope,
// 2x/3 - 4x^3/45 + ..., rises with x, and is in -1..1.
constexpr double series_end = 0.1, flat_end = 40; // the slope is 1 from there on

Interval hyperbolic_at(double x) { // x >= 0
    if (x < series_end) return {1, 1 + x * x / 3 * (1 + 1e-12)};
    return {x / std::tanh(x) * (1 - 1e-12), x / std::tanh(x) * (1 + 1e-12)};
}
Interval hyperbolic_slope_at(double x) {
    const double a = std::fabs(x);
    Interval slope{1 - 1e-10, 1};
    if (a < series_end) {
        slope = {a * (2.0 / 3) * (1 - 1e-12) - a * a * a * (4.0 / 45), a * (2.0 / 3) * (1 + 1e-12)};
    } else if (a < flat_end) {
        const double c = 1 / std::tanh(a), at = c - a * (c * c - 1);
        slope = {at - 1e-10, std::min(at + 1e-10, 1.0)};
    }
    return x < 0 ? -slope : slope;
}
} // namespace

// |x + y|^2 = |x|^2 + |y|^2 + 2 x.y, for gradients of these lengths at most that lie in these rows.
double Step::of_two(double x_length, const Row &x, double y_length, const Row &y) const {
    const double any = up(x_length + y_length);
    if (any == 0 || any == infinity) return any;
    const Interval dot = x[0] * y[0] + x[1] * y[1] + x[2] * y[2];
    if (!(dot.hi < 0.9 * x_length * y_length))
        return any; // what is hardly less is not worth a root
    const double squares = x_length * x_length + y_length * y_length;
    const double most = up(std::sqrt(std::max(up(squares + 2 * dot.hi, 4), 0.0)), 4);
    return std::min(any, most * machine.ranges_.rules[Rule::TwoGradients]);
}

void Step::negate() {
    for (int c = 0; c < n; ++c) set(c, -value(0, c), scaled(-1.0, grad(0, c)), odd(0, c));
    finish(norm(0), false);
    if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
}

void Step::add() {
    Interval sign = in.op == Op::Add ? 1.0 : -1.0;
    const auto is_0 = [&](int arg, int c) {
        return value(arg, c) == Interval(0.0) && grad(arg, c) == none && !odd(arg, c);
    };
    bool odd_used = false; // but where 0 is added: `p - vec3(0, 2, 0)` of a p with an odd x
    for (int c = 0; c < n; ++c) {
        const bool stays = (odd(0, c) && is_0(1, c)) || (odd(1, c) && is_0(0, c));
        odd_used = odd_used || (!stays && (odd(0, c) || odd(1, c)));
        set(c, value(0, c) + sign * value(1, c), sum(grad(0, c), scaled(sign, grad(1, c))), stays);
    }
    finish(norm(0) == 0                        ? norm(1)
           : norm(1) == 0                      ? norm(0)
           : machine.at_right_angles(in, 0, 1) ? up(std::hypot(norm(0), norm(1)), 4)
           : n == 1 ? of_two(norm(0), grad(0, 0), norm(1), scaled(sign, grad(1, 0)))
                    : up(norm(0) + norm(1)),
           odd_used);
    if (machine.norm_[out] != infinity)
        machine.cause_[out] =
            machine.cause_[in.args[0]] ? machine.cause_[in.args[0]] : machine.cause_[in.args[1]];
}

void Step::product() {
    double a = 0, b = 0, most = infinity;
    const bool none_times = has_pole(0) || has_pole(1);
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), y = value(1, c);
        a = std::max(a, x.magnitude()), b = std::max(b, y.magnitude());
        const Row of_x = scaled(y, grad(0, c)), of_y = scaled(x, grad(1, c));
        set(c, x * y, sum(of_x, of_y), odd(0, c) || odd(1, c));
        if (n == 1) most = of_two(times(b, norm(0)), of_x, times(a, norm(1)), of_y);
    }
    if (none_times) return fail(Trouble::Singular); // 0 times what is no number is none
    finish(std::min(most, up(times(b, norm(0)) + times(a, norm(1)))), false);
    if (machine.norm_[out] != infinity)
        machine.cause_[out] =
            machine.cause_[in.args[0]] ? machine.cause_[in.args[0]] : machine.cause_[in.args[1]];
}

void Step::quotient() {
    if (is_int()) {
        set(0,
            value(1, 0).contains(0)
                ? hull(0.0, Interval(-value(0, 0).magnitude(), value(0, 0).magnitude()))
                : trunc(value(0, 0) / value(1, 0)),
            none);
        return settle_int();
    }
    double most = 0, ratio = 0, greatest = 0, squares = 0;
    bool singular = false, odd_divisor = false;
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), y = value(1, c);
        odd_divisor = odd_divisor || odd(1, c);
        if (zero(grad(1, c)) && zero(grad(0, c)) && !y.contains(0)) {
            set(c, x / y, none);
            continue;
        }
        if (y.mignitude() < min_single) {
            singular = true;
            set(c, Interval::everything(), none);
            continue;
        }
        Interval q = x / y, inverse = Interval(1.0) / y;
        greatest = std::max(greatest, x.magnitude());
        squares += times(q.magnitude(), q.magnitude());
        most = std::max(most, inverse.magnitude()), ratio = std::max(ratio, q.magnitude());
        set(c, q, scaled(inverse, sum(grad(0, c), scaled(-q, grad(1, c)))), odd(0, c));
    }
    if (singular) return fail(Trouble::Singular);
    // |x y'|/y^2, by what is known of y' (2.16, 2.31); of a vector over a number with x's length
    const Slot divisor = in.args[1];
    const double length = n == 1 ? ratio : up(std::sqrt(squares), n + 4);
    const double by_divisor =
        std::min({times(times(ratio, most), norm(1)), times(length, machine.relative_[divisor]),
                  times(greatest, machine.norm_of_power(divisor, -1))});
    finish(up(times(most, norm(0)) + by_divisor, 4), odd_divisor);
    if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
}

void Step::remainder() {
    bool jumps = false;
    const double less = in.whole ? 1 : 0; // a whole number's is at most the divisor less 1
    const auto all = [&](Interval m) {
        return Interval(std::min(m.lo + less, 0.0), std::max(m.hi - less, 0.0));
    };
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), m = value(1, c);
        if (m.contains(0)) {
            jumps = jumps || !zero(grad(0, c)) || !zero(grad(1, c));
            const double size = std::max(x.magnitude(), m.magnitude());
            set(c, {-size, size}, none);
            continue;
        }
        if (in.scatters && norm(0) == 0 && norm(1) == 0) {
            jumps = jumps || in.wavers;
            set(c, all(m), none);
            continue;
        }
        Interval turns = floor(x / m);
        if (by_ways()) {
            turns = one_of(turns);
            const bool one = turns.is_point() && turns.finite();
            set(c, one ? meet(all(m), x - m * turns) : all(m),
                one ? sum(grad(0, c), scaled(-turns, grad(1, c))) : grad(0, c));
            jumps = jumps || !zero(grad(1, c));
            continue;
        }
        if (turns.is_point() && turns.finite()) {
            set(c, x - m * turns, sum(grad(0, c), scaled(-turns, grad(1, c))));
            continue;
        }
        jumps = jumps || !zero(grad(1, c)) || (!cancels() && !is_still(0, c));
        set(c, all(m), grad(0, c));
    }
    if (is_int()) return settle_int();
    if (jumps) return fail(Trouble::Jump);
    finish(norm(1) == 0 ? norm(0) : infinity, any_odd);
}

void Step::power() {
    double a = 0, b = 0;
    bool singular = false, odd_left = false;
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), y = value(1, c);
        // as evaluators see it: from 2^24 on every number is whole, and even
        const double exponent = y.is_point() ? double(float(y.lo)) : NAN,
                     whole = std::floor(exponent) == exponent ? exponent : NAN;
        odd_left = odd_left || odd(1, c) || (odd(0, c) && !(std::fmod(whole, 2) == 0));
        if (whole >= 0) {
            Interval d = whole == 0 ? Interval(0.0) : Interval(whole) * whole_power(x, whole - 1);
            a = std::max(a, d.magnitude());
            set(c, whole_power(x, whole), scaled(d, grad(0, c)));
            continue;
        }
        if (whole < 0) {
            if (x.contains(0)) {
                singular = singular || !zero(grad(0, c));
                set(c, Interval::everything(), none);
                continue;
            }
            Interval d = Interval(whole) / whole_power(x, 1 - whole);
            a = std::max(a, d.magnitude());
            set(c, Interval(1.0) / whole_power(x, -whole), scaled(d, grad(0, c)));
            continue;
        }
        // x^y for x > 0; 0 for x < 0 (other whole y below 0 aside), so continuous at 0 where y
        // > 0.
        Interval v = x.hi < 0 ? Interval(0.0) : positive_power(x, y);
        if (x.lo < 0 && !y.is_point()) { // y may be whole: +-|x|^y
            Interval m = positive_power(abs(x), y);
            v = {-m.hi, m.hi};
            singular = singular || !zero(grad(0, c)) || !zero(grad(1, c));
        } else if (x.lo < 0) {
            v = hull(v, 0.0);
        }
        Interval dx, dy;
        if (!zero(grad(0, c)) && x.hi >= 0) {
            if (y.lo >= 1)
                dx = y * positive_power(x, y - Interval(1.0));
            else if (x.lo > 0)
                dx = y * positive_power(x, y) / x;
            else if (y.lo > 0) // of some powers, it is not (2.40)
                dx = Interval::everything();
            else
                singular = true;
            if (x.lo <= 0) dx = hull(dx, 0.0);
        }
        if (!zero(grad(1, c))) {
            if (x.lo > 0)
                dy = positive_power(x, y) * log(x);
            else
                singular = true;
        }
        a = std::max(a, dx.magnitude()), b = std::max(b, dy.magnitude());
        set(c, v, sum(scaled(dx, grad(0, c)), scaled(dy, grad(1, c))));
    }
    if (singular) return fail(Trouble::Singular);
    finish(up(times(a, norm(0)) + times(b, norm(1))), odd_left);
}

// even: an odd wave becomes continuous
void Step::squared() {
    double most = 0;
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c);
        most = std::max(most, x.magnitude());
        set(c, square(x),
            scaled(Interval(2.0) * x, grad(0, c))); // even: an odd wave becomes continuous
    }
    finish(times(2 * most, norm(0)), false);
}

// x |x|^e: the slope is (e + 1) |x|^e, finite at 0
void Step::odd_power() {
    double most = 0;
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), e = value(1, c), power = positive_power(abs(x), e);
        Interval d = (e + Interval(1.0)) * power;
        most = std::max(most, d.magnitude());
        set(c, x * power, scaled(d, grad(0, c)), odd(0, c));
    }
    finish(times(most, norm(0)), false);
}

// Of what is odd it is odd, too: w(-x) is -w(x).
void Step::wave() {
    bool bad = norm(1) > 0, odd_period = false;
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c), m = value(1, c);
        odd_period = odd_period || odd(1, c);
        if (m.lo <= 0) {
            bad = true;
            set(c, Interval::everything(), none);
            continue;
        }
        Interval turns = floor(x / m + Interval(0.5));
        if (by_ways()) {
            turns = one_of(turns);
            const bool one = turns.is_point() && turns.finite();
            const Interval whole(-m.hi / 2, m.hi / 2);
            set(c, one ? meet(whole, x - m * turns) : whole, grad(0, c));
            continue;
        }
        if (turns.is_point() && turns.finite())
            set(c, x - m * turns, grad(0, c), odd(0, c));
        else
            set(c, {-m.hi / 2, m.hi / 2}, grad(0, c),
                odd(0, c) || (!cancels() && !zero(grad(0, c))));
    }
    if (bad) return fail(Trouble::Jump);
    finish(norm(0), odd_period);
    machine.cause_[out] = in.node;
}

// x - m*clamp(round(x/m), lo, hi): from one whole number to the next it goes from m/2 to -m/2.
void Step::held_wave() {
    bool bad = norm(1) > 0 || norm(2) > 0 || norm(3) > 0;
    for (int c = 0; c < n; ++c) {
        const Interval x = value(0, c), m = value(1, c), lo = value(2, c), hi = value(3, c);
        bad = bad || m.lo <= 0 || !lo.is_point() || !hi.is_point() || lo.lo > hi.lo || odd(0, c);
        Interval turns = min(max(floor(x / m + Interval(0.5)), lo), hi);
        if (by_ways() && !bad) turns = one_of(turns);
        if (bad || (turns.is_point() && turns.finite())) {
            set(c, bad ? Interval::everything() : x - m * turns, grad(0, c));
            continue;
        }
        const Interval below = x - m * lo, above = x - m * hi;
        set(c, {std::min(-m.hi / 2, below.lo), std::max(m.hi / 2, above.hi)}, grad(0, c),
            !cancels() && !by_ways() && !zero(grad(0, c)));
    }
    if (bad) return fail(Trouble::Jump);
    finish(norm(0), false);
    if (machine.norm_[out] != infinity) machine.cause_[out] = in.node;
}

// |(sin x / x)'| <= 0.4362, values in [-0.2173, 1]
void Step::sinc() {
    unary(
        [](Interval x) {
            if (x.contains(0) || x.mignitude() < 1e-4) return Interval(-0.2173, 1);
            return meet(Interval(-0.2173, 1), sin(x) / x);
        },
        [](Interval x) {
            Interval all(-0.4362, 0.4362);
            if (x.mignitude() < 0.5) return all;
            return meet(all, (cos(x) - sin(x) / x) / x);
        });
}

// |(x/tanh(x))'| <= 1, values from 1 on
void Step::hyperbolic() {
    unary(
        [](Interval x) {
            return Interval(hyperbolic_at(x.mignitude()).lo, hyperbolic_at(x.magnitude()).hi);
        },
        [](Interval x) {
            return Interval(hyperbolic_slope_at(x.lo).lo, hyperbolic_slope_at(x.hi).hi);
        });
}

void Step::absolute() {
    for (int c = 0; c < n; ++c) {
        Interval x = value(0, c);
        const bool open = x.lo < 0 && x.hi > 0;
        const int sign = by_ways() && open ? machine.sign_of(in.args[0], c) : -1;
        if (const int w = way(open, 2, sign < 0 ? -1 : 1 - sign); w >= 0) {
            keep_sign(0, c, w == 1);
            narrow(0, c, w == 0 ? Interval(0, infinity) : Interval(-infinity, 0));
            x = value(0, c);
        }
        Interval d = x.lo >= 0 && !odd(0, c)   ? Interval(1.0)
                     : x.hi <= 0 && !odd(0, c) ? Interval(-1.0)
                                               : Interval(-1, 1);
        set(c, abs(x), scaled(d, grad(0, c)));
    }
    if (is_int()) return settle_int();
    finish(norm(0), false);
}

// Of two scalars together.
Interval Step::length_of_both() const {
    const unsigned a = machine.coordinates(in.args[0]), b = machine.coordinates(in.args[1]);
    return machine.length_of(a && b && a != b ? a | b : 0,
                             sqrt(square(value(0, 0)) + square(value(1, 0))));
}

// the angle turns by at most |grad (x, y)| / r; it jumps across the negative x axis
void Step::angle() {
    const Interval y = value(0, 0), x = value(1, 0), r = length_of_both(),
                   pi(-3.1415926535897936, 3.1415926535897936);
    bool varies = norm(0) > 0 || norm(1) > 0;
    bool cut = x.lo <= 0 && y.contains(0);
    Interval v = pi;
    if (cut && cancels() && x.hi < 0 && y.lo >= 0) // the cut from above: up to pi
        v = meet(pi, ir::outward(std::atan2(y.hi, x.hi), pi.hi, ir::rounding::library));
    else if (cut && cancels() && x.hi < 0 && y.hi <= 0) // and from below, its limit there
        v = meet(pi, ir::outward(pi.lo, std::atan2(y.lo, x.hi), ir::rounding::library));
    if (!cut) {
        double a = std::atan2(y.lo, x.lo), b = std::atan2(y.lo, x.hi), c = std::atan2(y.hi, x.lo),
               d = std::atan2(y.hi, x.hi);
        v = meet(
            pi, ir::outward(std::min({a, b, c, d}), std::max({a, b, c, d}), ir::rounding::library));
    }
    if (cut && varies && in.stepped && cancels() && norm(0) != infinity && norm(1) != infinity) {
        // read by steps alone, which have no slope
        constexpr Interval any = Interval::everything();
        set(0, v, {any, any, any});
        return finish(1, any_odd);
    }
    const bool crosses = cut && !(cancels() && (!x.contains(0) || r.lo > 0));
    if (!varies || crosses) {
        set(0, v, none);
        if (varies) return fail(x.contains(0) ? Trouble::Singular : Trouble::Jump);
        return finish(0, any_odd);
    }
    Interval r2 = square(r);
    if (r2.lo <= 0) r2.lo = std::numeric_limits<double>::min();
    set(0, v, sum(scaled(x / r2, grad(0, 0)), scaled(-(y / r2), grad(1, 0))));
    finish(up(together() / std::sqrt(r2.lo), 8), any_odd);
}

void Step::smoothstep() {
    bool bad = false;
    double most = 0;
    for (int c = 0; c < n; ++c) {
        Interval lo = value(0, c), hi = value(1, c), x = value(2, c), width = hi - lo;
        bool flat = zero(grad(0, c)) && zero(grad(1, c)) && zero(grad(2, c));
        if (width.contains(0)) {
            bad = bad || !flat;
            set(c, {0, 1}, none);
            continue;
        }
        Interval whole = (x - lo) / width, t = min(max(whole, Interval(0.0)), Interval(1.0));
        auto curve = [](double u) { return u * u * (3 - 2 * u); };
        Interval v = meet(Interval(0, 1), ir::outward(curve(t.lo), curve(t.hi), 4));
        if (whole.hi <= 0 || whole.lo >= 1) v = whole.hi <= 0 ? 0.0 : 1.0; // and not by rounding
        // 6t(1-t): least at the end further from 1/2, 3/2 at 1/2
        auto slope = [](double u) { return 6 * u * (1 - u); };
        Interval d = ir::outward(std::min(slope(t.lo), slope(t.hi)),
                                 t.contains(0.5) ? 1.5 : std::max(slope(t.lo), slope(t.hi)), 4);
        if (whole.hi < 0 || whole.lo > 1) d = 0.0;
        d = Interval(std::max(d.lo, 0.0), d.hi);
        const Interval k = d == Interval(0.0) ? d : d / width;
        Row inner =
            sum(grad(2, c), sum(scaled(t - Interval(1.0), grad(0, c)), scaled(-t, grad(1, c))));
        most = std::max(most, k.magnitude());
        set(c, v, scaled(k, inner));
    }
    if (bad) return fail(Trouble::Singular);
    finish(times(most, up(norm(2) + norm(0) + norm(1))), any_odd);
}

} // namespace fathom::proof
