// A guard c over the carried values and what does not change in the loop: where each next value is
// `c ? new : old`, an iteration in which c is false changes none of them, so c is false ever after.
// The loop may then end there, and where it goes on, next is new.
#include "ir/passes/early_exit.h"

#include "ir/passes/cost.h"

#include <algorithm>
#include <optional>

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

// The one guard of all that change.
std::optional<Guard> guard_of(const Graph &graph, const Loop &loop) {
    std::optional<Guard> guard;
    for (std::size_t k = 0; k < loop.vars.size(); ++k) {
        if (loop.next[k] == loop.vars[k]) continue;
        const auto own = guard_of(graph, loop.next[k], loop.vars[k]);
        if (!own || (guard && *guard != *own)) return std::nullopt;
        guard = own;
    }
    if (!guard || std::ranges::count(graph.free_vars(guard->condition), loop.index))
        return std::nullopt;
    return guard;
}

} // namespace

void end_loops_early(Graph &graph) {
    constexpr double worth = 0.5; // nanoseconds (cost.h) of a body: a swap by `if` takes less
    for (std::size_t i = 0; i < graph.loop_count(); ++i) {
        Loop loop = graph.loop(LoopId{i});
        const auto guard = guard_of(graph, loop);
        if (!guard) continue;
        double cost = 0;
        for (std::size_t k = 0; k < loop.vars.size(); ++k) {
            if (loop.next[k] == loop.vars[k]) continue;
            loop.next[k] = graph.arg(loop.next[k], guard->holds ? 1 : 2);
            cost = std::max(cost, cost_of(graph, loop.next[k]));
        }
        if (cost < worth) continue;
        const NodeId goes_on =
            guard->holds ? guard->condition : graph.make(Op::Not, {guard->condition});
        loop.condition = loop.condition ? graph.make(Op::And, {loop.condition, goes_on}) : goes_on;
        graph.change_loop(LoopId{i}, std::move(loop));
    }
}

} // namespace fathom::ir
