// One step of the machine in progress: what its rules read and write, and the shapes that many
// rules share. For machine*.cpp alone.
#pragma once

#include "proof/machine.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::max_single;
using ir::rounding::min_single;

inline Row scaled(Interval factor, const Row &row) {
    return {factor * row[0], factor * row[1], factor * row[2]};
}
inline Row sum(const Row &a, const Row &b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Row joined(const Row &a, const Row &b) {
    return {hull(a[0], b[0]), hull(a[1], b[1]), hull(a[2], b[2])};
}
inline bool zero(const Row &row) {
    return row[0] == Interval(0.0) && row[1] == Interval(0.0) && row[2] == Interval(0.0);
}

// Where they have one their value is no number, or no finite one.
constexpr ir::OpSet poles{Op::Div, Op::InverseSqrt, Op::Log, Op::Log2, Op::Tan};

// Whether a, b or both may be the greater.
struct Choice {
    bool first, second;
};
inline Choice greater(Interval a, Interval b) { return {a.hi >= b.lo, b.hi >= a.lo}; }

// One instruction being run, with its arguments and its place for the result in the machine.
struct Step {
    Machine &machine;
    const Instruction &in;
    const Slot out;
    const std::uint32_t at;
    const int n; // components of the result
    static constexpr Row none{};
    bool any_odd = false; // an argument is odd, and the op does not know what becomes of it

    Step(Machine &of, const Instruction &instruction);
    void run();
    bool overflows() const;
    double bend() const; // machine_bend.cpp
    bool stands_still() const;
    void look_back(int c); // ways.cpp

    // -- inputs (machine_inputs.cpp)
    void constant();
    void point();
    void unit_vector();
    void time();
    void param();
    void variable();
    void table_read();
    void read();
    void hash();
    Interval hash_of_turn() const;
    void perlin();
    void simplex();
    void value_noise();
    void worley();
    void spot_noise();
    void sampled();
    void cached();

    // -- by component (machine_arithmetic.cpp)
    void negate();
    void add();
    void product();
    void quotient();
    void remainder();
    void power();
    void squared();
    void odd_power();
    void wave();
    void sinc();
    void hyperbolic();
    void held_wave();
    void absolute();
    void angle();
    Interval length_of_both() const;
    double of_two(double x_length, const Row &x, double y_length, const Row &y) const;
    void smoothstep();
    template <auto function, auto slope> void of_one() { unary(function, slope); }

    // -- choices (machine_choices.cpp)
    void extreme();
    int known_extreme(int c) const;
    void combine();
    void blend();
    void clamped();
    void mixed();
    void step_at();
    void sign_of();
    void floor_of();
    void ceil_of();
    void round_of();
    void trunc_of();
    void fraction();
    void compare();
    void compared();
    void both();
    void either();
    void opposite();
    void choose();
    void to_float();

    void nothing(); // has no rule: no bound

    // -- what mixes components (machine_vectors.cpp)
    double together() const;
    void splat();
    void make();
    void swizzle();
    int repeats_of_swizzle() const;
    void column();
    void transpose();
    void length();
    void corner();
    void p_norm();
    void smooth();
    void log_sum();
    void dot();
    void cross();
    void normalize();
    void multiply();

    // -- arguments and results, by component
    std::uint32_t first(int arg) const {
        return machine.tape_.first[in.args[static_cast<std::size_t>(arg)]];
    }
    const Interval &value(int arg, int c) const {
        return machine.value_[first(arg) + static_cast<std::uint32_t>(c)];
    }
    const Row &grad(int arg, int c) const {
        return machine.grad_[first(arg) + static_cast<std::uint32_t>(c)];
    }
    bool odd(int arg, int c) const {
        return machine.odd_[first(arg) + static_cast<std::uint32_t>(c)] != 0;
    }
    int size(int arg) const {
        return int(machine.tape_.size[in.args[static_cast<std::size_t>(arg)]]);
    }
    double norm(int arg) const { return machine.norm_[in.args[static_cast<std::size_t>(arg)]]; }
    void set(int c, Interval v, const Row &g, bool is_odd = false) {
        machine.value_[at + static_cast<std::uint32_t>(c)] = v;
        machine.grad_[at + static_cast<std::uint32_t>(c)] = g;
        machine.odd_[at + static_cast<std::uint32_t>(c)] = is_odd;
    }
    void finish(double norm, bool odd_used) { machine.finish(in, norm, odd_used); }
    void fail(Trouble why) { machine.fail(in, why); }

    // Is it proved that the result does not see this choice or step turn, here?
    bool cancels() const { return in.cancels && (!machine.tape_.near || machine.near_); }

    // -- runs by ways (ways.h)
    bool by_ways() const { return machine.ways_ != nullptr; }
    // Of an open choice of so many ways, the one that this run goes; -1 where all are looked at.
    // Asked of each choice that a rule meets, open or not, in one order.
    int way(bool open, int many, int known = -1) {
        return by_ways() ? machine.ways_->way(open, many, known) : -1;
    }
    // What is known of the sign of a difference, and of that of a value which is one: 0 where a <= b
    // (the value is at most 0), 1 where a >= b; -1: nothing.
    int order_of(int a, int ac, int b, int bc) const {
        return machine.order(in.args[std::size_t(a)], ac, in.args[std::size_t(b)], bc);
    }
    void keep_order(int lesser, int lc, int greater, int gc) {
        machine.keep_order(in.args[std::size_t(lesser)], lc, in.args[std::size_t(greater)], gc);
    }
    // One of the whole numbers.
    Interval one_of(Interval whole) {
        const bool few = !whole.is_point() && whole.width() <= 2;
        const int w = way(few, few ? int(whole.width()) + 1 : 1);
        return w < 0 ? whole : Interval(whole.lo + w);
    }
    void keep_sign(int arg, int c, bool negative) {
        machine.keep_sign(in.args[std::size_t(arg)], c, negative);
    }
    std::optional<double> number(int arg, int c) const {
        const Interval x = value(arg, c);
        return x.is_point() ? std::optional(x.lo) : std::nullopt;
    }
    void narrow(int arg, int c, Interval to) {
        machine.narrow(in.args[static_cast<std::size_t>(arg)], c, to);
    }

    // -- shapes of rules
    // f by component with the derivative's interval; norm(diag(D) J) <= max |D| * norm(J).
    template <class F, class D> void unary(F f, D derivative) {
        double most = 0;
        bool at_pole = false; // as log(k) at k = 0, whether that varies or not
        for (int c = 0; c < n; ++c) {
            const Interval x = value(0, c), y = f(x);
            Interval d = zero(grad(0, c)) ? Interval(0.0) : derivative(x);
            most = std::max(most, d.magnitude());
            at_pole = at_pole || (poles[in.op] && x.finite() && !y.finite());
            set(c, y, scaled(d, grad(0, c)));
        }
        if (at_pole) return fail(Trouble::Singular);
        finish(ir::rounding::times(most, norm(0)), any_odd);
    }
    // The same number at all points of the cell, also in single precision.
    bool is_still(int arg, int c) const { return zero(grad(arg, c)) && !in.wavers; }
    // Whether an argument may be 0/0: also the one that is never the least, since what a minimum of no
    // number is hangs on the order of its arguments (ir/semantics.h).
    bool may_be_undefined() const {
        return std::ranges::any_of(in.args, [&](Slot a) { return machine.undefined_[a] != 0; });
    }
    bool has_pole(int arg) const { return machine.pole_[in.args[std::size_t(arg)]] != 0; }
    bool may_jump(int arg) const { // of itself, so that it need not pass a choice's border
        return norm(arg) == ir::rounding::infinity || any_odd;
    }
    bool is_one_value() const {
        for (int c = 0; c < n; ++c)
            if (!machine.value_[at + static_cast<std::uint32_t>(c)].is_point()) return false;
        return true;
    }
    // Constant by pieces: fine where one piece holds the cell. `where`: of an argument whose value
    // is that whole number.
    template <class F, class B> void stepped(F f, B where) {
        bool jumps = false;
        for (int c = 0; c < n; ++c) {
            Interval v = f(c);
            if (by_ways()) {
                v = one_of(v);
                set(c, v, none);
                if (v.is_point()) narrow(0, c, where(v.lo));
                continue;
            }
            jumps = jumps || (!v.is_point() && !is_still(0, c));
            set(c, v, none);
        }
        // what jumps of itself need not pass a border of the step
        if (jumps && (!cancels() || norm(0) == ir::rounding::infinity))
            fail(Trouble::Jump);
        else
            finish(0, any_odd && !jumps);
    }
    // A truth. Where it may turn within the cell its norm is 1, so that a number made of it jumps
    // there; a choice by it need not (Joined). It is 0 where all points of the cell have the same.
    void truth(Interval v) {
        constexpr Interval all = Interval::everything();
        double norms = 0;
        for (int a = 0; a < int(in.args.size()); ++a) norms = std::max(norms, norm(a));
        const bool turns = !v.is_point() && (norms > 0 || any_odd || in.wavers);
        set(0, v, turns ? Row{all, all, all} : none);
        if (turns && (norms == ir::rounding::infinity || any_odd)) return fail(Trouble::Jump);
        finish(turns ? 1 : 0, false);
    }
    // `told`: that a component goes way 0, which is a, or 1, which is b; `known`: of which way that
    // is known already, or -1.
    template <class AV, class AG, class BV, class BG, class T, class K>
    double extremum(int sign, AV a_value, AG a_grad, BV b_value, BG b_grad, double a_norm,
                    double b_norm, T told, K known) {
        bool some_a = false, some_b = false;
        for (int c = 0; c < n; ++c) {
            Interval a = a_value(c), b = b_value(c);
            Choice which = sign > 0 ? greater(a, b) : greater(-a, -b);
            Interval v = sign > 0 ? max(a, b) : min(a, b);
            if (by_ways()) {
                // Where they touch alone, the one that is not beyond the other is all there is.
                const Interval above = sign > 0 ? a : -a, other = sign > 0 ? b : -b;
                which = {above.hi > other.lo, other.hi > above.lo};
                if (!which.first && !which.second) which.second = true;
                const int w = way(which.first && which.second, 2, known(c));
                if (w == 0) which.second = false, v = meet(a, v);
                if (w == 1) which.first = false, v = meet(b, v);
                if (w >= 0) told(c, w);
            }
            some_a = some_a || which.first, some_b = some_b || which.second;
            if (!which.second)
                set(c, v, a_grad(c));
            else if (!which.first)
                set(c, v, b_grad(c));
            else
                set(c, v, joined(a_grad(c), b_grad(c)));
        }
        if (!some_b) return a_norm;
        if (!some_a) return b_norm;
        if (n == 1 || a_norm == 0 || b_norm == 0) return std::max(a_norm, b_norm);
        return ir::rounding::up(std::hypot(a_norm, b_norm), 4);
    }
    // The slope of a function of a vector that is `slope`-Lipschitz in it, for output component c.
    Row through(double slope, int arg) const {
        Row g;
        for (std::size_t j = 0; j < 3; ++j) {
            double column = 0;
            for (int c = 0; c < size(arg); ++c) column += std::pow(grad(arg, c)[j].magnitude(), 2);
            double m = column == 0
                           ? 0
                           : ir::rounding::times(slope, ir::rounding::up(std::sqrt(column), 4));
            g[j] = {-m, m};
        }
        return g;
    }
    bool is_int() const { return in.type == ir::Type::Int; }
    // ints have no slope; where one varies with the point, it jumps
    void settle_int() {
        bool jumps = false;
        for (int a = 0; a < int(in.args.size()); ++a) jumps = jumps || norm(a) > 0;
        if (jumps)
            fail(Trouble::Jump);
        else
            finish(0, any_odd);
    }
};

} // namespace fathom::proof
