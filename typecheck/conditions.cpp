// What has to hold of arguments, where it is met while something is tried: in a loop's body with its
// number left open, in a function's with its parameters open, in an arm that is taken for some
// params alone. What is tried adds its conditions to the scene's as everything does; who tried takes
// them back from a mark on, and puts them for what it found.
#include "typecheck/conditions.h"

#include "ir/passes/inline.h"

#include <algorithm>
#include <functional>
#include <set>

namespace fathom::typecheck {

using ir::NodeId;
using ir::Op;

std::vector<ir::Condition> take_conditions(Interpreter &ev, std::size_t mark) {
    std::vector<ir::Condition> &all = ev.scene.conditions;
    const auto from = all.begin() + static_cast<std::ptrdiff_t>(std::min(mark, all.size()));
    std::vector<ir::Condition> taken(std::make_move_iterator(from),
                                     std::make_move_iterator(all.end()));
    all.erase(from, all.end());
    return taken;
}

static bool of_the_point(const ir::Graph::Reads &reads) {
    return reads.point || reads.normal || reads.direction;
}

void excuse_conditions(Interpreter &ev, std::size_t mark, const Value &excuse) {
    if (ev.scene.conditions.size() == mark || excuse.kind != ValueKind::Field) return;
    ir::Graph &g = ev.scene.graph;
    const NodeId node = node_of(excuse);
    if (of_the_point(g.reads(node))) return; // it may hold at one point and not at another
    for (std::size_t i = mark; i < ev.scene.conditions.size(); ++i) {
        NodeId &holds = ev.scene.conditions[i].holds;
        holds = g.make(Op::Or, {node, holds});
    }
}

// The same as a number where it is one.
static NodeId written_out(ir::Graph &g, NodeId node) {
    constexpr std::size_t most = 10'000;
    const ir::WithoutCalls out = ir::without_loops(g, node, most);
    return out.all ? out.root : node;
}

static bool is_false(const ir::Graph &g, NodeId node) {
    return g.is_constant(node) && g.constant_of(node).value[0] == 0;
}
static bool is_true(const ir::Graph &g, NodeId node) {
    return g.is_constant(node) && g.constant_of(node).value[0] != 0;
}

// The condition without excuses that are of the point, which may hold at one point and not at another;
// `hidden` says which nodes are.
static NodeId without_hidden(ir::Graph &g, NodeId holds,
                             const std::function<bool(NodeId)> &hidden) {
    if (g[holds].op != Op::Or) return holds;
    const NodeId excuse = g.arg(holds, 0), rest = without_hidden(g, g.arg(holds, 1), hidden);
    return hidden(excuse) ? rest : g.make(Op::Or, {excuse, rest});
}

std::optional<ir::Condition> put_conditions(Interpreter &ev,
                                            std::span<const ir::Condition> conditions,
                                            const ir::Substitution &map) {
    ir::Graph &g = ev.scene.graph;
    for (const ir::Condition &condition : conditions) {
        const NodeId holds = written_out(
            g, without_hidden(g, ir::substitute(g, condition.holds, map),
                              [&](NodeId node) { return of_the_point(g.reads(node)); }));
        if (is_true(g, holds) || of_the_point(g.reads(holds))) continue;
        if (is_false(g, holds)) return condition;
        ev.scene.conditions.push_back({holds, condition.at, condition.wanted});
    }
    return std::nullopt;
}

namespace {

// A loop, followed turn by turn in what its conditions hang on.
struct Turns {
    Interpreter &ev;
    const ir::Loop &loop;
    std::vector<NodeId> values; // by variable, before the turn
    std::vector<bool> followed; // … of those that matter
    std::vector<bool> of_point; // … and what depends on the point, which nobody follows
    std::vector<std::vector<std::size_t>> next_reads; // by variable that is followed

    std::optional<std::size_t> variable(NodeId id) const {
        const auto it = std::ranges::find(loop.vars, id);
        if (it == loop.vars.end()) return std::nullopt;
        return static_cast<std::size_t>(it - loop.vars.begin());
    }
    // The loop's variables that an expression reads; they are followed from now on.
    std::vector<std::size_t> reads(NodeId node) {
        std::vector<std::size_t> out;
        for (NodeId id : ev.scene.graph.free_vars(node)) {
            const auto k = variable(id);
            if (!k) continue;
            out.push_back(*k);
            if (followed[*k]) continue;
            followed[*k] = true;
            next_reads[*k] = reads(loop.next[*k]);
        }
        return out;
    }
    bool hidden(NodeId node) const {
        if (of_the_point(ev.scene.graph.reads(node))) return true;
        for (NodeId id : ev.scene.graph.free_vars(node))
            if (const auto k = variable(id); k && of_point[*k]) return true;
        return false;
    }
    bool hidden(NodeId node, const std::vector<std::size_t> &of) const {
        return of_the_point(ev.scene.graph.reads(node)) ||
               std::ranges::any_of(of, [&](std::size_t k) { return of_point[k]; });
    }
    ir::Substitution now(int turn) const {
        ir::Substitution map{{loop.index, ev.scene.graph.integer(turn)}};
        for (std::size_t k = 0; k < values.size(); ++k)
            if (followed[k] && !of_point[k]) map[loop.vars[k]] = values[k];
        return map;
    }
    void advance(const ir::Substitution &map, std::size_t &looked_at) {
        std::vector<NodeId> after = values;
        std::vector<bool> point_after = of_point;
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (!followed[k]) continue;
            point_after[k] = hidden(loop.next[k], next_reads[k]);
            if (!point_after[k])
                after[k] = ir::substitute(ev.scene.graph, loop.next[k], map, looked_at);
        }
        values = std::move(after), of_point = std::move(point_after);
    }
};

} // namespace

std::optional<ir::Condition> put_conditions_of_loop(Interpreter &ev, const ir::Loop &loop,
                                                    std::span<const NodeId> initial,
                                                    std::vector<ir::Condition> conditions,
                                                    Span place) {
    if (conditions.empty()) return std::nullopt;
    ir::Graph &g = ev.scene.graph;
    const std::size_t count = loop.vars.size();
    Turns turns{ev,
                loop,
                {initial.begin(), initial.end()},
                std::vector<bool>(count),
                std::vector<bool>(count),
                std::vector<std::vector<std::size_t>>(count)};
    for (std::size_t k = 0; k < count; ++k) turns.of_point[k] = of_the_point(g.reads(initial[k]));
    std::vector<std::vector<std::size_t>> reads;
    for (const ir::Condition &condition : conditions) reads.push_back(turns.reads(condition.holds));
    std::vector<std::size_t> go_reads;
    if (loop.condition) go_reads = turns.reads(loop.condition);
    std::set<std::pair<NodeId, std::size_t>> put;
    std::size_t looked_at = 0;
    for (int turn = 0; turn < loop.max_count; ++turn) {
        if (!spend(ev, place, 1 + std::exchange(looked_at, 0))) return std::nullopt;
        const ir::Substitution map = turns.now(turn);
        NodeId go = g.boolean(true);
        if (loop.condition && !turns.hidden(loop.condition, go_reads))
            go = written_out(g, ir::substitute(g, loop.condition, map, looked_at));
        if (is_false(g, go)) return std::nullopt;
        for (std::size_t i = 0; i < conditions.size(); ++i) {
            NodeId demanded = conditions[i].holds;
            if (turns.hidden(demanded, reads[i])) {
                demanded = without_hidden(g, demanded, [&](NodeId n) { return turns.hidden(n); });
                if (turns.hidden(demanded)) continue;
            }
            NodeId holds = written_out(g, ir::substitute(g, demanded, map, looked_at));
            if (is_false(g, holds) && is_true(g, go)) return conditions[i];
            if (!is_true(g, go)) holds = g.make(Op::Or, {g.make(Op::Not, {go}), holds});
            if (is_true(g, holds) || of_the_point(g.reads(holds))) continue;
            if (put.emplace(holds, i).second)
                ev.scene.conditions.push_back({holds, conditions[i].at, conditions[i].wanted});
        }
        turns.advance(map, looked_at);
    }
    return std::nullopt;
}

} // namespace fathom::typecheck
