// One rule an op: the value's interval, the partial derivatives' intervals, the norm; what mixes
// components stands in machine_vectors.cpp. Proofs: docs/lipschitz.md, 2.
#include "ir/noise.h"
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Profile;
using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

namespace {

Interval truth_of(bool may_be_false, bool may_be_true) {
    return {may_be_false ? 0.0 : 1.0, may_be_true ? 1.0 : 0.0};
}

bool even_aware(const Instruction &i) {
    if (i.form == Form::Norm || i.form == Form::Square || i.form == Form::Joined) return true;
    switch (ir::info(i.op).parity) {
    case ir::OpParity::Even:
    case ir::OpParity::Product:
    case ir::OpParity::Parts: return true;
    case ir::OpParity::None:
    case ir::OpParity::Odd:
    case ir::OpParity::Sum:
    case ir::OpParity::Own: break;
    }
    return i.op == Op::Neg || i.op == Op::Pow;
}

} // namespace

Step::Step(Machine &of, const Instruction &instruction)
    : machine(of), in(instruction), out(in.out), at(of.tape_.first[out]), n(of.tape_.size[out]) {
    if (!even_aware(in))
        for (int a = 0; a < int(in.args.size()); ++a)
            for (int c = 0; c < size(a); ++c) any_odd = any_odd || odd(a, c);
}

void Machine::step(const Instruction &instruction) {
    Step step(*this, instruction);
    step.run();
    if (!bend_.empty()) bend_[instruction.out] = step.bend();
}

// An argument that single precision may not hold is infinity there. What keeps the greater part of
// it, or says the same of all that is so large, may have it; of anything else the value is another
// (log), or none (infinity/infinity).
bool Step::overflows() const {
    const auto large = [&](int arg) {
        for (int c = 0; c < size(arg); ++c)
            if (value(arg, c).magnitude() > max_single) return true;
        return false;
    };
    int many = 0;
    for (int a = 0; a < int(in.args.size()); ++a) many += large(a);
    if (many == 0) return false;
    const auto at_least_one = [&](int arg) {
        for (int c = 0; c < size(arg); ++c)
            if (value(arg, c).mignitude() < 1) return false;
        return true;
    };
    if (in.form != Form::Plain && in.form != Form::Joined) return true;
    constexpr ir::OpSet bear{Op::Neg,          Op::Abs,     Op::Min,       Op::Max,      Op::Union,
                             Op::Intersection, Op::Clamp,   Op::Exp,       Op::Exp2,     Op::Atan,
                             Op::Tanh,         Op::Less,    Op::LessEqual, Op::Select,   Op::Make,
                             Op::Splat,        Op::Swizzle, Op::Column,    Op::Transpose};
    if (bear[in.op]) return false;
    if (in.op == Op::Add || in.op == Op::Sub) return many > 1;
    if (in.op == Op::Mul) return many == 1 && !at_least_one(large(0) ? 1 : 0);
    return in.op != Op::Div || large(0);
}

void Step::run() {
    if (machine.in_reach_ && overflows()) {
        for (int c = 0; c < n; ++c) set(c, Interval::everything(), none);
        return fail(Trouble::Overflow);
    }
    if (in.form == Form::Wave) {
        bool bad = norm(1) > 0;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), m = value(1, c);
            if (m.lo <= 0) {
                bad = true;
                set(c, Interval::everything(), none);
                continue;
            }
            Interval turns = floor(x / m + Interval(0.5));
            if (turns.is_point() && turns.finite())
                set(c, x - m * turns, grad(0, c), odd(0, c));
            else
                set(c, {-m.hi / 2, m.hi / 2}, grad(0, c), !in.cancels && !zero(grad(0, c)));
        }
        if (bad) return fail(Trouble::Jump);
        finish(norm(0), any_odd);
        machine.cause_[out] = in.node;
        return;
    }
    if (in.form == Form::Sinc) { // |(sin x / x)'| <= 0.4362, values in [-0.2173, 1]
        return unary(
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
    if (in.form == Form::Square) {
        double most = 0;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c);
            most = std::max(most, x.magnitude());
            set(c, square(x),
                scaled(Interval(2.0) * x, grad(0, c))); // even: an odd wave becomes continuous
        }
        return finish(times(2 * most, norm(0)), false);
    }
    if (in.form == Form::Norm) return length();
    if (in.form == Form::Corner) return corner();
    if (in.form == Form::Smooth) return smooth();
    if (in.form == Form::LogSum) return log_sum();

    switch (in.op) {
    case Op::Const: {
        const ir::Constant &k = machine.ranges_.scene->graph.constant_of(in.node);
        for (int c = 0; c < n; ++c) set(c, k.value[static_cast<std::size_t>(c)], none);
        return finish(0, false);
    }
    case Op::Point:
        for (int c = 0; c < n; ++c) {
            Row g{};
            g[static_cast<std::size_t>(c)] = 1.0;
            set(c, machine.cell_.p[static_cast<std::size_t>(c)], g);
        }
        return finish(1, false);
    case Op::Normal:
    case Op::Direction:
        for (int c = 0; c < n; ++c) set(c, {-1, 1}, none);
        return finish(0, false);
    case Op::Time: set(0, machine.ranges_.time, none); return finish(0, false);
    case Op::Param:
        for (int c = 0; c < n; ++c)
            set(c, machine.ranges_.params[in.payload][static_cast<std::size_t>(c)], none);
        return finish(0, false);
    case Op::Var: {
        auto found = machine.ranges_.vars.find(in.payload);
        for (int c = 0; c < n; ++c)
            set(c,
                found == machine.ranges_.vars.end() ? Interval::everything()
                                                    : found->second[static_cast<std::size_t>(c)],
                none);
        return finish(0, false);
    }
    case Op::Neg:
        for (int c = 0; c < n; ++c) set(c, -value(0, c), scaled(-1.0, grad(0, c)), odd(0, c));
        finish(norm(0), false);
        if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
        return;
    case Op::Add:
    case Op::Sub: {
        Interval sign = in.op == Op::Add ? 1.0 : -1.0;
        for (int c = 0; c < n; ++c)
            set(c, value(0, c) + sign * value(1, c), sum(grad(0, c), scaled(sign, grad(1, c))));
        return finish(norm(0) == 0               ? norm(1)
                      : norm(1) == 0             ? norm(0)
                      : (axes(0) & axes(1)) == 0 ? up(std::hypot(norm(0), norm(1)), 4)
                                                 : up(norm(0) + norm(1)),
                      any_odd);
    }
    case Op::Mul: {
        if (in.form == Form::OddPower) {
            double most = 0;
            for (int c = 0; c < n; ++c) {
                Interval x = value(0, c), e = value(1, c), power = positive_power(abs(x), e);
                Interval d = (e + Interval(1.0)) * power;
                most = std::max(most, d.magnitude());
                set(c, x * power, scaled(d, grad(0, c)), odd(0, c));
            }
            return finish(times(most, norm(0)), false);
        }
        double a = 0, b = 0;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), y = value(1, c);
            a = std::max(a, x.magnitude()), b = std::max(b, y.magnitude());
            set(c, x * y, sum(scaled(y, grad(0, c)), scaled(x, grad(1, c))),
                odd(0, c) || odd(1, c));
        }
        finish(up(times(b, norm(0)) + times(a, norm(1))), false);
        if (machine.norm_[out] != infinity)
            machine.cause_[out] = machine.cause_[in.args[0]] ? machine.cause_[in.args[0]]
                                                             : machine.cause_[in.args[1]];
        return;
    }
    case Op::Div: {
        if (is_int()) {
            set(0,
                value(1, 0).contains(0)
                    ? hull(0.0, Interval(-value(0, 0).magnitude(), value(0, 0).magnitude()))
                    : trunc(value(0, 0) / value(1, 0)),
                none);
            return settle_int();
        }
        double most = 0, ratio = 0;
        bool singular = false, odd_divisor = false;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), y = value(1, c);
            odd_divisor = odd_divisor || odd(1, c);
            if (zero(grad(1, c)) && zero(grad(0, c))) {
                set(c, x / y, none);
                continue;
            }
            if (y.mignitude() < min_single) {
                singular = true;
                set(c, Interval::everything(), none);
                continue;
            }
            Interval q = x / y, inverse = Interval(1.0) / y;
            most = std::max(most, inverse.magnitude()), ratio = std::max(ratio, q.magnitude());
            set(c, q, scaled(inverse, sum(grad(0, c), scaled(-q, grad(1, c)))), odd(0, c));
        }
        if (singular) return fail(Trouble::Singular);
        finish(up(times(most, norm(0)) + times(times(ratio, most), norm(1)), 4), odd_divisor);
        if (machine.norm_[out] != infinity) machine.cause_[out] = machine.cause_[in.args[0]];
        return;
    }
    case Op::Mod: {
        bool jumps = false;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), m = value(1, c);
            if (m.contains(0)) {
                jumps = jumps || !zero(grad(0, c)) || !zero(grad(1, c));
                double most = std::max(x.magnitude(), m.magnitude());
                set(c, {-most, most}, none);
                continue;
            }
            Interval turns = floor(x / m);
            if (turns.is_point() && turns.finite()) {
                set(c, x - m * turns, sum(grad(0, c), scaled(-turns, grad(1, c))));
                continue;
            }
            jumps = jumps || !zero(grad(1, c)) || (!in.cancels && !zero(grad(0, c)));
            set(c, {std::min(m.lo, 0.0), std::max(m.hi, 0.0)}, grad(0, c));
        }
        if (is_int()) return settle_int();
        if (jumps) return fail(Trouble::Jump);
        return finish(norm(1) == 0 ? norm(0) : infinity, any_odd);
    }
    case Op::Pow: {
        double a = 0, b = 0;
        bool singular = false, odd_left = false;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), y = value(1, c);
            // as evaluators see it: from 2^24 on every number is whole, and even
            const double exponent = y.is_point() ? double(float(y.lo)) : NAN,
                         whole = std::floor(exponent) == exponent ? exponent : NAN;
            odd_left = odd_left || odd(1, c) || (odd(0, c) && !(std::fmod(whole, 2) == 0));
            if (whole >= 0) {
                Interval d =
                    whole == 0 ? Interval(0.0) : Interval(whole) * whole_power(x, whole - 1);
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
        return finish(up(times(a, norm(0)) + times(b, norm(1))), odd_left);
    }
    case Op::Min:
    case Op::Max: {
        double m = extremum(
            in.op == Op::Max ? 1 : -1, [&](int c) { return value(0, c); },
            [&](int c) { return grad(0, c); }, [&](int c) { return value(1, c); },
            [&](int c) { return grad(1, c); }, norm(0), norm(1));
        return finish(m, any_odd);
    }
    case Op::Union:
    case Op::Intersection: {
        int sign = in.op == Op::Intersection ? 1 : -1;
        Interval v = value(0, 0);
        Row g = grad(0, 0);
        double m = norm(0);
        for (int a = 1; a < int(in.args.size()); ++a) {
            m = extremum(
                sign, [&](int) { return v; }, [&](int) { return g; },
                [&](int) { return value(a, 0); }, [&](int) { return grad(a, 0); }, m, norm(a));
            v = machine.value_[at], g = machine.grad_[at];
        }
        set(0, v, g);
        return finish(m, any_odd);
    }
    case Op::Blend: { // (r, n, a, b, …); every profile lies in [min - r, min] and weighs gradients
                      // with norm <= 1 or sqrt 2
        Interval v = value(2, 0);
        Row g = grad(2, 0);
        double m = norm(2), factor = static_cast<Profile>(in.payload) == Profile::Columns
                                         ? 1.4142135623730952
                                         : 1.0;
        bool radius_varies = norm(0) > 0 || norm(1) > 0;
        for (int a = 3; a < int(in.args.size()); ++a) {
            v = min(v, value(a, 0));
            v.lo = (v - Interval(std::max(value(0, 0).hi, 0.0))).lo;
            m = factor == 1 ? std::max(m, norm(a)) : up(std::hypot(m, norm(a)), 4);
            for (std::size_t j = 0; j < 3; ++j) g[j] = {-m, m};
        }
        set(0, v, g);
        if (radius_varies) return fail(Trouble::Singular);
        return finish(m, any_odd);
    }
    case Op::Step:
        stepped([&](int c) {
            Interval edge = value(0, c), x = value(1, c);
            return truth_of(x.lo < edge.hi, x.hi >= edge.lo);
        });
        for (int c = 0; c < n; ++c)
            if (!machine.value_[at + static_cast<std::uint32_t>(c)].is_point() &&
                (norm(0) > 0 || norm(1) > 0))
                return fail(Trouble::Jump);
        return;
    case Op::Sign:
        return stepped([&](int c) {
            Interval x = value(0, c);
            auto sign = [](double y) { return y < 0 ? -1.0 : y > 0 ? 1.0 : 0.0; };
            return Interval(sign(x.lo), sign(x.hi));
        });
    case Op::Floor: return stepped([&](int c) { return floor(value(0, c)); });
    case Op::Ceil: return stepped([&](int c) { return ceil(value(0, c)); });
    case Op::Round: return stepped([&](int c) { return floor(value(0, c) + Interval(0.5)); });
    case Op::Trunc: return stepped([&](int c) { return trunc(value(0, c)); });
    case Op::ToInt: return stepped([&](int c) { return trunc(value(0, c)); });
    case Op::Fract: {
        bool jumps = false;
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c), whole = floor(x);
            if (whole.is_point() && whole.finite())
                set(c, x - whole, grad(0, c));
            else {
                jumps = jumps || (!in.cancels && !zero(grad(0, c)));
                set(c, {0, 1}, grad(0, c));
            }
        }
        if (jumps) return fail(Trouble::Jump);
        return finish(norm(0), any_odd);
    }
    case Op::Atan2: { // the angle turns by at most |grad (x, y)| / r; it jumps across the negative
                      // x axis
        Interval y = value(0, 0), x = value(1, 0), pi(-3.1415926535897936, 3.1415926535897936);
        bool varies = norm(0) > 0 || norm(1) > 0;
        bool cut = x.lo <= 0 && y.contains(0);
        Interval v = pi;
        if (cut && in.cancels && x.hi < 0 && y.lo >= 0) // the cut from above: up to pi
            v = meet(pi, ir::outward(std::atan2(y.hi, x.hi), pi.hi, ir::rounding::library));
        else if (cut && in.cancels && x.hi < 0 && y.hi <= 0) // and from below, its limit there
            v = meet(pi, ir::outward(pi.lo, std::atan2(y.lo, x.hi), ir::rounding::library));
        if (!cut) {
            double a = std::atan2(y.lo, x.lo), b = std::atan2(y.lo, x.hi),
                   c = std::atan2(y.hi, x.lo), d = std::atan2(y.hi, x.hi);
            v = meet(pi, ir::outward(std::min({a, b, c, d}), std::max({a, b, c, d}),
                                     ir::rounding::library));
        }
        const bool crosses = cut && !(in.cancels && !x.contains(0));
        if (!varies || crosses) {
            set(0, v, none);
            if (varies) return fail(x.contains(0) ? Trouble::Singular : Trouble::Jump);
            return finish(0, any_odd);
        }
        Interval r2 = square(x) + square(y);
        if (r2.lo <= 0) r2.lo = std::numeric_limits<double>::min();
        set(0, v, sum(scaled(x / r2, grad(0, 0)), scaled(-(y / r2), grad(1, 0))));
        return finish(up(std::hypot(norm(0), norm(1)) / std::sqrt(r2.lo), 8), any_odd);
    }
    case Op::Abs: { // even: an odd wave becomes continuous
        for (int c = 0; c < n; ++c) {
            Interval x = value(0, c);
            Interval d = x.lo >= 0 && !odd(0, c)   ? Interval(1.0)
                         : x.hi <= 0 && !odd(0, c) ? Interval(-1.0)
                                                   : Interval(-1, 1);
            set(c, abs(x), scaled(d, grad(0, c)));
        }
        if (is_int()) return settle_int();
        return finish(norm(0), false);
    }
#define FATHOM_FUNCTION(name, function, ...)                                                       \
    case Op::name:                                                                                 \
        return unary([](Interval x) { return ir::function(x); },                                   \
                     [](Interval x) { return ir::slope::function(x); });
#include "ir/ops.def"
    case Op::Clamp: {
        double m = extremum(
            1, [&](int c) { return value(0, c); }, [&](int c) { return grad(0, c); },
            [&](int c) { return value(1, c); }, [&](int c) { return grad(1, c); }, norm(0),
            norm(1));
        m = extremum(
            -1, [&](int c) { return machine.value_[at + static_cast<std::uint32_t>(c)]; },
            [&](int c) { return machine.grad_[at + static_cast<std::uint32_t>(c)]; },
            [&](int c) { return value(2, c); }, [&](int c) { return grad(2, c); }, m, norm(2));
        return finish(m, any_odd);
    }
    case Op::Mix: { // a + t (b - a)
        double gap = 0;
        constexpr double rounded = 1e-12; // what rounding outward may add to a weight in 0..1
        bool convex = true, same = true;
        double t_most = 0, s_most = 0;
        for (int c = 0; c < n; ++c) {
            Interval a = value(0, c), b = value(1, c), t = value(2, c), s = Interval(1.0) - t;
            convex = convex && t.lo >= -rounded && t.hi <= 1 + rounded;
            same = same && t == value(2, 0);
            gap = std::max(gap, (b - a).magnitude());
            t_most = std::max(t_most, t.magnitude()), s_most = std::max(s_most, s.magnitude());
            Interval v = a * s + b * t;
            if (t.lo >= 0 && t.hi <= 1) v = meet(hull(a, b), v);
            set(c, v,
                sum(sum(scaled(s, grad(0, c)), scaled(t, grad(1, c))), scaled(b - a, grad(2, c))));
        }
        double m = convex && n == 1 ? std::max(norm(0), norm(1))
                                    : up(times(s_most, norm(0)) + times(t_most, norm(1)));
        if (convex && n > 1 && same && value(2, 0).is_point()) m = std::max(norm(0), norm(1));
        return finish(up(m * (1 + 4 * rounded) + times(gap, norm(2))), any_odd);
    }
    case Op::Smoothstep: {
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
            if (whole.hi <= 0 || whole.lo >= 1)
                v = whole.hi <= 0 ? 0.0 : 1.0; // and not by rounding
            // 6t(1-t): least at the end further from 1/2, 3/2 at 1/2
            auto slope = [](double u) { return 6 * u * (1 - u); };
            Interval d = ir::outward(std::min(slope(t.lo), slope(t.hi)),
                                     t.contains(0.5) ? 1.5 : std::max(slope(t.lo), slope(t.hi)), 4);
            if (whole.hi < 0 || whole.lo > 1) d = 0.0;
            d = Interval(std::max(d.lo, 0.0), d.hi);
            Interval k = d / width;
            Row inner =
                sum(grad(2, c), sum(scaled(t - Interval(1.0), grad(0, c)), scaled(-t, grad(1, c))));
            most = std::max(most, k.magnitude());
            set(c, v, scaled(k, inner));
        }
        if (bad) return fail(Trouble::Singular);
        return finish(times(most, up(norm(2) + norm(0) + norm(1))), any_odd);
    }
    case Op::Dot: return dot();
    case Op::Cross: return cross();
    case Op::Normalize: return normalize();
    case Op::Length: break; // always a Norm
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual: {
        Interval a = value(0, 0), b = value(1, 0);
        if (in.op == Op::Less) return truth(truth_of(a.hi >= b.lo, a.lo < b.hi));
        if (in.op == Op::LessEqual) return truth(truth_of(a.hi > b.lo, a.lo <= b.hi));
        bool can_equal = a.hi >= b.lo && b.hi >= a.lo, can_differ = !(a.is_point() && a == b);
        return truth(in.op == Op::Equal ? truth_of(can_differ, can_equal)
                                        : truth_of(can_equal, can_differ));
    }
    case Op::And: return truth(min(value(0, 0), value(1, 0)));
    case Op::Or: return truth(max(value(0, 0), value(1, 0)));
    case Op::Not: return truth({1 - value(0, 0).hi, 1 - value(0, 0).lo});
    case Op::Select: {
        Interval c = value(0, 0);
        if (c.lo > 0.5) return machine.copy(in.args[1], out);
        if (c.hi < 0.5) return machine.copy(in.args[2], out);
        machine.copy(in.args[1], out);
        const bool agree = norm(0) == 0 || (in.form == Form::Joined && norm(0) != infinity);
        machine.join(out, in.args[2], !agree, in.node);
        return;
    }
    case Op::ToFloat:
        set(0, value(0, 0), none);
        if (!value(0, 0).is_point() && norm(0) > 0) return fail(Trouble::Jump);
        return finish(0, any_odd);
    case Op::Splat: return splat();
    case Op::Make: return make();
    case Op::Swizzle: return swizzle();
    case Op::Column: return column();
    case Op::Transpose: return transpose();
    case Op::MatMul: return multiply();
    case Op::TableRead: {
        const ir::Table &table = machine.ranges_.scene->graph.table(ir::table_of(in.payload));
        int column = ir::column_of(in.payload);
        Interval row = value(0, 0);
        int last = std::max(table.rows - 1, 0);
        int from = int(std::clamp(row.lo, 0.0, double(last))),
            to = int(std::clamp(row.hi, 0.0, double(last)));
        for (int c = 0; c < n; ++c) {
            Interval v{infinity, -infinity};
            for (int r = from; r <= to; ++r)
                v = hull(v,
                         Interval(double(
                             table.data[static_cast<std::size_t>(r * table.stride + column + c)])));
            set(c, v, none);
        }
        if (norm(0) > 0 && from != to) return fail(Trouble::Jump);
        return finish(0, any_odd);
    }
    case Op::Hash: {
        bool fixed = true;
        for (int c = 0; c < size(0); ++c) fixed = fixed && zero(grad(0, c));
        set(0, {0, 1}, none);
        if (!fixed || norm(0) > 0) return fail(Trouble::Jump);
        return finish(0, any_odd);
    }
    case Op::Perlin:
        set(0, {-ir::sem::perlin_range, ir::sem::perlin_range}, through(ir::sem::perlin_slope, 0));
        return finish(times(ir::sem::perlin_slope, norm(0)), any_odd);
    case Op::Simplex:
        set(0, {-ir::sem::simplex_range, ir::sem::simplex_range},
            through(ir::sem::simplex_slope, 0));
        return finish(times(ir::sem::simplex_slope, norm(0)), any_odd);
    case Op::ValueNoise:
        set(0, {0, 1}, through(ir::sem::value_noise_slope, 0));
        return finish(times(ir::sem::value_noise_slope, norm(0)), any_odd);
    case Op::Worley:
        set(0, {0, 1}, through(ir::sem::worley_slope, 0));
        return finish(times(ir::sem::worley_slope, norm(0)), any_odd);
    case Op::SpotNoise: {
        double radius = std::max(value(1, 0).lo, 1e-6),
               density = std::clamp(value(2, 0).hi, 0.0, double(ir::sem::spot_maximum));
        double spots = std::ceil(density),
               scale = std::sqrt(std::max(std::clamp(value(2, 0).lo, 0.0, 8.0), 1.0));
        double slope = up(ir::sem::spot_slope * spots / (radius * scale), 8),
               range = up(ir::sem::spot_range * spots / scale, 8);
        set(0, {-range, range}, through(slope, 0));
        if (norm(1) > 0 || norm(2) > 0) return fail(Trouble::Jump);
        return finish(times(slope, norm(0)), any_odd);
    }
    case Op::Image:
    case Op::Grid: {
        const auto &all = in.op == Op::Image ? machine.ranges_.images : machine.ranges_.grids;
        Ranges::Sampled data = in.payload < all.size()
                                   ? all[in.payload]
                                   : Ranges::Sampled{Interval::everything(), infinity};
        for (int c = 0; c < n; ++c) set(c, data.values, through(data.slope, 0));
        return finish(up(times(data.slope * std::sqrt(double(n)), norm(0)), 4), any_odd);
    }
    case Op::Cached: { // only where it may be kept
        const Ranges::Cached &kept = machine.ranges_.caches[in.payload];
        for (int c = 0; c < n; ++c)
            set(c, kept.values[static_cast<std::size_t>(c)], through(kept.slope, 0));
        return finish(times(kept.slope, norm(0)), any_odd);
    }
    case Op::Call:
    case Op::Loop:
    case Op::LoopResult: break; // flattened away
    case Op::MakeHit:
    case Op::HitDistance:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra:
    case Op::NearestHit:
    case Op::FarthestHit:
    case Op::HitWith:
    case Op::FillPaint: break; // colours, never geometry
    }
    for (int c = 0; c < n; ++c) set(c, Interval::everything(), none);
    fail(Trouble::Singular);
}

} // namespace fathom::proof
