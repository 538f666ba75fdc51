// What chooses: least and greatest, means, steps, comparisons, `if`. Proofs: docs/lipschitz.md, 2.
#include "proof/instruction_rules.h"
#include "proof/supports.h"

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

} // namespace

void Step::extreme() {
    if (may_be_undefined()) return fail(Trouble::Singular);
    double m = extremum(
        in.op == Op::Max ? 1 : -1, [&](int c) { return value(0, c); },
        [&](int c) { return grad(0, c); }, [&](int c) { return value(1, c); },
        [&](int c) { return grad(1, c); }, norm(0), norm(1),
        [&](int c, int w) {
            const Interval own = value(w, c), other = value(1 - w, c);
            const bool greatest = in.op == Op::Max;
            narrow(w, c, greatest ? Interval(other.lo, infinity) : Interval(-infinity, other.hi));
            narrow(1 - w, c, greatest ? Interval(-infinity, own.hi) : Interval(own.lo, infinity));
            keep_order(greatest ? 1 - w : w, c, greatest ? w : 1 - w, c);
            if (number(1 - w, c) == 0.0) keep_sign(w, c, !greatest);
            if (number(w, c) == 0.0) keep_sign(1 - w, c, greatest);
        },
        [&](int c) { return known_extreme(c); });
    finish(m, any_odd);
}

// Of the two arguments the one that is known to be the extreme; -1 where neither is.
int Step::known_extreme(int c) const {
    const bool greatest = in.op == Op::Max;
    int lesser = order_of(0, c, 1, c);
    for (int a = 0; a < 2 && lesser < 0; ++a) // beside 0 the sign says it
        if (number(1 - a, c) == 0.0)
            if (const int sign = machine.sign_of(in.args[std::size_t(a)], c); sign >= 0)
                lesser = sign == 0 ? a : 1 - a;
    return lesser < 0 ? -1 : greatest ? 1 - lesser : lesser;
}

void Step::combine() {
    if (may_be_undefined()) return fail(Trouble::Singular);
    int sign = in.op == Op::Intersection ? 1 : -1;
    Interval v = value(0, 0);
    Row g = grad(0, 0);
    double m = norm(0);
    for (int a = 1; a < int(in.args.size()); ++a) {
        m = extremum(
            sign, [&](int) { return v; }, [&](int) { return g; }, [&](int) { return value(a, 0); },
            [&](int) { return grad(a, 0); }, m, norm(a), [](int, int) {}, [](int) { return -1; });
        v = machine.value_[at], g = machine.grad_[at];
    }
    set(0, v, g);
    finish(m, any_odd);
}

// (r, n, a, b, …); every profile lies in [min - r, min] and weighs gradients with norm <= 1 or sqrt 2
void Step::blend() {
    Interval v = value(2, 0);
    Row g = grad(2, 0);
    double m = norm(2),
           factor = static_cast<Profile>(in.payload) == Profile::Columns ? 1.4142135623730952 : 1.0;
    bool radius_varies = norm(0) > 0 || norm(1) > 0;
    for (int a = 3; a < int(in.args.size()); ++a) {
        v = min(v, value(a, 0));
        v.lo = (v - Interval(std::max(value(0, 0).hi, 0.0))).lo;
        m = factor == 1 ? std::max(m, norm(a)) : up(std::hypot(m, norm(a)), 4);
        for (std::size_t j = 0; j < 3; ++j) g[j] = {-m, m};
    }
    set(0, v, g);
    if (radius_varies) return fail(Trouble::Singular);
    finish(m, any_odd);
}

void Step::clamped() {
    if (may_be_undefined()) return fail(Trouble::Singular);
    const auto nothing_known = [](int) { return -1; };
    double m = extremum(
        1, [&](int c) { return value(0, c); }, [&](int c) { return grad(0, c); },
        [&](int c) { return value(1, c); }, [&](int c) { return grad(1, c); }, norm(0), norm(1),
        [&](int c, int w) {
            const Interval lo = value(1, c);
            narrow(0, c, w == 0 ? Interval(lo.lo, infinity) : Interval(-infinity, lo.hi));
        },
        nothing_known);
    m = extremum(
        -1, [&](int c) { return machine.value_[at + static_cast<std::uint32_t>(c)]; },
        [&](int c) { return machine.grad_[at + static_cast<std::uint32_t>(c)]; },
        [&](int c) { return value(2, c); }, [&](int c) { return grad(2, c); }, m, norm(2),
        [&](int c, int w) {
            const Interval lo = value(1, c), hi = value(2, c);
            if (w == 0) narrow(0, c, {-infinity, hi.hi});
            if (w == 1 && lo.hi < hi.lo) narrow(0, c, {hi.lo, infinity});
        },
        nothing_known);
    finish(m, any_odd);
}

// a + t (b - a)
void Step::mixed() {
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
        Row mean = sum(scaled(s, grad(0, c)), scaled(t, grad(1, c)));
        if (t.lo >= 0 && t.hi <= 1)
            for (std::size_t j = 0; j < 3; ++j)
                mean[j] = meet(hull(grad(0, c)[j], grad(1, c)[j]), mean[j]);
        set(c, v, sum(mean, scaled(b - a, grad(2, c))));
    }
    double m = convex && n == 1 ? std::max(norm(0), norm(1))
                                : up(times(s_most, norm(0)) + times(t_most, norm(1)));
    if (convex && n > 1 && same && value(2, 0).is_point()) m = std::max(norm(0), norm(1));
    m = up(m * (1 + 4 * rounded));
    const double turning = times(gap, norm(2));
    // the weight's gradient is at right angles to both others (supports.h)
    const bool apart = n == 1 && in_other_group(in, 2, 0) && in_other_group(in, 2, 1);
    finish(apart ? up(std::hypot(m, turning), 4) : up(m + turning), any_odd);
}

void Step::step_at() {
    stepped(
        [&](int c) {
            Interval edge = value(0, c), x = value(1, c);
            return truth_of(x.lo < edge.hi, x.hi >= edge.lo);
        },
        [](double) { return Interval::everything(); });
    if (by_ways()) return;
    const bool turns =
        cancels() ? may_jump(0) || may_jump(1) : norm(0) > 0 || norm(1) > 0 || in.wavers;
    if (turns && !is_one_value()) fail(Trouble::Jump);
}

void Step::sign_of() {
    stepped(
        [&](int c) {
            Interval x = value(0, c);
            auto sign = [](double y) { return y < 0 ? -1.0 : y > 0 ? 1.0 : 0.0; };
            return Interval(sign(x.lo), sign(x.hi));
        },
        [](double is) { return Interval(is < 0 ? -infinity : 0, is > 0 ? infinity : 0); });
    if (by_ways()) return;
    if (cancels() && may_jump(0) && !is_one_value()) fail(Trouble::Jump);
}

void Step::floor_of() {
    stepped([&](int c) { return floor(value(0, c)); },
            [](double is) { return Interval(is, is + 1); });
}

void Step::ceil_of() {
    stepped([&](int c) { return ceil(value(0, c)); },
            [](double is) { return Interval(is - 1, is); });
}

void Step::round_of() {
    stepped([&](int c) { return floor(value(0, c) + Interval(0.5)); },
            [](double is) { return Interval(is) + Interval(-0.5, 0.5); });
}

void Step::trunc_of() {
    stepped([&](int c) { return trunc(value(0, c)); },
            [](double) { return Interval::everything(); });
}

void Step::fraction() {
    bool jumps = false;
    for (int c = 0; c < n; ++c) {
        constexpr double most = 1000; // … of which single precision has the fraction to 1/10'000
        Interval x = value(0, c), whole = floor(x);
        if (norm(0) == 0 && (in.scatters || x.magnitude() > most)) {
            jumps = jumps || in.wavers;
            set(c, {0, 1}, none);
            continue;
        }
        if (by_ways()) {
            whole = one_of(whole);
            const bool one = whole.is_point() && whole.finite();
            set(c, one ? meet(Interval(0, 1), x - whole) : Interval(0, 1), grad(0, c));
            if (one) narrow(0, c, whole + Interval(0, 1));
            continue;
        }
        if (whole.is_point() && whole.finite())
            set(c, x - whole, grad(0, c));
        else {
            jumps = jumps || (!cancels() && !is_still(0, c));
            set(c, {0, 1}, grad(0, c));
        }
    }
    if (jumps) return fail(Trouble::Jump);
    finish(norm(0), any_odd);
}

void Step::compare() {
    Interval a = value(0, 0), b = value(1, 0);
    if (by_ways()) return compared();
    if (in.op == Op::Less) return truth(truth_of(a.hi >= b.lo, a.lo < b.hi));
    if (in.op == Op::LessEqual) return truth(truth_of(a.hi > b.lo, a.lo <= b.hi));
    bool can_equal = a.hi >= b.lo && b.hi >= a.lo, can_differ = !(a.is_point() && a == b);
    truth(in.op == Op::Equal ? truth_of(can_differ, can_equal) : truth_of(can_equal, can_differ));
}

// In a run by ways it is true, or false, in all that is left of the cell.
void Step::compared() {
    const Interval a = value(0, 0), b = value(1, 0);
    const bool orders = in.op == Op::Less || in.op == Op::LessEqual;
    Interval v;
    if (in.op == Op::Less)
        v = truth_of(a.hi >= b.lo, a.lo < b.hi);
    else if (in.op == Op::LessEqual)
        v = truth_of(a.hi > b.lo, a.lo <= b.hi);
    else {
        const bool can_equal = a.hi >= b.lo && b.hi >= a.lo, can_differ = !(a.is_point() && a == b);
        v = in.op == Op::Equal ? truth_of(can_differ, can_equal) : truth_of(can_equal, can_differ);
    }
    const bool open = !v.is_point();
    const int order = orders ? order_of(0, 0, 1, 0) : -1;
    const int w = way(open, 2, order < 0 ? -1 : 1 - order);
    if (w >= 0) v = double(w);
    set(0, v, none);
    finish(0, false);
    if (!open || !orders || !v.is_point()) return;
    const int less = v.lo == 1 ? 0 : 1; // which argument is the lesser
    narrow(less, 0, {-infinity, value(1 - less, 0).hi});
    narrow(1 - less, 0, {value(less, 0).lo, infinity});
    keep_order(less, 0, 1 - less, 0);
    for (int a = 0; a < 2; ++a)
        if (number(1 - a, 0) == 0.0) keep_sign(a, 0, a == less);
}

void Step::both() { truth(min(value(0, 0), value(1, 0))); }

void Step::either() { truth(max(value(0, 0), value(1, 0))); }

void Step::opposite() { truth({1 - value(0, 0).hi, 1 - value(0, 0).lo}); }

void Step::choose() {
    Interval c = value(0, 0);
    if (by_ways() && c.lo <= 0.5 && c.hi >= 0.5) { // hangs on more than comparisons
        machine.copy(in.args[1], out);
        return machine.join(out, in.args[2], false, in.node);
    }
    if (c.lo > 0.5) return machine.copy(in.args[1], out);
    if (c.hi < 0.5) return machine.copy(in.args[2], out);
    if (in.type == ir::Type::Bool) return truth(hull(value(1, 0), value(2, 0)));
    machine.copy(in.args[1], out);
    const bool joins = in.form == Form::Joined || in.form == Form::Opposite,
               meets = in.cancels ? cancels() : joins,
               agree = norm(0) == 0 || (meets && norm(0) != infinity);
    machine.join(out, in.args[2], !agree, in.node);
    if (in.form != Form::Opposite || norm(0) == 0) return;
    for (int c = 0; c < n; ++c) machine.odd_[at + static_cast<std::uint32_t>(c)] = true;
    machine.cause_[out] = in.node;
}

void Step::to_float() {
    set(0, value(0, 0), none);
    if (!value(0, 0).is_point() && norm(0) > 0) return fail(Trouble::Jump);
    finish(0, any_odd);
}

} // namespace fathom::proof
