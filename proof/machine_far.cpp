// Cells that are endless: of what intervals have no end for, products of powers of the coordinates'
// sizes tell how it grows or falls, so that what grows times what falls faster has a slope
// (docs/lipschitz.md, 2.34).
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::proof {

using ir::rounding::down;
using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

// One instruction's result, from what its arguments are.
struct FarStep {
    const Machine &machine;
    const FarOut &out;
    const Instruction &in;

    int size(std::size_t arg) const { return machine.tape_.size[in.args[arg]]; }
    // Of a number among components, that number.
    Far of(std::size_t arg, int c) const {
        return machine.far(in.args[arg], size(arg) == 1 ? 0 : c);
    }
    bool still(std::size_t arg) const { return machine.norm_[in.args[arg]] == 0; }
    Interval value(std::size_t arg, int c) const {
        return machine.value(in.args[arg], size(arg) == 1 ? 0 : c);
    }

    double rule(Rule which) const { return machine.ranges_.rules[which]; }
    Growth by_rule(const Growth &a, Rule which) const {
        return rule(which) == 1 ? a : multiple(a, rule(which));
    }

    Far times_of(const Far &a, const Far &b) const {
        Far v;
        v.most = product(a.most, b.most, true), v.least = product(a.least, b.least, false);
        v.slope = out.sum(product(b.most, a.slope, true),
                          by_rule(product(a.most, b.slope, true), Rule::FarProduct));
        v.relative = out.sum(a.relative, b.relative);
        v.sign = a.sign * b.sign;
        return v;
    }
    Far plus(const Far &a, const Far &b) const {
        Far v;
        v.most = out.sum(a.most, b.most);
        v.slope = out.sum(a.slope, by_rule(b.slope, Rule::FarSum));
        if (a.sign != 0 && a.sign == b.sign) {
            v.sign = a.sign, v.least = FarOut::least_sum(a.least, b.least);
            v.relative = out.greater(a.relative, b.relative);
            return v;
        }
        for (const auto &[x, y] : {std::pair(a, b), std::pair(b, a)}) { // the greater decides
            if (x.least.by <= 0 || !y.most.known()) continue;
            const double share = out.most(over(y.most, x.least)) * rule(Rule::FarDifference);
            if (!(share < 1)) continue;
            v.sign = x.sign, v.least = product(x.least, {down(1 - share, 2)}, false);
            break;
        }
        return v;
    }
    static Far negative(Far a) {
        a.sign = -a.sign;
        return a;
    }
    // Of n > 0 of them together, as sums.
    template <class F> Far sum_of(int n, F each) const {
        Far v = each(0);
        for (int i = 1; i < n; ++i) v = plus(v, each(i));
        return v;
    }
    Far squared(const Far &a) const {
        Far v = times_of(a, a);
        v.sign = 1;
        return v;
    }
    // v^e of |v|, by a sign that is known.
    Far power(const Far &a, double e, int sign) const {
        Far v;
        v.sign = sign;
        v.most = to_power(e > 0 ? a.most : a.least, e, true);
        v.least = to_power(e > 0 ? a.least : a.most, e, false);
        const Growth derived = to_power(e >= 1 ? a.most : a.least, e - 1, true);
        const double by = up(std::fabs(e)) * rule(Rule::FarPower);
        v.slope = multiple(product(derived, a.slope, true), by);
        v.relative = multiple(a.relative, by);
        return v;
    }
    Far quotient(const Far &a, const Far &b) const {
        Far v = times_of(a, power(b, -1, b.sign));
        v.slope = by_rule(product(v.most, b.relative, true), Rule::FarQuotient);
        v.slope = out.sum(over(a.slope, b.least), v.slope);
        return v;
    }
    Far exponential(const Far &a, double rate) const {
        Far v;
        v.sign = 1;
        v.relative = multiple(a.slope, up(rate));
        if (a.sign < 0)
            v.most = by_rule(out.exponential(a.least, down(rate), true), Rule::FarExponential);
        if (a.sign > 0) v.least = out.exponential(a.least, down(rate), false);
        v.slope = product(v.most, v.relative, true);
        return v;
    }
    Far logarithm(const Far &a, double rate, Interval x) const {
        Far v;
        v.slope = multiple(a.relative, up(rate) * rule(Rule::FarLogarithm));
        // log(t) <= 8 t^(1/8) / e
        if (x.lo >= 1) v.most = multiple(to_power(a.most, 0.125, true), up(2.9431 * rate));
        return v;
    }
    // f(v) with f(0) = 0 and |f'| <= 1 …
    Far no_steeper(const Far &a) const {
        Far v;
        v.most = a.most, v.slope = by_rule(a.slope, Rule::FarFunction);
        return v;
    }
    // … or with f' of at most that size, where v's is `least`
    Far flatter(const Far &a, const Growth &derived) const {
        Far v;
        v.slope = by_rule(product(derived, a.slope, true), Rule::FarFunction);
        return v;
    }
    Far chosen(const Far &a, const Far &b) const { // by component one, or a mean
        Far v;
        v.most = out.greater(a.most, b.most);
        v.slope = out.greater(a.slope, by_rule(b.slope, Rule::FarChoice));
        return v;
    }
    Far extreme(const Far &a, const Far &b) const {
        Far v = chosen(a, b);
        const int sign = in.op == Op::Max ? 1 : -1;
        for (const Far &x : {a, b}) // max(a, b) >= a
            if (x.sign == sign && x.least.degree() >= v.least.degree())
                v.sign = sign, v.least = x.least;
        return v;
    }
    Far mean(const Far &a, const Far &b, const Far &t) const {
        Far v = chosen(a, b);
        const Growth turned = product(t.slope, out.sum(a.most, b.most), true);
        v.slope = out.sum(v.slope, by_rule(turned, Rule::FarMean));
        return v;
    }
    Far of_parts(int c) const {
        std::size_t arg = 0;
        while (c >= size(arg)) c -= size(arg++);
        return machine.far(in.args[arg], c);
    }
    Far length() const {
        Far v;
        bool first = true;
        for (std::size_t arg = 0; arg < in.args.size(); ++arg)
            for (int c = 0; c < size(arg); ++c) {
                const Far part = squared(of(arg, c)), own = of(arg, c);
                const Growth slope =
                    first ? own.slope : out.sum(v.slope, by_rule(own.slope, Rule::FarLength));
                v = first ? part : plus(v, part);
                v.slope = slope, first = false;
            }
        const Growth slope = v.slope;
        v = power(v, 0.5, 1);
        v.slope = slope;
        return v;
    }

    std::optional<Far> of_component(int c) const;
    std::optional<Far> of_function(int c) const;
    std::optional<Far> of_power(int c) const;
    Far of_point(int c) const;
    // A result that is a sum of products has these factors.
    struct Factors {
        Slot a, b;
        int a_at, b_at;
    };
    std::vector<Factors> factors(int c) const;
    double slope_of_products(int c, Row &row) const;
};

std::vector<FarStep::Factors> FarStep::factors(int c) const {
    std::vector<Factors> found;
    if (in.args.empty()) return found;
    const Slot a = in.args[0], b = in.args.size() > 1 ? in.args[1] : a;
    if (in.form == Form::Square) return {{a, a, c, c}};
    if (in.form != Form::Plain) return {};
    const int na = machine.tape_.size[a], nb = machine.tape_.size[b];
    if (in.op == Op::Mul) found.push_back({a, b, na == 1 ? 0 : c, nb == 1 ? 0 : c});
    if (in.op == Op::Dot)
        for (int i = 0; i < na; ++i) found.push_back({a, b, i, i});
    if (in.op != Op::MatMul) return found;
    const int n = machine.tape_.size[in.out];
    const bool right = nb > na, both = na == nb; // which is a matrix
    const int side = both ? (na == 4 ? 2 : na == 9 ? 3 : 4) : right ? na : nb;
    const int column = both ? c / side : 0, row = both ? c % side : c;
    if (n > 9) return {};
    for (int k = 0; k < side; ++k)
        found.push_back({a, b, right ? k : k * side + row,
                         right  ? row * side + k
                         : both ? column * side + k
                                : k});
    return found;
}

// Of a function of one number.
std::optional<Far> FarStep::of_function(int c) const {
    const Far a = of(0, c);
    const Op op = in.op;
    const bool off_pole = value(0, c).lo >= ir::rounding::min_single;
    if (op == Op::Sqrt && a.sign > 0) return power(a, 0.5, 1);
    if (op == Op::InverseSqrt && off_pole) return power(a, -0.5, 1);
    if (op == Op::Exp) return exponential(a, 1);
    if (op == Op::Exp2) return exponential(a, std::numbers::ln2);
    if (op == Op::Log && off_pole) return logarithm(a, 1, value(0, c));
    if (op == Op::Log2 && off_pole) return logarithm(a, std::numbers::log2e, value(0, c));
    if (op == Op::Sin) return no_steeper(a);
    if (op == Op::Cos) return flatter(a, {1});
    if (op != Op::Atan && op != Op::Tanh) return {};
    // of x the slopes are 1/(1 + x^2) and 1 - tanh(x)^2 <= 4 exp(-2 |x|)
    Far v = no_steeper(a);
    const Growth derived = op == Op::Atan ? to_power(a.least, -2, true)
                                          : multiple(out.exponential(a.least, 2, true), 4);
    v.slope = out.lesser(v.slope, flatter(a, derived).slope);
    return v;
}

std::optional<Far> FarStep::of_power(int c) const {
    const Far a = of(0, c);
    const Interval at = value(1, c);
    if (!still(1) || !at.is_point()) return {};
    const double e = double(float(at.lo)); // as evaluators see it
    if (in.form == Form::OddPower)
        return e > 0 ? std::optional(power(a, 1 + e, a.sign)) : std::nullopt;
    const bool whole = std::floor(e) == e && std::fabs(e) <= 64;
    if (!whole && a.sign <= 0) return {};
    if (e < 0 && value(0, c).mignitude() < ir::rounding::min_single) return {};
    return power(a, e, whole && std::fmod(e, 2) == 0 ? 1 : a.sign);
}

Far FarStep::of_point(int c) const {
    const auto axis = std::size_t(c);
    Far v;
    v.slope = {1};
    v.most = {machine.cell_.p[axis].magnitude()}, v.least = {machine.cell_.p[axis].mignitude()};
    if (out.endless(axis)) v.most = v.least = FarOut::coordinate(axis);
    return v;
}

// Nothing where only its interval and norm are known.
std::optional<Far> FarStep::of_component(int c) const {
    const Op op = in.op;
    if (in.form == Form::Norm) return length();
    if (in.form == Form::OddPower) return of_power(c);
    if (in.form != Form::Plain && in.form != Form::Square) return {};
    if (const std::vector<Factors> each = factors(c); !each.empty())
        return sum_of(int(each.size()), [&](int i) {
            const auto &[a, b, a_at, b_at] = each[std::size_t(i)];
            const Far x = machine.far(a, a_at);
            return a == b && a_at == b_at ? squared(x) : times_of(x, machine.far(b, b_at));
        });
    if (op == Op::Point) return of_point(c);
    if (op == Op::Neg) return negative(of(0, c));
    if (op == Op::Abs) {
        Far v = of(0, c);
        v.sign = 1;
        return v;
    }
    if (op == Op::Add) return plus(of(0, c), of(1, c));
    if (op == Op::Sub) return plus(of(0, c), negative(of(1, c)));
    if (op == Op::Div) return quotient(of(0, c), of(1, c));
    if (op == Op::Pow) return of_power(c);
    if (op == Op::Min || op == Op::Max) return extreme(of(0, c), of(1, c));
    if (op == Op::Clamp) return chosen(of(0, c), chosen(of(1, c), of(2, c)));
    if (op == Op::Mix && value(2, c).lo >= 0 && value(2, c).hi <= 1)
        return mean(of(0, c), of(1, c), of(2, c));
    if (op == Op::Make) return of_parts(c);
    if (op == Op::Splat) return of(0, 0);
    if (op == Op::Swizzle) return machine.far(in.args[0], ir::swizzle_component(in.payload, c));
    if (op == Op::Column)
        return machine.far(in.args[0], int(in.payload) * machine.tape_.size[in.out] + c);
    constexpr ir::OpSet functions{Op::Sqrt, Op::InverseSqrt, Op::Exp, Op::Exp2, Op::Log,
                                  Op::Log2, Op::Sin,         Op::Cos, Op::Atan, Op::Tanh};
    return functions[op] ? of_function(c) : std::nullopt;
}

// What is known: by an instruction of its own, or by the interval and the norm.
Far Machine::far(Slot s, int c) const {
    const std::size_t at = tape_.first[s] + std::uint32_t(c);
    if (at < is_far_.size() && is_far_[at]) return far_[at];
    Far out;
    if (pole_[s]) return out;
    const Interval v = value_[at];
    out.sign = v.lo >= 0 ? 1 : v.hi <= 0 ? -1 : 0;
    out.most = {v.magnitude()}, out.least = {v.mignitude()};
    out.slope = {odd_[at] ? infinity : norm_[s]};
    out.relative = over(out.slope, out.least);
    return out;
}

// Keeps of a result what is known, and lets it narrow the interval.
void Machine::keep_far(Slot s, int c, Far found) {
    const std::size_t at = tape_.first[s] + std::uint32_t(c);
    Interval &v = value_[at];
    const double most = far_out_.most(found.most), least = far_out_.least(found.least);
    v = meet(v, Interval(-most, most));
    if (found.sign > 0) v = meet(v, Interval(least, infinity));
    if (found.sign < 0) v = meet(v, Interval(-infinity, -least));
    if (found.sign == 0) found.sign = v.lo >= 0 ? 1 : v.hi <= 0 ? -1 : 0;
    found.most = far_out_.lesser(found.most, {v.magnitude()});
    if (found.least.degree() <= 0 && !(least >= v.mignitude())) found.least = {v.mignitude()};
    found.slope = far_out_.lesser(found.slope, {norm_[s]});
    found.relative = far_out_.lesser(found.relative, over(found.slope, found.least));
    far_[at] = found;
    is_far_[at] = 1;
}

// What a component's gradient is at most, as a sum of products: of each the lesser of what intervals
// and growth tell.
double FarStep::slope_of_products(int c, Row &row) const {
    double sum = 0;
    const auto within = [](Interval x, double most) { return meet(x, Interval(-most, most)); };
    for (const auto &[a, b, a_at, b_at] : factors(c)) {
        const Far x = machine.far(a, a_at), y = machine.far(b, b_at);
        const double by_a = out.most(product(y.most, x.slope, true)),
                     by_b = out.most(by_rule(product(x.most, y.slope, true), Rule::FarProduct));
        const Interval va = machine.value(a, a_at), vb = machine.value(b, b_at);
        for (std::size_t k = 0; k < 3; ++k)
            row[k] = row[k] + within(vb * machine.row(a, a_at)[k], by_a) +
                     within(va * machine.row(b, b_at)[k], by_b);
        sum += std::min(times(vb.magnitude(), machine.norm_[a]), by_a) +
               std::min(times(va.magnitude(), machine.norm_[b]), by_b);
    }
    return up(sum, 32);
}

// Are all arguments continuous, and away from where the op has a pole?
bool Machine::is_regular(const Instruction &in) const {
    if (trouble_[in.out] == Trouble::Jump || trouble_[in.out] == Trouble::Overflow) return false;
    for (const Slot a : in.args)
        for (int c = 0; c < int(tape_.size[a]); ++c)
            if (pole_[a] || odd_[tape_.first[a] + std::uint32_t(c)]) return false;
    if (in.op == Op::Div && in.form == Form::Plain)
        for (int c = 0; c < int(tape_.size[in.args[1]]); ++c)
            if (value(in.args[1], c).mignitude() < ir::rounding::min_single) return false;
    return true;
}

void Machine::hold_far(const Instruction &in) {
    const Slot out = in.out;
    const int n = tape_.size[out];
    for (int c = 0; c < n; ++c)
        is_far_[tape_.first[out] + std::uint32_t(c)] = 0; // of the last turn
    const bool number = in.type != ir::Type::Int && in.type != ir::Type::Bool;
    if (n > 16 || !number || in.stands_at || !is_regular(in)) return;
    if (in.args.empty() && in.op != Op::Point) return;
    const FarStep step{*this, far_out_, in};
    Row rows[16];
    Far all[16];
    double squares = 0;
    for (int c = 0; c < n; ++c) {
        const auto found = step.of_component(c);
        if (!found) return;
        all[c] = *found;
        const double slope = far_out_.most(found->slope);
        double most = slope;
        rows[c].fill(Interval(-slope, slope));
        if (!step.factors(c).empty()) {
            Row row{};
            most = std::min(most, step.slope_of_products(c, row));
            for (std::size_t k = 0; k < 3; ++k) rows[c][k] = meet(row[k], Interval(-most, most));
        }
        squares = up(squares + up(most * most));
    }
    const double most = std::min(up(std::sqrt(squares), 4), spectral_norm(rows, n));
    if (most < norm_[out]) {
        if (norm_[out] == infinity) trouble_[out] = Trouble::None, cause_[out] = NodeId();
        pole_[out] = 0;
        norm_[out] = most;
        for (int c = 0; c < n; ++c)
            for (std::size_t k = 0; k < 3; ++k) {
                Interval &own = grad_[tape_.first[out] + std::uint32_t(c)][k];
                own = meet(own, rows[c][k]);
            }
    }
    for (int c = 0; c < n; ++c) keep_far(out, c, all[c]);
}

} // namespace fathom::proof
