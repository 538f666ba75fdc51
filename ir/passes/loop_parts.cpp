#include "ir/passes/loop_parts.h"

#include "ir/passes/inline.h"

#include <algorithm>
#include <set>

namespace fathom::ir {
namespace {

NodeId whole_result(Graph &graph, NodeId loop, std::size_t k) {
    if (k == 0) return loop;
    const NodeId var = graph.loop(LoopId{std::size_t{graph[loop].payload}}).vars[k];
    return graph.make(Op::LoopResult, graph.type(var), {loop}, static_cast<std::uint32_t>(k));
}

// A loop of which variable k is taken apart: its components are the last variables.
struct Apart {
    Loop loop; // without k
    std::vector<NodeId> first;
    std::size_t parts = 0;
    std::size_t part(std::size_t i) const { return loop.vars.size() - parts + i; }
};

constexpr std::size_t most_nodes = 2000; // of a next value whose calls are written out
constexpr std::size_t most_variables = 16;

// None where a component of the next value can not be computed by itself.
std::optional<Apart> taken_apart(Graph &graph, NodeId node, std::size_t k) {
    const Loop loop = graph.loop(LoopId{std::size_t{graph[node].payload}});
    const std::span<const NodeId> args = graph.args(node);
    Apart out{loop,
              {args.begin(), args.end()},
              static_cast<std::size_t>(components(graph.type(loop.vars[k])))};
    const NodeId first = out.first[k];
    std::vector<NodeId> parts;
    for (std::size_t i = 0; i < out.parts; ++i) parts.push_back(graph.fresh_var(Type::Float));
    const Substitution map{{loop.vars[k], graph.make(Op::Make, graph.type(loop.vars[k]), parts)}};
    for (NodeId &next : out.loop.next) next = substitute(graph, next, map);
    if (loop.condition) out.loop.condition = substitute(graph, loop.condition, map);
    const WithoutCalls written = without_calls(graph, out.loop.next[k], most_nodes);
    if (!written.all) return std::nullopt;
    const auto drop = [&](std::vector<NodeId> &from) {
        from.erase(from.begin() + static_cast<std::ptrdiff_t>(k));
    };
    drop(out.loop.vars), drop(out.loop.next), drop(out.first);
    for (std::size_t i = 0; i < out.parts; ++i) {
        const auto own = graph.scalar_part(written.root, static_cast<int>(i));
        if (!own) return std::nullopt;
        out.loop.vars.push_back(parts[i]);
        out.loop.next.push_back(*own);
        out.first.push_back(graph.component(first, static_cast<int>(i)));
    }
    return out;
}

// The variables that the next values of these read, and so on.
std::set<std::size_t> closure(const Graph &graph, const Loop &loop, std::vector<NodeId> of) {
    std::set<std::size_t> found;
    while (!of.empty()) {
        const NodeId node = of.back();
        of.pop_back();
        for (NodeId var : graph.free_vars(node)) {
            const auto at = std::ranges::find(loop.vars, var);
            if (at == loop.vars.end()) continue;
            const auto k = static_cast<std::size_t>(at - loop.vars.begin());
            if (found.insert(k).second) of.push_back(loop.next[k]);
        }
    }
    return found;
}

// The last value of variable k by the variables of `needed` alone.
NodeId own_loop(Graph &graph, const Apart &from, const std::set<std::size_t> &needed,
                std::size_t k) {
    Loop loop;
    loop.max_count = from.loop.max_count;
    loop.index = graph.fresh_var(Type::Int);
    Substitution map{{from.loop.index, loop.index}};
    std::vector<NodeId> first;
    for (std::size_t i : needed) {
        loop.vars.push_back(graph.fresh_var(graph.type(from.loop.vars[i])));
        map.emplace(from.loop.vars[i], loop.vars.back());
        first.push_back(from.first[i]);
    }
    for (std::size_t i : needed) loop.next.push_back(substitute(graph, from.loop.next[i], map));
    loop.count = from.loop.count;
    if (from.loop.condition) loop.condition = substitute(graph, from.loop.condition, map);
    const Type type = graph.type(loop.vars.front());
    const LoopId id = graph.add_loop(std::move(loop));
    const NodeId node = graph.make(Op::Loop, type, first, id.index);
    const auto at = static_cast<std::size_t>(std::distance(needed.begin(), needed.find(k)));
    return whole_result(graph, node, at);
}

} // namespace

NodeId loop_result(Graph &graph, NodeId loop, std::size_t k) {
    const NodeId whole = whole_result(graph, loop, k);
    const std::size_t variables = graph.loop(LoopId{std::size_t{graph[loop].payload}}).vars.size();
    if (!is_vector(graph.type(whole)) || variables > most_variables) return whole;
    const auto apart = taken_apart(graph, loop, k);
    if (!apart) return whole;
    std::vector<std::set<std::size_t>> needs;
    for (std::size_t i = 0; i < apart->parts; ++i) {
        std::vector<NodeId> roots{apart->loop.vars[apart->part(i)]};
        if (apart->loop.condition) roots.push_back(apart->loop.condition);
        needs.push_back(closure(graph, apart->loop, std::move(roots)));
    }
    std::vector<NodeId> results;
    bool any = false;
    for (std::size_t i = 0; i < apart->parts; ++i) {
        bool alone = true, leads = false;
        for (std::size_t j = 0; j < apart->parts; ++j) {
            if (j == i) continue;
            alone &= !needs[i].contains(apart->part(j));
            leads |= needs[j].contains(apart->part(i));
        }
        any |= alone && leads;
        results.push_back(alone && leads ? own_loop(graph, *apart, needs[i], apart->part(i))
                                         : graph.component(whole, static_cast<int>(i)));
    }
    return any ? graph.make(Op::Make, graph.type(whole), results) : whole;
}

} // namespace fathom::ir
