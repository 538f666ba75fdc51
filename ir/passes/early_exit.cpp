// A guard c over the carried values and what does not change in the loop: where each next value is
// `c ? new : old`, an iteration in which c is false changes none of them, so c is false ever after.
// The loop may then end there, and where it goes on, next is new.
//
// A `break` at the begin is the same with a flag, which is carried, too: it is false while the loop
// goes on, and becomes true as the guard fails, which ends the loop one iteration later. Where
// nothing after the loop reads the flag, it stays false instead.
//
// Arguments precede their users, so the condition has to be there before the Loop node is.
#include "ir/passes/early_exit.h"

#include "ir/passes/cost.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <optional>
#include <unordered_set>

namespace fathom::ir {
namespace {

struct Guard {
    NodeId condition;
    bool holds; // the value of the condition with which the loop goes on
    friend bool operator==(Guard, Guard) = default;
};

// Of a next value that keeps its variable by one arm of a Select.
std::optional<Guard> guard_of(const Graph &graph, NodeId next, NodeId var) {
    if (graph[next].op != Op::Select) return std::nullopt;
    const bool first = graph.arg(next, 1) == var, second = graph.arg(next, 2) == var;
    if (first == second) return std::nullopt;
    return Guard{graph.arg(next, 0), second};
}

// The one guard of all that change but the flag, whose place it is (-1: none), and which becomes
// true where the guard fails, and stays false elsewhere.
std::optional<Guard> guard_of(const Graph &graph, const Loop &loop, int flag) {
    std::optional<Guard> guard;
    for (std::size_t k = 0; k < loop.vars.size(); ++k) {
        if (loop.next[k] == loop.vars[k] || static_cast<int>(k) == flag) continue;
        const auto own = guard_of(graph, loop.next[k], loop.vars[k]);
        if (!own || (guard && *guard != *own)) return std::nullopt;
        guard = own;
    }
    if (!guard || flag < 0) return guard;
    NodeId fails = loop.next[static_cast<std::size_t>(flag)];
    const bool negated = graph[fails].op == Op::Not;
    if (negated) fails = graph.arg(fails, 0);
    return fails == guard->condition && negated == guard->holds ? guard : std::nullopt;
}

bool is_not(const Graph &graph, NodeId condition, NodeId var) {
    return graph[condition].op == Op::Not && graph.arg(condition, 0) == var;
}

// The condition of the loop but for that the flag is false: no id where nothing is left.
NodeId without(const Graph &graph, const Loop &loop, int flag) {
    if (flag < 0) return loop.condition;
    const NodeId var = loop.vars[static_cast<std::size_t>(flag)];
    if (graph[loop.condition].op != Op::And) return {};
    return graph.arg(loop.condition, is_not(graph, graph.arg(loop.condition, 0), var) ? 1 : 0);
}

// The condition with which the loop ends where its guard fails.
NodeId exit_condition(Graph &graph, const Loop &loop, Guard guard, int flag) {
    const NodeId goes_on = guard.holds ? guard.condition : graph.make(Op::Not, {guard.condition});
    const NodeId rest = without(graph, loop, flag);
    return rest ? graph.make(Op::And, {rest, goes_on}) : goes_on;
}

// The place of the value that the loop's condition wants false; -1: there is none. Not the first,
// which a Loop node is where it stands for a value.
int flag_of(const Graph &graph, const Loop &loop) {
    if (!loop.condition) return -1;
    const bool both = graph[loop.condition].op == Op::And;
    for (std::size_t k = 1; k < loop.vars.size(); ++k)
        if (both ? is_not(graph, graph.arg(loop.condition, 0), loop.vars[k]) ||
                       is_not(graph, graph.arg(loop.condition, 1), loop.vars[k])
                 : is_not(graph, loop.condition, loop.vars[k]))
            return static_cast<int>(k);
    return -1;
}

// How a loop is used, by all Loop nodes that have its record.
struct Uses {
    NodeId first;                           // the first of these nodes
    std::unordered_set<std::uint32_t> read; // the places of the values that are read after it
    std::unordered_set<std::uint32_t> set;  // of those that do not begin as false
};

// By loop, in the order in which they were made: inner ones come first.
std::map<std::uint32_t, Uses> uses_of_loops(const Graph &graph) {
    std::map<std::uint32_t, Uses> uses;
    for (std::size_t i = 0; i < graph.size(); ++i) {
        const NodeId id{i};
        if (graph[id].op == Op::LoopResult)
            uses[graph[graph.arg(id, 0)].payload].read.insert(graph[id].payload);
        if (graph[id].op != Op::Loop) continue;
        Uses &own = uses[graph[id].payload];
        if (!own.first) own.first = id;
        for (std::uint32_t k = 0; k < graph[id].count; ++k)
            if (graph.as_number(graph.args(id)[k]) != 0) own.set.insert(k);
    }
    return uses;
}

// A body that costs (cost.h, in nanoseconds) less than the way out is left as it is. Loops of a few
// turns are written out by drivers where nothing can end them.
bool is_worth_it(double cost, int turns) { return cost >= 0.4 || cost * turns >= 12; }

void end_early(Graph &graph, LoopId id, const Uses &uses) {
    Loop loop = graph.loop(id);
    int flag = flag_of(graph, loop);
    if (flag >= 0 && (uses.read.contains(static_cast<std::uint32_t>(flag)) ||
                      uses.set.contains(static_cast<std::uint32_t>(flag))))
        flag = -1;
    const auto guard = guard_of(graph, loop, flag);
    if (!guard) return;
    // What fails once has to fail ever after, unless a flag has ended the loop then.
    if (flag < 0 && std::ranges::count(graph.free_vars(guard->condition), loop.index)) return;
    const NodeId condition = exit_condition(graph, loop, *guard, flag);
    assert(condition < uses.first);
    double cost = 0;
    for (std::size_t k = 0; k < loop.vars.size(); ++k) {
        if (loop.next[k] == loop.vars[k]) continue;
        loop.next[k] = static_cast<int>(k) == flag ? loop.vars[k]
                                                   : graph.arg(loop.next[k], guard->holds ? 1 : 2);
        cost = std::max(cost, cost_of(graph, loop.next[k]));
    }
    if (!is_worth_it(cost, loop.max_count)) return;
    loop.condition = condition;
    graph.change_loop(id, std::move(loop));
}

} // namespace

void make_exit_conditions(Graph &graph, const Loop &loop) {
    if (const auto guard = guard_of(graph, loop, -1)) exit_condition(graph, loop, *guard, -1);
    const int flag = flag_of(graph, loop);
    if (flag < 0) return;
    if (const auto guard = guard_of(graph, loop, flag)) exit_condition(graph, loop, *guard, flag);
}

void end_loops_early(Graph &graph) {
    for (const auto &[loop, uses] : uses_of_loops(graph))
        if (uses.first) end_early(graph, LoopId{std::size_t{loop}}, uses);
}

} // namespace fathom::ir
