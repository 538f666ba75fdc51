#include "proof/majorants.h"

#include <unordered_set>
#include <vector>

namespace fathom::proof {
namespace {

using ir::NodeId;
using ir::Op;

constexpr std::size_t max_nodes_of_quotient = 2'000; // looked at

// What stands below `root`: all of it, or what goes by sums, products, choices and parts alone.
std::vector<NodeId> terms_below(const ir::Graph &graph, NodeId root, bool all) {
    constexpr ir::OpSet through{Op::Mul, Op::Div,   Op::Add,  Op::Sub,     Op::Select,
                                Op::Neg, Op::Abs,   Op::Make, Op::Swizzle, Op::Min,
                                Op::Max, Op::Clamp, Op::Splat};
    std::vector<NodeId> todo{root}, out;
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() < max_nodes_of_quotient) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !graph.reads(id).point || !seen.insert(id).second) continue;
        out.push_back(id);
        if (all || through[graph[id].op])
            todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return out;
}

NodeId unsplat(const ir::Graph &graph, NodeId id) {
    return graph[id].op == Op::Splat ? graph.arg(id, 0) : id;
}

} // namespace

bool are_scaled_alike(const ir::Graph &graph, NodeId numerator, NodeId divisor, Work &work) {
    std::unordered_set<NodeId> factors{unsplat(graph, divisor)};
    const auto is_product = [&](NodeId id) {
        return graph[id].op == Op::Mul || graph[id].op == Op::Div;
    };
    for (const NodeId id : terms_below(graph, divisor, false))
        if (is_product(id))
            for (const NodeId arg : graph.args(id))
                if (graph.reads(arg).point) factors.insert(unsplat(graph, arg));
    const std::vector<NodeId> above = terms_below(graph, numerator, true);
    work.take(above.size() / 8);
    for (const NodeId id : above)
        if (is_product(id))
            for (const NodeId arg : graph.args(id))
                if (graph.reads(arg).point && factors.contains(unsplat(graph, arg))) return true;
    return false;
}

bool divides_by_scale(const ir::Graph &graph, NodeId field, Work &work) {
    for (const NodeId id : terms_below(graph, field, true))
        if (graph[id].op == Op::Div && graph.reads(graph.arg(id, 1)).point &&
            are_scaled_alike(graph, graph.arg(id, 0), graph.arg(id, 1), work))
            return true;
    return false;
}

bool may_divide_by_scale(const ir::Graph &graph, NodeId field) {
    std::vector<NodeId> todo{field};
    std::unordered_set<NodeId> seen;
    bool loops = false, divides = false;
    while (!todo.empty() && seen.size() < max_nodes_of_quotient) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        if (node.op == Op::Div) {
            const ir::Graph::Reads reads = graph.reads(graph.arg(id, 1));
            divides = divides || reads.point || reads.free_vars;
        }
        if (node.op == Op::Loop) {
            loops = true;
            const auto &next = graph.loop(ir::LoopId{node.payload}).next;
            todo.insert(todo.end(), next.begin(), next.end());
        }
        if (node.op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{node.payload}).result);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return loops && divides;
}

} // namespace fathom::proof
