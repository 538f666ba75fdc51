#include "mesh/varying.h"

#include "mesh/stepped.h"

#include "ir/blends.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

constexpr double unit_roundoff = 0x1.01p-24; // of sums, products and quotients,
constexpr double of_roots = 0x1p-22;         // … and of what is not rounded right
constexpr Interval one{1, 1}, minus_one{-1, -1};

} // namespace

Varying chained(std::initializer_list<std::pair<const Varying *, Interval>> parts, double terms) {
    Varying made;
    made.known = true;
    made.error = unit_roundoff * terms;
    for (const auto &[part, by] : parts) {
        made.known = made.known && part->known;
        made.error += size(by) * part->error;
        for (std::size_t i = 0; i < directions; ++i)
            made.slope[i] = made.slope[i] + by * part->slope[i];
    }
    return made;
}

namespace {

// a·x + b·y + …
Varying sum_of_products(const Varying *a, const Varying *b, std::size_t count) {
    Varying made;
    made.known = true;
    for (std::size_t k = 0; k < count; ++k) {
        const Varying part = chained({{&a[k], b[k].range}, {&b[k], a[k].range}}, 0);
        made.known = made.known && part.known;
        // Each is rounded, and then each sum.
        made.error += part.error + static_cast<double>(count) * unit_roundoff * size(a[k].range) *
                                       size(b[k].range);
        for (std::size_t i = 0; i < directions; ++i) made.slope[i] = made.slope[i] + part.slope[i];
    }
    return made;
}

// Of both together; not known: there are more than are kept.
Ids joined(const Ids &a, const Ids &b) {
    std::vector<std::uint32_t> all;
    for (const Ids *ids : {&a, &b})
        for (const std::uint32_t id : ids->of)
            if (id != 0) all.push_back(id);
    std::ranges::sort(all);
    all.erase(std::unique(all.begin(), all.end()), all.end());
    Ids made;
    made.known = a.known && b.known && all.size() <= made.of.size();
    if (made.known) std::ranges::copy(all, made.of.begin());
    return made;
}

// The numbers of which one is above 0 where a number is.
Ids above_in(const Varying &a) {
    if (a.range.hi <= 0) return {true, {}};
    if (a.greatest.known) return a.greatest;
    return {a.id != 0, {a.id}};
}

// The length of a vector whose components are not below 0 has the slopes of those that are above 0, by
// shares that are not below 0 and whose squares add up to 1. Of components that are parts above 0 of
// numbers it is not 0 just where one of these is above 0.
Varying::Half half_of_length(const Varying *x, std::size_t count) {
    Varying::Half half{{true, {}}, true, {}, 0};
    std::array<std::array<double, 2>, directions> squares{};
    bool first = true;
    for (std::size_t k = 0; k < count; ++k) {
        if (size(x[k].range) == 0) continue;
        const bool part = x[k].half.of.known && x[k].half.above;
        if (!part && x[k].range.lo < 0) return {};
        half.of = joined(half.of, part ? x[k].half.of : Ids{});
        half.error += part ? x[k].half.error : x[k].error;
        for (std::size_t i = 0; i < directions; ++i) {
            const Interval slope = part ? x[k].half.slope[i] : x[k].slope[i];
            half.slope[i] = first ? slope : hull(half.slope[i], slope);
            squares[i][0] += std::pow(std::min(slope.lo, 0.0), 2);
            squares[i][1] += std::pow(std::max(slope.hi, 0.0), 2);
        }
        first = false;
    }
    for (std::size_t i = 0; i < directions; ++i) {
        if (half.slope[i].lo < 0) half.slope[i].lo = -std::sqrt(squares[i][0]);
        if (half.slope[i].hi > 0) half.slope[i].hi = std::sqrt(squares[i][1]);
    }
    half.above = !first;
    return half;
}

// The length of a vector.
Varying length_of(const Varying *x, std::size_t count) {
    double least = 0, most = 0; // squares
    for (std::size_t k = 0; k < count; ++k) {
        const Interval r = x[k].range;
        const double low = r.lo > 0 ? r.lo : r.hi < 0 ? -r.hi : 0;
        least += low * low;
        most += size(r) * size(r);
    }
    const double shortest = std::sqrt(least), longest = std::sqrt(most);
    Varying made;
    made.known = true;
    made.error = static_cast<double>(count) * of_roots * longest;
    for (std::size_t k = 0; k < count; ++k) {
        const Interval r = x[k].range;
        Interval share{-1, 1}; // of the component in the length
        if (r.lo >= 0) share.lo = 0;
        if (r.hi <= 0) share.hi = 0;
        if (shortest > 0) {
            share.lo = std::max(-1.0, r.lo / (r.lo < 0 ? shortest : longest));
            share.hi = std::min(1.0, r.hi / (r.hi > 0 ? shortest : longest));
        }
        made.known = made.known && x[k].known;
        made.error += x[k].error;
        for (std::size_t i = 0; i < directions; ++i)
            made.slope[i] = made.slope[i] + share * x[k].slope[i];
    }
    made.half = half_of_length(x, count);
    made.half.error += static_cast<double>(count) * of_roots * longest;
    for (std::size_t i = 0; i < directions && made.half.above && shortest > 0; ++i)
        made.slope[i] = {std::max(made.slope[i].lo, made.half.slope[i].lo),
                         std::min(made.slope[i].hi, made.half.slope[i].hi)};
    return made;
}

Varying minus(const Varying &a, const Varying &b) {
    Varying made = chained({{&a, one}, {&b, minus_one}}, size(a.range) + size(b.range));
    made.range = {a.range.lo - b.range.hi, a.range.hi - b.range.lo};
    return made;
}

Varying size_of(const Varying &a) {
    Varying made = chained({{&a, a.range.lo >= 0   ? one
                                 : a.range.hi <= 0 ? minus_one
                                                   : Interval{-1, 1}}},
                           0);
    made.range = a.range.lo >= 0   ? a.range
                 : a.range.hi <= 0 ? Interval{-a.range.hi, -a.range.lo}
                                   : Interval{0, size(a.range)};
    return made;
}

// The greater of both, or the lesser, here this one and there the other, or one of them all over.
Varying one_of(const Varying &a, const Varying &b, bool greater) {
    const bool a_alone = greater ? a.range.lo >= b.range.hi : a.range.hi <= b.range.lo;
    const bool b_alone = greater ? b.range.lo >= a.range.hi : b.range.hi <= a.range.lo;
    if (a_alone) return a;
    if (b_alone) return b;
    Varying made;
    made.range = greater
                     ? Interval{std::max(a.range.lo, b.range.lo), std::max(a.range.hi, b.range.hi)}
                     : Interval{std::min(a.range.lo, b.range.lo), std::min(a.range.hi, b.range.hi)};
    made.known = a.known && b.known;
    made.error = std::max(a.error, b.error);
    for (std::size_t i = 0; i < directions; ++i) made.slope[i] = hull(a.slope[i], b.slope[i]);
    if (greater) made.greatest = joined(above_in(a), above_in(b));
    if (size(b.range) == 0) made.half = {above_in(a), greater, a.slope, a.error};
    if (size(a.range) == 0) made.half = {above_in(b), greater, b.slope, b.error};
    return made;
}

// a + b: of both halves of a number that number; of what is not 0 in two places here the one and
// there the other.
Varying plus(const Varying &a, const Varying &b) {
    const double terms = size(a.range) + size(b.range);
    Varying made = chained({{&a, one}, {&b, one}}, terms);
    if (!a.half.of.known || a.half.of != b.half.of || a.half.above == b.half.above) return made;
    for (std::size_t i = 0; i < directions; ++i)
        made.slope[i] = hull(a.half.slope[i], b.half.slope[i]);
    made.error = a.half.error + b.half.error + unit_roundoff * terms;
    return made;
}

Varying quotient_of(const Varying &a, const Varying &b) {
    if (!(b.range.lo > 0 || b.range.hi < 0)) return {};
    const Interval inverse{1 / b.range.hi, 1 / b.range.lo};
    const Interval quotient = a.range * inverse;
    return chained({{&a, inverse}, {&b, quotient * inverse * minus_one}}, size(quotient));
}

Varying root_of(const Varying &a) {
    if (!(a.range.lo > 0)) return {};
    const double least = std::sqrt(a.range.lo), most = std::sqrt(a.range.hi);
    Varying made = chained({{&a, {0.5 / most, 0.5 / least}}}, 0);
    made.error += of_roots * most;
    return made;
}

Varying negative(const Varying &a) {
    Varying made = chained({{&a, minus_one}}, 0);
    made.range = {-a.range.hi, -a.range.lo};
    return made;
}

Varying selected(const Varying &choice, const Varying &a, const Varying &b) {
    if (choice.range.lo > 0) return a;
    if (choice.range.hi <= 0) return b;
    Varying made;
    made.known = choice.known && a.known && b.known;
    made.range = hull(a.range, b.range);
    made.error = std::max(a.error, b.error);
    for (std::size_t i = 0; i < directions; ++i) made.slope[i] = hull(a.slope[i], b.slope[i]);
    made.jumps = true;
    return made;
}

// The least share of the slopes of b in those of a blend, and the greatest, by how much b is above a,
// measured by the blend's radius: 1/2 where they are equal, less above.
using ShareOfOther = double (*)(double above);
double share_in_smooth(double x) { return std::clamp(0.5 - 0.5 * x, 0.0, 1.0); }
double share_in_round(double x) {
    return std::fabs(x) >= 1 ? (x > 0 ? 0 : 1) : 0.5 * (1 - x / std::sqrt(2 - x * x));
}
double share_in_chamfer(double x) { return x >= 1 ? 0 : x <= -1 ? 1 : 0.5; }

// min(a, b) less what a blend of radius r takes off, which falls by at most half of |a - b|: its slopes
// are a mean of those of a and b. Not known where the radius changes.
Varying blended(const Varying &a, const Varying &b, const Varying &r, ShareOfOther share) {
    constexpr double rounding = 1e-9, of_blends = 0x1p-20;
    // Farther apart than the radius, in floats too, it is the lesser of both, and nothing is rounded.
    const double apart = (1 + of_blends) * std::max(r.range.hi, 0.0);
    if (b.range.lo - a.range.hi > apart) return a;
    if (a.range.lo - b.range.hi > apart) return b;
    Varying made;
    made.known = a.known && b.known && r.known;
    for (const Interval &slope : r.slope) made.known = made.known && size(slope) == 0;
    made.error = std::max(a.error, b.error) + r.error +
                 of_blends * (size(a.range) + size(b.range) + size(r.range));
    Interval of_b{0, 1};
    if (r.range.lo > ir::sem::min_radius) { // below it a smooth blend is another one
        const Interval above = Interval{b.range.lo - a.range.hi, b.range.hi - a.range.lo} *
                               Interval{1 / r.range.hi, 1 / r.range.lo};
        of_b = {std::max(share(above.hi + rounding) - rounding, 0.0),
                std::min(share(above.lo - rounding) + rounding, 1.0)};
    }
    for (std::size_t i = 0; i < directions; ++i) {
        const auto mean = [&](double w) {
            return Interval{1 - w, 1 - w} * a.slope[i] + Interval{w, w} * b.slope[i];
        };
        made.slope[i] = hull(mean(of_b.lo), mean(of_b.hi));
    }
    return made;
}

// A ball by its place, its middle and its radius, with its range.
Varying ball_of(const Varying *in) {
    Varying part[3];
    double least = 0, most = 0; // squares
    for (std::size_t i = 0; i < 3; ++i) {
        part[i] = minus(in[i], in[3 + i]);
        const Interval r = part[i].range;
        least += std::pow(std::max({r.lo, -r.hi, 0.0}), 2);
        most += size(r) * size(r);
    }
    const Varying length = length_of(part, 3);
    Varying ball = chained({{&length, one}, {&in[6], minus_one}}, size(in[6].range));
    ball.range = {std::sqrt(least) - in[6].range.hi - ball.error,
                  std::sqrt(most) - in[6].range.lo + ball.error};
    return ball;
}

// What kernels give that blend numbers; others are not known.
Varying blend_of_several(Kernel kernel, const std::vector<Varying> &in) {
    if (kernel == Kernel::BlendSmooth) return blended(in[0], in[1], in[2], share_in_smooth);
    if (kernel == Kernel::BlendRound) return blended(in[0], in[1], in[2], share_in_round);
    if (kernel == Kernel::BlendChamfer) return blended(in[0], in[1], in[2], share_in_chamfer);
    if (kernel == Kernel::SmoothBall)
        return blended(in[0], ball_of(in.data() + 1), in[8], share_in_smooth);
    return {};
}

// What kernels give that choose among numbers; others are not known.
Varying one_of_several(Kernel kernel, const std::vector<Varying> &in) {
    if (kernel == Kernel::MinF) return one_of(in[0], in[1], false);
    if (kernel == Kernel::MaxF) return one_of(in[0], in[1], true);
    if (kernel == Kernel::ClampF) return one_of(one_of(in[0], in[1], true), in[2], false);
    if (kernel == Kernel::MaxNeg) return one_of(in[0], negative(in[1]), true);
    if (kernel == Kernel::MaxAbs) return one_of(size_of(in[0]), size_of(in[1]), true);
    if (kernel == Kernel::MinMax) return one_of(in[0], one_of(in[1], in[2], true), false);
    if (kernel == Kernel::MaxMin) return one_of(in[0], one_of(in[1], in[2], false), true);
    if (kernel == Kernel::Slab) return one_of(minus(in[0], in[1]), minus(in[1], in[2]), true);
    return {};
}

} // namespace

// The sine of an angle, or its cosine: both at their derivatives about the middle of its range.
Varying wave_of(const Varying &angle, bool cosine) {
    constexpr double near = 5e-7, by_size = 1.2e-7; // what its floats are off (docs/trusted.md, 2)
    const double middle = 0.5 * (angle.range.lo + angle.range.hi);
    const double half = 0.5 * (angle.range.hi - angle.range.lo) + 1e-9 * (1 + std::fabs(middle));
    const double slope = cosine ? -std::sin(middle) : std::cos(middle);
    Varying made =
        chained({{&angle, {std::max(slope - half, -1.0), std::min(slope + half, 1.0)}}}, 0);
    made.error += near + by_size * size(angle.range);
    return made;
}

// What kernels of one output give; others are not known.
Varying through(Kernel kernel, const std::vector<Varying> &in) {
    const auto differences = [&] {
        return std::array<Varying, 3>{minus(in[0], in[3]), minus(in[1], in[4]),
                                      minus(in[2], in[5])};
    };
    if (kernel == Kernel::CopyF) return in[0];
    if (kernel == Kernel::NegF) return negative(in[0]);
    if (kernel == Kernel::AddF) return plus(in[0], in[1]);
    if (kernel == Kernel::SubF) return minus(in[0], in[1]);
    if (kernel == Kernel::MulF) return sum_of_products(in.data(), in.data() + 1, 1);
    if (kernel == Kernel::DivF) return quotient_of(in[0], in[1]);
    if (kernel == Kernel::SqrtF) return root_of(in[0]);
    if (kernel == Kernel::MulAdd) {
        const Varying product = sum_of_products(in.data(), in.data() + 1, 1);
        return chained({{&product, one}, {&in[2], one}},
                       size(in[0].range) * size(in[1].range) + size(in[2].range));
    }
    if (kernel == Kernel::Dot2) return sum_of_products(in.data(), in.data() + 2, 2);
    if (kernel == Kernel::Dot3) return sum_of_products(in.data(), in.data() + 3, 3);
    if (kernel == Kernel::Dot4) return sum_of_products(in.data(), in.data() + 4, 4);
    if (kernel == Kernel::SinF) return wave_of(in[0], false);
    if (kernel == Kernel::CosF) return wave_of(in[0], true);
    if (kernel == Kernel::AbsF) return size_of(in[0]);
    if (kernel == Kernel::AbsSub) {
        const Varying whole = size_of(in[0]);
        return chained({{&whole, one}, {&in[1], minus_one}}, size(in[0].range) + size(in[1].range));
    }
    if (kernel == Kernel::SubAbs) return size_of(minus(in[0], in[1]));
    if (kernel == Kernel::Length2) return length_of(in.data(), 2);
    if (kernel == Kernel::Length3) return length_of(in.data(), 3);
    if (kernel == Kernel::Distance3) return length_of(differences().data(), 3);
    if (kernel == Kernel::Ball) return ball_of(in.data());
    if (kernel == Kernel::MinBall) return one_of(in[0], ball_of(in.data() + 1), false);
    if (kernel == Kernel::LengthPositive3) {
        Varying nothing, parts[3];
        nothing.known = true;
        for (std::size_t i = 0; i < 3; ++i) parts[i] = one_of(in[i], nothing, true);
        return length_of(parts, 3);
    }
    if (kernel == Kernel::LessF || kernel == Kernel::LessEqualF) return comparison_of(in[0], in[1]);
    if (kernel == Kernel::Not) {
        Varying made = in[0];
        made.id = 0; // another number
        return made;
    }
    if (kernel == Kernel::SelectF) return selected(in[0], in[1], in[2]);
    if (kernel == Kernel::And || kernel == Kernel::Or) {
        Varying made;
        made.known = in[0].known && in[1].known;
        made.range = {0, 1};
        made.error = std::max(in[0].error, in[1].error);
        return made;
    }
    for (const auto other : {blend_of_several, one_of_several})
        if (const Varying made = other(kernel, in); made.known) return made;
    return stepped(kernel, in);
}

} // namespace fathom::mesh
