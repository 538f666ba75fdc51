#include "proof/exact.h"

#include "proof/continuity.h"

#include <algorithm>
#include <cmath>

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
