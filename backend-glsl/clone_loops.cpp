#include "backend-glsl/clone_loops.h"

#include "ir/passes/walk.h"

#include <unordered_map>
#include <unordered_set>

namespace fathom::glsl {

using ir::NodeId;
using ir::Op;

namespace {

// A Loop node whose record another Loop node below `roots` has too.
NodeId find_shared(const ir::Graph &graph, std::span<const NodeId> roots) {
    std::vector<NodeId> todo(roots.begin(), roots.end());
    std::unordered_set<NodeId> seen;
    std::unordered_map<std::uint32_t, NodeId> owner;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
        if (graph[id].op != Op::Loop) continue;
        if (!owner.try_emplace(graph[id].payload, id).second) return id;
        const ir::Loop &loop = graph.loop(ir::LoopId{graph[id].payload});
        todo.push_back(loop.count);
        todo.push_back(loop.condition);
        todo.insert(todo.end(), loop.next.begin(), loop.next.end());
    }
    return {};
}

// The same loop with variables of its own.
NodeId copy_of(ir::Graph &graph, NodeId id) {
    const ir::Loop loop = graph.loop(ir::LoopId{graph[id].payload});
    ir::Substitution fresh;
    ir::Loop copy = loop;
    const auto rename = [&](NodeId var) { return fresh[var] = graph.fresh_var(graph[var].type); };
    copy.index = rename(loop.index);
    for (std::size_t k = 0; k < loop.vars.size(); ++k) copy.vars[k] = rename(loop.vars[k]);
    for (std::size_t k = 0; k < loop.next.size(); ++k)
        copy.next[k] = substitute(graph, loop.next[k], fresh);
    if (loop.condition) copy.condition = substitute(graph, loop.condition, fresh);
    const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    return graph.make(Op::Loop, graph[id].type, args, graph.add_loop(std::move(copy)).index);
}

} // namespace

std::optional<ClonedLoops> clone_shared_loops(const ir::Graph &graph,
                                              std::span<const NodeId> roots) {
    NodeId shared = find_shared(graph, roots);
    if (!shared) return std::nullopt;
    ClonedLoops result{graph, {roots.begin(), roots.end()}};
    for (; shared; shared = find_shared(result.graph, result.roots)) {
        const ir::Substitution apart{{shared, copy_of(result.graph, shared)}};
        for (NodeId &root : result.roots) root = substitute(result.graph, root, apart);
    }
    return result;
}

} // namespace fathom::glsl
