#include "mesh/alternatives.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

constexpr std::size_t most_alternatives = 24;
constexpr double of_doubles = 1e-12; // what their rounding may take

constexpr Interval minus_one{-1, -1};

bool same(const Decision &x, const Decision &y) { return x.a == y.a && x.b == y.b; }

// The decisions of both; none where they contradict each other. Those that there is no room for are
// left out: then the alternative is one at more places than it says.
bool join_decisions(const Alternative &a, const Alternative &b, Alternative &made) {
    made.where = a.where;
    made.count = a.count;
    for (std::size_t k = 0; k < b.count; ++k) {
        bool there = false;
        for (std::size_t j = 0; j < a.count; ++j) {
            if (!same(a.where[j], b.where[k])) continue;
            if (a.where[j].holds != b.where[k].holds) return false;
            there = true;
        }
        if (!there && made.count < made.where.size()) made.where[made.count++] = b.where[k];
    }
    return true;
}

bool nearly(Interval x, Interval y) {
    const double slack = of_doubles * (size(x) + size(y));
    return std::fabs(x.lo - y.lo) <= slack && std::fabs(x.hi - y.hi) <= slack;
}

// Takes one in. Where it is as another that one is both of them, by the decisions that they share.
void add(const Alternative &alternative, Alternatives &to) {
    for (Alternative &other : to.all) {
        bool alike = nearly(other.middle, alternative.middle);
        for (std::size_t i = 0; i < directions; ++i)
            alike = alike && nearly(other.slope[i], alternative.slope[i]);
        if (!alike) continue;
        other.middle = hull(other.middle, alternative.middle);
        for (std::size_t i = 0; i < directions; ++i)
            other.slope[i] = hull(other.slope[i], alternative.slope[i]);
        std::size_t kept = 0;
        for (std::size_t k = 0; k < other.count; ++k)
            for (std::size_t j = 0; j < alternative.count; ++j)
                if (same(other.where[k], alternative.where[j]) &&
                    other.where[k].holds == alternative.where[j].holds) {
                    other.where[kept++] = other.where[k];
                    break;
                }
        other.count = kept;
        return;
    }
    to.all.push_back(alternative);
}

void close(Alternatives &made) {
    made.known = made.known && !made.all.empty() && made.all.size() <= most_alternatives;
    if (!made.known) made.all.clear();
}

// One of each, in all ways that may be at one place.
template <class Make>
Alternatives each_of(const Alternatives &a, const Alternatives &b, Make make) {
    Alternatives made{a.known && b.known, {}};
    for (const Alternative &x : a.all)
        for (const Alternative &y : b.all) {
            Alternative of;
            if (!join_decisions(x, y, of)) continue;
            make(x, y, of);
            add(of, made);
        }
    close(made);
    return made;
}

Alternatives sum(const Alternatives &a, const Alternatives &b) {
    return each_of(a, b, [](const Alternative &x, const Alternative &y, Alternative &of) {
        of.middle = x.middle + y.middle;
        for (std::size_t i = 0; i < directions; ++i) of.slope[i] = x.slope[i] + y.slope[i];
    });
}

Alternatives times(const Alternatives &a, Interval by) {
    Alternatives made = a;
    for (Alternative &x : made.all) {
        x.middle = x.middle * by;
        for (Interval &slope : x.slope) slope = slope * by;
    }
    return made;
}

Alternatives difference(const Alternatives &a, const Alternatives &b) {
    return sum(a, times(b, minus_one));
}

Interval range_of(const Alternative &x, const std::array<double, 3> &reach) {
    double far = 0;
    for (std::size_t i = 0; i < 3; ++i) far += size(x.slope[i]) * reach[i];
    far *= 1 + of_doubles;
    return {x.middle.lo - far, x.middle.hi + far};
}

Alternatives product(const Alternatives &a, const Alternatives &b,
                     const std::array<double, 3> &reach) {
    return each_of(a, b, [&](const Alternative &x, const Alternative &y, Alternative &of) {
        const Interval in_x = range_of(x, reach), in_y = range_of(y, reach);
        of.middle = x.middle * y.middle;
        for (std::size_t i = 0; i < directions; ++i)
            of.slope[i] = in_y * x.slope[i] + in_x * y.slope[i];
    });
}

// a, or b, as it is decided; where nothing is known of the decision either may be anywhere.
Alternatives chosen(const Alternatives &a, const Alternatives &b,
                    const std::optional<Decision> &decision) {
    Alternatives made{a.known && b.known, {}};
    for (const bool first : {true, false})
        for (const Alternative &x : first ? a.all : b.all) {
            Alternative of = x;
            if (decision) {
                Alternative by;
                by.where[0] = *decision;
                by.where[0].holds = decision->holds == first;
                by.count = 1;
                if (!join_decisions(by, x, of)) continue;
            }
            add(of, made);
        }
    close(made);
    return made;
}

// Which number it is, for decisions: none if it has no name.
std::optional<std::uint32_t> name_of(const Varying &number) {
    if (number.id != 0) return number.id;
    return size(number.range) == 0 ? std::optional<std::uint32_t>(0) : std::nullopt;
}

// That a is at least as great as b.
std::optional<Decision> at_least(const Varying &a, const Varying &b) {
    const auto x = name_of(a), y = name_of(b);
    if (!x || !y || *x == *y) return std::nullopt;
    // A number that equals another is at least as great as it by the order of their ids.
    return *x > *y ? Decision{*x, *y, true} : Decision{*y, *x, false};
}

// The greater of two, or the lesser.
Alternatives one_of(const Chosen &a, const Chosen &b, bool greater) {
    const Interval x = a.number->range, y = b.number->range;
    if (greater ? x.lo >= y.hi : x.hi <= y.lo) return a.alternatives;
    if (greater ? y.lo >= x.hi : y.hi <= x.lo) return b.alternatives;
    std::optional<Decision> decision = at_least(*a.number, *b.number);
    if (decision && !greater) decision->holds = !decision->holds;
    return chosen(a.alternatives, b.alternatives, decision);
}

// The greater of a and the lesser of b and c, or the other way round.
Alternatives one_of_three(std::span<const Chosen> in, bool greater) {
    const Kernel inner = greater ? Kernel::MinF : Kernel::MaxF;
    const Varying number = through(inner, {*in[1].number, *in[2].number});
    return one_of(in[0], {&number, one_of(in[1], in[2], !greater)}, greater);
}

Alternatives size_of(const Chosen &a) {
    const Interval range = a.number->range;
    if (range.lo >= 0) return a.alternatives;
    const Alternatives negative = times(a.alternatives, minus_one);
    if (range.hi <= 0) return negative;
    Varying nothing;
    return chosen(a.alternatives, negative, at_least(*a.number, nothing));
}

Alternatives greater_size(const Chosen &a, const Chosen &b) {
    const Varying x = through(Kernel::AbsF, {*a.number}), y = through(Kernel::AbsF, {*b.number});
    return one_of({&x, size_of(a)}, {&y, size_of(b)}, true);
}

// |a - b|
Alternatives size_of_difference(const Chosen &a, const Chosen &b) {
    const Alternatives whole = difference(a.alternatives, b.alternatives);
    return chosen(whole, times(whole, minus_one), at_least(*a.number, *b.number));
}

Alternatives sum_of_products(std::span<const Chosen> in, const std::array<double, 3> &reach) {
    const std::size_t half = in.size() / 2;
    Alternatives made = product(in[0].alternatives, in[half].alternatives, reach);
    for (std::size_t k = 1; k < half; ++k)
        made = sum(made, product(in[k].alternatives, in[half + k].alternatives, reach));
    return made;
}

// By a number that has one value all over the box.
Alternatives quotient(const Alternatives &a, const Chosen &b) {
    const Interval by = b.number->range;
    if (!(by.lo == by.hi) || by.lo == 0) return {};
    return times(a, {1 / by.lo, 1 / by.lo});
}

// A ball by its place, its middle and its radius: what it is at the middle of the box.
Alternatives ball(std::span<const Chosen> in, const Varying &number) {
    double least = 0, most = 0; // squares
    for (const Chosen &one : in)
        if (one.alternatives.all.size() != 1) return {};
    const auto middle = [&](std::size_t k) { return in[k].alternatives.all[0].middle; };
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval way = middle(i) + middle(3 + i) * minus_one;
        const double near = std::max({way.lo, -way.hi, 0.0}), far = size(way);
        least += near * near, most += far * far;
    }
    const double low = std::sqrt(least), high = std::sqrt(most);
    return single(
        number, {low - of_doubles * high - middle(6).hi, high + of_doubles * high - middle(6).lo});
}

Alternatives with_ball(std::span<const Chosen> in) {
    std::vector<Varying> of;
    for (const Chosen &one : in.subspan(1)) of.push_back(*one.number);
    const Varying number = through(Kernel::Ball, of);
    return one_of(in[0], {&number, ball(in.subspan(1), number)}, false);
}

} // namespace

Alternatives single(const Varying &number, Interval middle) {
    Alternatives made;
    made.known = number.known && !number.jumps && std::isfinite(middle.lo + middle.hi);
    if (!made.known) return made;
    Alternative alternative;
    alternative.middle = {middle.lo - number.error, middle.hi + number.error};
    alternative.slope = number.slope;
    made.all.push_back(alternative);
    return made;
}

bool chooses(Kernel kernel) {
    constexpr Kernel all[] = {Kernel::MinF,   Kernel::MaxF,    Kernel::AbsF,   Kernel::AbsSub,
                              Kernel::SubAbs, Kernel::SelectF, Kernel::MaxAbs, Kernel::MinMax,
                              Kernel::MaxMin, Kernel::MinBall};
    return std::ranges::find(all, kernel) != std::end(all);
}

std::array<Alternatives, 3> differences_of(std::span<const Chosen> in) {
    std::array<Alternatives, 3> made;
    for (std::size_t i = 0; i < made.size(); ++i)
        made[i] = difference(in[i].alternatives, in[3 + i].alternatives);
    return made;
}

Alternatives alternatives_of(Kernel kernel, std::span<const Chosen> in,
                             const std::array<double, 3> &reach) {
    if (kernel == Kernel::CopyF) return in[0].alternatives;
    if (kernel == Kernel::NegF) return times(in[0].alternatives, minus_one);
    if (kernel == Kernel::AddF) return sum(in[0].alternatives, in[1].alternatives);
    if (kernel == Kernel::SubF) return difference(in[0].alternatives, in[1].alternatives);
    if (kernel == Kernel::MulF) return product(in[0].alternatives, in[1].alternatives, reach);
    if (kernel == Kernel::DivF) return quotient(in[0].alternatives, in[1]);
    if (kernel == Kernel::MulAdd)
        return sum(product(in[0].alternatives, in[1].alternatives, reach), in[2].alternatives);
    if (kernel == Kernel::Dot2 || kernel == Kernel::Dot3 || kernel == Kernel::Dot4)
        return sum_of_products(in, reach);
    if (kernel == Kernel::MinF) return one_of(in[0], in[1], false);
    if (kernel == Kernel::MaxF) return one_of(in[0], in[1], true);
    if (kernel == Kernel::AbsF) return size_of(in[0]);
    if (kernel == Kernel::AbsSub) return difference(size_of(in[0]), in[1].alternatives);
    if (kernel == Kernel::SubAbs) return size_of_difference(in[0], in[1]);
    if (kernel == Kernel::MaxAbs) return greater_size(in[0], in[1]);
    if (kernel == Kernel::MinMax) return one_of_three(in, false);
    if (kernel == Kernel::MaxMin) return one_of_three(in, true);
    if (kernel == Kernel::MinBall) return with_ball(in);
    if (kernel != Kernel::SelectF) return {};
    const Varying &choice = *in[0].number;
    if (choice.range.lo > 0) return in[1].alternatives;
    if (choice.range.hi <= 0) return in[2].alternatives;
    std::optional<Decision> decision;
    if (choice.id != 0) decision = Decision{choice.id, Decision::of_choice, true};
    return chosen(in[1].alternatives, in[2].alternatives, decision);
}

} // namespace fathom::mesh
