#include "proof/exact.h"

#include "proof/continuity.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::proof {

using ir::Graph;
using ir::NodeId;
using ir::Op;

namespace {

bool is_whole(const Graph &graph, NodeId atom) {
    constexpr ir::OpSet rounds{Op::Floor, Op::Ceil, Op::Round, Op::Trunc};
    const ir::Node node = graph[atom];
    return rounds[node.op] ||
           (node.op == Op::ToFloat && graph[graph.arg(atom, 0)].type == ir::Type::Int);
}

} // namespace

bool is_exact(const Graph &graph, const Polynomial &sum) {
    constexpr double few = 0x1p20;
    return std::ranges::all_of(sum, [&](const auto &term) {
        const auto &[factors, c] = term;
        return std::floor(c * few) == c * few && std::fabs(c) < few &&
               std::ranges::all_of(factors, [&](NodeId f) { return is_whole(graph, f); });
    });
}

bool is_exact(Graph &graph, NodeId scalar) {
    const auto sum = polynomial(graph, scalar);
    return sum && is_exact(graph, *sum);
}

bool single_is_far_off(const Graph &graph, NodeId number) {
    constexpr std::size_t max_nodes_of_number = 200;
    constexpr ir::OpSet near{Op::Const, Op::Param, Op::Time,  Op::Point,   Op::Add,   Op::Sub,
                             Op::Mul,   Op::Div,   Op::Neg,   Op::Abs,     Op::Min,   Op::Max,
                             Op::Clamp, Op::Make,  Op::Splat, Op::Swizzle, Op::Dot,   Op::MatMul,
                             Op::ToInt, Op::Mix,   Op::Floor, Op::Ceil,    Op::Round, Op::Trunc};
    std::vector<NodeId> todo{number};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second || is_whole(graph, id)) continue;
        if (!near[graph[id].op] || seen.size() > max_nodes_of_number) return true;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return false;
}

bool exactly_same(Graph &graph, NodeId a, NodeId b) {
    if (a == b) return true;
    const ir::Type type = graph[a].type;
    if (type != graph[b].type || (type != ir::Type::Float && !ir::is_vector(type))) return false;
    for (int i = 0; i < ir::components(type); ++i) {
        const NodeId x = component_of(graph, a, i), y = component_of(graph, b, i);
        if (x == y) continue;
        const auto p = polynomial(graph, x), q = polynomial(graph, y);
        if (!p || !q || !is_exact(graph, *p) || !is_exact(graph, *q)) return false;
        Polynomial gap = *p;
        for (const auto &[factors, c] : *q) gap[factors] -= c;
        if (std::ranges::any_of(gap, [](const auto &term) { return term.second != 0; }))
            return false;
    }
    return true;
}

} // namespace fathom::proof
