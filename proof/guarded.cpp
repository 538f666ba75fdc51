#include "proof/guarded.h"

#include "ir/passes/walk.h"
#include "proof/ellipsoids.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

constexpr std::size_t most_nodes = 2'000, most_orders = 16;

// number <= limit or number >= limit, where limit does not vary with the point.
struct Order {
    NodeId number, limit;
    bool at_least;
};

// The orders that a condition says where it holds, or does not.
std::vector<Order> orders_of(const Graph &graph, NodeId condition, bool holds) {
    std::vector<Order> out;
    std::vector<std::pair<NodeId, bool>> todo{{condition, holds}};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() < most_orders) {
        const auto [id, is_true] = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const ir::Node node = graph[id];
        if (node.op == Op::Not) todo.emplace_back(graph.arg(id, 0), !is_true);
        if (node.op == (is_true ? Op::And : Op::Or))
            for (NodeId a : graph.args(id)) todo.emplace_back(a, is_true);
        if (node.op != Op::Less && node.op != Op::LessEqual) continue;
        const NodeId less = graph.arg(id, 0), more = graph.arg(id, 1);
        if (graph[less].type != ir::Type::Float) continue;
        if (!graph.reads(more).point) out.push_back({less, more, !is_true});
        if (!graph.reads(less).point) out.push_back({more, less, is_true});
    }
    return out;
}

// The argument in which an op has a pole or an end of what it takes; -1 without one.
int edged_argument(Op op) {
    constexpr ir::OpSet of_first{Op::Sqrt, Op::InverseSqrt, Op::Log, Op::Log2, Op::Pow};
    return op == Op::Div ? 1 : of_first[op] ? 0 : -1;
}

// A number with its bounds in its place, wherever it stands in an expression.
NodeId with_bounds(Graph &graph, NodeId root, const std::vector<Order> &orders, Work &work) {
    constexpr std::size_t most_below = 48;
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> below;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!below.insert(id).second) continue;
        work.take(1);
        if (below.size() > most_below) return root;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    ir::Substitution kept;
    for (const Order &order : orders) {
        if (!below.contains(order.number)) continue;
        const auto known = kept.find(order.number);
        kept[order.number] =
            graph.make(order.at_least ? Op::Max : Op::Min,
                       {known == kept.end() ? order.number : known->second, order.limit});
    }
    return kept.empty() ? root : ir::substitute(graph, root, kept);
}

// An ellipsoid to first order where its k0 is at least 1.
std::optional<NodeId> outside(Graph &graph, NodeId id, const std::vector<Order> &orders) {
    const Op op = graph[id].op;
    if ((op != Op::Div && op != Op::Mul) || graph[id].type != ir::Type::Float) return {};
    const auto is_size = [&](const Order &order) {
        return order.at_least && graph[order.number].op == Op::Length &&
               graph.as_number(order.limit) == 1.0;
    };
    if (std::ranges::none_of(orders, is_size)) return {};
    const auto found = ellipsoid(graph, id);
    if (!found) return {};
    for (const Order &order : orders)
        if (is_size(order) && order.number == found->k0) return kept_outside(graph, *found);
    return {};
}

} // namespace

bool is_never_negative(const Graph &graph, NodeId id, int depth) {
    constexpr ir::OpSet sizes{Op::Length, Op::Abs, Op::Exp, Op::Exp2, Op::Sqrt},
        by_all{Op::Add, Op::Min, Op::Select, Op::Clamp, Op::Div, Op::Mul, Op::Splat};
    const ir::Node node = graph[id];
    if (graph.is_constant(id)) {
        const auto numbers = graph.constant_of(id).value;
        const int count = ir::components(node.type);
        return std::all_of(numbers.begin(), numbers.begin() + count,
                           [](double number) { return number >= 0; });
    }
    if (sizes[node.op]) return true;
    if ((node.op == Op::Mul || node.op == Op::Dot) && graph.arg(id, 0) == graph.arg(id, 1))
        return true;
    if (node.op == Op::Pow) { // 0 below 0 where the exponent is not whole
        const auto exponent = graph.as_number(graph.arg(id, 1));
        if (exponent && std::fmod(*exponent, 2) != 1 && std::fmod(*exponent, 2) != -1) return true;
        return depth > 0 && is_never_negative(graph, graph.arg(id, 0), depth - 1);
    }
    if (depth == 0 || (!by_all[node.op] && node.op != Op::Max)) return false;
    const int first = node.op == Op::Select || node.op == Op::Clamp ? 1 : 0;
    for (int i = first; i < int(node.count); ++i)
        if (is_never_negative(graph, graph.arg(id, i), depth - 1) == (node.op == Op::Max))
            return node.op == Op::Max;
    return node.op != Op::Max;
}

NodeId on_its_side(Graph &graph, NodeId condition, bool holds, NodeId arm, Work &work) {
    const std::vector<Order> orders = orders_of(graph, condition, holds);
    if (orders.empty()) return arm;
    ir::Substitution kept;
    std::vector<NodeId> todo{arm};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        work.take(1);
        if (seen.size() > most_nodes) return arm;
        const ir::Node node = graph[id];
        if (const auto kept_node = outside(graph, id, orders)) {
            kept[id] = *kept_node;
            continue;
        }
        const int edged = edged_argument(node.op);
        std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        todo.insert(todo.end(), args.begin(), args.end());
        if (edged < 0) continue;
        NodeId &at = args[static_cast<std::size_t>(edged)];
        const bool splat = graph[at].op == Op::Splat;
        NodeId number = splat ? graph.arg(at, 0) : at;
        const NodeId before = number;
        for (const Order &order : orders)
            if (order.number == before)
                number = graph.make(order.at_least ? Op::Max : Op::Min, {number, order.limit});
        // Forms that such a root is part of would not be seen with other numbers in it.
        if (number == before && graph[number].type == ir::Type::Float &&
            !is_never_negative(graph, number))
            number = with_bounds(graph, number, orders, work);
        if (number == before) continue;
        at = splat ? graph.make(Op::Splat, graph[at].type, {number}) : number;
        kept[id] = graph.make(node.op, node.type, args, node.payload);
    }
    return kept.empty() ? arm : ir::substitute(graph, arm, kept);
}

} // namespace fathom::proof
