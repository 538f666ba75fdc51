// What the user states of a field of his own, `lipschitz:` and `estimate:`. A bound that is stated
// is proved where that can be done; else it is tested, and stays an assumption where no pair of
// points refutes it (docs/lipschitz.md, 2.30).
#include "ir/passes/operations.h"
#include "proof/crossings.h"
#include "proof/prover.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>

namespace fathom::proof {

using ir::NodeId;
using ir::ShapeId;

namespace {

constexpr double refuting = 1 + 1e-6; // the stated bound, from which on a pair refutes it
using Values = std::array<Interval, 4>;

struct Steepest : Pair {
    double slope = 0;
};

Values values_at(Machine &machine, const std::array<double, 3> &p) {
    machine.run(at_point(p));
    Values v{Interval(0), Interval(0), Interval(0), Interval(0)};
    for (int i = 0; i < std::min(machine.size(), 4); ++i)
        v[static_cast<std::size_t>(i)] = machine.value(i);
    return v;
}

// The rise is what lies between the two intervals: where rounding leaves a choice open, both of its
// branches are in there, and nothing is refuted.
double rise_of(const Values &a, const Values &b) {
    double sum = 0;
    for (std::size_t i = 0; i < 4; ++i) {
        if (!a[i].finite() || !b[i].finite()) return 0;
        const double gap = std::max({0.0, a[i].lo - b[i].hi, b[i].lo - a[i].hi});
        sum += gap * gap;
    }
    return std::sqrt(sum);
}

double slope_of(Machine &machine, const Pair &pair) {
    const double run = pair.length();
    if (!(run > 0)) return 0;
    const Values a = values_at(machine, pair.a), b = values_at(machine, pair.b);
    return rise_of(a, b) / run;
}

// Pairs of points at all distances.
struct Sample {
    Steepest steepest;
    int pairs = 0, violations = 0;
};
Sample by_chance(Machine &machine, SomeWays &ways, double limit, int pairs) {
    Sample out;
    out.pairs = pairs;
    for (int n = 0; n < pairs; ++n) {
        Pair pair{ways.point(), ways.point()};
        // from the whole region down to a ten-thousandth of it
        const double reach = std::pow(10.0, -4 * ways.dice.next());
        for (std::size_t i = 0; i < 3; ++i) pair.b[i] = pair.a[i] + (pair.b[i] - pair.a[i]) * reach;
        const double slope = slope_of(machine, pair);
        out.violations += slope > limit * refuting;
        if (slope > out.steepest.slope) out.steepest = {pair, slope};
    }
    return out;
}

// Small moves of a short pair that make it steeper.
void climb(Machine &machine, SomeWays &ways, Steepest &top, int moves) {
    double step = 0.1;
    for (int n = 0; n < moves; ++n) {
        Pair next = top;
        for (std::size_t i = 0; i < 3; ++i) {
            if (!ways.reads[i]) continue;
            const double move = step * (2 * ways.dice.next() - 1);
            next.a[i] += move, next.b[i] += move;
            next.b[i] += step * 0.1 * (2 * ways.dice.next() - 1);
            next.a[i] = std::clamp(next.a[i], ways.box.p[i].lo, ways.box.p[i].hi);
            next.b[i] = std::clamp(next.b[i], ways.box.p[i].lo, ways.box.p[i].hi);
        }
        if (!ways.inside(next.a) || !ways.inside(next.b)) continue;
        const double slope = slope_of(machine, next);
        if (slope > top.slope)
            top = {next, slope};
        else
            step = std::max(step * 0.98, 1e-4);
    }
}

// The direction in which a field is steepest where the machine has just run: of J^T J the
// eigenvector of the greatest value.
std::array<double, 3> steepest_way(const Machine &machine) {
    std::array<double, 3> way{0.53, 0.62, 0.58};
    constexpr int rounds = 12;
    for (int k = 0; k < rounds; ++k) {
        std::array<double, 3> next{};
        for (int i = 0; i < machine.size(); ++i) {
            double along = 0;
            for (std::size_t j = 0; j < 3; ++j) along += machine.row(i)[j].middle() * way[j];
            for (std::size_t j = 0; j < 3; ++j) next[j] += machine.row(i)[j].middle() * along;
        }
        const double size = std::hypot(next[0], next[1], next[2]);
        if (!(size > 0) || !std::isfinite(size)) break;
        for (std::size_t j = 0; j < 3; ++j) way[j] = next[j] / size;
    }
    return way;
}

// Pairs along the gradient, where that is longer than the limit, at its longest and near that.
Steepest by_gradients(Machine &machine, SomeWays &ways, double limit, int points) {
    Steepest out;
    std::array<double, 3> top{};
    double longest = 0, step = 0.1;
    for (int n = 0; n < points; ++n) {
        std::array<double, 3> p = top;
        const bool anywhere = n < points / 2 || !(longest > 0);
        if (anywhere)
            p = ways.point();
        else
            for (std::size_t i = 0; i < 3; ++i)
                if (ways.reads[i]) p[i] += step * (2 * ways.dice.next() - 1);
        if (!ways.inside(p)) continue;
        machine.run(at_point(p));
        const double norm = machine.norm();
        if (!std::isfinite(norm)) continue;
        if (norm > longest)
            longest = norm, top = p;
        else if (!anywhere)
            step = std::max(step * 0.98, 1e-4);
        if (!(norm > limit * refuting) || norm < longest) continue;
        const std::array<double, 3> way = steepest_way(machine);
        for (const double length : {1e-3, 1e-4}) {
            Pair pair{p, p};
            for (std::size_t i = 0; i < 3; ++i)
                pair.a[i] -= way[i] * length / 2, pair.b[i] += way[i] * length / 2;
            if (!ways.inside(pair.a) || !ways.inside(pair.b)) continue;
            const double slope = slope_of(machine, pair);
            if (slope > out.slope) out = {pair, slope};
        }
    }
    return out;
}

// Pairs between which a decision turns: near a place where the proof has met one, and everywhere.
// The first that refutes the limit, by more than what rounding makes of two sides that meet.
Steepest by_turns(Machine &machine, SomeWays &ways, double limit, const FieldBound &found,
                  std::size_t most_work) {
    constexpr int most_pairs = 2000, pairs_near = 300, without_turns = 200;
    constexpr double rounding = 1e-7;
    double reach = 1;
    for (const Interval &side : ways.box.p)
        if (side.hi > side.lo) reach = std::min(reach, (side.hi - side.lo) / 2);
    const bool named = found.trouble == Trouble::Jump && !found.at_infinity;
    int turns = 0;
    const std::size_t end = machine.work() + most_work;
    for (int n = 0; n < most_pairs && machine.work() < end; ++n) {
        if (n >= without_turns && turns == 0) break;
        const bool near = named && n < 2 * pairs_near && n % 2 == 0;
        const auto way = near ? ways.next_near(found.where, reach) : ways.next();
        if (!way) continue;
        const auto pair = turning(machine, *way, near_in(ways.box, way->a));
        if (!pair) continue;
        ++turns;
        if (!ways.inside(pair->a) || !ways.inside(pair->b)) continue;
        const double slope = slope_of(machine, *pair);
        const double excess = (slope - limit * refuting) * pair->length();
        if (excess > rounding * std::max(1.0, machine.value(0).magnitude())) return {*pair, slope};
    }
    return {};
}

// Does the rise between two points stay as they come nearer? Leaves the nearer ones.
bool keeps_its_rise(Machine &machine, Steepest &pair) {
    constexpr int halvings = 7;
    const double before = pair.slope * pair.length();
    Values a = values_at(machine, pair.a), b = values_at(machine, pair.b);
    Pair near = pair;
    for (int k = 0; k < halvings; ++k) {
        std::array<double, 3> middle{};
        for (std::size_t i = 0; i < 3; ++i) middle[i] = (near.a[i] + near.b[i]) / 2;
        const Values at = values_at(machine, middle);
        if (rise_of(a, at) > rise_of(at, b))
            near.b = middle, b = at;
        else
            near.a = middle, a = at;
    }
    if (rise_of(a, b) < before / 4) return false;
    pair = {near, rise_of(a, b) / near.length()};
    return true;
}

std::string value_text(const Values &v, int size) {
    if (size == 1) return fmt::format("{:.6g}", v[0].middle());
    std::string out;
    for (int i = 0; i < size; ++i)
        out += fmt::format("{}{:.6g}", i ? ", " : "[", v[std::size_t(i)].middle());
    return out + "]";
}

// Fewer where a field has long loops, so that the work is bounded: about 5 million operations, or
// the fewest pairs.
constexpr int fewest_pairs = 2;
double share_of(const ir::Scene &scene, NodeId field) {
    return std::min(1.0, 1e3 / ir::operations(scene.graph, field));
}

SomeWays ways_in(const Place &here, int dims) {
    SomeWays out;
    out.box = to_cell(here.box);
    if (dims == 2) out.box.p[2] = 0.0, out.reads[2] = false;
    out.zone = here.zone;
    out.dice = Dice{0xa55e55};
    return out;
}

} // namespace

void Prover::test_estimate(ShapeId id, NodeId field, double estimate) {
    const Place &here = place(id);
    if (!here.reported || !options.test_assumptions) return;
    const auto kept = tape_of(field);
    const Tape &tape = *kept;
    if (tape.too_large) return;
    if (work.spent()) {
        report(id, Code::ProofLimit, "");
        return;
    }
    Machine machine(tape, ranges);
    const int dims = scene.shapes[id].dims;
    SomeWays ways = ways_in(here, dims);
    const double share = share_of(scene, field);
    Sample sample = by_chance(machine, ways, estimate, std::max(fewest_pairs, int(2000 * share)));
    climb(machine, ways, sample.steepest, int(400 * share));
    const auto &[a, b] = static_cast<const Pair &>(sample.steepest);
    const auto [one_end, other_end] = two_points(a, b, dims);
    const double worst = sample.steepest.slope;
    if (Diagnostic *d = report(id, Code::EstimatedField,
                               "this field is marched by an estimate, which is not a proof: "
                               "thin parts may be missed"))
        d->note(fmt::format("{:.2g} % of {} pairs of points are steeper than {}; ",
                            100.0 * sample.violations / sample.pairs, sample.pairs,
                            number_text(estimate)) +
                (worst > 0 ? "between " + one_end + " and " + other_end + " its slope is " +
                                 number_text(worst)
                           : "none of them is steep at all"));
}

// The ordinary search, of work of its own, so that no scene is refused for what is not needed.
// Where that comes near the stated bound alone it is asked for just that.
FieldBound Prover::bound_apart(NodeId field, const Place &here, double stated, bool own) {
    const std::size_t all = work.left, most = std::min(leaf_work, spare_work);
    FieldBound nothing;
    nothing.lipschitz = ir::rounding::infinity;
    if (most == 0) return nothing;
    work.left = most;
    FieldBound out = bound_once(field, here, own);
    constexpr double near = 1.1;
    if (out.lipschitz > stated && out.lipschitz <= near * stated && out.sampled <= stated) {
        Budget budget;
        budget.instructions = options.field_instructions;
        budget.tolerance = 1;
        budget.enough = stated;
        budget.hopeless = stated * refuting;
        const FieldBound finer = bound_written(field, {to_cell(here.box), here.zone}, budget);
        if (finer.lipschitz < out.lipschitz) out = finer;
    }
    const bool stopped = work.stop && work.stop->stopped();
    spare_work -= most - work.left;
    work.left = stopped ? 0 : all;
    return out;
}

std::optional<FieldBound> Prover::holds_stated(ShapeId id, NodeId field, double stated) {
    const Place &here = place(id);
    if (!here.reported || work.spent()) {
        if (here.reported) report(id, Code::ProofLimit, "");
        return {};
    }
    const bool leaf = scene.shapes[id].kind == ir::ShapeKind::Leaf;
    FieldBound found = bound_apart(field, here, stated, leaf);
    const Rule rule = leaf ? Rule::Field : Rule::Distort;
    if (found.lipschitz * std::max(1.0, options.rules[rule]) <= stated * (1 + slack)) {
        held.insert(id);
        return found;
    }
    if (options.test_assumptions) test_stated(id, field, stated, found);
    return {};
}

void Prover::test_stated(ShapeId id, NodeId field, double stated, const FieldBound &found) {
    const Place &here = place(id);
    const auto kept = tape_of(field);
    const Tape &tape = *kept;
    if (tape.too_large) return;
    const int dims = scene.shapes[id].dims;
    SomeWays ways = ways_in(here, dims);
    const double share = share_of(scene, field);
    const Told holds = reads_of(tape);
    std::vector<Held> helds{Held::Middle};
    if (holds.params || holds.time) helds = {Held::Middle, Held::First, Held::Last};
    const std::size_t most_work = std::min<std::size_t>(3'000'000, spare_work / 4) / helds.size();
    for (const Held how : helds) {
        const Ranges one = held_at(tape, ranges, how);
        Machine machine(tape, one);
        machine.read_values();
        Steepest top = by_chance(machine, ways, stated,
                                 std::max(fewest_pairs, int(1000 * share) / int(helds.size())))
                           .steepest;
        climb(machine, ways, top, int(200 * share));
        const Steepest longest =
            by_gradients(machine, ways, stated, int(1000 * share) / int(helds.size()));
        if (longest.slope > top.slope) top = longest;
        bool jumps = false;
        if (!(top.slope > stated * refuting)) {
            const std::size_t all = work.left, most = std::min(2 * most_work, spare_work);
            work.left = most;
            top = by_turns(machine, ways, stated, found, most_work);
            spare_work -= most - work.left;
            work.left = work.stop && work.stop->stopped() ? 0 : all;
            if (!(top.slope > stated * refuting)) continue;
        }
        jumps = keeps_its_rise(machine, top);
        const std::string rate = number_text(stated);
        Diagnostic *d = report(id, Code::LipschitzViolated,
                               jumps ? "the field jumps, so no `lipschitz:` holds of it"
                                     : "the field is steeper than `lipschitz: " + rate + "` says");
        if (!d) return;
        const auto [one_end, other_end] = two_points(top.a, top.b, dims);
        const int size = std::min(machine.size(), 4);
        const std::string held_there = (holds.params ? std::string(", with each param ") +
                                                           (how == Held::Middle  ? "in the middle"
                                                            : how == Held::First ? "at the begin"
                                                                                 : "at the end") +
                                                           " of its range"
                                                     : "") +
                                       (holds.time ? ", at time " + number_text(one.time.lo) : "");
        d->note("it is " + value_text(values_at(machine, top.a), size) + " at " + one_end +
                " and " + value_text(values_at(machine, top.b), size) + " at " + other_end +
                held_there + (jumps ? "" : ": a slope of " + number_text(top.slope)));
        const std::string other = "what is no distance, as a fractal's, can be drawn by an "
                                  "`estimate:`";
        if (jumps)
            d->help("leave `lipschitz:` out to be told what jumps, and make both sides agree "
                    "there; " +
                    other);
        else
            d->help("state at least " + number_text(std::ceil(top.slope * 100) / 100) +
                    ", or leave `lipschitz:` out to have it proved; " + other);
        return; // the picture is refused; what depends on it is not reported again
    }
}

} // namespace fathom::proof
