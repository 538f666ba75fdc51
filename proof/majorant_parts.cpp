// What quotients by a scale are made of: parts of vectors, what hangs on a vector's size, and folds.
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
constexpr std::size_t most_factors = 8;
}

// -- of parts and vectors

Interval Majorants::value(const Vector &v) const {
    Interval out = value(v.at[0]);
    for (std::uint32_t i = 1; i < v.size; ++i) out = hull(out, value(v.at[i]));
    return out;
}

double Majorants::size(const Vector &v) const {
    Interval sum = 0.0;
    for (std::uint32_t i = 0; i < v.size; ++i) sum += square(value(v.at[i]));
    return sqrt(sum).hi;
}

double Majorants::norm(const Vector &v) const {
    std::array<Row, 4> rows{};
    bool of_one = true;
    for (std::uint32_t i = 0; i < v.size; ++i) {
        rows[i] = machine.grad_[v.at[i]];
        of_one = of_one && slot(v.at[i]) == slot(v.at[0]);
        for (std::uint32_t k = 0; k < i; ++k) of_one = of_one && v.at[i] != v.at[k];
    }
    const double box = spectral_norm(rows.data(), int(v.size));
    return of_one ? std::min(box, machine.norm_[slot(v.at[0])]) : box;
}

Vector Majorants::all_of(Slot s) const {
    Vector out;
    if (tape.size[s] > 4) return out;
    for (std::uint32_t c = 0; c < tape.size[s]; ++c) out.at[out.size++] = tape.first[s] + c;
    return out;
}

const Instruction *Majorants::plain(Part p) const {
    const Instruction *made = machine.maker(slot(p));
    if (!made) return nullptr;
    if (made->stands_at) return nullptr; // another value than that of its arguments
    const bool is_plain = made->form == Form::Plain || made->form == Form::Wave ||
                          made->form == Form::Joined || made->form == Form::Opposite;
    return is_plain ? made : nullptr;
}

Part Majorants::argument(const Instruction &made, std::size_t i, Part p) const {
    const Slot s = made.args[i];
    return tape.first[s] + (tape.size[s] == 1 ? 0 : component(p));
}

int Majorants::taken(const Instruction &choice) const {
    const Interval c = machine.value(choice.args[0], 0);
    return c.lo > 0.5 ? 1 : c.hi < 0.5 ? 2 : 0;
}

Part Majorants::source(Part p) const {
    for (const Instruction *made = plain(p); made; made = plain(p)) {
        if (made->op == Op::Swizzle) {
            const int c = ir::swizzle_component(made->payload, int(component(p)));
            p = tape.first[made->args[0]] + std::uint32_t(c);
        } else if (made->op == Op::Splat) {
            p = tape.first[made->args[0]];
        } else if (made->op == Op::Make && ir::is_vector(made->type)) {
            std::uint32_t c = component(p), i = 0;
            for (; i < made->args.size() && c >= tape.size[made->args[i]]; ++i)
                c -= tape.size[made->args[i]];
            if (i == made->args.size()) return p;
            p = tape.first[made->args[i]] + c;
        } else if (made->op == Op::Select && taken(*made) != 0) {
            p = argument(*made, std::size_t(taken(*made)), p);
        } else {
            return p;
        }
    }
    return p;
}

Vector Majorants::sources(const Vector &v) const {
    Vector out;
    for (std::uint32_t i = 0; i < v.size; ++i) out.at[out.size++] = source(v.at[i]);
    for (std::uint32_t i = 1; i < v.size; ++i)
        for (std::uint32_t k = i; k > 0 && out.at[k] < out.at[k - 1]; --k)
            std::swap(out.at[k], out.at[k - 1]);
    return is_in_order(out) ? out : v;
}

const Instruction *Majorants::made_alike(const Vector &v) const {
    const Instruction *first = plain(v.at[0]);
    for (std::uint32_t i = 1; first && i < v.size; ++i) {
        const Instruction *made = plain(v.at[i]);
        if (!made || made->op != first->op || made->form != first->form) return nullptr;
        if (made->op == Op::Select && made->args[0] != first->args[0]) return nullptr;
    }
    return first;
}

Vector Majorants::arguments(const Vector &v, std::size_t i) const {
    Vector out;
    for (std::uint32_t k = 0; k < v.size; ++k)
        out.at[out.size++] = source(argument(*plain(v.at[k]), i, v.at[k]));
    return out;
}

bool Majorants::are_one(const Vector &v) {
    return std::all_of(v.at.begin(), v.at.begin() + v.size, [&](Part p) { return p == v.at[0]; });
}

bool Majorants::is_in_order(const Vector &v) {
    for (std::uint32_t i = 1; i < v.size; ++i)
        if (v.at[i] <= v.at[i - 1]) return false;
    return true;
}

Part Majorants::divisor(Part d) const {
    if (d == one) return d;
    while (true) {
        d = source(d);
        const Instruction *made = plain(d);
        if (!made || made->form != Form::Plain) return d;
        if (made->op == Op::Abs || made->op == Op::Neg) {
            d = argument(*made, 0, d);
        } else if (made->op == Op::Add || made->op == Op::Sub) { // of 0
            const Part a = argument(*made, 0, d), b = argument(*made, 1, d);
            if (value(b) == Interval(0.0) && is_still(b))
                d = a;
            else if (value(a) == Interval(0.0) && is_still(a))
                d = b;
            else
                return d;
        } else {
            return d;
        }
    }
}

// -- what hangs on a vector's size

Interval Majorants::in_arm(Part p, int depth) const {
    constexpr int max_depth = 4;
    Interval out = value(p);
    if (narrowed.empty() || depth > max_depth) return out;
    for (const auto &[part, to] : narrowed)
        if (part == p) out = {std::max(out.lo, to.lo), std::min(out.hi, to.hi)};
    const Instruction *made = plain(p);
    constexpr ir::OpSet known{Op::Min, Op::Max, Op::Mul, Op::Div};
    if (made && made->form == Form::Plain && known[made->op]) {
        const Interval a = in_arm(source(argument(*made, 0, p)), depth + 1),
                       b = in_arm(source(argument(*made, 1, p)), depth + 1);
        const Interval x = made->op == Op::Min   ? min(a, b)
                           : made->op == Op::Max ? max(a, b)
                           : made->op == Op::Mul ? a * b
                                                 : a / b;
        out = {std::max(out.lo, x.lo), std::min(out.hi, x.hi)};
    }
    return out.lo <= out.hi ? out : value(p); // no point of the cell is there
}

std::optional<Majorants::Radial> Majorants::length_of(const Instruction &made, double power) const {
    Vector v;
    for (const Slot arg : made.args)
        for (std::uint32_t c = 0; c < tape.size[arg]; ++c) {
            if (v.size == 4) return {};
            v.at[v.size++] = tape.first[arg] + c;
        }
    v = sources(v);
    if (!is_in_order(v)) return {};
    return Radial{v, power, power, 1.0};
}

// Of what is a here and b there.
std::optional<Majorants::Radial> Majorants::joined(const Radial &a, const Radial &b) const {
    if (a.of.size > 0 && b.of.size > 0 && a.of != b.of) return {};
    Radial out = a.of.size > 0 ? a : b;
    out.exponent = hull(a.exponent, b.exponent);
    if (a.of.size > 0 && b.of.size > 0 && (a.power != b.power || a.by != b.by)) out.power = 0;
    return out;
}

std::optional<Majorants::Radial> Majorants::radial(Part p, int depth) const {
    constexpr int max_depth = 12;
    p = source(p);
    if (is_still(p)) return Radial{};
    const Instruction *made = machine.maker(slot(p));
    if (!made || tape.size[slot(p)] != 1 || depth > max_depth) return {};
    const auto of = [&](std::size_t i) { return radial(tape.first[made->args[i]], depth + 1); };
    if (made->form == Form::Norm) return length_of(*made, 1);
    if (made->form == Form::Square) {
        auto a = of(0);
        if (a) a->exponent = Interval(2.0) * a->exponent, a->power *= 2, a->by = square(a->by);
        return a;
    }
    if (made->form != Form::Plain && made->form != Form::Joined) return {};
    const Op op = made->op;
    if (op == Op::Dot) {
        if (made->args[0] != made->args[1]) return {};
        Instruction once = *made;
        once.args.resize(1);
        return length_of(once, 2);
    }
    if (op == Op::Neg || op == Op::Abs) {
        auto a = of(0);
        if (a) a->by = op == Op::Neg ? -a->by : abs(a->by);
        return a;
    }
    if (op == Op::Sqrt || op == Op::InverseSqrt) {
        auto a = of(0);
        if (!a || !(value(tape.first[made->args[0]]).lo > 0)) return {};
        const double half = op == Op::Sqrt ? 0.5 : -0.5;
        a->exponent = Interval(half) * a->exponent;
        a->power *= half;
        a->by = op == Op::Sqrt ? sqrt(a->by) : Interval(1.0) / sqrt(a->by);
        return a;
    }
    constexpr ir::OpSet choices{Op::Min,          Op::Max,   Op::Union,
                                Op::Intersection, Op::Clamp, Op::Select};
    if (choices[op]) {
        const std::size_t first = op == Op::Select ? 1 : 0;
        std::optional<Radial> out = of(first);
        for (std::size_t i = first + 1; out && i < made->args.size(); ++i) {
            const auto next = of(i);
            out = next ? joined(*out, *next) : next;
        }
        return out;
    }
    if (op == Op::Add) {
        const auto a = of(0), b = of(1);
        const Interval x = value(tape.first[made->args[0]]), y = value(tape.first[made->args[1]]);
        if (!a || !b || !have_one_sign(x, y)) return {};
        auto out = joined(*a, *b);
        if (out) out->power = 0;
        return out;
    }
    return op == Op::Mul || op == Op::Div ? radial_product(*made, depth) : std::nullopt;
}

std::optional<Majorants::Radial> Majorants::radial_product(const Instruction &made,
                                                           int depth) const {
    const Part p = tape.first[made.args[0]], q = tape.first[made.args[1]];
    const auto a = radial(p, depth + 1), b = radial(q, depth + 1);
    if (!a || !b || (a->of.size > 0 && b->of.size > 0 && a->of != b->of)) return {};
    const bool both = a->of.size > 0 && b->of.size > 0, divides = made.op == Op::Div;
    Radial out = a->of.size > 0 ? *a : *b;
    out.exponent = divides ? a->exponent - b->exponent : a->exponent + b->exponent;
    if (divides && a->of.size == 0) out.power = -b->power;
    // a factor that has no slope may be another number at each point
    const Interval a_by = a->of.size > 0 ? a->by : value(p),
                   b_by = b->of.size > 0 ? b->by : value(q);
    out.by = divides ? a_by / b_by : a_by * b_by;
    if (both) out.power = 0;
    return out;
}

namespace {

// The sizes r of the vector at which k = by r^power has a slope.
Interval sizes_of(const Interval &value, const Interval &size, const Majorants::Radial &k) {
    if (k.power == 0) return size;
    const Interval power = abs(value) / abs(k.by);
    const double x = std::pow(power.lo, 1 / k.power), y = std::pow(power.hi, 1 / k.power);
    const double lo = ir::rounding::down(std::min(x, y), 8), hi = up(std::max(x, y), 8);
    if (std::isnan(lo) || std::isnan(hi)) return size;
    return {std::max(size.lo, lo), std::min(size.hi, hi)};
}

} // namespace

std::optional<Majorants::Turns> Majorants::turns(const std::vector<Factor> &factors) const {
    Turns out;
    for (const Factor &factor : factors) {
        const auto k = radial(factor.part);
        if (!k) return {};
        if (k->of.size == 0) continue;
        if (out.of.size > 0 && out.of != k->of) return {};
        out.of = k->of;
        out.exponent = factor.divides ? out.exponent - k->exponent : out.exponent + k->exponent;
        Interval sum = 0.0;
        for (std::uint32_t i = 0; i < k->of.size; ++i) sum += square(value(k->of.at[i]));
        const Interval known = in_arm(factor.part);
        const Interval r = sizes_of(known, sqrt(sum), *k);
        const double e = k->exponent.magnitude();
        const double slope = e == 0 || r.lo > r.hi ? 0 : ratio_of(e, r.lo);
        out.log_slope = plus(out.log_slope, slope);
        out.by_itself = infinity;
        if (factors.size() > 1) continue;
        out.farthest = k->power == 0 ? infinity : std::max(r.hi, 0.0);
        // e/(r by r^power), or with the inverse
        const double itself = ratio_of(1, ir::rounding::down(least(factors)));
        out.by_itself = slope == 0 ? 0 : up(times(slope, itself));
        if (slope == 0 || k->power == 0) continue;
        const double power = -1 - (factor.divides ? -k->power : k->power);
        const double by = factor.divides ? k->by.magnitude() : ratio_of(1, k->by.mignitude());
        const double most = std::max(std::pow(r.lo, power), std::pow(r.hi, power));
        if (!std::isnan(most))
            out.by_itself = std::min(out.by_itself, up(times(times(e, by), most), 16));
    }
    return out;
}

void Majorants::gather(Part p, bool divides, Factors &out, int depth) const {
    constexpr int max_depth = 8;
    p = divisor(p);
    if (is_still(p)) {
        out.by = divides ? out.by / value(p) : out.by * value(p);
        return;
    }
    const Instruction *made = plain(p);
    const bool is_product = made && made->form == Form::Plain && depth < max_depth &&
                            out.parts.size() < most_factors &&
                            (made->op == Op::Mul || made->op == Op::Div);
    if (!is_product) {
        out.parts.push_back({p, divides});
        return;
    }
    gather(argument(*made, 0, p), divides, out, depth + 1);
    gather(argument(*made, 1, p), divides != (made->op == Op::Div), out, depth + 1);
}

double Majorants::least(const std::vector<Factor> &factors) const {
    double out = 1;
    for (const Factor &f : factors) {
        const double x = in_arm(f.part).mignitude(), y = in_arm(f.part).magnitude();
        out = ir::rounding::down(f.divides ? out / y : out * x);
    }
    return out;
}
double Majorants::most(const std::vector<Factor> &factors) const {
    double out = 1;
    for (const Factor &f : factors)
        out = f.divides ? ratio_of(out, in_arm(f.part).mignitude())
                        : up(times(out, in_arm(f.part).magnitude()));
    return out;
}

std::optional<Majorants::Scaled> Majorants::scaled(Part d) const {
    Scaled out;
    out.rest = d;
    Vector of;
    const auto hangs_on_one = [&](Part p) {
        const auto k = radial(p);
        return k && (k->of.size == 0 || of.size == 0 || k->of == of);
    };
    const auto is_sum = [&](Part p) {
        const Instruction *made = plain(p);
        return made && made->op == Op::Add;
    };
    const Factors factors = peel(out.rest, [&](const Factors &found, Part other) {
        for (const Factor &factor : found.parts) {
            if (!hangs_on_one(factor.part)) return false;
            // of two that do, a sum is what was scaled before
            if (!factor.divides && is_sum(factor.part) && hangs_on_one(other)) return false;
            if (of.size == 0) of = radial(factor.part)->of;
        }
        return true;
    });
    out.scales = factors.parts;
    if (out.rest == d) {
        if (!radial(d)) return {};
        out.rest = one;
        out.scales = {{d, false}};
    }
    out.by = factors.by.mignitude();
    out.least = ir::rounding::down(out.by * least(out.scales));
    return out;
}

// At most, of the gradient of what `rest` is multiplied by, over that squared and over `rest`.
double Majorants::slope_over(const Scaled &d) {
    double out = 0;
    for (const Factor &factor : d.scales) {
        const auto turned = turns({factor});
        if (!turned) return infinity;
        if (turned->log_slope == 0) continue;
        std::vector<Factor> others = d.scales;
        std::erase(others, factor);
        const double beside = ir::rounding::down(d.by * least(others));
        const double slope = bound(Wanted::Slope, turned->of, d.rest);
        out = plus(out, ratio_of(up(times(turned->by_itself, slope)), beside));
    }
    return out;
}

// -- folds

// A vector and those that it is made of by component, each of the one before, what stands still
// apart.
std::vector<Vector> Majorants::chain(Vector v, bool meets) const {
    constexpr std::size_t max_length = 12;
    constexpr ir::OpSet known{Op::Add, Op::Sub, Op::Neg,   Op::Abs, Op::Mul,
                              Op::Min, Op::Max, Op::Clamp, Op::Div};
    std::vector<Vector> out{v};
    while (out.size() < max_length) {
        const Instruction *made = made_alike(v);
        if (!made || (!known[made->op] && made->form != Form::Wave)) break;
        std::vector<Vector> varying;
        for (std::size_t i = 0; i < made->args.size(); ++i)
            if (const Vector arg = arguments(v, i); !is_still(arg)) varying.push_back(arg);
        if (varying.empty() || varying.size() > 2) break;
        if (varying.size() == 2) {
            if (!meets) break;
            const std::vector<Vector> one_way = chain(varying[0], false),
                                      other = chain(varying[1], false);
            const auto met = std::ranges::find_if(one_way, [&](const Vector &a) {
                return std::ranges::find(other, a) != other.end();
            });
            if (met == one_way.end()) break;
            varying[0] = *met;
        }
        v = varying[0];
        out.push_back(v);
    }
    return out;
}

std::optional<Majorants::Fold> Majorants::fold_to(const Vector &v, const Vector &y,
                                                  int depth) const {
    constexpr int max_depth = 12;
    if (v == y) return Fold{y, 1.0, 0.0, true};
    if (is_still(v)) return Fold{y, 0.0, value(v), true};
    const Instruction *made = made_alike(v);
    if (!made || depth > max_depth) return {};
    const auto of = [&](std::size_t i) { return fold_to(arguments(v, i), y, depth + 1); };
    const auto a = of(0);
    if (!a) return {};
    if (made->form == Form::Wave) { // jumps, but not to beyond its argument's size
        if (!is_still(arguments(v, 1))) return {};
        return Fold{y, a->slope, a->at_0, a->bounded && a->at_0 == Interval(0.0)};
    }
    if (made->form != Form::Plain) return {};
    if (made->op == Op::Neg) return Fold{y, -a->slope, -a->at_0, a->bounded};
    if (made->op == Op::Abs) return Fold{y, hull(a->slope, -a->slope), abs(a->at_0), a->bounded};
    const auto b = of(1);
    if (!b) return {};
    const bool bounded = a->bounded && b->bounded;
    const bool a_still = a->slope == Interval(0.0), b_still = b->slope == Interval(0.0);
    const Op op = made->op;
    if (op == Op::Add) return Fold{y, a->slope + b->slope, a->at_0 + b->at_0, bounded};
    if (op == Op::Sub) return Fold{y, a->slope - b->slope, a->at_0 - b->at_0, bounded};
    if (op == Op::Min) return Fold{y, hull(a->slope, b->slope), min(a->at_0, b->at_0), bounded};
    if (op == Op::Max) return Fold{y, hull(a->slope, b->slope), max(a->at_0, b->at_0), bounded};
    if (op == Op::Mul && (a_still || b_still))
        return Fold{y, b_still ? a->slope * b->at_0 : a->at_0 * b->slope, a->at_0 * b->at_0,
                    bounded};
    if (op == Op::Div && b_still && !b->at_0.contains(0))
        return Fold{y, a->slope / b->at_0, a->at_0 / b->at_0, bounded};
    if (op != Op::Clamp || !b_still) return {};
    const auto c = of(2);
    if (!c || !(c->slope == Interval(0.0))) return {};
    return Fold{y, hull(a->slope, 0.0), min(max(a->at_0, b->at_0), c->at_0), bounded};
}

// Of what folds one by one, the vector that is folded.
std::optional<Majorants::Fold> Majorants::fold(const Vector &v) const {
    const Instruction *made = made_alike(v);
    constexpr ir::OpSet sums{Op::Add, Op::Sub}, folds{Op::Min, Op::Max, Op::Clamp};
    if (!made || (!sums[made->op] && !folds[made->op] && made->form != Form::Wave)) return {};
    if (sums[made->op] && made->form != Form::Wave &&
        (is_still(arguments(v, 0)) || is_still(arguments(v, 1))))
        return {}; // moved
    const std::vector<Vector> all = chain(v, true);
    return all.size() > 1 ? fold_to(v, all[1]) : std::nullopt;
}

} // namespace fathom::proof
