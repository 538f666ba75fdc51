#include "proof/crossings.h"

#include "ir/passes/fold.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {

double Pair::length() const { return std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]); }

// Of a number on its border, as an even one is of `x % 2`, a step has one value where that number
// is exact: not the hull of both sides.
void Machine::read_step(const Instruction &in) {
    const ir::Graph &graph = ranges_.scene->graph;
    std::vector<ir::Constant> args;
    for (std::size_t a = 0; a < in.args.size(); ++a) {
        args.push_back({graph[graph.arg(in.node, int(a))].type, {}});
        for (std::uint32_t c = 0; c < tape_.size[in.args[a]]; ++c) {
            const Interval x = value_[tape_.first[in.args[a]] + c];
            if (!x.is_point()) return;
            args.back().value[c] = x.lo;
        }
    }
    if (const auto made = ir::evaluate(in.op, in.type, args, in.payload))
        for (std::uint32_t c = 0; c < tape_.size[in.out]; ++c)
            value_[tape_.first[in.out] + c] = made->value[c];
}

// Takes down what a step has decided: between its borders that is the same for all points.
void Machine::decide(const Instruction &in) {
    constexpr ir::OpSet on_borders{Op::Fract, Op::Mod, Op::Sign, Op::Step};
    constexpr ir::OpSet by_value{Op::Floor, Op::Ceil,      Op::Round, Op::Trunc,
                                 Op::Sign,  Op::Step,      Op::ToInt, Op::Less,
                                 Op::Equal, Op::LessEqual, Op::Hash,  Op::NotEqual};
    if (in.form != Form::Plain || !in.varies) return;
    if (on_borders[in.op] && !in.scatters) read_step(in);
    const std::uint32_t size = tape_.size[in.out];
    const auto arg = [&](std::size_t i, std::uint32_t c) {
        const Slot s = in.args[i];
        return value_[tape_.first[s] + std::min<std::uint32_t>(c, tape_.size[s] - 1u)].middle();
    };
    for (std::uint32_t c = 0; c < size; ++c) {
        double told = 0;
        if (by_value[in.op])
            told = value_[tape_.first[in.out] + c].middle();
        else if (in.op == Op::Fract)
            told = std::floor(arg(0, c));
        else if (in.op == Op::Mod)
            told = std::floor(arg(0, c) / arg(1, c));
        else if (in.op == Op::Atan2)
            told = arg(1, c) >= 0 ? 0 : arg(0, c) < 0 ? -1 : 1;
        else
            return;
        decided_ = (decided_ ^ std::bit_cast<std::uint64_t>(told + 0.0)) * 0x9e3779b97f4a7c15u;
        decided_ ^= decided_ >> 29;
    }
}

namespace {

std::uint64_t decided_at(Machine &machine, const std::array<double, 3> &p) {
    machine.run(at_point(p));
    return machine.decided();
}

} // namespace

std::optional<Pair> turning(Machine &machine, Pair way, double near) {
    const std::uint64_t first = decided_at(machine, way.a);
    if (decided_at(machine, way.b) == first) return {};
    constexpr int most = 60;
    for (int k = 0; k < most && way.length() > near; ++k) {
        std::array<double, 3> middle{};
        for (std::size_t i = 0; i < 3; ++i) middle[i] = (way.a[i] + way.b[i]) / 2;
        (decided_at(machine, middle) == first ? way.a : way.b) = middle;
    }
    return way;
}

bool SomeWays::inside(const std::array<double, 3> &p) const {
    for (std::size_t i = 0; i < 3; ++i)
        if (p[i] < box.p[i].lo || p[i] > box.p[i].hi) return false;
    return !zone || !misses(*zone, at_point(p));
}

std::array<double, 3> SomeWays::point() {
    constexpr int most_tries = 64;
    constexpr double far = 4;
    std::array<double, 3> p{};
    for (int tries = 0; tries < most_tries; ++tries) {
        for (std::size_t i = 0; i < 3; ++i) {
            double lo = std::max(box.p[i].lo, -far), hi = std::min(box.p[i].hi, far);
            if (lo > hi) lo = hi = std::isfinite(box.p[i].lo) ? box.p[i].lo : box.p[i].hi;
            p[i] = lo + (hi - lo) * dice.next();
        }
        if (inside(p)) break;
    }
    return p;
}

std::optional<Pair> SomeWays::next() {
    const std::array<double, 3> a = point();
    std::array<double, 3> b = point();
    const double part = std::pow(10.0, -2 * dice.next());
    for (std::size_t i = 0; i < 3; ++i) b[i] = a[i] + (b[i] - a[i]) * part;
    if (!inside(a) || !inside(b)) return {};
    return Pair{a, b};
}

std::optional<Pair> SomeWays::next_near(const std::array<double, 3> &place, double reach) {
    const double far = reach * std::pow(10.0, -3 * dice.next());
    Pair out{place, place};
    for (std::size_t i = 0; i < 3; ++i) {
        const double fixed = std::clamp(place[i], box.p[i].lo, box.p[i].hi);
        if (!reads[i]) continue;
        out.a[i] = std::clamp(fixed + far * (2 * dice.next() - 1), box.p[i].lo, box.p[i].hi);
        out.b[i] = std::clamp(fixed + far * (2 * dice.next() - 1), box.p[i].lo, box.p[i].hi);
    }
    if (!inside(out.a) || !inside(out.b)) return {};
    return out;
}

double near_in(const Cell &box, const std::array<double, 3> &place) {
    double wide = 0, size = 1;
    for (std::size_t i = 0; i < 3; ++i) {
        wide = std::max(wide, std::min(box.p[i].hi - box.p[i].lo, 1.0));
        size = std::max(size, std::fabs(place[i]));
    }
    return std::max(1e-5 * wide, 1e-9 * size);
}

Told reads_of(const Tape &tape) {
    Told out;
    for (const auto *block : {&tape.once, &tape.each})
        for (const Instruction &in : *block) {
            out.params = out.params || in.op == Op::Param;
            out.time = out.time || in.op == Op::Time;
        }
    return out;
}

Ranges held_at(const Tape &tape, Ranges ranges, Held held) {
    std::unordered_set<std::uint32_t> whole; // params
    for (const auto *block : {&tape.once, &tape.each})
        for (const Instruction &in : *block)
            if (in.op == Op::Param && (in.type == ir::Type::Int || in.type == ir::Type::Bool))
                whole.insert(in.payload);
    const auto one_of = [&](const Interval &range) {
        return held == Held::Middle ? range.middle() : held == Held::First ? range.lo : range.hi;
    };
    for (std::uint32_t i = 0; i < ranges.params.size(); ++i)
        for (Interval &range : ranges.params[i])
            if (range.finite())
                range = whole.contains(i) ? std::floor(one_of(range)) : one_of(range);
    for (auto &[payload, numbers] : ranges.vars)
        for (Interval &range : numbers)
            if (range.finite()) range = std::floor(one_of(range));
    ranges.time = held == Held::Last && ranges.time.finite() ? ranges.time.hi : ranges.time.lo;
    return ranges;
}

} // namespace fathom::proof
