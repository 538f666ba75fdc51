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

double root_of(double x, double power) {
    if (power == infinity) return 1;
    return power == 2 ? up(std::sqrt(x)) : up(std::pow(x, 1 / power), 4);
}

// What |grad w| is at most, of the slope: power w^(1 - 1/power), or w.
double growth(double power, double w) {
    return power == infinity ? w : power * std::pow(w, 1 - 1 / power);
}
// The greatest growth times e^-w for these w: it rises up to w = 1 - 1/power, then falls.
double steepest_decay(double power, Interval of) {
    const double w = std::clamp(1 - 1 / power, of.lo, of.hi);
    return up(growth(power, w) * std::exp(-w), 32);
}
// … and over (m + w)^e, m + w > 0, e >= 1, which rises up to w = m (1 - 1/power) / (e - 1 + 1/power).
double steepest_share(double power, double m, double e, Interval of) {
    if (power == infinity && e == 1) return 1;
    const double w = std::clamp(m * (1 - 1 / power) / (e - 1 + 1 / power), of.lo, of.hi);
    if (!(m + w > 0)) return infinity;
    return up(growth(power, w) / std::pow(m + w, e), 32);
}

Raised multiple(Raised x, Interval by) {
    if (x.slope == infinity || (by.lo < 0 && by.hi > 0)) return {};
    x.slope = up(times(x.slope, root_of(by.magnitude(), x.power)), 4);
    x.base = x.base * by;
    if (by.lo < 0) x.negative = !x.negative;
    return x;
}

} // namespace

Raised either(const Raised &a, const Raised &b) {
    if (a.power != b.power || a.base != b.base || !a.base.is_point() || a.negative != b.negative)
        return {};
    return {std::max(a.slope, b.slope), a.power, a.base, a.negative};
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
    const bool known = norm_[u] > 0 && inner.slope < infinity && inner.power > 0;
    if (known && inner.base == Interval(0.0) && !inner.negative) {
        const bool itself = inner.power == infinity;
        return {itself ? up(power * inner.slope) : inner.slope, power * inner.power};
    }
    return norm_[u] < infinity ? Raised{norm_[u], power} : Raised();
}

// Powers, and sums and multiples of them.
Raised Machine::raised(const Instruction &instruction) const {
    const Slot out = instruction.out;
    if (tape_.size[out] != 1 || norm_[out] == 0) return {};
    if (trouble_[out] == Trouble::Jump || trouble_[out] == Trouble::Overflow) return {};
    const Slot a = instruction.args.empty() ? out : instruction.args[0],
               b = instruction.args.size() < 2 ? a : instruction.args[1];
    const Op op = instruction.op;
    if (instruction.form == Form::Square) return raised_to(a, 2);
    if (instruction.form != Form::Plain) return {};
    if (op == Op::Dot) return a == b && norm_[a] < infinity ? Raised{norm_[a], 2} : Raised();
    if (op == Op::Pow) {
        const Interval exponent = value(b, 0);
        const bool even = std::fmod(exponent.lo, 2) == 0 && exponent.lo <= 64;
        if (norm_[b] != 0 || !exponent.is_point() || !(exponent.lo >= 2)) return {};
        return even || value(a, 0).lo >= 0 ? raised_to(a, exponent.lo) : Raised();
    }
    if (op == Op::Neg) {
        Raised x = raised(a);
        x.base = -x.base, x.negative = !x.negative;
        return x;
    }
    if (op == Op::Add || op == Op::Sub) {
        Raised x = raised(a), y = raised(b);
        if (op == Op::Sub) y.base = -y.base, y.negative = !y.negative;
        if (x.slope == 0) std::swap(x, y);
        if (y.slope == 0) return {x.slope, x.power, x.base + y.base, x.negative};
        if (x.power != y.power && op == Op::Add) x = grows_as_itself(a), y = grows_as_itself(b);
        const Interval base = x.base + y.base;
        if (x.slope == infinity || y.slope == infinity) return {};
        if (x.power != y.power || x.negative != y.negative) return {};
        const double q = x.power, most = std::max(x.slope, y.slope);
        if (q == infinity) return {most, q, base, x.negative};
        const double sum = std::pow(x.slope, q) + std::pow(y.slope, q);
        const bool apart = at_right_angles(instruction, 0, 1);
        return {apart && q == 2 ? most : root_of(up(sum, 16), q), q, base, x.negative};
    }
    if (op == Op::Mul || op == Op::Div) {
        const bool first = op == Op::Mul && norm_[a] == 0;
        const Raised x = raised(first ? b : a);
        Interval by = value(first ? a : b, 0);
        if (norm_[first ? a : b] != 0) {
            const Monomial m = monomial(out);
            const bool even = m.degree >= 2 && m.degree % 2 == 0;
            return even ? multiple(raised_to(m.of, m.degree), m.by) : Raised();
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

// Of v^-e for such a v.
double Machine::norm_of_inverse(Slot s, double e) const {
    const Raised x = raised(s);
    if (x.slope == infinity || x.power == 0 || x.negative || !(x.base.lo >= 0)) return infinity;
    return up(times(e * x.slope, steepest_share(x.power, x.base.lo, e + 1, above_base(s, x))), 8);
}

// … and what else reads them.
double Machine::norm_by_raised(const Instruction &instruction) const {
    if (instruction.form != Form::Plain || tape_.size[instruction.out] != 1) return infinity;
    const Op op = instruction.op;
    if (op == Op::InverseSqrt) return norm_of_inverse(instruction.args[0], 0.5);
    if (op == Op::Pow) {
        const Interval exponent = value(instruction.args[1], 0);
        const bool falls =
            norm_[instruction.args[1]] == 0 && exponent.is_point() && exponent.hi < 0;
        return falls ? norm_of_inverse(instruction.args[0], -exponent.lo) : infinity;
    }
    if (op != Op::Exp && op != Op::Exp2 && op != Op::Sqrt) return infinity;
    const Raised x = raised(instruction.args[0]);
    if (x.slope == infinity || x.power == 0) return infinity;
    if (op == Op::Sqrt) return x.power == 2 && !x.negative && x.base.lo >= 0 ? x.slope : infinity;
    if (!x.negative) return infinity;
    const double rate = op == Op::Exp ? 1 : std::numbers::ln2;
    const double slope = times(x.slope, root_of(rate, x.power));
    const Interval w = Interval(rate) * above_base(instruction.args[0], x);
    return up(times(times(slope, steepest_decay(x.power, w)), exp(Interval(rate) * x.base).hi), 16);
}

void Machine::hold_raised(const Instruction &instruction) {
    const Slot out = instruction.out;
    Raised &x = raised_[out];
    x = raised(instruction);
    if (x.slope == infinity || x.slope == 0 || x.negative || !(x.base.lo >= 0)) return;
    relative_[out] =
        std::min(relative_[out],
                 up(times(x.slope, steepest_share(x.power, x.base.lo, 1, above_base(out, x))), 8));
}

} // namespace fathom::proof
