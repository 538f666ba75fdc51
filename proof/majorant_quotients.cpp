// How steep a vector over a divisor is, as one: what both are multiplied by leaves it, and what
// folds the vector folds the quotient.
#include "proof/majorant_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;
using Vector = Majorants::Vector;
using Part = Majorants::Part;

namespace {
constexpr int deepest_of_folds = 12;
constexpr int most_wholes = 4'000; // steps, from which on nothing new is begun
} // namespace

// Of a number that is made of another by pieces that are affine: its slopes by that in the cell.
Interval Majorants::slopes_here(Part p, Part of, int depth) const {
    p = source(p);
    if (p == of) return 1.0;
    if (is_still(p)) return 0.0;
    const Instruction *made = plain(p);
    if (!made || depth > deepest_of_folds) return Interval::everything();
    const auto arg = [&](std::size_t i) { return source(argument(*made, i, p)); };
    const auto slope = [&](std::size_t i) { return slopes_here(arg(i), of, depth + 1); };
    if (made->form == Form::Wave) return is_still(arg(1)) ? slope(0) : Interval::everything();
    if (made->form != Form::Plain) return Interval::everything();
    const Op op = made->op;
    if (op == Op::Neg) return -slope(0);
    if (op == Op::Abs) {
        const Interval a = value(arg(0)), s = slope(0);
        return a.lo >= 0 ? s : a.hi <= 0 ? -s : hull(s, -s);
    }
    if (op == Op::Add) return slope(0) + slope(1);
    if (op == Op::Sub) return slope(0) - slope(1);
    if (op == Op::Mul && is_still(arg(1))) return slope(0) * value(arg(1));
    if (op == Op::Mul && is_still(arg(0))) return slope(1) * value(arg(0));
    if (op == Op::Div && is_still(arg(1)) && !value(arg(1)).contains(0))
        return slope(0) / value(arg(1));
    const auto lesser = [&](std::size_t i, std::size_t k) { // of both, or the one that it is
        const Interval a = value(arg(i)), b = value(arg(k));
        return a.hi <= b.lo ? slope(i) : b.hi <= a.lo ? slope(k) : hull(slope(i), slope(k));
    };
    if (op == Op::Min) return lesser(0, 1);
    if (op == Op::Max) {
        const Interval a = value(arg(0)), b = value(arg(1));
        return a.lo >= b.hi ? slope(0) : b.lo >= a.hi ? slope(1) : hull(slope(0), slope(1));
    }
    if (op == Op::Clamp && is_still(arg(1)) && is_still(arg(2))) {
        const Interval x = value(arg(0)), lo = value(arg(1)), hi = value(arg(2));
        if (lo.hi <= x.lo && x.hi <= hi.lo) return slope(0);
        if (x.hi <= lo.lo || x.lo >= hi.hi) return 0.0;
        return hull(slope(0), 0.0);
    }
    return Interval::everything();
}

// Of v/d, by what folds v: D y + b, over d.
double Majorants::whole_of_fold(const Vector &v, const Vector &y, Part d) {
    double most = 0;
    Interval beside = 0.0;
    for (std::uint32_t i = 0; i < v.size; ++i) {
        const Interval slope = slopes_here(v.at[i], y.at[i]);
        if (!slope.finite()) return infinity;
        most = std::max(most, slope.magnitude());
        beside += square(value(v.at[i]) - slope * value(y.at[i]));
    }
    return plus(times(most, whole(y, d)), up(times(sqrt(beside).hi, growth(d))));
}

// Of a quotient whose numerator is multiplied by what the divisor is multiplied by.
double Majorants::whole_of_product(const Vector &v, const Instruction &made, Part d) {
    for (const std::size_t i : {1, 0}) {
        const bool divides = made.op == Op::Div;
        if (divides && i == 0) break;
        const Vector factor = arguments(v, i), rest = arguments(v, 1 - i);
        if (is_still(factor)) {
            if (!are_one(factor)) continue;
            const Interval by = divides ? Interval(1.0) / value(factor) : value(factor);
            return up(times(by.magnitude(), whole(rest, d)));
        }
        if (!are_one(factor)) continue;
        Factors f;
        gather(factor.at[0], divides, f);
        std::vector<Factor> above = f.parts;
        Part left = d;
        const Factors below = peel(left, [&](const Factors &factors, Part) {
            std::vector<Factor> less = above;
            for (const Factor &one_of : factors.parts) {
                const auto at = std::ranges::find(less, one_of);
                if (at == less.end()) return false;
                less.erase(at);
            }
            above = less;
            return true;
        });
        if (left != one && std::ranges::find(above, Factor{left, false}) != above.end()) {
            std::erase(above, Factor{left, false});
            left = one;
        }
        if (!above.empty()) continue;
        const double ratio = ratio_of(f.by.magnitude(), below.by.mignitude());
        return up(times(ratio, whole(rest, left)));
    }
    return infinity;
}

double Majorants::whole_of_sum(const Vector &v, Part d) {
    const Vector a = arguments(v, 0), b = arguments(v, 1);
    if (is_still(b)) return plus(whole(a, d), up(times(size(b), growth(d))));
    if (is_still(a)) return plus(whole(b, d), up(times(size(a), growth(d))));
    double best = plus(whole(a, d), whole(b, d));
    const auto sum = sum_of(d);
    if (!sum) return best;
    // t a/x + (1 - t) b/y with t = x/(x + y)
    for (const auto &[x, y] :
         {std::pair{sum->first, sum->second}, std::pair{sum->second, sum->first}}) {
        const double of_x = share_of(x, y), of_y = share_of(y, x);
        const double turned = plus(up(times(value(y).magnitude() * of_x * of_x, growth(x)), 4),
                                   up(times(value(x).magnitude() * of_y * of_y, growth(y)), 4));
        const double apart = plus(bound(Wanted::Size, a, x), bound(Wanted::Size, b, y));
        best = std::min(best, plus(std::max(whole(a, x), whole(b, y)), up(times(apart, turned))));
    }
    return best;
}

double Majorants::whole_in_parts(const Vector &v, Part d) {
    const Instruction *made = made_alike(v);
    if (v.size == 1) {
        const Instruction *number = machine.maker(slot(v.at[0]));
        if (number && tape.size[number->out] == 1 &&
            (number->form == Form::Norm || number->form == Form::Corner)) {
            Vector parts;
            for (const Slot arg : number->args)
                for (std::uint32_t c = 0; c < tape.size[arg]; ++c) {
                    if (parts.size == 4) return infinity;
                    parts.at[parts.size++] = tape.first[arg] + c;
                }
            return whole(parts, d);
        }
    }
    if (const auto f = fold(v)) return whole_of_fold(v, f->of, d);
    if (!made) return infinity;
    constexpr ir::OpSet extremes{Op::Min, Op::Max, Op::Union, Op::Intersection};
    if (v.size == 1 && made->form == Form::Plain && extremes[made->op]) {
        double most = 0;
        for (std::size_t i = 0; i < made->args.size(); ++i)
            most = std::max(most, whole(arguments(v, i), d));
        return most;
    }
    if (made->op == Op::Select) {
        const Instruction *other = d == one ? nullptr : plain(d);
        const bool together = other && other->op == Op::Select && other->args[0] == made->args[0];
        double most = 0;
        for (const std::size_t arm : {1, 2})
            most = std::max(
                most, whole(arguments(v, arm), together ? source(argument(*other, arm, d)) : d));
        return most;
    }
    if (made->form != Form::Plain) return infinity;
    if (made->op == Op::Neg || made->op == Op::Abs) return whole(arguments(v, 0), d);
    if (made->op == Op::Add || made->op == Op::Sub) return whole_of_sum(v, d);
    if (made->op == Op::Mul || made->op == Op::Div) return whole_of_product(v, *made, d);
    return infinity;
}

double Majorants::whole(const Vector &raw, Part given) {
    if (raw.size == 0) return infinity;
    const Part d = divisor(given);
    const OutsideArms outside(*this);
    const Vector v = sources(raw);
    const auto key = std::tuple{Wanted::Whole, v, d, 0.0};
    if (const auto at = known.find(key); at != known.end()) return at->second;
    double best = bound(Wanted::Slope, raw, d);
    if (d != one && !is_still(d)) best = plus(best, bound(Wanted::Turning, v, d));
    known[key] = best;
    if (best == 0 || ++steps > most_wholes || is_still(v)) return best;
    if (d == one || is_still(d)) return best;
    known[key] = best = std::min(best, whole_in_parts(v, d));
    return best;
}

} // namespace fathom::proof
