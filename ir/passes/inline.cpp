#include "ir/passes/inline.h"

#include <optional>

namespace fathom::ir {
namespace {

struct Inliner {
    Graph &graph;
    std::size_t left; // nodes that may still be looked at
    bool loops = false;
    bool all = true;
    std::unordered_map<NodeId, NodeId> done{};
    std::unordered_map<NodeId, std::vector<NodeId>>
        ends{}; // by loop: its results; none if it stays

    // A loop's results by its arguments and constants alone.
    const std::vector<NodeId> &written(NodeId id) {
        if (const auto known = ends.find(id); known != ends.end()) return known->second;
        const Loop loop = graph.loop(LoopId{graph[id].payload});
        std::vector<NodeId> values(graph.args(id).begin(), graph.args(id).end());
        for (NodeId &value : values) value = of(value);
        const NodeId count = of(loop.count);
        std::vector<NodeId> &out = ends[id];
        if (!graph.is_constant(count)) return out;
        const int iterations = static_cast<int>(graph.constant_of(count).value[0]);
        NodeId goes_on; // all conditions so far
        for (int i = 0; i < iterations; ++i) {
            if (left == 0) {
                all = false;
                return ends[id] = {};
            }
            std::vector<NodeId> next = after_iteration(graph, loop, i, values);
            if (loop.condition) {
                const NodeId here = of(in_iteration(graph, loop, i, values, loop.condition));
                goes_on = goes_on ? graph.make(Op::And, Type::Bool, {goes_on, here}) : here;
            }
            for (std::size_t k = 0; k < next.size(); ++k) {
                next[k] = of(next[k]);
                if (goes_on)
                    next[k] =
                        graph.make(Op::Select, graph[next[k]].type, {goes_on, next[k], values[k]});
            }
            values = std::move(next);
        }
        return ends[id] = std::move(values);
    }
    std::optional<NodeId> result_of_loop(NodeId id, const Node &node) {
        if (!loops || (node.op != Op::Loop && node.op != Op::LoopResult)) return {};
        const NodeId loop = node.op == Op::Loop ? id : graph.arg(id, 0);
        const std::vector<NodeId> &values = written(loop);
        if (values.empty()) return {};
        return values[node.op == Op::Loop ? 0 : node.payload];
    }

    // A row of a table by a number that is known.
    std::optional<NodeId> row_of(const Node &node, NodeId row) const {
        if (!loops || node.op != Op::TableRead || !graph.is_constant(row)) return {};
        const Table &table = graph.table(table_of(node.payload));
        const double at = graph.constant_of(row).value[0];
        if (!(at >= 0 && at < table.rows)) return {};
        const std::size_t first = static_cast<std::size_t>(at) * std::size_t(table.stride) +
                                  std::size_t(column_of(node.payload));
        Constant out{node.type};
        for (std::size_t i = 0; i < std::size_t(components(node.type)); ++i)
            out.value[i] = double(table.data[first + i]);
        return graph.constant(out);
    }

    NodeId of(NodeId id) {
        if (const auto known = done.find(id); known != done.end()) return known->second;
        if (left == 0) {
            all = false;
            return id;
        }
        --left;
        const Node node = graph[id];
        if (const auto result = result_of_loop(id, node)) return done[id] = *result;
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        for (NodeId &arg : args) arg = of(arg);
        NodeId out = id;
        if (node.op == Op::Call)
            out = of(called(graph, FunctionId{node.payload}, args));
        else if (const auto row = row_of(node, args.empty() ? id : args[0]))
            out = *row;
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
    Inliner writer{graph, max_nodes};
    const NodeId out = writer.of(root);
    return {out, writer.all};
}

WithoutCalls without_loops(Graph &graph, NodeId root, std::size_t max_nodes) {
    Inliner writer{graph, max_nodes, true};
    const NodeId out = writer.of(root);
    return {out, writer.all};
}

namespace {

struct Balancer {
    Graph &graph;
    std::unordered_map<NodeId, int> uses{};
    std::unordered_map<NodeId, NodeId> done{};

    void count(NodeId root) {
        std::vector<NodeId> todo{root};
        while (!todo.empty()) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (++uses[id] > 1) continue;
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        }
    }
    bool chains(NodeId id) const {
        constexpr OpSet ops{Op::Add, Op::Min, Op::Max};
        return ops[graph[id].op] && graph[id].type == Type::Float;
    }
    // The terms of a chain, in order: what is used elsewhere is a term of its own.
    void terms(NodeId id, Op op, bool first, std::vector<NodeId> &out) {
        if (!chains(id) || graph[id].op != op || (!first && uses[id] > 1)) {
            out.push_back(of(id));
            return;
        }
        const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
        terms(a, op, false, out);
        terms(b, op, false, out);
    }
    NodeId tree(Op op, std::span<const NodeId> parts) {
        if (parts.size() == 1) return parts[0];
        const std::size_t half = parts.size() / 2;
        const NodeId left = tree(op, parts.first(half)), right = tree(op, parts.subspan(half));
        return graph.make(op, {left, right});
    }
    NodeId of(NodeId id) {
        if (const auto known = done.find(id); known != done.end()) return known->second;
        const Node node = graph[id];
        NodeId out = id;
        if (chains(id)) {
            std::vector<NodeId> parts;
            terms(id, node.op, true, parts);
            constexpr std::size_t few = 4;
            if (parts.size() > few) return done[id] = tree(node.op, parts);
        }
        if (node.count > 0) {
            std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
            for (NodeId &arg : args) arg = of(arg);
            out = graph.make(node.op, node.type, args, node.payload);
        }
        return done[id] = out;
    }
};

} // namespace

NodeId balanced(Graph &graph, NodeId root) {
    Balancer balancer{graph};
    balancer.count(root);
    return balancer.of(root);
}

} // namespace fathom::ir
