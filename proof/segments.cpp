// With s = c g(share), g one of min, max and clamp by what does not vary, and share = e v.b, the
// Jacobian of v - b s is (I - t c e b b^T) J_v, t in 0..1: of norm at most max(1, |1 - c e b.b|).
#include "proof/segments.h"

#include "proof/continuity.h"

#include <algorithm>
#include <cmath>
#include <vector>

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

// |b|^2, where that is one number: of `normalize(…)` 1, or 0, of which nothing is moved.
std::optional<double> square_of(Graph &graph, NodeId b, NodeId square) {
    if (const auto number = graph.as_number(square)) return number;
    if (graph[b].op == Op::Normalize) return 1;
    return number_of(graph, square);
}

// The factors of a product of vectors, those of a Splat as scalars.
void take_factors(const Graph &graph, NodeId id, std::vector<NodeId> &factors) {
    const ir::Node node = graph[id];
    if (node.op == Op::Mul && factors.size() < 8) {
        take_factors(graph, graph.arg(id, 0), factors);
        take_factors(graph, graph.arg(id, 1), factors);
    } else if (node.op == Op::Splat) {
        take_factors(graph, graph.arg(id, 0), factors);
    } else {
        factors.push_back(id);
    }
}

// v - sign*along
std::optional<Moved> moved_by(Graph &graph, NodeId v, NodeId along, double sign) {
    std::vector<NodeId> factors;
    take_factors(graph, along, factors);
    const ir::Type type = graph[along].type;
    for (std::size_t i = 0; i < factors.size(); ++i) {
        if (graph[factors[i]].type != ir::Type::Float) continue;
        auto s = bent(graph, factors[i]);
        if (!s) continue;
        s->by *= sign;
        NodeId b; // the other factors; numbers go to s
        const auto splat = [&](NodeId scalar) { return graph.make(Op::Splat, type, {scalar}); };
        for (std::size_t k = 0; k < factors.size(); ++k) {
            if (k == i) continue;
            if (const auto number = even(graph, factors[k])) {
                s->by *= *number;
                continue;
            }
            const bool is_scalar = graph[factors[k]].type == ir::Type::Float;
            const NodeId factor = is_scalar ? splat(factors[k]) : factors[k];
            b = b ? graph.mul(b, factor) : factor;
        }
        if (!b) b = splat(graph.number(1));
        const NodeId inner = graph.make(Op::Dot, {v, b}), square = graph.make(Op::Dot, {b, b});
        const NodeId signed_inner = s->by == -1 ? graph.make(Op::Neg, {inner}) : inner;
        if (std::fabs(s->by) == 1 && (same(graph, graph.mul(s->share, square), signed_inner) ||
                                      same(graph, s->share, graph.div(signed_inner, square))))
            return Moved{v, b, 1};
        const auto size = square_of(graph, b, square);
        if (!size || !(*size > 0)) continue;
        for (const double e : {1.0, 0.5, 2.0, 1 / *size, 2 / *size})
            if (same(graph, s->share, graph.mul(graph.number(e), inner)))
                return Moved{v, b, std::max(1.0, std::fabs(1 - s->by * e * *size) * (1 + 1e-12))};
    }
    return {};
}

// v - b m, component by component: those of m are numbers, or g(v_i / b_i), which moves v_i alone, so
// that the Jacobian is a diagonal of 0..1 times J_v.
std::optional<Moved> moved_by_components(Graph &graph, NodeId v, NodeId along, double sign) {
    if (graph[along].op != Op::Mul) return {};
    for (int k = 0; k < 2; ++k) {
        const NodeId m = graph.arg(along, k), b = graph.arg(along, 1 - k);
        if (graph[m].op != Op::Make || graph[b].type != graph[m].type) continue;
        bool moves = true;
        for (int i = 0; moves && i < int(graph[m].count); ++i) {
            const NodeId part = graph.arg(m, i);
            if (graph.is_constant(part)) continue;
            const auto s = bent(graph, part);
            moves = s && graph[part].type == ir::Type::Float && s->by == sign &&
                    same(graph, s->share, graph.div(graph.component(v, i), graph.component(b, i)));
        }
        if (moves) return Moved{v, b, 1};
    }
    return {};
}

} // namespace

std::optional<Moved> moved_along(Graph &graph, NodeId vector) {
    const ir::Node node = graph[vector];
    if ((node.op != Op::Sub && node.op != Op::Add) || !ir::is_vector(node.type)) return {};
    for (int side = 0; side < (node.op == Op::Add ? 2 : 1); ++side) {
        const NodeId v = graph.arg(vector, side);
        const double sign = node.op == Op::Sub ? 1 : -1;
        const NodeId along = graph.arg(vector, 1 - side);
        if (auto moved = moved_by(graph, v, along, sign)) return moved;
        if (auto moved = moved_by_components(graph, v, along, sign)) return moved;
    }
    return {};
}

} // namespace fathom::proof
