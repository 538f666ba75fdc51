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

// What a node becomes where it is put; nothing where it is of the point, which is the field's own.
using Put = std::function<std::optional<NodeId>(NodeId)>;

// A condition where it is put: what was demanded, or one of the excuses before it. An excuse counts
// where it is the same at all points; what is still open may become of the point, so it does not
// count alone.
static NodeId put_one(ir::Graph &g, NodeId condition, std::vector<NodeId> excuses, const Put &put) {
    const NodeId holds_anyway = g.boolean(true);
    std::vector<NodeId> given;
    for (; g[condition].op == Op::Or; condition = g.arg(condition, 1))
        given.push_back(g.arg(condition, 0));
    const std::optional<NodeId> demanded = put(condition);
    if (!demanded || is_true(g, *demanded)) return holds_anyway;
    for (const NodeId excuse : given)
        if (const auto here = put(excuse)) excuses.push_back(*here);
    NodeId out = *demanded;
    for (const NodeId excuse : excuses) {
        if (is_true(g, excuse)) return holds_anyway;
        if (is_false(g, excuse) || (is_false(g, out) && g.reads(excuse).free_vars)) continue;
        out = g.make(Op::Or, {excuse, out});
    }
    return out;
}

std::optional<ir::Condition> put_conditions(Interpreter &ev,
                                            std::span<const ir::Condition> conditions,
                                            const ir::Substitution &map) {
    ir::Graph &g = ev.scene.graph;
    const Put put = [&](NodeId node) -> std::optional<NodeId> {
        const NodeId here = written_out(g, ir::substitute(g, node, map));
        return of_the_point(g.reads(here)) ? std::nullopt : std::optional(here);
    };
    for (const ir::Condition &condition : conditions) {
        const NodeId holds = put_one(g, condition.holds, {}, put);
        if (is_false(g, holds)) return condition;
        if (!is_true(g, holds))
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
    std::vector<bool> lost;     // … and what grew too large to be followed

    std::optional<std::size_t> variable(NodeId id) const {
        const auto it = std::ranges::find(loop.vars, id);
        if (it == loop.vars.end()) return std::nullopt;
        return static_cast<std::size_t>(it - loop.vars.begin());
    }
    // The loop's variables that an expression reads are followed from now on.
    void follow(NodeId node) {
        for (NodeId id : ev.scene.graph.free_vars(node)) {
            const auto k = variable(id);
            if (!k || followed[*k]) continue;
            followed[*k] = true;
            follow(loop.next[*k]);
        }
    }
    bool reads_any(NodeId node, const std::vector<bool> &of) const {
        return std::ranges::any_of(ev.scene.graph.free_vars(node), [&](NodeId id) {
            const auto k = variable(id);
            return k && of[*k];
        });
    }
    bool hidden(NodeId node) const {
        return of_the_point(ev.scene.graph.reads(node)) || reads_any(node, of_point);
    }
    bool reads_vector(NodeId node) const {
        return std::ranges::any_of(ev.scene.graph.free_vars(node), [&](NodeId id) {
            return ir::is_vector(ev.scene.graph[id].type);
        });
    }
    ir::Substitution now(int turn) const {
        ir::Substitution map{{loop.index, ev.scene.graph.integer(turn)}};
        for (std::size_t k = 0; k < values.size(); ++k)
            if (followed[k] && !of_point[k] && !lost[k]) map[loop.vars[k]] = values[k];
        return map;
    }
    void advance(const ir::Substitution &map, std::size_t &looked_at) {
        constexpr std::size_t most = 500; // nodes of what grows from turn to turn
        std::vector<NodeId> after = values;
        std::vector<bool> point_after = of_point, lost_after = lost;
        for (std::size_t k = 0; k < values.size(); ++k) {
            if (!followed[k]) continue;
            const NodeId next = loop.next[k];
            point_after[k] = hidden(next);
            lost_after[k] = !point_after[k] && reads_any(next, lost);
            if (point_after[k] || lost_after[k]) continue;
            std::size_t size = 0;
            after[k] = ir::substitute(ev.scene.graph, next, map, size);
            looked_at += size;
            if (size <= most || !ev.scene.graph.reads(after[k]).free_vars) continue;
            point_after[k] = reads_vector(after[k]); // a function's point
            lost_after[k] = !point_after[k];
        }
        values = std::move(after), of_point = std::move(point_after), lost = std::move(lost_after);
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
    const std::vector<bool> none(count);
    Turns turns{ev, loop, {initial.begin(), initial.end()}, none, none, none};
    for (std::size_t k = 0; k < count; ++k) turns.of_point[k] = of_the_point(g.reads(initial[k]));
    for (const ir::Condition &condition : conditions) turns.follow(condition.holds);
    if (loop.condition) turns.follow(loop.condition);
    std::set<std::pair<NodeId, std::size_t>> put_already;
    std::size_t looked_at = 0;
    for (int turn = 0; turn < loop.max_count; ++turn) {
        if (!spend(ev, place, 1 + std::exchange(looked_at, 0))) return std::nullopt;
        const ir::Substitution map = turns.now(turn);
        const Put put = [&](NodeId node) -> std::optional<NodeId> {
            if (turns.hidden(node)) return std::nullopt;
            if (turns.reads_any(node, turns.lost)) return g.boolean(false);
            const NodeId here = written_out(g, ir::substitute(g, node, map, looked_at));
            return of_the_point(g.reads(here)) ? std::nullopt : std::optional(here);
        };
        std::vector<NodeId> left; // the loop, before this turn
        if (loop.condition && !turns.reads_any(loop.condition, turns.lost))
            if (const auto go = put(loop.condition)) left.push_back(g.make(Op::Not, {*go}));
        if (!left.empty() && is_true(g, left[0])) return std::nullopt;
        for (std::size_t i = 0; i < conditions.size(); ++i) {
            const NodeId holds = put_one(g, conditions[i].holds, left, put);
            if (is_false(g, holds)) return conditions[i];
            if (!is_true(g, holds) && put_already.emplace(holds, i).second)
                ev.scene.conditions.push_back({holds, conditions[i].at, conditions[i].wanted});
        }
        turns.advance(map, looked_at);
    }
    return std::nullopt;
}

} // namespace fathom::typecheck
