// What chooses: least and greatest, means, steps, comparisons, `if`. Proofs: docs/lipschitz.md, 2.
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

} // namespace

void Step::extreme() {
    double m = extremum(
        in.op == Op::Max ? 1 : -1, [&](int c) { return value(0, c); },
        [&](int c) { return grad(0, c); }, [&](int c) { return value(1, c); },
        [&](int c) { return grad(1, c); }, norm(0), norm(1));
    finish(m, any_odd);
}

void Step::combine() {
    int sign = in.op == Op::Intersection ? 1 : -1;
    Interval v = value(0, 0);
    Row g = grad(0, 0);
    double m = norm(0);
    for (int a = 1; a < int(in.args.size()); ++a) {
        m = extremum(
            sign, [&](int) { return v; }, [&](int) { return g; }, [&](int) { return value(a, 0); },
            [&](int) { return grad(a, 0); }, m, norm(a));
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
    double m = extremum(
        1, [&](int c) { return value(0, c); }, [&](int c) { return grad(0, c); },
        [&](int c) { return value(1, c); }, [&](int c) { return grad(1, c); }, norm(0), norm(1));
    m = extremum(
        -1, [&](int c) { return machine.value_[at + static_cast<std::uint32_t>(c)]; },
        [&](int c) { return machine.grad_[at + static_cast<std::uint32_t>(c)]; },
        [&](int c) { return value(2, c); }, [&](int c) { return grad(2, c); }, m, norm(2));
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
        set(c, v,
            sum(sum(scaled(s, grad(0, c)), scaled(t, grad(1, c))), scaled(b - a, grad(2, c))));
    }
    double m = convex && n == 1 ? std::max(norm(0), norm(1))
                                : up(times(s_most, norm(0)) + times(t_most, norm(1)));
    if (convex && n > 1 && same && value(2, 0).is_point()) m = std::max(norm(0), norm(1));
    finish(up(m * (1 + 4 * rounded) + times(gap, norm(2))), any_odd);
}

void Step::step_at() {
    stepped([&](int c) {
        Interval edge = value(0, c), x = value(1, c);
        return truth_of(x.lo < edge.hi, x.hi >= edge.lo);
    });
    const bool turns = in.cancels ? may_jump(0) || may_jump(1) : norm(0) > 0 || norm(1) > 0;
    if (turns && !is_one_value()) fail(Trouble::Jump);
}

void Step::sign_of() {
    stepped([&](int c) {
        Interval x = value(0, c);
        auto sign = [](double y) { return y < 0 ? -1.0 : y > 0 ? 1.0 : 0.0; };
        return Interval(sign(x.lo), sign(x.hi));
    });
    if (in.cancels && may_jump(0) && !is_one_value()) fail(Trouble::Jump);
}

void Step::floor_of() {
    stepped([&](int c) { return floor(value(0, c)); });
}

void Step::ceil_of() {
    stepped([&](int c) { return ceil(value(0, c)); });
}

void Step::round_of() {
    stepped([&](int c) { return floor(value(0, c) + Interval(0.5)); });
}

void Step::trunc_of() {
    stepped([&](int c) { return trunc(value(0, c)); });
}

void Step::fraction() {
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
    finish(norm(0), any_odd);
}

void Step::compare() {
    Interval a = value(0, 0), b = value(1, 0);
    if (in.op == Op::Less) return truth(truth_of(a.hi >= b.lo, a.lo < b.hi));
    if (in.op == Op::LessEqual) return truth(truth_of(a.hi > b.lo, a.lo <= b.hi));
    bool can_equal = a.hi >= b.lo && b.hi >= a.lo, can_differ = !(a.is_point() && a == b);
    truth(in.op == Op::Equal ? truth_of(can_differ, can_equal) : truth_of(can_equal, can_differ));
}

void Step::both() { truth(min(value(0, 0), value(1, 0))); }

void Step::either() { truth(max(value(0, 0), value(1, 0))); }

void Step::opposite() { truth({1 - value(0, 0).hi, 1 - value(0, 0).lo}); }

void Step::choose() {
    Interval c = value(0, 0);
    if (c.lo > 0.5) return machine.copy(in.args[1], out);
    if (c.hi < 0.5) return machine.copy(in.args[2], out);
    machine.copy(in.args[1], out);
    const bool meets = in.form == Form::Joined || in.form == Form::Opposite,
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
