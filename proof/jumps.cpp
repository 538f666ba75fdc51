#include "proof/jumps.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace fathom::proof {
namespace {

// Two points and the field's values there.
struct Sides {
    std::array<double, 3> a{}, b{};
    double value_a = 0, value_b = 0;
    double gap() const { return std::fabs(value_a - value_b); }
};

std::optional<double> value_at(Machine &machine, const std::array<double, 3> &p) {
    machine.run(at_point(p));
    const Interval value = machine.value(0);
    const bool known = value.finite() && value.width() <= 1e-6 * std::max(1.0, value.magnitude());
    return known ? std::optional(value.middle()) : std::nullopt;
}

std::optional<Sides> sides_at(Machine &machine, const std::array<double, 3> &a,
                              const std::array<double, 3> &b) {
    const auto x = value_at(machine, a), y = value_at(machine, b);
    if (!x || !y) return {};
    return Sides{a, b, *x, *y};
}

// The half of the way between two points that has the greater part of their gap.
bool halve(Machine &machine, Sides &sides) {
    std::array<double, 3> middle{};
    for (std::size_t i = 0; i < 3; ++i) middle[i] = (sides.a[i] + sides.b[i]) / 2;
    const auto value = value_at(machine, middle);
    if (!value) return false;
    if (std::fabs(*value - sides.value_a) > std::fabs(*value - sides.value_b))
        sides.b = middle, sides.value_b = *value;
    else
        sides.a = middle, sides.value_a = *value;
    return true;
}

// A jump keeps its gap as the way over it is halved; that of a slope, however steep, goes with it.
bool jumps(Machine &machine, Sides &sides) {
    constexpr int halvings = 10;
    const double before = sides.gap();
    for (int k = 0; k < halvings; ++k)
        if (!halve(machine, sides)) return false;
    return sides.gap() > before / 4 &&
           sides.gap() > 1e-4 * std::max({1.0, std::fabs(sides.value_a), std::fabs(sides.value_b)});
}

// By the pairs between which decisions turn: those near the place that is named, then those of all
// of the box. A jump that is small beside what the field does on the way to it is met by these.
bool find_by_turns(Machine &machine, FieldBound &out, double scale, SomeWays ways) {
    constexpr int pairs_near = 200, pairs_in_all = 300;
    const std::array<double, 3> place = out.where;
    double reach = 1;
    for (std::size_t i = 0; i < 3; ++i)
        if (ways.reads[i]) reach = std::min(reach, ways.box.p[i].width() / 2);
    for (int k = 0; k < pairs_near + pairs_in_all; ++k) {
        const auto way = k < pairs_near ? ways.next_near(place, reach) : ways.next();
        if (!way) continue;
        const auto pair = turning(machine, *way, 2 * scale);
        if (!pair || !ways.inside(pair->a) || !ways.inside(pair->b)) continue;
        const auto sides = sides_at(machine, pair->a, pair->b);
        Sides nearer = sides.value_or(Sides{});
        if (!sides || !jumps(machine, nearer)) continue;
        out.side_a = sides->a, out.side_b = sides->b;
        out.value_a = sides->value_a, out.value_b = sides->value_b;
        out.known_sides = out.seen_jump = true;
        for (std::size_t i = 0; i < 3; ++i) out.where[i] = (sides->a[i] + sides->b[i]) / 2;
        return true;
    }
    return false;
}

void look_for_sides(const Tape &tape, Ranges ranges, FieldBound &out, double scale,
                    const std::array<bool, 3> &reads, const Cell &box, const Zone *zone) {
    const Told holds = reads_of(tape);
    out.held_params = holds.params;
    out.held_time = holds.time;
    ranges = held_at(tape, std::move(ranges), Held::Middle);
    Machine machine(tape, ranges);
    machine.read_values();
    const auto take = [&](const Sides &sides) {
        out.side_a = sides.a, out.side_b = sides.b;
        out.value_a = sides.value_a, out.value_b = sides.value_b;
        out.known_sides = true;
    };
    std::optional<Sides> widest;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!reads[i]) continue;
        std::array<double, 3> a = out.where, b = out.where;
        a[i] -= scale, b[i] += scale;
        const auto sides = sides_at(machine, a, b);
        if (sides && (!widest || sides->gap() > widest->gap())) widest = sides;
    }
    if (widest) {
        Sides nearer = *widest;
        out.seen_jump = jumps(machine, nearer);
        take(out.seen_jump ? *widest : nearer); // what does not jump is told where it nearly meets
    }
    if (out.seen_jump) return;
    SomeWays ways{box, zone, reads};
    if (out.trouble == Trouble::Jump && find_by_turns(machine, out, scale, ways)) return;
    // Places spread evenly by the multiples of the plastic number's kin in three dimensions (Roberts 2018).
    constexpr std::array<double, 3> spread{0.8191725133961645, 0.6710436067037893,
                                           0.5497004779019703};
    constexpr int places = 400;
    for (int k = 1; k <= places; ++k) {
        std::array<double, 3> a{};
        for (std::size_t i = 0; i < 3; ++i) {
            if (!box.p[i].finite()) return;
            const double way = k * spread[i];
            a[i] = box.p[i].lo + (way - std::floor(way)) * box.p[i].width();
        }
        const std::size_t axis = static_cast<std::size_t>(k % 3);
        if (!reads[axis]) continue;
        std::array<double, 3> b = a;
        b[axis] += box.p[axis].width() / 8;
        if (b[axis] > box.p[axis].hi) continue;
        if (zone && (misses(*zone, at_point(a)) || misses(*zone, at_point(b)))) continue;
        auto sides = sides_at(machine, a, b);
        bool known = sides.has_value();
        while (known && sides->b[axis] - sides->a[axis] > 2 * scale) known = halve(machine, *sides);
        Sides nearer = sides.value_or(Sides{});
        if (!known || !jumps(machine, nearer)) continue;
        take(*sides);
        out.seen_jump = true;
        for (std::size_t i = 0; i < 3; ++i) out.where[i] = (sides->a[i] + sides->b[i]) / 2;
        return;
    }
}

} // namespace

void find_sides(const Tape &tape, Ranges ranges, FieldBound &out, double scale,
                const std::array<bool, 3> &reads, const Cell &box, const Zone *zone) {
    constexpr std::size_t most_work = 12'000'000; // of a dear field fewer places are looked at
    Work &all = *ranges.work, own = all;
    own.left = std::min(own.left, most_work);
    const std::size_t before = own.left;
    ranges.work = &own;
    look_for_sides(tape, std::move(ranges), out, scale, reads, box, zone);
    all.take(before - own.left);
}

} // namespace fathom::proof
