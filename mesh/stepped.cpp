#include "mesh/stepped.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

constexpr double of_quotients = 1e-6; // a share of one, more than its floats are off

// What a number's floats lie within: not the real number, too.
Interval floats_of(const Varying &a) { return {a.range.lo + a.error, a.range.hi - a.error}; }

// How far from where a number passes some value its floats may lie on the other side: what they are
// off over its slope. That is taken to be 1 where it is not known, as where decisions are proved
// (docs/trusted.md, 2).
double beyond_of(const Varying &number) {
    double slope = 0;
    for (const Interval &along : number.slope) slope = std::max({slope, along.lo, -along.hi});
    return number.error / (slope > 0 ? slope : 1);
}

// A number that is the same all over the box, but where another passes some values: `step` says which
// it is there, and rises with it. Where floats are all on one side of such a value, and the real
// number may not be, they are off by how far apart both sides are.
template <class Step> Varying steps_of(const Varying &a, Step step) {
    Varying made;
    made.known = a.known;
    made.range = {step(a.range.lo), step(a.range.hi)};
    made.jumps = made.range.lo != made.range.hi;
    if (!made.jumps) return made;
    const Interval floats = floats_of(a);
    const bool both = floats.lo <= floats.hi && step(floats.lo) == made.range.lo &&
                      step(floats.hi) == made.range.hi;
    made.error = both ? 0 : made.range.hi - made.range.lo;
    made.beyond = beyond_of(a);
    return made;
}

double sign_of(double x) { return x < 0 ? -1 : x > 0 ? 1 : 0; }
double round_of(double x) { return std::floor(x + 0.5); }
double step_of(double x) { return x < 0 ? 0 : 1; }

// a - b·floor(a/b)
Varying rest_of(const Varying &a, const Varying &b) {
    if (!(b.range.lo > 0 || b.range.hi < 0)) return {};
    const Varying quotient = through(Kernel::DivF, {a, b});
    const auto within = [&](Interval x, Interval y, double share) {
        const Interval exact = x * Interval{1 / y.hi, 1 / y.lo};
        const double slack = share * (1 + size(exact));
        return Interval{exact.lo - slack, exact.hi + slack};
    };
    const Interval all = within(a.range, b.range, of_quotients);
    const Interval seen = within(floats_of(a), floats_of(b), -of_quotients);
    const Interval turns{std::floor(all.lo), std::floor(all.hi)};
    const double most = size(turns) * size(b.range);
    Varying made = chained({{&a, {1, 1}}, {&b, {-turns.hi, -turns.lo}}}, size(a.range) + 2 * most);
    made.known = made.known && std::isfinite(most);
    made.jumps = turns.lo != turns.hi;
    if (!made.jumps) return made;
    made.beyond = beyond_of(quotient);
    // One rest or another is in all of the kernel's range, but where floats see one alone.
    if (!(seen.lo <= seen.hi && std::floor(seen.lo) == turns.lo && std::floor(seen.hi) == turns.hi))
        made.error += size(b.range);
    return made;
}

// The angle of (x, y), which has a cut where y is 0 and x is below 0.
Varying angle_of(const Varying &y, const Varying &x) {
    constexpr double rounding = 4e-6; // more than 8 units of the last place of a half turn
    constexpr double turn = 6.283185307179586;
    const auto least = [](Interval r) { return std::max({r.lo, -r.hi, 0.0}); };
    const double nearest = std::hypot(least(x.range), least(y.range)) * (1 - 1e-9);
    const double farthest = std::hypot(size(x.range), size(y.range));
    if (!(nearest > 0)) return {};
    // r/(x² + y²) of r = x or y: as a share of the length, and over the length.
    const auto over_square = [&](Interval r) {
        const double lo = std::max(r.lo / (r.lo < 0 ? nearest : farthest), -1.0);
        const double hi = std::min(r.hi / (r.hi > 0 ? nearest : farthest), 1.0);
        return Interval{lo / (lo < 0 ? nearest : farthest), hi / (hi > 0 ? nearest : farthest)};
    };
    Varying made =
        chained({{&y, over_square(x.range)}, {&x, over_square(y.range) * Interval{-1, -1}}}, 0);
    made.error += rounding;
    made.jumps = x.range.lo < 0 && y.range.lo <= 0 && y.range.hi >= 0;
    if (!made.jumps) return made;
    made.beyond = beyond_of(y);
    const Interval floats = floats_of(y);
    if (!(floats.lo < 0 && floats.hi >= 0)) made.error += turn;
    return made;
}

// A whole power from 2 on.
Varying power_of(const Varying &a, int exponent) {
    const double low = std::pow(a.range.lo, exponent - 1),
                 high = std::pow(a.range.hi, exponent - 1);
    Interval slope{std::min(low, high), std::max(low, high)};
    if (exponent % 2 != 0 && a.range.lo < 0 && a.range.hi > 0) slope.lo = 0;
    return chained({{&a, slope * Interval{double(exponent), double(exponent)}}},
                   2 * exponent * std::pow(size(a.range), exponent));
}

// a·(1 - t) + b·t
Varying mixed(const Varying &a, const Varying &b, const Varying &t) {
    const Interval less{1 - t.range.hi, 1 - t.range.lo};
    const Interval apart{b.range.lo - a.range.hi, b.range.hi - a.range.lo};
    return chained({{&a, less}, {&b, t.range}, {&t, apart}},
                   3 * (size(a.range) * size(less) + size(b.range) * size(t.range)));
}

// t²·(3 - 2t) of the share t of x between two numbers that are the same all over the box.
Varying smooth_step(const Varying &lo, const Varying &hi, const Varying &x) {
    const double width = hi.range.lo - lo.range.hi;
    if (!(width > 0 && lo.range.lo == lo.range.hi && hi.range.lo == hi.range.hi)) return {};
    const auto slope = [&](double at) {
        const double t = std::clamp((at - lo.range.lo) / width, 0.0, 1.0);
        return 6 * t * (1 - t) / width;
    };
    const double middle = 0.5 * (lo.range.lo + hi.range.lo);
    const double a = slope(x.range.lo), b = slope(x.range.hi);
    const double most = x.range.lo <= middle && x.range.hi >= middle ? 1.5 / width : std::max(a, b);
    return chained({{&x, {std::min(a, b), most}}}, 16 + 4 * size(x.range) / width);
}

// What kernels give whose number is the same where their inputs are: no rounding is in it.
Varying piece_by_piece(const std::vector<Varying> &in) {
    Varying made;
    made.known = true;
    for (const Varying &one : in) {
        made.known = made.known && one.known && one.error == 0;
        for (const Interval &slope : one.slope) made.known = made.known && size(slope) == 0;
    }
    return made;
}

} // namespace

Varying comparison_of(const Varying &a, const Varying &b) {
    const Varying difference = through(Kernel::SubF, {a, b});
    Varying made;
    made.known = difference.known;
    made.range = {0, 1};
    made.jumps = true; // it may be read as a number
    made.beyond = beyond_of(difference);
    // Floats may all be on one side where the real numbers are not.
    const bool sure = a.range.hi < b.range.lo || b.range.hi < a.range.lo;
    const Interval x = floats_of(a), y = floats_of(b);
    const bool seen = x.lo < y.hi && y.lo < x.hi;
    made.error = sure || seen ? 0 : 1;
    return made;
}

Varying stepped(Kernel kernel, const std::vector<Varying> &in) {
    const Varying &a = in[0];
    if (kernel == Kernel::FloorF) return steps_of(a, [](double x) { return std::floor(x); });
    if (kernel == Kernel::CeilF) return steps_of(a, [](double x) { return std::ceil(x); });
    if (kernel == Kernel::TruncF || kernel == Kernel::IntOfFloat)
        return steps_of(a, [](double x) { return std::trunc(x); });
    if (kernel == Kernel::RoundF) return steps_of(a, round_of);
    if (kernel == Kernel::SignF) return steps_of(a, sign_of);
    if (kernel == Kernel::StepF) return steps_of(through(Kernel::SubF, {in[1], a}), step_of);
    if (kernel == Kernel::FractF) {
        Varying whole;
        whole.known = true;
        whole.range = {1, 1};
        return rest_of(a, whole);
    }
    if (kernel == Kernel::ModF) return rest_of(a, in[1]);
    if (kernel == Kernel::Atan2F) return angle_of(a, in[1]);
    if (kernel == Kernel::MixF) return mixed(a, in[1], in[2]);
    if (kernel == Kernel::SmoothstepF) return smooth_step(a, in[1], in[2]);
    constexpr Kernel powers[] = {Kernel::Power2, Kernel::Power3, Kernel::Power4, Kernel::Power5,
                                 Kernel::Power6, Kernel::Power7, Kernel::Power8};
    if (const auto at = std::ranges::find(powers, kernel); at != std::end(powers))
        return power_of(a, 2 + static_cast<int>(at - std::begin(powers)));
    constexpr Kernel whole[] = {
        Kernel::NegI,   Kernel::AddI,       Kernel::SubI,  Kernel::MulI,      Kernel::DivI,
        Kernel::ModI,   Kernel::MinI,       Kernel::MaxI,  Kernel::AbsI,      Kernel::SignI,
        Kernel::ClampI, Kernel::EqualF,     Kernel::LessI, Kernel::NotEqualF, Kernel::EqualI,
        Kernel::HashI,  Kernel::LessEqualI, Kernel::Hash1, Kernel::NotEqualI, Kernel::SelectI,
        Kernel::Hash2,  Kernel::FloatOfInt, Kernel::Hash3, Kernel::Hash4};
    return std::ranges::find(whole, kernel) != std::end(whole) ? piece_by_piece(in) : Varying{};
}

} // namespace fathom::mesh
