// With s = c g(share), g one of min, max and clamp by what does not vary, and share = e v.b, the
// Jacobian of v - b s is (I - t c e b b^T) J_v, t in 0..1: of norm at most max(1, |1 - c e b.b|).
#include "proof/segments.h"

#include "proof/continuity.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// A scalar as a number times min, max or clamp; the argument of these that varies with the point.
struct Bent {
    double by = 1;
    NodeId share;
};
std::optional<Bent> bent(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.op == Op::Neg || node.op == Op::Mul)
        for (int i = 0; i < int(node.count); ++i) {
            const auto number =
                node.op == Op::Neg ? std::optional(-1.0) : graph.as_number(graph.arg(id, 1 - i));
            if (!number) continue;
            auto inner = bent(graph, graph.arg(id, i));
            if (inner) inner->by *= *number;
            return inner;
        }
    if (node.op != Op::Min && node.op != Op::Max && node.op != Op::Clamp) return {};
    Bent out;
    for (int i = 0; i < int(node.count); ++i) {
        const NodeId arg = graph.arg(id, i);
        if (graph.is_constant(arg)) continue;
        if (out.share || (node.op == Op::Clamp && i > 0)) return {};
        out.share = arg;
    }
    return out.share ? std::optional(out) : std::nullopt;
}

// The number that all components of a constant are.
std::optional<double> even(const Graph &graph, NodeId id) {
    if (!graph.is_constant(id)) return {};
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 1; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
    return c.value[0];
}

} // namespace

std::optional<Moved> moved_along(Graph &graph, NodeId vector) {
    const ir::Node node = graph[vector];
    if (node.op != Op::Sub || !ir::is_vector(node.type)) return {};
    const NodeId v = graph.arg(vector, 0);
    NodeId along = graph.arg(vector, 1);
    double by = 1; // in front of all of it
    for (bool again = true; again && graph[along].op == Op::Mul;) {
        again = false;
        for (int i = 0; i < 2 && !again; ++i)
            if (const auto number = even(graph, graph.arg(along, i))) {
                by *= *number;
                along = graph.arg(along, 1 - i);
                again = true;
            }
    }
    if (graph[along].op != Op::Mul) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId splat = graph.arg(along, i), b = graph.arg(along, 1 - i);
        if (graph[splat].op != Op::Splat) continue;
        auto s = bent(graph, graph.arg(splat, 0));
        if (!s) continue;
        s->by *= by;
        const NodeId inner = graph.make(Op::Dot, {v, b}), square = graph.make(Op::Dot, {b, b});
        if (s->by == 1 && (same(graph, graph.mul(s->share, square), inner) ||
                           same(graph, s->share, graph.div(inner, square))))
            return Moved{v, b, 1};
        const auto size = graph.as_number(square);
        if (!size || !(*size > 0)) continue;
        for (const double e : {1.0, 0.5, 2.0, 1 / *size, 2 / *size})
            if (same(graph, s->share, graph.mul(graph.number(e), inner)))
                return Moved{v, b, std::max(1.0, std::fabs(1 - s->by * e * *size) * (1 + 1e-12))};
    }
    return {};
}

} // namespace fathom::proof
