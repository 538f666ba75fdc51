// Branch and bound: the cell with the greatest bound is cut in two until the bound is near the
// largest slope seen.
#include "proof/field.h"

#include "proof/composed.h"
#include "proof/homogeneous.h"
#include "proof/jumps.h"
#include "proof/question.h"
#include "proof/reduced.h"
#include "proof/zones.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <optional>
#include <queue>

namespace fathom::proof {

using ir::rounding::infinity;

double Dice::next() { // splitmix64
    state += 0x9e3779b97f4a7c15u;
    std::uint64_t z = state;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return double((z ^ (z >> 31)) >> 11) * 0x1p-53;
}

namespace {

struct Candidate { // small: heaps move them about
    double bound;
    std::int16_t depth, ways_at; // ways_at: the depth from which on it is asked by ways
    std::uint32_t at;            // of the cell and its values
};
struct Worse { // finite bounds: the greatest first; infinite ones: the deepest, so that trouble is
               // found soon
    bool operator()(const Candidate &a, const Candidate &b) const {
        if (a.bound != b.bound) return a.bound < b.bound;
        return a.depth < b.depth;
    }
};

std::array<double, 3> middle(const Cell &cell) {
    return {cell.p[0].middle(), cell.p[1].middle(), cell.p[2].middle()};
}
// How far off its middle is, at least 1.
double distance(const Cell &cell) {
    const std::array<double, 3> p = middle(cell);
    return std::max({std::fabs(p[0]), std::fabs(p[1]), std::fabs(p[2]), 1.0});
}
// Kinks lie in the middle of domains, and there the hull of both sides may be steeper than either.
std::array<double, 3> beside_middle(const Cell &cell) {
    constexpr double beside[3] = {0.0137, 0.0171, 0.0119};
    std::array<double, 3> out = middle(cell);
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval &x = cell.p[i];
        const double far = std::max(1.0, std::fabs(out[i])); // of an endless one: further out
        out[i] += beside[i] * (x.finite() ? x.width() : x.hi < infinity ? -far : far);
    }
    return out;
}

// The axis along which a cell is cut: of those along which it is endless the one that begins nearest
// to 0, so that all of them are far from it some time.
double widest(const Cell &cell, const std::array<bool, 3> &reads, int *axis) {
    double most = -1, begins = infinity;
    for (int i = 0; i < 3; ++i) {
        auto k = static_cast<std::size_t>(i);
        if (!reads[k]) continue;
        const double w = cell.p[k].hi - cell.p[k].lo;
        const bool straddles = cell.p[k].lo < 0 && cell.p[k].hi > 0;
        const double from = straddles ? -1 : cell.p[k].mignitude();
        if (w > most || (w == infinity && from < begins)) most = w, *axis = i, begins = from;
    }
    return most;
}

// Of a cell that may be endless, not far from the origin.
std::array<double, 3> some_point(const Cell &cell, Dice &dice) {
    std::array<double, 3> p{};
    for (std::size_t i = 0; i < 3; ++i) {
        double lo = std::max(cell.p[i].lo, -8.0), hi = std::min(cell.p[i].hi, 8.0);
        if (lo > hi) lo = hi = cell.p[i].middle();
        p[i] = lo + (hi - lo) * dice.next();
    }
    return p;
}

constexpr double loose = 1.3; // a bound over the slope seen, from which on more work is worth it

// Whether more than `limit` instructions are run for a bound that is above the slope seen: twice as
// many, and so on; the last of them if that helped since `at_limit`, the bound at the limit before.
bool goes_on(const Budget &budget, double bound, double seen, std::size_t &limit,
             double &at_limit) {
    constexpr double helped = 0.97;
    const bool helps = limit < budget.most / 2 || bound < helped * at_limit;
    if (limit >= budget.most || bound < loose * seen || !helps) return false;
    limit *= 2;
    at_limit = bound;
    return true;
}

constexpr double ways_gain = 0.98; // what a bound by ways is at most, of the one that it replaces

constexpr int first_ways = 3, more_ways = 3; // depths; halving often does as well, for less

bool any_instruction(const Tape &tape, const auto &may) {
    return std::ranges::any_of(tape.each, may) || std::ranges::any_of(tape.loops, [&](auto &loop) {
               return std::ranges::any_of(loop.body, may);
           });
}

// Is there a choice that may be open in a cell?
bool holds_choices(const Tape &tape) {
    constexpr ir::OpSet choices{Op::Min,    Op::Max,   Op::Clamp, Op::Abs,   Op::Union,
                                Op::Select, Op::Sign,  Op::Step,  Op::Floor, Op::Round,
                                Op::Ceil,   Op::Trunc, Op::Fract, Op::Mod,   Op::Intersection};
    return any_instruction(tape, [&](const Instruction &in) {
        return choices[in.op] || in.form == Form::Wave || in.form == Form::HeldWave;
    });
}

// Else no point turns by an angle that varies (winding.h).
bool holds_waves(const Tape &tape) {
    return any_instruction(
        tape, [](const Instruction &in) { return in.op == Op::Sin || in.op == Op::Cos; });
}

// A hull of both sides of a step holds what neither of them comes near. Of the points beside the
// cell, too: it may lie on one side alone.
void look_at_sides(Machine &machine, const Cell &cell, const Cell &whole, FieldBound &found) {
    if (!found.came_near || found.trouble != Trouble::Singular) return;
    Cell about = cell;
    for (std::size_t i = 0; i < 3; ++i) {
        const double more = 1e-6 * std::max(1.0, cell.p[i].magnitude());
        about.p[i] = meet(cell.p[i] + Interval(-more, more), whole.p[i]);
    }
    found.each_side = machine.norm_by_ways(about, infinity) < infinity;
}

// No bound, since this cell has none that cannot be cut, or that no work is left for.
void refuse(const ir::Graph &graph, Machine &machine, const Cell &cell, bool came_near,
            FieldBound &found) {
    machine.run(cell);
    found.lipschitz = infinity;
    found.value = Interval::everything();
    found.trouble = machine.trouble();
    if (machine.cause()) found.cause = graph[machine.cause()].op;
    found.where = middle(cell);
    found.came_near = came_near;
}

// The part of a cell where rays go.
Cell within_reach(Cell cell) {
    for (Interval &x : cell.p) x = meet(x, Interval(-in_reach, in_reach));
    return cell;
}

// May products leave single precision where rays go, of a field without powers and exponentials?
bool products_overflow(const Tape &tape, const Ranges &ranges, const Domain &domain) {
    if (tape.grows || tape.too_large || tape.winds_about) return false; // that is seen as it is
    Machine machine(tape, ranges);
    const Cell near = within_reach(domain.box);
    machine.run(near);
    // In a region what is infinite is the time, or beside a pole, and is told of as such.
    return machine.leaves_single(near.p != domain.box.p);
}

// Those along which a field is as steep all along are of no use.
std::array<bool, 3> axes_to_cut(const Periods &periods, const Tape &tape) {
    std::array<bool, 3> cuts = periods.reads;
    for (std::size_t i = 0; i < 3; ++i)
        if (periods.linear[i] && !tape.near) cuts[i] = false;
    return cuts;
}

FieldBound search_cells(Flattening &context, const Ranges &ranges, const Tape &tape,
                        const Domain &domain, const Budget &budget) {
    FieldBound out;
    if (tape.too_large) {
        out.lipschitz = infinity;
        out.value = Interval::everything();
        out.too_large = true;
        return out;
    }
    Machine machine(tape, ranges);
    machine.narrow_still();
    Periods periods = periods_of(tape, context.graph);
    Cell whole = domain.box;
    const std::array<bool, 3> shifted = to_one_period(periods, whole);
    const bool reduced = shifted[0] || shifted[1] || shifted[2];
    const std::array<bool, 3> cuts = axes_to_cut(periods, tape);
    const std::optional<Zone> along =
        reduced && domain.zone ? zone_along(*domain.zone, shifted) : std::nullopt;
    const Zone *zone = !reduced ? domain.zone : along ? &*along : nullptr;
    const bool negated = keep_half(tape, whole, zone);
    if (zone) machine.keep_to(distances_of(*zone));

    auto outside = [&](const Cell &cell) { return zone && misses(*zone, cell); };
    auto sample = [&](const std::array<double, 3> &p) {
        if (outside(at_point(p))) return;
        machine.run(at_point(p));
        ++out.evaluations;
        if (machine.norm() != infinity)
            out.sampled = std::max(out.sampled, machine.norm() * (1 - 1e-9));
    };
    Dice dice{0x5eed};
    for (int k = 0; k < 24; ++k) sample(some_point(whole, dice));

    std::priority_queue<Candidate, std::vector<Candidate>, Worse> queue;
    std::vector<std::pair<Cell, Interval>> cells;
    auto push = [&](const Cell &cell, int depth, int ways_at) {
        if (outside(cell)) return;
        machine.run(cell);
        ++out.evaluations;
        queue.push({machine.norm(), std::int16_t(depth), std::int16_t(ways_at),
                    static_cast<std::uint32_t>(cells.size())});
        cells.emplace_back(cell, machine.value(0));
    };
    // What a run tells that begins with no work left is nothing.
    const auto runs_left = [&] {
        const std::size_t taken = out.evaluations > 0 ? machine.work() / out.evaluations : 0;
        return ranges.work->left / std::max(tape.length() + 1, taken);
    };
    const bool asks_ways = holds_choices(tape);
    push(whole, 0, first_ways);
    if (tape.grows) // where rays go, what leaves single precision has no bound, whatever a rule says
        if (const Cell near = within_reach(whole); near.p != whole.p) push(near, 0, first_ways);
    double settled = 0; // of cells that cannot be cut any more
    Interval settled_value{infinity, -infinity};
    std::size_t limit = std::max(budget.instructions, 200 * tape.length());
    double at_limit = infinity; // the bound when the last limit was reached
    while (!queue.empty()) {
        Candidate top = queue.top();
        if (top.bound <= std::max({out.sampled * budget.tolerance, settled, budget.enough})) break;
        if (out.sampled > budget.hopeless) break;
        if (top.bound != infinity && runs_left() < 3) break; // a sample, and both halves
        if (top.bound != infinity && machine.work() > limit &&
            !goes_on(budget, top.bound, out.sampled, limit, at_limit))
            break;
        queue.pop();
        const auto [cell, value] = cells[top.at];
        int axis = 0;
        double width = widest(cell, cuts, &axis);
        auto k = static_cast<std::size_t>(axis);
        const double size = distance(cell);
        bool endless = !std::isfinite(width);
        if (top.bound == infinity &&
            (width <= 1e-7 * size || (endless && top.depth > 60) || machine.work() > 4 * limit)) {
            refuse(context.graph, machine, cell, width <= 1e-7 * size, out);
            out.at_infinity = endless;
            if (!endless && out.trouble == Trouble::Jump)
                find_sides(tape, ranges, out, std::max(1e-5 * size, width), periods.reads, whole,
                           zone);
            if (asks_ways) look_at_sides(machine, cell, whole, out);
            to_domain(periods, shifted, domain.box, out);
            return out;
        }
        if (width <= 1e-9 * size || (endless && top.depth > 60)) { // no further out is it flatter
            settled = std::max(settled, top.bound);
            settled_value = hull(settled_value, value);
            continue;
        }
        sample(beside_middle(cell));
        int ways_at = top.ways_at;
        if (asks_ways && top.bound != infinity && top.depth >= ways_at) {
            const double less =
                machine.norm_by_ways(cell, top.bound * ways_gain) * ranges.rules[Rule::Ways];
            ways_at = top.depth + more_ways;
            if (less < top.bound * ways_gain) {
                queue.push({less, top.depth, std::int16_t(ways_at), top.at});
                continue;
            }
            if (runs_left() < 2) {
                queue.push(top);
                break;
            }
        }
        Cell left = cell, right = cell;
        double cut = cell.p[k].middle();
        left.p[k].hi = cut, right.p[k].lo = cut;
        push(left, top.depth + 1, ways_at);
        push(right, top.depth + 1, ways_at);
    }
    out.value = settled_value;
    out.lipschitz = settled;
    if (!queue.empty()) out.lipschitz = std::max(settled, queue.top().bound);
    while (!queue.empty()) {
        out.value = hull(out.value, cells[queue.top().at].second);
        queue.pop();
    }
    if (out.value.lo > out.value.hi) out.value = Interval::everything(); // an empty region
    if (negated) out.value = hull(out.value, -out.value);
    out.sampled = std::min(out.sampled, out.lipschitz);
    return out;
}

FieldBound search_bound(Flattening &context, const Ranges &ranges, const Tape &tape,
                        const Domain &domain, const Budget &budget) {
    if (!products_overflow(tape, ranges, domain))
        return search_cells(context, ranges, tape, domain, budget);
    if (within_reach(domain.box).p ==
        domain.box.p) { // of a region: what else is wrong is told first
        Budget any = budget;
        any.enough = std::numeric_limits<double>::max(); // it ends where each cell has a bound
        const FieldBound as_it_is = search_cells(context, ranges, tape, domain, any);
        if (!std::isfinite(as_it_is.lipschitz)) return as_it_is;
    }
    Tape growing = tape;
    growing.grows = true;
    return search_cells(context, ranges, growing, domain, budget);
}

double search_magnitude(Flattening &context, const Ranges &ranges, NodeId scalar,
                        const Domain &domain, const Budget &budget) {
    Tape tape = flatten(context, scalar, &domain.box);
    if (tape.too_large) return infinity;
    Machine machine(tape, ranges);
    machine.narrow_still();
    const std::array<bool, 3> all{true, true, true};
    std::priority_queue<Candidate, std::vector<Candidate>, Worse> queue;
    std::vector<Cell> cells;
    double seen = 0;
    auto push = [&](const Cell &cell, int depth) {
        if (domain.zone && misses(*domain.zone, cell)) return;
        machine.run(cell);
        Interval value = machine.value(0);
        double reach =
            0; // by the mean value theorem no value is further from the middle's than that
        for (std::size_t i = 0; i < 3; ++i)
            reach += ir::rounding::times(machine.row(0)[i].magnitude(),
                                         (cell.p[i] - Interval(cell.p[i].middle())).magnitude());
        if (machine.norm() != infinity && std::isfinite(reach)) {
            machine.run(at_point(middle(cell)));
            seen = std::max(seen, machine.value(0).mignitude());
            value = meet(machine.value(0) + Interval(-reach, reach), value);
        }
        queue.push(
            {value.magnitude(), std::int16_t(depth), 0, static_cast<std::uint32_t>(cells.size())});
        cells.push_back(cell);
    };
    push(domain.box, 0);
    while (!queue.empty()) {
        Candidate top = queue.top();
        if (top.bound <= seen * budget.tolerance || machine.work() > budget.instructions)
            return top.bound;
        queue.pop();
        const Cell cell = cells[top.at];
        int axis = 0;
        if (widest(cell, all, &axis) <= 1e-9) return top.bound;
        auto k = static_cast<std::size_t>(axis);
        Cell left = cell, right = cell;
        left.p[k].hi = right.p[k].lo = cell.p[k].middle();
        push(left, top.depth + 1);
        push(right, top.depth + 1);
    }
    return 0;
}

// The bound that a field has as seen from coordinates that turn about an axis; nothing where it is
// not seen to be of that kind.
std::optional<double> unwound_bound(Flattening &context, const Ranges &ranges, NodeId field,
                                    const Domain &domain, const Budget &budget) {
    const Tape tape = flatten_unwound(context, field);
    if (!tape.winds_about || tape.too_large) return {};
    if (tape.near) return {}; // a point and what it is turned to need not both be near
    const auto zone = turned_about(domain, *tape.winds_about);
    if (!zone) return {};
    Cell box = outer_box(*zone);
    box.p[std::size_t(*tape.winds_about)] = domain.box.p[std::size_t(*tape.winds_about)];
    return search_bound(context, ranges, tape, Domain{box, &*zone}, budget).lipschitz;
}

constexpr double beyond_flat = 1e4; // a bound by parts, over the slope seen

// The steepest slope seen with the params in the middle of their ranges, and the time at its begin.
double seen_once(Flattening &own, const Ranges &all, NodeId field, const Domain &domain) {
    Ranges once = all;
    once.time = once.time.lo;
    for (auto &param : once.params)
        for (Interval &x : param) x = x.finite() ? x.middle() : 0.0;
    const Tape tape = flatten(own, field);
    Machine machine(tape, once);
    Dice dice{0x5eed};
    double most = 0;
    for (int k = 0; k < 24; ++k) {
        const Cell at = at_point(some_point(domain.box, dice));
        if (domain.zone && misses(*domain.zone, at)) continue;
        machine.run(at);
        if (machine.norm() != infinity) most = std::max(most, machine.norm());
    }
    return most;
}

bool holds_origin(const Cell &box) {
    return std::ranges::all_of(box.p, [](const Interval &x) { return x.contains(0); });
}

// By all of the field, and where that is loose from coordinates that turn.
FieldBound bound_of_all(Flattening &own, const Ranges &all, NodeId copy, const Domain &domain,
                        const Budget &budget) {
    const Tape tape = flatten(own, copy, &domain.box);
    if (budget.most == 0 || !holds_waves(tape)) return search_bound(own, all, tape, domain, budget);
    Budget first = budget;
    first.most = 0;
    FieldBound out = search_bound(own, all, tape, domain, first);
    const auto is_loose = [&] {
        return std::isfinite(out.lipschitz) && out.lipschitz > loose * out.sampled &&
               out.lipschitz > budget.enough;
    };
    // Of an angle that moves nothing is known, so that all slopes seen are those of any angle.
    const ir::Graph::Reads reads = own.graph.reads(copy);
    const bool moves = reads.time || reads.params;
    if (is_loose() || (moves && std::isfinite(out.lipschitz)))
        if (const auto less = unwound_bound(own, all, copy, domain, budget))
            out.lipschitz = std::min(out.lipschitz, *less);
    if (!is_loose()) return out;
    const double unwound = out.lipschitz;
    out = search_bound(own, all, tape, domain, budget);
    out.lipschitz = std::min(out.lipschitz, unwound);
    return out;
}

} // namespace

FieldBound bound_field(Flattening &context, const Ranges &ranges, NodeId field,
                       const Domain &domain, const Budget &budget) {
    Question question(context, ranges, field, Wanted::Bound);
    question.add(domain.box);
    question.add(domain.zone);
    question.add(budget);
    return std::move(question).answer([&](Flattening &own, const Ranges &all, NodeId copy) {
        if (const auto found = bound_by_distance(own, all, copy, domain, budget)) return *found;
        FieldBound out = bound_of_all(own, all, copy, domain, budget);
        if (std::isfinite(out.lipschitz) && out.lipschitz > budget.tolerance * out.sampled &&
            out.lipschitz > budget.enough && holds_origin(domain.box))
            if (const auto less =
                    bound_along_rays(own, all, copy, budget, out.lipschitz, out.sampled))
                out.lipschitz = *less * all.rules[Rule::Rays];
        if (out.lipschitz <= budget.enough || is_near(own.graph, copy, out)) return out;
        const bool refused = !std::isfinite(out.lipschitz);
        auto parts = bound_by_parts(own, all, copy, domain, budget, refused);
        if (parts) parts->lipschitz *= all.rules[Rule::Composed];
        if (!parts || !(parts->lipschitz < out.lipschitz)) return out;
        // What is rounding beside so steep a part may be all of a field that is flat.
        if (refused && parts->lipschitz > beyond_flat * seen_once(own, all, copy, domain))
            return out;
        const double sampled = std::min(out.sampled, parts->lipschitz);
        out = refused ? *parts : out;
        out.lipschitz = parts->lipschitz;
        out.sampled = sampled;
        return out;
    });
}

double bound_magnitude(Flattening &context, const Ranges &ranges, NodeId scalar,
                       const Domain &domain, const Budget &budget) {
    Question question(context, ranges, scalar, Wanted::Magnitude);
    question.add(domain.box);
    question.add(domain.zone);
    question.add(budget);
    return std::move(question)
        .answer([&](Flattening &own, const Ranges &all, NodeId copy) {
            FieldBound out;
            out.lipschitz = search_magnitude(own, all, copy, domain, budget);
            return out;
        })
        .lipschitz;
}

std::array<Interval, 16> range_of(Flattening &context, const Ranges &ranges, NodeId expression,
                                  const Cell &cell) {
    std::array<Interval, 16> out{};
    Tape tape = flatten(context, expression);
    if (tape.too_large) {
        out.fill(Interval::everything());
        return out;
    }
    Machine machine(tape, ranges);
    machine.narrow_still();
    machine.run(cell);
    for (int i = 0; i < machine.size() && i < 16; ++i)
        out[static_cast<std::size_t>(i)] = machine.value(i);
    return out;
}

} // namespace fathom::proof
