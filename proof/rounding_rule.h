// What the rules of the error analysis share: one step in progress, sums and products, lengths. The
// model: + - * round to nearest; division, square roots and the functions are right to the units
// that `loss` says; what is below the least normal number may be 0. For rounding_rules.cpp alone.
#pragma once

#include "base/single.h"
#include "ir/noise.h"
#include "proof/rounding.h"

#include <algorithm>
#include <cmath>
#include <span>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;

constexpr double unit_roundoff = 0x1p-24; // half a unit_roundoff in the last place of 1

inline double rounded_by(Interval value, double error) {
    return (value.magnitude() + error) * unit_roundoff + smallest_normal;
}
inline double total(const Rounded &x) { return x.error + times(x.relative, x.value.magnitude()); }
inline Interval widened(const Rounded &x) {
    const double e = total(x);
    if (std::isinf(e)) return {x.above, infinity};
    return e == 0 ? x.value : Interval(x.value.lo - e, x.value.hi + e);
}
inline bool still(const Rounded &x) { return x.linear && x.gradient == std::array<double, 3>{}; }
inline bool large(const Rounded &x) { return x.value.magnitude() + total(x) > largest_single; }

// Of a function of one number: what computing it loses, in an argument within x, to a value of v.
// docs/trusted.md names the test. Sines are ours on each evaluator (backend-glsl/helpers).
inline double loss(Op op, Interval x, Interval v) {
    const double size = v.magnitude();
    constexpr ir::OpSet grow{Op::Exp, Op::Exp2, Op::Sinh, Op::Cosh};
    if (op == Op::Sqrt || op == Op::InverseSqrt) return smallest_normal; // and 3 units of itself
    if (grow[op]) return (6 + 4 * x.magnitude()) * unit_roundoff * size + smallest_normal;
    if (op == Op::Sin || op == Op::Cos)
        return std::min(2.0, 8 * unit_roundoff + 2 * unit_roundoff * x.magnitude());
    if (op == Op::Tan) return (1 + size * size) * (8 + 2 * x.magnitude()) * unit_roundoff;
    return 16 * unit_roundoff * std::max(size, 1.0);
}

// Roots and angles are infinitely steep at an end, and yet move by no more than this there.
inline double holder(Op op, double error) {
    if (op == Op::Sqrt) return std::sqrt(error);
    if (op == Op::Asin || op == Op::Acos) return 2.3 * std::sqrt(error);
    return infinity;
}

// One step of a plan in progress.
struct RoundingRule {
    RoundingMachine &machine;
    const ir::Graph &graph;
    NodeId id;
    const ir::Node node;
    std::span<const Rounded *const> args; // each its first component
    std::span<const int> sizes;
    Rounded *out;
    int n;

    const Rounded &arg(int a, int c = 0) const {
        const auto i = static_cast<std::size_t>(a);
        return args[i][sizes[i] == 1 ? 0 : c];
    }
    int count() const { return int(args.size()); }

    static double slope_of(const Rounded &x) { // 1 where it is not known
        const double slope = std::hypot(x.gradient[0], x.gradient[1], x.gradient[2]);
        return x.linear && slope > 0 ? slope : 1;
    }
    // A decision within `error` of a border is taken that far from it, over the slope.
    void decide(double error, const Rounded &x) {
        if (error == 0) return;
        machine.misplaced_ = std::max(machine.misplaced_, std::min(error / slope_of(x), x.off));
    }
    // An angle times or over a number, or more by one, which is rounded by that many units.
    static void turn(Rounded &r, const Rounded &angle, double over, double units) {
        r.reach = angle.reach * over;
        r.off = angle.off + units * unit_roundoff * (r.value.magnitude() + total(r)) * r.reach;
    }
    static Rounded unknown() { return {Interval::everything(), infinity, 0, false, {}}; }
    static Rounded bent(Interval value, double error) {
        return {value, std::isnan(error) ? infinity : error, 0, false, {}};
    }
    // A function of arguments of which none varies does not vary either.
    Rounded made(Interval value, double error) const {
        Rounded r = bent(value, error);
        bool all = true;
        for (int a = 0; a < count(); ++a)
            for (int c = 0; c < sizes[static_cast<std::size_t>(a)]; ++c)
                all = all && still(args[static_cast<std::size_t>(a)][c]);
        r.linear = all;
        return r;
    }
    bool whole() const { return node.type == ir::Type::Int || node.type == ir::Type::Bool; }

    // What evaluators have as infinity may be compared, cut off, divided by and added to a number.
    bool overflows() const {
        int many = 0, which = 0;
        for (int a = 0; a < count(); ++a)
            for (int c = 0; c < sizes[static_cast<std::size_t>(a)]; ++c)
                if (large(args[static_cast<std::size_t>(a)][c])) {
                    ++many, which = a;
                    break;
                }
        if (many == 0) return false;
        constexpr ir::OpSet bear{Op::Neg,       Op::Abs,          Op::Min,      Op::Max,
                                 Op::Union,     Op::Intersection, Op::Clamp,    Op::Atan,
                                 Op::Tanh,      Op::Less,         Op::Equal,    Op::NotEqual,
                                 Op::LessEqual, Op::Select,       Op::Make,     Op::Splat,
                                 Op::Swizzle,   Op::Column,       Op::Transpose};
        if (bear[node.op]) return false;
        if (node.op == Op::Add || node.op == Op::Sub) return many > 1;
        if (node.op == Op::Mul) return many > 1 || arg(1 - which).value.mignitude() < 1;
        return node.op != Op::Div || which == 0;
    }

    // Of numbers, or whole ones within a double's, without widening by the interval's own rounding.
    static Interval added(Interval x, Interval y) {
        const double lo = x.lo + y.lo, hi = x.hi + y.hi;
        const bool exact =
            lo - x.lo == y.lo && lo - y.lo == x.lo && hi - x.hi == y.hi && hi - y.hi == x.hi;
        return exact ? Interval(lo, hi) : x + y;
    }
    static bool is_single(Interval x) { return x.is_point() && to_single(x.lo) == x.lo; }
    // |x| <= |x + y| + |y|, so that the larger one's relative error is one of the sum.
    static Rounded sum(const Rounded &x, const Rounded &y, double sign, bool exact) {
        Rounded r;
        r.value = added(x.value, sign < 0 ? -y.value : y.value);
        const bool first = y.value.magnitude() <= x.value.magnitude();
        const Rounded &most = first ? x : y, &least = first ? y : x;
        r.error =
            x.error + y.error + times(most.relative + least.relative, least.value.magnitude());
        r.relative = most.relative;
        exact = exact || y.value == Interval(0.0) || x.value == Interval(0.0) ||
                (total(x) == 0 && total(y) == 0 && is_single(r.value));
        if (!exact)
            r.relative += unit_roundoff, r.error = r.error * (1 + unit_roundoff) + smallest_normal;
        r.linear = x.linear && y.linear;
        for (std::size_t j = 0; j < 3; ++j) r.gradient[j] = x.gradient[j] + sign * y.gradient[j];
        if (sign > 0) {
            r.root_error = std::hypot(x.root_error, y.root_error);
            r.root_relative = std::max(x.root_relative, y.root_relative) + unit_roundoff;
        }
        if (still(x) != still(y)) turn(r, still(x) ? y : x, 1, 1);
        return r;
    }
    static bool power_of_two(const Rounded &x) {
        int exponent = 0;
        return x.value.is_point() && total(x) == 0 &&
               std::fabs(std::frexp(x.value.lo, &exponent)) == 0.5;
    }
    static Rounded product(const Rounded &x, const Rounded &y, bool exact) {
        Rounded r;
        const double p = x.value.lo * y.value.lo;
        const bool points =
            x.value.is_point() && y.value.is_point() && std::fma(x.value.lo, y.value.lo, -p) == 0;
        r.value = points ? Interval(p) : x.value * y.value;
        const double a = x.value.magnitude(), b = y.value.magnitude();
        r.error = times(a, y.error) + times(b, x.error) + times(total(x), total(y));
        r.relative = x.relative + y.relative;
        if (!exact && !(total(x) == 0 && total(y) == 0 && is_single(r.value))) {
            r.error += smallest_normal;
            if (!power_of_two(x) && !power_of_two(y)) r.relative += 2 * unit_roundoff;
        }
        const Rounded &factor = still(x) ? x : y, &rest = still(x) ? y : x;
        r.linear = still(factor) && rest.linear && (factor.value.is_point() || still(rest));
        if (r.linear)
            for (std::size_t j = 0; j < 3; ++j)
                r.gradient[j] = rest.gradient[j] * factor.value.middle();
        if (&x == &y) {
            r.root_error = x.error + std::sqrt(smallest_normal);
            r.root_relative = x.relative + 2 * unit_roundoff;
        } else if (still(factor) && factor.value.lo >= 0) {
            r.root_error = times(std::sqrt(factor.value.hi), rest.root_error);
            r.root_relative = rest.root_relative + factor.relative + 2 * unit_roundoff;
        }
        if (still(factor)) turn(r, rest, 1 / factor.value.mignitude(), 2);
        return r;
    }
    static Rounded quotient(const Rounded &x, const Rounded &y) {
        const double least = y.value.mignitude() - total(y);
        if (!(least > smallest_normal)) return unknown();
        Rounded r;
        r.value = x.value / y.value;
        const double share = y.value.mignitude() / least; // |y| over the evaluator's
        r.error = (x.error + times(r.value.magnitude(), y.error)) / least + smallest_normal;
        r.relative = (x.relative + y.relative) * share + (power_of_two(y) ? 0 : 6 * unit_roundoff);
        r.linear = still(y) && x.linear && (y.value.is_point() || still(x));
        if (r.linear)
            for (std::size_t j = 0; j < 3; ++j) r.gradient[j] = x.gradient[j] / y.value.middle();
        if (still(y)) turn(r, x, y.value.magnitude(), 6);
        return r;
    }
    // A function of one number, with its slope over all that the evaluator may ask.
    Rounded smooth(const Rounded &x, Interval v, Interval slope) const {
        const bool root = node.op == Op::Sqrt || node.op == Op::InverseSqrt;
        const double e = root ? x.error : total(x); // a root halves what is relative
        const double moved = e == 0 ? 0 : std::min(times(slope.magnitude(), e), holder(node.op, e));
        Rounded r = made(v, moved + loss(node.op, widened(x), v));
        if (root) r.relative = x.relative + 6 * unit_roundoff;
        if (node.op == Op::Sqrt &&
            x.root_error + times(x.root_relative, v.magnitude()) < total(r)) {
            r.error = x.root_error + loss(node.op, widened(x), v);
            r.relative = x.root_relative + 6 * unit_roundoff;
        }
        return r;
    }
    // Of what rounds: the decision is the evaluator's own, its result exact.
    template <class F> Rounded stepped(const Rounded &x, F f) {
        const Interval near = f(widened(x));
        if (!near.is_point()) decide(total(x), x);
        Rounded r = bent(f(x.value), 0);
        r.linear = still(x);
        return r;
    }
    static Rounded extremum(const Rounded &x, const Rounded &y, int sign) {
        const Interval a = widened(x), b = widened(y);
        if (sign > 0 ? a.lo > b.hi : a.hi < b.lo) return x;
        if (sign > 0 ? b.lo > a.hi : b.hi < a.lo) return y;
        Rounded r = bent(sign > 0 ? max(x.value, y.value) : min(x.value, y.value),
                         std::max(x.error, y.error));
        r.relative = std::max(x.relative, y.relative);
        r.linear = still(x) && still(y);
        r.root_error = std::max(x.root_error, y.root_error);
        r.root_relative = std::max(x.root_relative, y.root_relative);
        return r;
    }
    // In exact arithmetic and the evaluator's.
    bool never_negative(NodeId x) const {
        constexpr ir::OpSet sizes_of{Op::Length, Op::Sqrt, Op::Abs};
        if (graph[x].op == Op::Splat) x = graph.arg(x, 0);
        if (graph[x].op == Op::Max)
            return never_negative(graph.arg(x, 0)) || never_negative(graph.arg(x, 1));
        return sizes_of[graph[x].op] || graph.as_number(x).value_or(-1) >= 0;
    }
    Rounded dot(int a, int b) const {
        Rounded r = product(arg(a, 0), arg(b, 0), false);
        const int size =
            std::max(sizes[static_cast<std::size_t>(a)], sizes[static_cast<std::size_t>(b)]);
        for (int c = 1; c < size; ++c) r = sum(r, product(arg(a, c), arg(b, c), false), 1, false);
        return r;
    }
    // Of all arguments' components: evaluators square them.
    Rounded length() const {
        Interval squares;
        double errors = 0, relative = 0;
        for (int a = 0; a < count(); ++a)
            for (int c = 0; c < sizes[static_cast<std::size_t>(a)]; ++c) {
                const Rounded &x = args[static_cast<std::size_t>(a)][c];
                squares += square(x.value);
                errors += x.error * x.error;
                relative = std::max(relative, x.relative);
            }
        if (squares.hi > largest_single) return unknown();
        Rounded r = made(sqrt(squares), std::sqrt(errors) + 2 * std::sqrt(smallest_normal));
        r.relative = relative + 8 * unit_roundoff;
        return r;
    }
    void normalize() {
        Interval squares;
        double errors = 0;
        for (int c = 0; c < n; ++c) squares += square(arg(0, c).value), errors += total(arg(0, c));
        const double least = std::sqrt(squares.lo) - errors;
        const bool bad = squares.hi > largest_single;
        const double e = least > 1e-18 ? std::min(2.0, 2 * errors / least + 16 * unit_roundoff) : 2;
        for (int c = 0; c < n; ++c) out[c] = made({-1, 1}, bad ? infinity : e);
    }
    void multiply_matrices() {
        const bool left = ir::is_matrix(graph[graph.arg(id, 0)].type),
                   right = ir::is_matrix(graph[graph.arg(id, 1)].type);
        const int side = ir::side(graph[graph.arg(id, left ? 0 : 1)].type);
        const int rows = left ? side : 1, columns = right ? side : 1;
        for (int column = 0; column < columns; ++column)
            for (int row = 0; row < rows; ++row) {
                Rounded r;
                for (int k = 0; k < side; ++k) {
                    const Rounded &x = args[0][left ? k * side + row : k],
                                  &y = args[1][right ? column * side + k : k];
                    const Rounded xy = product(x, y, false);
                    r = k == 0 ? xy : sum(r, xy, 1, false);
                }
                out[column * rows + row] = r;
            }
    }
    void cross() {
        for (int c = 0; c < 3; ++c) {
            const int i = (c + 1) % 3, j = (c + 2) % 3;
            out[c] = sum(product(arg(0, i), arg(1, j), false), product(arg(0, j), arg(1, i), false),
                         -1, false);
        }
    }
    Rounded power(const Rounded &x, const Rounded &y) const {
        const Interval a = widened(x), b = widened(y);
        const double exponent = y.value.is_point() ? y.value.lo : NAN;
        const bool is_whole = std::floor(exponent) == exponent;
        Interval v;
        double slope_x = infinity, slope_y = 0;
        if (is_whole && exponent >= 0) {
            v = whole_power(x.value, exponent);
            slope_x = exponent == 0 ? 0 : exponent * whole_power(abs(a), exponent - 1).hi;
        } else if (x.value.lo < 0 && is_whole) {
            if (a.contains(0)) return unknown();
            v = Interval(1.0) / whole_power(x.value, -exponent);
            slope_x = -exponent * (Interval(1.0) / whole_power(abs(a), 1 - exponent)).magnitude();
        } else {
            v = positive_power(x.value, y.value);
            if (x.value.lo < 0) v = hull(v, hull(0.0, -v));
            if (b.lo >= 1)
                slope_x = b.hi * positive_power(abs(a), b - Interval(1.0)).hi;
            else if (a.lo > 0)
                slope_x = (b * positive_power(a, b) / a).magnitude();
            if (total(y) > 0 || !y.value.is_point())
                slope_y = total(y) == 0 ? 0
                          : a.lo > 0    ? (positive_power(a, b) * log(a)).magnitude()
                                        : infinity;
        }
        double e = times(slope_x, total(x)) + times(slope_y, total(y));
        if (b.lo > 0 && b.hi <= 1 && total(y) == 0) e = std::min(e, std::pow(total(x), b.lo));
        const double turns =
            b.magnitude() * std::max(std::fabs(std::log2(std::max(a.magnitude(), 1e-38))), 1.0);
        return made(v, e + (16 + 4 * std::min(turns, 128.0)) * unit_roundoff * v.magnitude() +
                           smallest_normal);
    }
    Rounded noise(double slope, double range, double lo) const {
        double errors = 0;
        for (int c = 0; c < sizes[0]; ++c) errors += std::pow(total(arg(0, c)), 2);
        return made({lo, range},
                    std::min(2 * range, slope * std::sqrt(errors)) + 64 * unit_roundoff);
    }
    Rounded table_read(int c) const {
        const ir::Table &table = graph.table(ir::table_of(node.payload));
        const double last = std::max(table.rows - 1, 0);
        const int from = int(std::clamp(arg(0).value.lo, 0.0, last)),
                  to = int(std::clamp(arg(0).value.hi, 0.0, last));
        Interval v{infinity, -infinity};
        for (int r = from; r <= to; ++r)
            v = hull(v, Interval(double(table.data[static_cast<std::size_t>(
                            r * table.stride + ir::column_of(node.payload) + c)])));
        return made(v, 0);
    }
    Rounded truth(bool may_be_false, bool may_be_true) const {
        return made({may_be_false ? 0.0 : 1.0, may_be_true ? 1.0 : 0.0}, 0);
    }
    Rounded compare() {
        const Interval a = widened(arg(0)), b = widened(arg(1));
        const bool unsure = a.hi >= b.lo && b.hi >= a.lo;
        if (unsure) decide(total(arg(0)) + total(arg(1)), sum(arg(0), arg(1), -1, true));
        const Interval x = arg(0).value, y = arg(1).value;
        if (node.op == Op::Less) return truth(x.hi >= y.lo, x.lo < y.hi);
        if (node.op == Op::LessEqual) return truth(x.hi > y.lo, x.lo <= y.hi);
        const bool can_equal = x.hi >= y.lo && y.hi >= x.lo, can_differ = !(x.is_point() && x == y);
        return node.op == Op::Equal ? truth(can_differ, can_equal) : truth(can_equal, can_differ);
    }
    void run();
    Rounded component(int c);
};

} // namespace fathom::proof
