// What a scalar's own size says of its gradient: |grad v| <= c v (docs/lipschitz.md, 2.16), and of
// what is a power of a Lipschitz function, and a number (2.31). Both hold where slopes have no bound.
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

namespace {

constexpr double same_power = 2e-7; // exponents of single precision

double root_of(double x, double power) {
    if (power == infinity) return 1;
    return power == 2 ? up(std::sqrt(x)) : up(std::pow(x, 1 / power), 4);
}

// What |grad w| is at most, of the slope: |power| w^(1-1/power), or w.
double growth(double power, double w) {
    return power == infinity ? w : std::fabs(power) * std::pow(w, 1 - 1 / power);
}
// The greatest growth times e^-w for these w: it rises up to w = 1 - 1/power, then falls.
double steepest_decay(double power, Interval of) {
    const double w = std::clamp(1 - 1 / power, of.lo, of.hi);
    return up(growth(power, w) * std::exp(-w), 32);
}
// … and over (m + w)^e, m + w > 0: it rises up to w = m (1 - 1/power) / (e - 1 + 1/power), and all
// the way where that divisor is not above 0. There m is 0 or more.
double steepest_share(double power, double m, double e, Interval of) {
    const double falls = e - 1 + (power == infinity ? 0 : 1 / power);
    const double by = power == infinity ? 1 : std::fabs(power);
    if (std::fabs(falls * by) <= same_power) return by; // (w / (m + w))^(1-1/power)
    const double from = m == 0 ? of.lo : std::clamp(m * (1 - 1 / power) / falls, of.lo, of.hi);
    const double w = falls > 0 ? from : of.hi;
    if (!(m + w > 0)) return infinity;
    const double share = growth(power, w) / std::pow(m + w, e);
    return std::isnan(share) ? infinity : up(share, 32);
}

Raised multiple(Raised x, Interval by) {
    if (by == Interval(1.0)) return x;
    if (x.slope == infinity || (by.lo < 0 && by.hi > 0) || x.param != 0) return {};
    const double size = x.power < 0 ? by.mignitude() : by.magnitude();
    x.slope = up(times(x.slope, root_of(size, x.power)), 4);
    x.base = x.base * by;
    if (by.lo < 0) x.negative = !x.negative;
    return x;
}

// Does single precision take the power for 0 where its root is not small?
bool underflows_early(double power) {
    constexpr double most_power = 8; // 1.2e-38^(1/8) is 1.9e-5
    return power != infinity && std::fabs(power) > most_power;
}

bool is_power(const Raised &x) { return x.slope < infinity && x.power != 0; }
// w alone, whose root to its power is Lipschitz.
bool is_whole_power(const Raised &x) {
    return is_power(x) && x.power != infinity && x.base == Interval(0.0) && !x.negative;
}

} // namespace

Raised either(const Raised &a, const Raised &b) {
    if (!a.same_power(b) || a.base != b.base || !a.base.is_point() || a.negative != b.negative)
        return {};
    return {std::max(a.slope, b.slope), a.power, a.base, a.negative, a.param};
}

// |grad v| <= c v, v >= 0: of exp(u) with c the norm of u, of sums with the greater of both, of
// products with the sum.
double Machine::relative_norm(const Instruction &instruction) const {
    const Slot s = instruction.out;
    const auto of = [&](std::size_t i) { return relative_[instruction.args[i]]; };
    const Op op = instruction.op;
    const bool plain = instruction.form == Form::Plain;
    // a vector of one number: of its length
    if (tape_.size[s] > 1) return plain && op == Op::Splat ? of(0) : infinity;
    const Interval v = value_[tape_.first[s]];
    if (v.lo < 0) return infinity;
    if (norm_[s] == 0) return 0;
    constexpr ir::OpSet extremes{Op::Add, Op::Min, Op::Max}, products{Op::Mul, Op::Div};
    double known = infinity;
    if (instruction.form == Form::Square)
        known = times(2, of(0));
    else if (!plain)
        known = infinity;
    else if (op == Op::Exp || op == Op::Exp2)
        known = times(op == Op::Exp ? 1 : std::numbers::ln2, norm_[instruction.args[0]]);
    else if (op == Op::Sqrt || op == Op::InverseSqrt)
        known = times(0.5, of(0));
    else if (op == Op::Pow && norm_[instruction.args[1]] == 0)
        known = times(value(instruction.args[1], 0).magnitude(), of(0));
    else if (extremes[op])
        known = std::max(of(0), of(1));
    else if (products[op])
        known = of(0) + of(1);
    return std::min(up(known, 4), v.lo > 0 ? up(norm_[s] / v.lo, 4) : infinity);
}

Raised Machine::grows_as_itself(Slot s) const {
    return relative_[s] < infinity ? Raised{relative_[s], infinity} : Raised();
}

Raised Machine::raised(Slot s) const {
    if (tape_.size[s] != 1) return {};
    if (norm_[s] == 0) return {0, 0, value(s, 0), false};
    return raised_[s].slope < infinity ? raised_[s] : grows_as_itself(s);
}

// A number times a power of a value, as it is written: `-p.x*p.x`, `3*(r*r)*r`.
Machine::Monomial Machine::monomial(Slot s, int depth) const {
    const Monomial itself{1.0, s, 1};
    if (norm_[s] == 0) return {value(s, 0), s, 0};
    if (made_by_[s] < 0 || depth > 8) return itself;
    const Instruction &made = tape_.each[std::size_t(made_by_[s])];
    if (tape_.size[s] != 1 || made.args.empty()) return itself;
    const bool square = made.form == Form::Square;
    constexpr ir::OpSet known{Op::Neg, Op::Mul, Op::Div};
    if (!square && (made.form != Form::Plain || !known[made.op])) return itself;
    Monomial a = monomial(made.args[0], depth + 1);
    if (square) return {ir::square(a.by), a.of, 2 * a.degree};
    if (made.op == Op::Neg) return {-a.by, a.of, a.degree};
    const Monomial b = monomial(made.args[1], depth + 1);
    if (made.op == Op::Div)
        return b.degree == 0 && !b.by.contains(0) ? Monomial{a.by / b.by, a.of, a.degree} : itself;
    if (a.degree > 0 && b.degree > 0 && a.of != b.of) return itself;
    return {a.by * b.by, a.degree > 0 ? a.of : b.of, a.degree + b.degree};
}

Raised Machine::raised_to(Slot u, double power) const {
    const Raised &inner = raised_[u];
    const bool known = norm_[u] > 0 && is_power(inner) && inner.param == 0;
    if (known && inner.base == Interval(0.0) && !inner.negative) {
        const bool itself = inner.power == infinity;
        const double both = power * inner.power;
        if (itself) return {up(std::fabs(power) * inner.slope), infinity};
        if (both < 0 || both >= 1) return {inner.slope, both};
    }
    const bool falls_or_grows = power < 0 || power >= 1;
    return norm_[u] < infinity && falls_or_grows ? Raised{norm_[u], power} : Raised();
}

// Of x^e with a number e: |x|^e, or 0 below 0.
Raised Machine::raised_by_exponent(const Instruction &instruction) const {
    const Slot a = instruction.args[0], b = instruction.args[1];
    const Interval of = value(a, 0), exponent = value(b, 0);
    if (norm_[b] != 0) return {};
    if (!exponent.is_point()) return raised_by_param(instruction);
    const double e = double(float(exponent.lo)); // as evaluators see it
    const bool whole = e == std::floor(e), even = std::fmod(e, 2) == 0;
    if (e < 0 && of.contains(0)) return {};
    if (of.lo < 0 && !even && (whole || e < 0)) return {};
    return raised_to(a, e);
}

// … and with one that is not known, or its inverse.
Raised Machine::raised_by_param(const Instruction &instruction) const {
    if (!instruction.exponent) return {};
    const Slot a = instruction.args[0];
    const auto [of, negative, inverse] = *instruction.exponent;
    const Interval k = value(of, 0);
    if (!(k.lo >= 1)) return {};
    if (underflows_early(k.hi) && value(a, 0).lo < ir::rounding::min_single) return {};
    const double sign = negative ? -1 : 1;
    if (negative && value(a, 0).lo < ir::rounding::min_single) return {};
    if (!inverse && value(a, 0).lo < 0) return {};
    if (!inverse)
        return norm_[a] < infinity ? Raised{norm_[a], sign * k.lo, 0.0, false, of + 1} : Raised();
    const Raised &inner = raised_[a];
    const bool same = inner.param == of + 1 || (inner.param == 0 && k.is_point() &&
                                                std::fabs(inner.power) == double(float(k.lo)));
    if (!is_whole_power(inner) || !same) return {};
    return {inner.slope, inner.power < 0 ? -sign : sign};
}

// The inverse of the sum of the inverses of powers, or of what is not below 0, or grows as itself.
Raised Machine::raised_in_parallel(const Instruction &instruction) const {
    const std::vector<Slot> &parts = instruction.parallel;
    if (parts.empty()) return {};
    const auto of = [&](Slot part, int as) {
        if (as == 0) return is_whole_power(raised_[part]) ? raised_[part] : Raised();
        if (as == 2) return grows_as_itself(part);
        return value(part, 0).lo >= 0 && norm_[part] < infinity ? Raised{norm_[part], 1} : Raised();
    };
    for (int as = 0; as < 3; ++as) {
        Raised out{0, 0};
        for (const Slot part : parts) {
            const Raised x = of(part, as);
            const bool fits =
                x.slope < infinity && x.power > 0 && (out.power == 0 || x.same_power(out));
            if (!fits) {
                out = {};
                break;
            }
            out = {std::max(out.slope, x.slope), x.power, 0.0, false, x.param};
        }
        if (out.slope < infinity) return multiple(out, instruction.parallel_by);
    }
    return {};
}

const Instruction *Machine::maker(Slot s) const {
    return made_by_[s] < 0 ? nullptr : &tape_.each[std::size_t(made_by_[s])];
}

// The factors of a product, those that stand still apart.
bool Machine::gather(Slot s, Product &out, int depth) const {
    constexpr std::size_t most_factors = 4;
    if (tape_.size[s] != 1 || depth > 8) return false;
    if (norm_[s] == 0) {
        out.by = out.by * value(s, 0);
        return true;
    }
    const Instruction *made = maker(s);
    if (made && made->form == Form::Plain && made->op == Op::Mul)
        return gather(made->args[0], out, depth + 1) && gather(made->args[1], out, depth + 1);
    out.factors.push_back(s);
    return out.factors.size() <= most_factors;
}

// sin(u) = 1 - w or -1 + w, w twice the square of a sine of u/2 and a number; |sin(u)| = 1 - w.
Raised Machine::raised_wave(Slot s, bool from_below) const {
    const auto plain = [](const Instruction *made) { return made && made->form == Form::Plain; };
    const Instruction *made = maker(s);
    if (plain(made) && made->op == Op::Abs) {
        made = maker(made->args[0]);
        from_below = false;
    }
    if (!plain(made) || (made->op != Op::Sin && made->op != Op::Cos)) return {};
    if (tape_.size[made->out] != 1 || !(norm_[made->args[0]] < infinity)) return {};
    const double slope = up(times(norm_[made->args[0]], std::numbers::sqrt2 / 2), 4);
    return {slope, 2, from_below ? -1.0 : 1.0, !from_below};
}

// w b, b > 0: its root is that of w times that of b.
Raised Machine::raised_times(Slot w, Slot b) const {
    const Raised &x = raised_[w];
    const Interval by = value(b, 0);
    if (!is_whole_power(x) || x.param != 0 || x.power < 0) return {};
    if (!(by.lo >= ir::rounding::min_single) || !(norm_[b] < infinity)) return {};
    const double root = root_of(by.hi, x.power), own = root_of(above_base(w, x).hi, x.power),
                 falls = up(std::pow(by.lo, 1 / x.power - 1), 8) / x.power;
    const double slope = up(times(x.slope, root) + times(own, times(falls, norm_[b])), 8);
    return slope < infinity ? Raised{slope, x.power} : Raised();
}

// Powers, and sums and multiples of them.
Raised Machine::raised(const Instruction &instruction) const {
    const Slot out = instruction.out;
    if (tape_.size[out] != 1 || norm_[out] == 0) return {};
    if (trouble_[out] == Trouble::Jump || trouble_[out] == Trouble::Overflow) return {};
    if (pole_[out]) return {};
    const Slot a = instruction.args.empty() ? out : instruction.args[0],
               b = instruction.args.size() < 2 ? a : instruction.args[1];
    const Op op = instruction.op;
    if (instruction.form == Form::Square) return raised_to(a, 2);
    if (instruction.form != Form::Plain) return {};
    if (op == Op::Dot) return a == b && norm_[a] < infinity ? Raised{norm_[a], 2} : Raised();
    if (op == Op::Pow) return raised_by_exponent(instruction);
    if (op == Op::Sqrt || op == Op::InverseSqrt)
        return is_whole_power(raised_[a]) && raised_[a].param == 0
                   ? raised_to(a, op == Op::Sqrt ? 0.5 : -0.5)
                   : Raised();
    if (op == Op::Neg) {
        Raised x = raised(a);
        x.base = -x.base, x.negative = !x.negative;
        return x;
    }
    if (op == Op::Add || op == Op::Sub) {
        Raised x = raised(a), y = raised(b);
        const auto is_1 = [](const Raised &v) {
            return v.slope == 0 && abs(v.base) == Interval(1.0);
        };
        if (const Raised wave = raised_wave(a, op == Op::Add); is_1(y) && wave.slope < infinity)
            x = wave;
        else if (const Raised other = raised_wave(b, op == Op::Add);
                 is_1(x) && other.slope < infinity)
            y = other;
        if (op == Op::Sub) y.base = -y.base, y.negative = !y.negative;
        if (x.slope == 0) std::swap(x, y);
        if (y.slope == 0) return {x.slope, x.power, x.base + y.base, x.negative, x.param};
        if (!x.same_power(y) && op == Op::Add) x = grows_as_itself(a), y = grows_as_itself(b);
        const Interval base = x.base + y.base;
        if (x.slope == infinity || y.slope == infinity) return {};
        if (!x.same_power(y) || x.negative != y.negative) return {};
        const double q = x.power, most = std::max(x.slope, y.slope);
        if (q == infinity || q < 0) return {most, q, base, x.negative, x.param};
        const double sum = std::pow(x.slope, q) + std::pow(y.slope, q);
        const bool apart = at_right_angles(instruction, 0, 1);
        const bool as_one = apart && q == 2 && x.param == 0;
        return {as_one ? most : root_of(up(sum, 16), q), q, base, x.negative, x.param};
    }
    if (op == Op::Mul || op == Op::Div) {
        const bool first = op == Op::Mul && norm_[a] == 0;
        const Raised x = raised(first ? b : a);
        Interval by = value(first || (op == Op::Div && norm_[a] == 0) ? a : b, 0);
        if (op == Op::Div && norm_[a] == 0 && norm_[b] != 0) {
            Raised below = raised_[b];
            const bool keeps = below.power <= -1 || below.power > 0; // the inverse's is 1 or more
            if (!is_whole_power(below) || !keeps)
                below = norm_[b] < infinity ? Raised{norm_[b], 1} : Raised();
            if (value(b, 0).lo < ir::rounding::min_single) return {};
            below.power = -below.power;
            return multiple(below, by);
        }
        if (norm_[first ? a : b] != 0) {
            if (op == Op::Div) return raised_in_parallel(instruction);
            const Monomial m = monomial(out);
            const bool even = m.degree >= 2 && m.degree % 2 == 0;
            if (even) return multiple(raised_to(m.of, m.degree), m.by);
            const Raised first_by = raised_times(a, b);
            return first_by.slope < infinity ? first_by : raised_times(b, a);
        }
        if (op == Op::Div) {
            if (by.contains(0)) return {};
            by = Interval(1.0) / by;
        }
        return multiple(x, by);
    }
    // of v and a number that v's other side of `base` does not reach
    if ((op == Op::Min || op == Op::Max) && (norm_[a] == 0 || norm_[b] == 0)) {
        const Raised x = raised(norm_[a] == 0 ? b : a);
        const Interval k = value(norm_[a] == 0 ? a : b, 0);
        const bool keeps = (op == Op::Min) == x.negative;
        return keeps || (x.negative ? k.hi <= x.base.lo : k.lo >= x.base.hi) ? x : Raised();
    }
    if (op == Op::Clamp) {
        const Slot lo = b, hi = instruction.args[2];
        const Raised x = raised(a);
        const Slot far =
            x.negative ? lo : hi; // the other one keeps w as it is, or makes it greater
        const bool reached =
            x.negative ? value(far, 0).hi <= x.base.lo : value(far, 0).lo >= x.base.hi;
        return norm_[lo] == 0 && norm_[hi] == 0 && reached ? x : Raised();
    }
    return {};
}

// w, for such a value.
Interval Machine::above_base(Slot s, const Raised &x) const {
    const Interval w = x.negative ? x.base - value(s, 0) : value(s, 0) - x.base;
    return {std::max(w.lo, 0.0), std::max(w.hi, 0.0)};
}

// Of v^e for such a v.
double Machine::norm_of_power(Slot s, double e) const {
    const Raised x = raised(s);
    if (!is_power(x) || x.param != 0 || x.negative || !(x.base.lo >= 0)) return infinity;
    const Interval w = above_base(s, x);
    const bool is_small = !(x.base.lo + w.lo >= ir::rounding::min_single);
    if (is_small && (e < 0 || underflows_early(x.power))) return infinity;
    const double share = steepest_share(x.power, e > 1 ? x.base.hi : x.base.lo, 1 - e, w);
    return up(times(std::fabs(e) * x.slope, share), 8);
}

// (w v …)^e by the powers of its factors, which are not below 0.
double Machine::norm_of_product(Slot s, double e) const {
    Product all;
    if (!(e > 0) || !gather(s, all) || all.factors.size() < 2 || !(all.by.lo >= 0)) return infinity;
    double sum = 0, squares = 0;
    unsigned read = 0;
    bool apart = true; // the gradients are at right angles
    for (std::size_t i = 0; i < all.factors.size(); ++i) {
        const Slot factor = all.factors[i];
        apart = apart && (read & axes(factor)) == 0;
        read |= axes(factor);
        const Interval own = value(factor, 0);
        if (own.lo < 0 && !is_whole_power(raised_[factor])) return infinity;
        double part = norm_of_power(factor, e);
        if (own.lo > 0) {
            const double falls = up(std::pow(e < 1 ? own.lo : own.hi, e - 1), 8);
            part = std::min(part, up(times(e * falls, norm_[factor]), 4));
        }
        for (std::size_t k = 0; k < all.factors.size(); ++k)
            if (k != i)
                part = times(part, up(std::pow(std::max(value(all.factors[k], 0).hi, 0.0), e), 8));
        sum = up(sum + part);
        squares = up(squares + up(times(part, part)));
    }
    return up(times(apart ? up(std::sqrt(squares)) : sum, std::pow(all.by.hi, e)), 8);
}

// … and what else reads them.
double Machine::norm_by_raised(const Instruction &instruction) const {
    if (instruction.form != Form::Plain || tape_.size[instruction.out] != 1) return infinity;
    const Op op = instruction.op;
    if (op == Op::InverseSqrt) return norm_of_power(instruction.args[0], -0.5);
    if (op == Op::Sqrt) return norm_of_power(instruction.args[0], 0.5);
    if (op == Op::Pow) {
        const Interval exponent = value(instruction.args[1], 0);
        if (norm_[instruction.args[1]] != 0) return infinity;
        if (instruction.exponent && instruction.exponent->inverse) {
            const Raised x = raised_by_param(instruction);
            return x.power == 1 ? x.slope : infinity;
        }
        if (!exponent.is_point()) return infinity;
        return std::min(norm_of_power(instruction.args[0], exponent.lo),
                        norm_of_product(instruction.args[0], exponent.lo));
    }
    if (op != Op::Exp && op != Op::Exp2) return infinity;
    const Raised x = raised(instruction.args[0]);
    if (!is_power(x) || x.param != 0 || !x.negative) return infinity;
    const double rate = op == Op::Exp ? 1 : std::numbers::ln2;
    const double slope = times(x.slope, root_of(rate, x.power));
    const Interval w = Interval(rate) * above_base(instruction.args[0], x);
    return up(times(times(slope, steepest_decay(x.power, w)), exp(Interval(rate) * x.base).hi), 16);
}

// |sin(u)| + |cos(u)| is in 1..sqrt 2.
void Machine::hold_waves_of_one(const Instruction &instruction) {
    if (instruction.op != Op::Add || tape_.size[instruction.out] != 1) return;
    const Instruction *waves[2] = {};
    for (std::size_t i = 0; i < 2; ++i) {
        const Instruction *size = maker(instruction.args[i]);
        if (!size || size->form != Form::Plain || size->op != Op::Abs) return;
        waves[i] = maker(size->args[0]);
        if (!waves[i] || waves[i]->form != Form::Plain) return;
    }
    const bool both = (waves[0]->op == Op::Sin && waves[1]->op == Op::Cos) ||
                      (waves[0]->op == Op::Cos && waves[1]->op == Op::Sin);
    if (!both || waves[0]->args[0] != waves[1]->args[0]) return;
    Interval &sum = value_[tape_.first[instruction.out]];
    sum = meet(sum, Interval(1, up(std::numbers::sqrt2)));
}

void Machine::hold_raised(const Instruction &instruction) {
    const Slot out = instruction.out;
    if (instruction.form == Form::Plain) hold_waves_of_one(instruction);
    Raised &x = raised_[out];
    x = raised(instruction);
    if (x.slope == infinity || x.slope == 0 || x.param != 0) return;
    if (norm_[out] < infinity && x.power != infinity)
        hold_norm(out, up(times(x.slope, up(growth(x.power, above_base(out, x).hi), 32)), 4));
    if (x.negative || !(x.base.lo >= 0)) return;
    relative_[out] =
        std::min(relative_[out],
                 up(times(x.slope, steepest_share(x.power, x.base.lo, 1, above_base(out, x))), 8));
}

} // namespace fathom::proof
