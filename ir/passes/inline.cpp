#include "ir/passes/inline.h"

namespace fathom::ir {
namespace {

struct Writer {
    Graph &graph;
    std::size_t left; // nodes that may still be looked at
    bool all = true;
    std::unordered_map<NodeId, NodeId> done{};

    NodeId of(NodeId id) {
        if (const auto known = done.find(id); known != done.end()) return known->second;
        if (left == 0) {
            all = false;
            return id;
        }
        --left;
        const Node node = graph[id];
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        for (NodeId &arg : args) arg = of(arg);
        NodeId out = id;
        if (node.op == Op::Call)
            out = of(called(graph, FunctionId{node.payload}, args));
        else if (node.count > 0)
            out = graph.make(node.op, node.type, args, node.payload);
        return done[id] = out;
    }
};

} // namespace

NodeId called(Graph &graph, FunctionId function, std::span<const NodeId> args,
              const Substitution &also) {
    const Function &callee = graph.function(function);
    Substitution map = also;
    for (std::size_t i = 0; i < callee.params.size(); ++i) map[callee.params[i]] = args[i];
    return substitute(graph, callee.result, map);
}

NodeId called(Graph &graph, NodeId call) {
    const std::vector<NodeId> args(graph.args(call).begin(), graph.args(call).end());
    return called(graph, FunctionId{graph[call].payload}, args);
}

namespace {
Substitution of_iteration(Graph &graph, const Loop &loop, int iteration,
                          std::span<const NodeId> values) {
    Substitution map{{loop.index, graph.integer(iteration)}};
    for (std::size_t i = 0; i < values.size(); ++i) map[loop.vars[i]] = values[i];
    return map;
}
} // namespace

NodeId in_iteration(Graph &graph, const Loop &loop, int iteration, std::span<const NodeId> values,
                    NodeId expression) {
    return substitute(graph, expression, of_iteration(graph, loop, iteration, values));
}

std::vector<NodeId> after_iteration(Graph &graph, const Loop &loop, int iteration,
                                    std::span<const NodeId> values) {
    const Substitution map = of_iteration(graph, loop, iteration, values);
    std::vector<NodeId> after;
    for (NodeId next : loop.next) after.push_back(substitute(graph, next, map));
    return after;
}

WithoutCalls without_calls(Graph &graph, NodeId root, std::size_t max_nodes) {
    Writer writer{graph, max_nodes};
    const NodeId out = writer.of(root);
    return {out, writer.all};
}

} // namespace fathom::ir
