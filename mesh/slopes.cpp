#include "mesh/slopes.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

constexpr double unit_roundoff = 0x1.01p-24; // of sums, products and quotients,
constexpr double of_roots = 0x1p-22;         // … and of what is not rounded right
constexpr double inward = 1 - 1e-6;          // what sums of doubles may take
constexpr std::size_t most_levels = 9;       // that are chosen
constexpr double along_gradient = 0.9; // the cosine from where a number may vary as the field does

struct Interval {
    double lo = 0, hi = 0;
};
Interval operator+(Interval a, Interval b) { return {a.lo + b.lo, a.hi + b.hi}; }
Interval operator*(Interval a, Interval b) {
    const double p = a.lo * b.lo, q = a.lo * b.hi, r = a.hi * b.lo, s = a.hi * b.hi;
    return {std::min({p, q, r, s}), std::max({p, q, r, s})};
}
Interval hull(Interval a, Interval b) { return {std::min(a.lo, b.lo), std::max(a.hi, b.hi)}; }
double size(Interval a) { return std::max(std::fabs(a.lo), std::fabs(a.hi)); }

// A number over a box: its range, what its slopes along the axes lie within wherever it has any (it
// is continuous), and how far its floats are from the real number at most.
struct Varying {
    bool known = false;
    Interval range;
    std::array<Interval, 3> slope{};
    double error = 0;
    std::uint32_t id = 0; // the same of copies of one number; 0: it has none yet
    // It is the part above 0, or below, of the number with that id, whose slopes and error are these:
    // both parts together are that number.
    struct Half {
        std::uint32_t of = 0; // 0: it is none
        bool above = false;
        std::array<Interval, 3> slope{};
        double error = 0;
    } half{};
};

// f(a, b, …) of which the partial derivatives lie within `by`; its own rounding is part of the sizes
// of `terms`, what is added up.
Varying chained(std::initializer_list<std::pair<const Varying *, Interval>> parts, double terms) {
    Varying made;
    made.known = true;
    made.error = unit_roundoff * terms;
    for (const auto &[part, by] : parts) {
        made.known = made.known && part->known;
        made.error += size(by) * part->error;
        for (std::size_t i = 0; i < 3; ++i) made.slope[i] = made.slope[i] + by * part->slope[i];
    }
    return made;
}

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
        for (std::size_t i = 0; i < 3; ++i) made.slope[i] = made.slope[i] + part.slope[i];
    }
    return made;
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
        if (shortest > 0) {
            share.lo = std::max(-1.0, r.lo / (r.lo < 0 ? shortest : longest));
            share.hi = std::min(1.0, r.hi / (r.hi > 0 ? shortest : longest));
        }
        made.known = made.known && x[k].known;
        made.error += x[k].error;
        for (std::size_t i = 0; i < 3; ++i) made.slope[i] = made.slope[i] + share * x[k].slope[i];
    }
    // Of one number alone that is never below 0 it is that number.
    const auto is_nothing = [](const Varying &one) { return size(one.range) == 0; };
    for (std::size_t k = 0; k < count; ++k)
        if (x[k].half.above && std::count_if(x, x + count, is_nothing) == long(count) - 1 &&
            !is_nothing(x[k])) {
            made.half = x[k].half;
            made.half.error += static_cast<double>(count) * of_roots * longest;
        }
    return made;
}

constexpr Interval one{1, 1}, minus_one{-1, -1};

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
    for (std::size_t i = 0; i < 3; ++i) made.slope[i] = hull(a.slope[i], b.slope[i]);
    if (size(b.range) == 0) made.half = {a.id, greater, a.slope, a.error};
    if (size(a.range) == 0) made.half = {b.id, greater, b.slope, b.error};
    return made;
}

// a + b: of both halves of a number that number.
Varying plus(const Varying &a, const Varying &b) {
    const double terms = size(a.range) + size(b.range);
    Varying made = chained({{&a, one}, {&b, one}}, terms);
    if (a.half.of == 0 || a.half.of != b.half.of || a.half.above == b.half.above) return made;
    made.slope = a.half.slope;
    made.error = a.half.error + b.half.error + unit_roundoff * terms;
    return made;
}

Varying negative(const Varying &a) {
    Varying made = chained({{&a, minus_one}}, 0);
    made.range = {-a.range.hi, -a.range.lo};
    return made;
}

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

// What kernels give that choose among numbers; others are not known.
Varying one_of_several(Kernel kernel, const std::vector<Varying> &in) {
    if (kernel == Kernel::MinF) return one_of(in[0], in[1], false);
    if (kernel == Kernel::MaxF) return one_of(in[0], in[1], true);
    if (kernel == Kernel::MaxNeg) return one_of(in[0], negative(in[1]), true);
    if (kernel == Kernel::MaxAbs) return one_of(size_of(in[0]), size_of(in[1]), true);
    if (kernel == Kernel::MinMax) return one_of(in[0], one_of(in[1], in[2], true), false);
    if (kernel == Kernel::MaxMin) return one_of(in[0], one_of(in[1], in[2], false), true);
    if (kernel == Kernel::Slab) return one_of(minus(in[0], in[1]), minus(in[1], in[2]), true);
    return {};
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
    if (kernel == Kernel::DivF) {
        const Interval by = in[1].range;
        if (by.lo != by.hi || by.lo == 0 || !in[1].known) return {};
        return chained({{&in[0], {1 / by.lo, 1 / by.lo}}}, size(in[0].range) / std::fabs(by.lo));
    }
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
    if (kernel == Kernel::Ball) {
        const Varying length = length_of(differences().data(), 3);
        return chained({{&length, one}, {&in[6], minus_one}}, size(in[6].range));
    }
    if (kernel == Kernel::LengthPositive3) {
        Varying nothing, parts[3];
        nothing.known = true;
        for (std::size_t i = 0; i < 3; ++i) parts[i] = one_of(in[i], nothing, true);
        return length_of(parts, 3);
    }
    return one_of_several(kernel, in);
}

// Slopes by slot: the registers of a tape, and what all points share.
struct Slopes {
    const cpu::PruneProgram &parts;
    const cpu::Shortener &ranges;
    std::vector<Varying> by_slot;

    bool shared(std::uint32_t address) const { return address < parts.program->first_register; }
    std::size_t slot(std::uint32_t address) const {
        const std::size_t first = parts.program->first_register;
        return address < first ? address : first + (address - first) / cpu::batch_size;
    }
    Varying at(std::uint32_t address) const {
        Varying found = by_slot[slot(address)];
        if (shared(address)) found = {}, found.known = true;
        // Of its floats and of the real number.
        found.range = {ranges.lo[address] - found.error, ranges.hi[address] + found.error};
        found.known = found.known && std::isfinite(found.range.lo) && std::isfinite(found.range.hi);
        return found;
    }
};

// The axis along which a number changes fastest for sure.
double least_slope(const Varying &number) {
    double best = 0;
    for (const Interval &slope : number.slope)
        best = std::max(best, inward * std::max(slope.lo, -slope.hi));
    return best;
}

// Of a number that an evaluator has over a box and, behind that, at its middle.
Level level_of(Register where, const cpu::Shortener &ranges, const Varying &number, double slope) {
    const std::uint32_t at = where.address;
    Level level{where,
                ranges.lo[at],
                ranges.hi[at],
                slope,
                number.error,
                {},
                {},
                {ranges.lo[at + 1], ranges.hi[at + 1]}};
    for (std::size_t i = 0; i < 3; ++i) {
        level.gradient[i] = 0.5 * (number.slope[i].lo + number.slope[i].hi);
        level.slopes[i] = {number.slope[i].lo, number.slope[i].hi};
    }
    return level;
}

// Whether a number may be what the field depends on somewhere here: it changes in the same direction.
bool may_hold(const Level &level, const std::array<std::vector<float>, 4> &slopes) {
    for (std::size_t k = 0; k < slopes[0].size(); ++k) {
        double product = 0, a = 0, b = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            product += level.gradient[i] * slopes[1 + i][k];
            a += level.gradient[i] * level.gradient[i];
            b += double(slopes[1 + i][k]) * slopes[1 + i][k];
        }
        if (std::fabs(product) > along_gradient * std::sqrt(a * b)) return true;
    }
    return false;
}

} // namespace

double cosine(const Level &x, const Level &y) {
    double product = 0, a = 0, b = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        product += x.gradient[i] * y.gradient[i];
        a += x.gradient[i] * x.gradient[i];
        b += y.gradient[i] * y.gradient[i];
    }
    return std::fabs(product) / std::sqrt(a * b);
}

std::vector<Level> chosen_levels(const std::vector<Level> &levels,
                                 const std::array<std::vector<float>, 4> &slopes) {
    constexpr double parallel = 0.9999;
    std::vector<Level> first, more, unseen;
    for (const bool seen : {true, false})
        for (const Level &level : levels) {
            if (may_hold(level, slopes) != seen || !(level.lo < level.hi)) continue;
            const auto is_new = [&](const std::vector<Level> &all) {
                return std::ranges::none_of(
                    all, [&](const Level &one) { return cosine(one, level) > parallel; });
            };
            if (seen)
                (is_new(first) ? first : more).push_back(level);
            else if (is_new(first) && is_new(unseen))
                unseen.push_back(level);
        }
    std::stable_partition(unseen.begin(), unseen.end(), has_cut);
    first.insert(first.end(), unseen.begin(), unseen.end());
    first.insert(first.end(), more.begin(), more.end());
    if (first.size() > most_levels) first.resize(most_levels);
    std::ranges::sort(first, {}, [](const Level &level) { return level.where.step; });
    return first;
}

Tie tie_of(const Level &level, const Level &other, const Point &lo, const Point &hi) {
    constexpr double of_doubles = 1e-9;    // what their rounding may take, of what is added up
    constexpr double underflow = 0x1p-140; // of floats, many times over
    double product = 0, squares = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        product += level.gradient[i] * other.gradient[i];
        squares += level.gradient[i] * level.gradient[i];
    }
    Tie tie;
    tie.share = product / squares;
    const Interval share{tie.share, tie.share}, less{-tie.share, -tie.share};
    // The difference at the middle, and how far from there it may come to be.
    const Interval middle = Interval{other.middle[0], other.middle[1]} +
                            less * Interval{level.middle[0], level.middle[1]};
    const Point at = middle_point(lo, hi);
    double spread = 2 * (other.error + size(share) * level.error) + underflow;
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval mine{level.slopes[i][0], level.slopes[i][1]},
            its{other.slopes[i][0], other.slopes[i][1]};
        const double reach = std::max(double(hi[i]) - at[i], double(at[i]) - lo[i]);
        spread += (size(its + less * mine) + of_doubles * (size(its) + size(share * mine))) * reach;
    }
    spread += of_doubles * (size(middle) + size(share) * (size({level.lo, level.hi})));
    tie.lo = middle.lo - spread;
    tie.hi = middle.hi + spread;
    return tie;
}

namespace {

// Runs a tape over a box, and at its middle, step by step: what each number is that it writes.
Slopes slopes_over(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                   const Point &lo, const Point &hi,
                   const std::function<void(Register, const Varying &)> &see) {
    const Field &field = evaluator.field;
    boxes.count = 16; // of which the first is looked at, and the second: its middle
    const Point middle = middle_point(lo, hi);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < boxes.count; ++k) {
            boxes.lo[i][k] = k == 1 ? middle[i] : lo[i];
            boxes.hi[i][k] = k == 1 ? middle[i] : hi[i];
        }
    cpu::enter_boxes(field.parts, evaluator.ranges, boxes);
    Slopes slopes{field.parts, evaluator.ranges, std::vector<Varying>(field.parts.slot_count)};
    std::uint32_t ids = 0; // that are given
    for (std::size_t axis = 0; axis < 3; ++axis) {
        Varying &input = slopes.by_slot[slopes.slot(field.program.params[axis].address)];
        input.known = true;
        input.slope[axis] = one;
        input.id = ++ids;
    }
    std::vector<Varying> in;
    const cpu::Selection whole = tape.selection(field.parts);
    std::size_t loops = 0; // before the step at hand: they have rows of their own
    for (std::size_t k = 0; k < tape.steps.size(); ++k) {
        const std::uint32_t id = tape.steps[k];
        const cpu::Step &step = field.parts.table[id];
        const cpu::Part &part = field.parts.parts[id];
        const std::uint32_t *operands = field.parts.operands.data() + step.operands;
        std::array<Varying, 2> made;
        const bool waves = step.kind == cpu::StepKind::Run &&
                           cpu::kernel_of_variant(step.target) == Kernel::SinCos;
        const bool plain =
            step.kind == cpu::StepKind::Run && !step.once && part.writes == (waves ? 2u : 1u);
        if (plain) {
            in.clear();
            for (std::uint32_t n = part.writes; n < part.operands; ++n)
                in.push_back(slopes.at(operands[n]));
            if (waves)
                made = {wave_of(in[0], false), wave_of(in[0], true)};
            else
                made[0] = through(cpu::kernel_of_variant(step.target), in);
        }
        cpu::Selection here = whole;
        here.steps = whole.steps.subspan(k, 1);
        here.loops = whole.loops.subspan(loops);
        loops += step.kind == cpu::StepKind::Loop;
        cpu::run_steps(field.parts, evaluator.ranges, here);
        for (std::uint32_t n = 0; n < part.writes; ++n)
            slopes.by_slot[field.parts.slots[part.first_slot + n]] = {};
        // One number all over the box, as the copy of a repetition: it does not change.
        const bool runs = step.kind == cpu::StepKind::Run && !step.once;
        for (std::uint32_t n = 0; runs && n < std::min(part.writes, part.operands); ++n)
            if (const std::uint32_t to = operands[n]; !slopes.shared(to))
                slopes.by_slot[slopes.slot(to)].known =
                    evaluator.ranges.lo[to] == evaluator.ranges.hi[to];
        for (std::uint32_t n = 0; plain && n < part.writes; ++n) {
            const std::uint32_t to = operands[n];
            if (!made[n].known || slopes.shared(to)) continue;
            if (made[n].id == 0) made[n].id = ++ids;
            slopes.by_slot[slopes.slot(to)] = made[n];
            see({k, to}, made[n]);
        }
    }
    return slopes;
}

constexpr std::size_t longest_tape = 500; // steps

} // namespace

std::vector<Level> levels_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                             const Point &lo, const Point &hi) {
    std::vector<Level> levels;
    if (tape.steps.size() > longest_tape) return levels;
    slopes_over(evaluator, tape, boxes, lo, hi, [&](Register where, const Varying &number) {
        if (const double slope = least_slope(number); slope > 0)
            levels.push_back(level_of(where, evaluator.ranges, number, slope));
    });
    return levels;
}

std::optional<Linear> linear_over(Evaluator &evaluator, const cpu::ShortTape &tape,
                                  cpu::Boxes &boxes, const Point &lo, const Point &hi) {
    const cpu::Program::Slot &result = evaluator.field.program.results[0];
    if (evaluator.field.cut || result.shared || tape.steps.size() > longest_tape)
        return std::nullopt;
    const Slopes slopes =
        slopes_over(evaluator, tape, boxes, lo, hi, [](Register, const Varying &) {});
    const Varying field = slopes.at(result.address);
    if (!field.known) return std::nullopt;
    const double least = evaluator.ranges.lo[result.address + 1],
                 most = evaluator.ranges.hi[result.address + 1]; // at the middle
    const Point middle = middle_point(lo, hi);
    Linear linear{0.5 * (least + most), 0.5 * (most - least) + 2 * field.error, {}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval slope = field.slope[i];
        const double reach = std::max(double(hi[i]) - middle[i], double(middle[i]) - lo[i]);
        linear.slope[i] = 0.5 * (slope.lo + slope.hi);
        linear.off += 0.5 * (slope.hi - slope.lo) * reach;
    }
    linear.off *= 1 + 1e-9;
    return std::isfinite(linear.value + linear.off) ? std::optional(linear) : std::nullopt;
}

} // namespace fathom::mesh
