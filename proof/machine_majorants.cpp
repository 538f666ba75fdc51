// How steep a quotient is whose divisor is multiplied by what its numerator is.
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
constexpr int most_steps = 30'000;  // of one quotient in a cell
constexpr std::size_t as_long = 16; // a step takes, as so many instructions
} // namespace

// Both of one sign, so that the sum has the size of both.
std::optional<std::pair<Part, Part>> Majorants::sum_of(Part d) const {
    if (d == one) return {};
    const Instruction *made = plain(d);
    if (!made || made->form != Form::Plain || made->op != Op::Add) return {};
    const Part a = source(argument(*made, 0, d)), b = source(argument(*made, 1, d));
    if (!have_one_sign(value(a), value(b))) return {};
    return std::pair{a, b};
}

// At most, of part over part + rest, of one sign.
double Majorants::share_of(Part part, Part rest) const {
    const double most = value(part).magnitude(), beside = value(rest).mignitude();
    return most == infinity ? 1 : std::min(1.0, ratio_of(most, ir::rounding::down(most + beside)));
}

double Majorants::at_once(Wanted wanted, const Vector &v, Part d, double more) {
    const double least = d == one ? 1 : value(d).mignitude();
    if (wanted == Wanted::Size) return ratio_of(size(v), least);
    if (wanted == Wanted::Slope) return ratio_of(norm(v), least);
    const double slope = ratio_of(machine.norm_[slot(d)], least); // of d, over d
    return std::min(times(plus(size(v), more), growth(d)),
                    times(plus(bound(Wanted::Size, v, d), ratio_of(more, least)), slope));
}

double Majorants::bound(Wanted wanted, const Vector &raw, Part given, double more) {
    const Part d = divisor(given);
    const bool of_slope = wanted == Wanted::Slope, turning = wanted == Wanted::Turning;
    const OutsideArms outside(*this);
    if (turning && (d == one || is_still(d))) return 0;
    if (of_slope && is_still(raw)) return 0;
    if (more > 0) // one of few numbers, so that what is known of it is met again
        more = std::max(more, std::exp2(std::ceil(8 * std::log2(more)) / 8));
    const double rows = of_slope ? by_rows(raw, d) : infinity;
    const Vector v = sources(raw);
    const auto key = std::tuple{wanted, v, d, more};
    if (const auto at = known.find(key); at != known.end()) return std::min(rows, at->second);
    double best = up(at_once(wanted, v, d, more), 4);
    known[key] = best;
    if (++steps > most_steps) return std::min(rows, best);
    if (is_still(v) && (d == one || is_still(d))) return std::min(rows, best);
    if (v.size == 1) best = std::min(best, by_number(wanted, v, d, more));
    const auto f = fold(v);
    double found = f ? by_fold(wanted, *f, v.size, d, more) : infinity;
    if (!f || of_slope) found = std::min(found, by_arm(wanted, v, d, more));
    best = std::min(best, up(found, 4));
    known[key] = best;
    return std::min(rows, best);
}

double Majorants::by_fold(Wanted wanted, const Fold &fold, std::uint32_t size, Part d,
                          double more) {
    const double by = fold.slope.magnitude();
    if (wanted == Wanted::Slope) return times(by, bound(wanted, fold.of, d));
    if (!fold.bounded) return infinity;
    const double moved = up(times(fold.at_0.magnitude(), std::sqrt(size)), 4);
    if (wanted == Wanted::Size)
        return plus(up(times(by, bound(wanted, fold.of, d))),
                    ratio_of(moved, d == one ? 1 : value(d).mignitude()));
    const double beside = plus(moved, more);
    if (by == 0) return times(beside, growth(d));
    return times(by, bound(wanted, fold.of, d, ratio_of(beside, by)));
}

// By what makes the vector, or the divisor. Values are those in an arm of a choice, if any is
// looked at.
double Majorants::by_arm(Wanted wanted, const Vector &v, Part d, double more) {
    const Instruction *made = made_alike(v);
    if (made && made->op == Op::Select) return by_choice(wanted, v, *made, d, more);
    const bool is_plain = made && made->form == Form::Plain;
    if (is_plain && (made->op == Op::Neg || made->op == Op::Abs))
        return bound(wanted, arguments(v, 0), d, more);
    if (is_plain && (made->op == Op::Add || made->op == Op::Sub)) return by_sum(wanted, v, d, more);
    if (is_plain && (made->op == Op::Mul || made->op == Op::Div) && !sum_of(d))
        return by_product(wanted, v, *made, d, more);
    if (d != one && made && made->op != Op::Point) return by_divisor(wanted, v, d, more);
    return infinity;
}

// Of a vector that is M v + c (2.7), or M v.
double Majorants::by_rows(const Vector &raw, Part d) {
    const Slot s = slot(raw.at[0]);
    for (std::uint32_t i = 1; i < raw.size; ++i)
        if (slot(raw.at[i]) != slot(raw.at[0]) || raw.at[i] == raw.at[i - 1]) return infinity;
    const Instruction *made = machine.maker(s);
    if (!made || made->turned.empty() || tape.size[made->turned[0]] > 4) return infinity;
    if (made->turned[0] == s || ++steps > most_steps) return infinity;
    for (std::size_t i = 1; i < made->turned.size(); ++i)
        if (machine.norm_[made->turned[i]] != 0) return infinity;
    return up(times(made->norm, bound(Wanted::Slope, all_of(made->turned[0]), d)), 4);
}

// Of lengths, of greatest and least, and of distances to corners.
double Majorants::by_number(Wanted wanted, const Vector &v, Part d, double more) {
    const Instruction *made = machine.maker(slot(v.at[0]));
    if (!made || tape.size[made->out] != 1) return infinity;
    if (made->form == Form::Norm || made->form == Form::Corner) {
        Vector parts;
        for (const Slot arg : made->args)
            for (std::uint32_t c = 0; c < tape.size[arg]; ++c) {
                if (parts.size == 4) return infinity;
                parts.at[parts.size++] = tape.first[arg] + c;
            }
        return bound(wanted, parts, d, more);
    }
    constexpr ir::OpSet extremes{Op::Min, Op::Max, Op::Union, Op::Intersection};
    if (made->form != Form::Plain || !extremes[made->op]) return infinity;
    double most = 0;
    for (const Slot arg : made->args) most = std::max(most, bound(wanted, all_of(arg), d, more));
    return most;
}

double Majorants::by_choice(Wanted wanted, const Vector &v, const Instruction &choice, Part d,
                            double more) {
    const Instruction *other = d == one ? nullptr : plain(d);
    const bool together = other && other->op == Op::Select && other->args[0] == choice.args[0];
    return greatest_of_arms(choice, [&](std::size_t arm) {
        const Vector in_it = sources(arguments(v, arm));
        const Part below = together ? divisor(source(argument(*other, arm, d))) : d;
        const double outside = bound(wanted, in_it, below, more);
        const Instruction *made = made_alike(in_it);
        constexpr ir::OpSet told{Op::Mul, Op::Div, Op::Select};
        const bool is_told = made && told[made->op];
        return is_told ? std::min(outside, by_arm(wanted, in_it, below, more)) : outside;
    });
}

double Majorants::by_sum(Wanted wanted, const Vector &v, Part d, double more) {
    const Vector a = arguments(v, 0), b = arguments(v, 1);
    if (wanted == Wanted::Turning) // the lesser one as a number
        return size(a) <= size(b) ? bound(wanted, b, d, plus(more, size(a)))
                                  : bound(wanted, a, d, plus(more, size(b)));
    const double apart = plus(bound(wanted, a, d), bound(wanted, b, d));
    const auto sum = sum_of(d);
    if (!sum) return apart;
    // (x + y)/(d + e) is at most the greater of x/d and y/e
    double most = apart;
    for (const auto &[of_a, of_b] :
         {std::pair{sum->first, sum->second}, std::pair{sum->second, sum->first}})
        most = std::min(most, std::max(bound(wanted, a, of_a), bound(wanted, b, of_b)));
    return most;
}

double Majorants::by_product(Wanted wanted, const Vector &v, const Instruction &made, Part d,
                             double more) {
    double best = infinity;
    for (const std::size_t i : {1, 0}) {
        if (made.op == Op::Div && i == 0) break;
        const Vector factor = arguments(v, i), rest = arguments(v, 1 - i);
        Factors f;
        if (is_still(factor)) {
            f.by = made.op == Op::Div ? Interval(1.0) / value(factor) : value(factor);
        } else if (are_one(factor)) {
            gather(factor.at[0], made.op == Op::Div, f);
        } else {
            continue;
        }
        double found = by_factors(wanted, rest, f, d, more);
        if (const auto unscaled = without_number(rest)) { // (s u) f, where f hangs on the size of u
            f.by = f.by * unscaled->second;
            found = std::min(found, by_factors(wanted, unscaled->first, f, d, more));
        }
        best = std::min(best, found);
        if (is_still(factor)) break;
    }
    return best;
}

// u and s of s u, where s stands still.
std::optional<std::pair<Vector, Interval>> Majorants::without_number(const Vector &v) const {
    const Instruction *made = made_alike(v);
    if (!made || made->form != Form::Plain) return {};
    if (made->op == Op::Neg) return std::pair{arguments(v, 0), Interval(1.0)};
    if (made->op != Op::Mul && made->op != Op::Div) return {};
    const Vector a = arguments(v, 0), b = arguments(v, 1);
    if (is_still(b)) return std::pair{a, made->op == Op::Div ? Interval(1.0) / value(b) : value(b)};
    if (made->op == Op::Mul && is_still(a)) return std::pair{b, value(a)};
    return {};
}

// u f over a divisor, by what both are multiplied by.
double Majorants::by_factors(Wanted wanted, const Vector &given, const Factors &f, Part d,
                             double more) {
    std::vector<Factor> common, above = f.parts;
    Part left = d;
    const Factors below = peel(left, [&](const Factors &factors, Part) {
        std::vector<Factor> less = above;
        for (const Factor &factor : factors.parts) {
            const auto at = std::ranges::find(less, factor);
            if (at == less.end()) return false;
            less.erase(at);
        }
        common.insert(common.end(), factors.parts.begin(), factors.parts.end());
        above = less;
        return true;
    });
    if (left != one && std::ranges::find(above, Factor{left, false}) != above.end()) {
        common.push_back({left, false});
        std::erase(above, Factor{left, false});
        left = one;
    }
    const double by_least = below.by.mignitude();
    const double ratio = ratio_of(up(times(f.by.magnitude(), most(above))), by_least);
    const Vector u = sources(given);
    if (wanted == Wanted::Size) return up(times(ratio, bound(wanted, u, left)));
    if (wanted == Wanted::Turning)
        return turning_by_factors(u, f, above, common, left, by_least, more);
    const auto about = turns(f.parts);
    if (!about) return infinity;
    Vector wider = u;
    if (about->of.size > 0) {
        if (!is_in_order(u) || !about->of.holds(u)) return infinity;
        wider = about->of;
    }
    const double along = (Interval(1.0) + about->exponent).magnitude();
    const double rest_bound = bound(wanted, wider, left);
    return up(times(up(times(ratio, std::max(1.0, along))), rest_bound));
}

// (|u f| + more) |grad (e h)|/(e h)^2, h what both are multiplied by times at least `least_by`: where
// h has no slope, and where it has.
double Majorants::turning_by_factors(const Vector &u, const Factors &f,
                                     const std::vector<Factor> &above,
                                     const std::vector<Factor> &common, Part left, double least_by,
                                     double more) {
    const auto about = turns(common);
    if (!about) return infinity;
    const double by = up(times(f.by.magnitude(), most(above))); // of f over what is common
    const double beside = ratio_of(more, ir::rounding::down(by * least(common)));
    const bool is_within = is_in_order(u) && about->of.size > 0 && about->of.holds(u);
    const double still = by == 0 ? infinity : bound(Wanted::Turning, u, left, beside);
    double turned = 0;
    if (about->log_slope > 0) {
        const double far = is_within ? about->farthest : size(u);
        const double there = std::min(still, up(times(plus(far, beside), growth(left))));
        const double slope = bound(Wanted::Slope, about->of, left);
        const double along =
            is_within ? about->exponent.magnitude() : up(times(size(u), about->log_slope));
        turned = plus(
            there, up(times(plus(along, up(times(ratio_of(more, by), about->by_itself))), slope)));
    }
    return up(times(ratio_of(by, least_by), std::max(still, turned)));
}

// By parts of the divisor alone.
double Majorants::by_divisor(Wanted wanted, const Vector &v, Part d, double more) {
    const bool turning = wanted == Wanted::Turning;
    if (const auto sum = sum_of(d)) {
        const auto [a, b] = *sum;
        const double of_a = share_of(a, b), of_b = share_of(b, a);
        const double by_a = times(bound(wanted, v, a, more), turning ? up(of_a * of_a) : of_a),
                     by_b = times(bound(wanted, v, b, more), turning ? up(of_b * of_b) : of_b);
        return turning ? plus(by_a, by_b) : std::min(up(by_a), up(by_b));
    }
    const Instruction *made = plain(d);
    if (made && made->op == Op::Select)
        return std::max(bound(wanted, v, source(argument(*made, 1, d)), more),
                        bound(wanted, v, source(argument(*made, 2, d)), more));
    const auto product = scaled(d);
    if (!product || product->rest == d) return infinity;
    if (!turning) return ratio_of(bound(wanted, v, product->rest), product->least);
    const double size_of = v.size == 0 ? 0 : size(v);
    return plus(ratio_of(bound(wanted, v, product->rest, more), product->least),
                up(times(plus(size_of, more), slope_over(*product))));
}

// The gradient of d over d^2.
double Majorants::growth(Part given) {
    const Part d = divisor(given);
    if (d == one || is_still(d)) return 0;
    const OutsideArms outside(*this);
    const auto key = std::tuple{Wanted::Turning, Vector(), d, 1.0};
    if (const auto at = known.find(key); at != known.end()) return at->second;
    const double least = value(d).mignitude();
    double best = up(ratio_of(ratio_of(machine.norm_[slot(d)], least), least), 4);
    known[key] = best;
    if (++steps > most_steps) return best;
    best = std::min(best, up(growth_in_arm(d), 4));
    known[key] = best;
    return best;
}

double Majorants::growth_in_arm(Part d) {
    if (is_still(d)) return 0;
    const Instruction *made = plain(d);
    if (const auto sum = sum_of(d)) {
        const auto [a, b] = *sum;
        const double of_a = share_of(a, b), of_b = share_of(b, a);
        return plus(up(times(up(of_a * of_a), growth(a))), up(times(up(of_b * of_b), growth(b))));
    }
    if (made && made->op == Op::Select)
        return greatest_of_arms(*made, [&](std::size_t arm) {
            const Part in_it = divisor(argument(*made, arm, d));
            return std::min(growth(in_it), growth_in_arm(in_it));
        });
    const auto product = scaled(d);
    if (!product || product->rest == d) return infinity;
    return plus(ratio_of(growth(product->rest), product->least), slope_over(*product));
}

// |J(v/d)| <= |J_v|/|d| + |v| |grad d|/d^2. Where the rules for each op say less than this mostly
// does it is asked now and then.
void Machine::hold_majorant(const Instruction &instruction) {
    constexpr int seldom = 8;
    const Slot out = instruction.out, above = instruction.args[0], below = instruction.args[1];
    if (norm_[out] == infinity || norm_[out] == 0) return;
    auto &[most, left] = majorants_;
    if (norm_[out] <= most && left-- > 0) return;
    left = seldom;
    for (const Slot s : {above, below})
        for (std::uint32_t i = 0; i < tape_.size[s]; ++i)
            if (odd_[tape_.first[s] + i]) return;
    Majorants majorants{*this, tape_};
    const Majorants::Vector v = majorants.all_of(above);
    if (v.size == 0) return;
    const Majorants::Part d = majorants.source(tape_.first[below]);
    for (std::uint32_t i = 1; i < tape_.size[below]; ++i)
        if (majorants.source(tape_.first[below] + i) != d) return;
    using Wanted = Majorants::Wanted;
    const double slope = majorants.bound(Wanted::Slope, v, d);
    if (slope < norm_[out]) {
        const double found = up(majorants.whole(v, d), 8);
        most = std::max(most, found);
        hold_norm(out, found);
    }
    work_ += as_long * std::size_t(majorants.steps);
}

} // namespace fathom::proof
