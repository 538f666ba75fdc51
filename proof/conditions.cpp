// What library functions demand of arguments that depend on params, time and the ids of copies:
// proved with intervals, by halving the ranges. Proofs: docs/lipschitz.md, 9.
#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>
#include <set>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

namespace {

constexpr int max_boxes = 4096;
// Instructions, and numbers that boxes are made of: for one condition, and for all of a scene.
constexpr std::size_t work_of_one = 2'000'000, work_of_all = 16'000'000;
constexpr double grain = 1e-6; // by this much an order may be missed: a size is 0 there at worst

// One number that a condition hangs on: a component of a variable that stands for a param, or time,
// for which the point's first coordinate stands.
struct Unknown {
    bool time = false;
    std::uint32_t variable = 0;
    std::size_t component = 0;
    bool whole = false;
    Interval range;
};

struct Closed {
    NodeId holds; // over variables
    std::vector<Unknown> unknowns;
    bool endless = false; // a param has no range; that is said elsewhere
};

Closed closed(ir::Graph &graph, const Ranges &ranges, NodeId condition) {
    Closed out;
    ir::Substitution map;
    std::vector<NodeId> todo{condition};
    std::set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
        if (node.op == Op::Time) {
            map[id] = graph.component(graph.point(), 0);
            out.unknowns.push_back({true, 0, 0, false, ranges.time});
        }
        if (node.op != Op::Param) continue;
        const NodeId variable = graph.fresh_var(node.type);
        map[id] = variable;
        for (int i = 0; i < ir::components(node.type); ++i) {
            const auto k = static_cast<std::size_t>(i);
            const Interval range = ranges.params[node.payload][k];
            const bool whole = node.type == ir::Type::Int || node.type == ir::Type::Bool;
            out.endless = out.endless || !range.finite();
            out.unknowns.push_back({false, graph[variable].payload, k, whole, range});
        }
    }
    out.holds = ir::substitute(graph, condition, map);
    return out;
}

enum class Orders { All, Inclusive };

// The same condition with orders that may be missed by a grain, all or those that hold of equal
// numbers, too; what must not be equal must not.
NodeId nearly(ir::Graph &graph, NodeId condition, Orders which) {
    const ir::Node node = graph[condition];
    const auto arg = [&](int i) { return graph.arg(condition, i); };
    const auto ordered = [&](NodeId less, NodeId more, bool inclusive) {
        if (graph[less].type != ir::Type::Float || (which == Orders::Inclusive && !inclusive))
            return condition;
        return graph.make(Op::LessEqual, {less, graph.add(more, graph.number(grain))});
    };
    if (node.op == Op::Less || node.op == Op::LessEqual)
        return ordered(arg(0), arg(1), node.op == Op::LessEqual);
    if (node.op == Op::And || node.op == Op::Or) {
        const NodeId one = nearly(graph, arg(0), which), other = nearly(graph, arg(1), which);
        return graph.make(node.op, {one, other});
    }
    if (node.op == Op::Not && (graph[arg(0)].op == Op::Less || graph[arg(0)].op == Op::LessEqual))
        return ordered(graph.arg(arg(0), 1), graph.arg(arg(0), 0), graph[arg(0)].op == Op::Less);
    return condition;
}

// Terms that stand on both sides of an order leave each other.
NodeId in_differences(ir::Graph &graph, NodeId condition) {
    const ir::Node node = graph[condition];
    const auto arg = [&](int i) { return graph.arg(condition, i); };
    if (node.op == Op::And || node.op == Op::Or)
        return graph.make(node.op, {in_differences(graph, arg(0)), in_differences(graph, arg(1))});
    if (node.op == Op::Not) return graph.make(node.op, {in_differences(graph, arg(0))});
    if ((node.op != Op::Less && node.op != Op::LessEqual) || graph[arg(0)].type != ir::Type::Float)
        return condition;
    const auto way = difference(graph, arg(1), arg(0));
    return way ? graph.make(node.op, {graph.number(0), *way}) : condition;
}

struct Halving {
    std::size_t left = work_of_all;
    bool ended = false; // before it was decided
};

// Is it true for all values? The box that is not decided is halved along its longest side, as long
// as work is left; one is always looked at.
bool always(Flattening &flattening, Ranges &ranges, NodeId condition,
            const std::vector<Unknown> &unknowns, Halving &search) {
    const Tape tape = flatten(flattening, condition);
    if (tape.too_large) return false;
    const double period = periods_of(tape, flattening.graph).period[0];
    std::vector<Interval> all;
    for (const Unknown &one : unknowns) {
        all.push_back(one.range);
        if (one.time && period > 0 && all.back().width() > period)
            all.back().hi = all.back().lo + period * (1 + 1e-9);
    }
    std::vector<std::vector<Interval>> boxes{all};
    const std::size_t step = tape.once.size() + tape.each.size() + all.size() + 1;
    std::size_t left = std::min(search.left, work_of_one);
    for (int tried = 0; !boxes.empty(); ++tried) {
        if (tried == max_boxes || (tried > 0 && left < step)) {
            search.ended = true;
            return false;
        }
        left -= std::min(left, step);
        search.left -= std::min(search.left, step);
        const std::vector<Interval> box = boxes.back();
        boxes.pop_back();
        Cell cell;
        for (std::size_t i = 0; i < box.size(); ++i)
            (unknowns[i].time ? cell.p[0]
                              : ranges.vars[unknowns[i].variable][unknowns[i].component]) = box[i];
        Machine machine(tape, ranges);
        machine.run(cell);
        if (machine.value(0).lo > 0.5) continue;
        if (machine.value(0).hi < 0.5) return false;
        std::size_t longest = 0;
        double most = 0;
        for (std::size_t i = 0; i < box.size(); ++i) {
            const double part = box[i].width() / std::max(all[i].width(), 1e-300);
            if (part > most) most = part, longest = i;
        }
        if (most < 1e-9) return false;
        const double cut = box[longest].middle();
        const bool whole = unknowns[longest].whole;
        boxes.resize(boxes.size() + 2, box);
        boxes.back()[longest].hi = whole ? std::floor(cut) : cut;
        boxes[boxes.size() - 2][longest].lo = whole ? std::floor(cut) + 1 : cut;
    }
    return true;
}

} // namespace

void Prover::test_conditions() {
    std::set<std::pair<NodeId, std::uint32_t>> seen;
    Halving search;
    for (std::size_t i = 0; i < scene.conditions.size(); ++i) {
        const ir::Condition condition = scene.conditions[i];
        if (work.spent()) {
            if (!work.stopped() && !std::exchange(told_of_work, true))
                diagnostics
                    .add(Code::ProofLimit, condition.at,
                         "the proof of this scene takes more work than is allowed: not all "
                         "arguments are tested")
                    .note(options.limit_note)
                    .help("hang them on fewer params; " + options.limit_help);
            return;
        }
        if (!seen.emplace(condition.holds, condition.at.begin).second) continue;
        bool bound = true; // a loop's own variable is followed turn by turn
        for (NodeId var : graph.free_vars(condition.holds))
            bound = bound && ranges.vars.contains(graph[var].payload);
        const Closed over = closed(graph, ranges, condition.holds);
        if (!bound || over.endless) continue;
        const auto holds = [&](NodeId node) {
            return always(flattening, ranges, node, over.unknowns, search) ||
                   always(flattening, ranges, in_differences(graph, node), over.unknowns, search);
        };
        search.ended = false;
        // `0.5 + 0.5 * sin(time)` is 0 at least, and by its rounding a little less.
        if (holds(over.holds) || holds(nearly(graph, over.holds, Orders::Inclusive))) continue;
        const bool by_time =
            std::ranges::any_of(over.unknowns, [](const Unknown &one) { return one.time; });
        const std::string range = by_time ? "of the time that is covered " : "of a param's range ";
        if (holds(nearly(graph, over.holds, Orders::All)))
            diagnostics
                .add(Code::DegenerateRange, condition.at, "at an end " + range + condition.wanted)
                .help(by_time ? "keep the argument off its limit, as with `0.01 + time`"
                              : "let the range begin a little further in");
        else
            diagnostics
                .add(Code::BadArgument, condition.at,
                     condition.wanted + (search.ended
                                             ? "; that it is over all params and times is not seen"
                                             : "; over all params and times it is not"))
                .help(
                    "narrow the param's range, or hold the argument with `clamp`; the time that is "
                    "covered ends at `render(time: …)`");
    }
}

} // namespace fathom::proof
