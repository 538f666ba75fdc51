#include "ir/passes/exponential_ratios.h"

#include <array>
#include <cmath>
#include <optional>

namespace fathom::ir {
namespace {

constexpr double ln_2 = 0.6931471805599453;

// exp(u), or exp2(u).
struct Exponential {
    Op op;
    NodeId u;
    double base() const { return op == Op::Exp2 ? ln_2 : 1; } // the logarithm of the base
};
std::optional<Exponential> exponential(const Graph &graph, NodeId id) {
    if (graph[id].type != Type::Float) return {};
    if (graph[id].op != Op::Exp && graph[id].op != Op::Exp2) return {};
    return Exponential{graph[id].op, graph.arg(id, 0)};
}

// u/tanh(u) is 1 at 0, and not 0/0: u is taken no nearer to it than 0.002, where it is 1 + 1.4e-6,
// and where single precision has half of the digits of tanh(u) on all graphics cards.
NodeId hyperbolic_ratio(Graph &graph, NodeId u) {
    constexpr double least = 2e-3;
    const NodeId minimum = graph.number(least);
    if (graph[u].op == Op::Max && (graph.arg(u, 0) == minimum || graph.arg(u, 1) == minimum))
        return {};
    const NodeId off = graph.make(Op::Max, {graph.make(Op::Abs, {u}), minimum});
    return graph.div(off, graph.make(Op::Tanh, {off}));
}

// exp(u) where id is 1 - exp(u), with `sign` 1, or exp(u) - 1, with -1.
std::optional<Exponential> one_less(const Graph &graph, NodeId id, double &sign) {
    const Node node = graph[id];
    if (node.op != Op::Sub && node.op != Op::Add) return {};
    for (int i = 0; i < 2; ++i) {
        const auto number = graph.as_number(graph.arg(id, 1 - i));
        const auto found = exponential(graph, graph.arg(id, i));
        if (!number || !found) continue;
        sign = node.op == Op::Sub && i == 1 ? 1 : -1;
        const double one = node.op == Op::Add ? -1 : 1;
        if (*number == one) return found;
    }
    return {};
}

// What x is times 1/u where u is a multiple of x by what is there to be read; none without it.
NodeId over_exponent(Graph &graph, NodeId x, NodeId u, int depth = 6) {
    if (depth == 0) return {};
    if (x == u) return graph.number(1);
    const Node node = graph[u];
    if (node.op == Op::Neg) {
        const NodeId inner = over_exponent(graph, x, graph.arg(u, 0), depth - 1);
        return inner ? graph.neg(inner) : NodeId{};
    }
    if (node.op == Op::Div) {
        const NodeId inner = over_exponent(graph, x, graph.arg(u, 0), depth - 1);
        return inner ? graph.mul(graph.arg(u, 1), inner) : NodeId{};
    }
    if (node.op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (const NodeId inner = over_exponent(graph, x, graph.arg(u, i), depth - 1))
                return graph.div(inner, graph.arg(u, 1 - i));
    return {};
}

// With u = 2 v, u/(1 - exp(u)) = v - v/tanh(v).
NodeId sigmoid_ratio(Graph &graph, NodeId above, NodeId below) {
    double sign = 1;
    const auto found = one_less(graph, below, sign);
    if (!found) return {};
    bool negative = false;
    if (graph[above].op == Op::Neg) above = graph.arg(above, 0), negative = true;
    const NodeId factor = over_exponent(graph, above, found->u);
    if (!factor) return {};
    const NodeId v = graph.mul(graph.number(found->base() / 2), found->u);
    const NodeId ratio = hyperbolic_ratio(graph, v);
    if (!ratio) return {};
    const double by = (negative ? -sign : sign) / found->base();
    return graph.mul({graph.mul(graph.number(by), factor), graph.sub(v, ratio)});
}

// u - v, with a factor or divisor of both before it.
NodeId difference(Graph &graph, NodeId u, NodeId v) {
    const Node a = graph[u], b = graph[v];
    if (a.op == b.op && a.op == Op::Neg)
        return graph.neg(difference(graph, graph.arg(u, 0), graph.arg(v, 0)));
    if (a.op == b.op && a.op == Op::Div && graph.arg(u, 1) == graph.arg(v, 1))
        return graph.div(difference(graph, graph.arg(u, 0), graph.arg(v, 0)), graph.arg(u, 1));
    if (a.op == b.op && a.op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 2; ++j)
                if (graph.arg(u, i) == graph.arg(v, j))
                    return graph.mul(graph.arg(u, i),
                                     difference(graph, graph.arg(u, 1 - i), graph.arg(v, 1 - j)));
    return graph.sub(u, v);
}

// x where id is x exp(u), exp(u) = `factor`; none where it is not.
NodeId weighed_by(Graph &graph, NodeId id, NodeId factor) {
    if (graph[id].op != Op::Mul) return {};
    for (int i = 0; i < 2; ++i)
        if (graph.arg(id, i) == factor) return graph.arg(id, 1 - i);
    return {};
}

// x + (y - x)/(1 + exp(u - v)), of which an infinite exponential is right.
NodeId mean_by_exponentials(Graph &graph, NodeId above, NodeId below) {
    if (graph[above].op != Op::Add || graph[below].op != Op::Add) return {};
    const std::array weights{graph.arg(below, 0), graph.arg(below, 1)};
    const auto u = exponential(graph, weights[0]), v = exponential(graph, weights[1]);
    if (!u || !v || u->op != v->op) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId x = weighed_by(graph, graph.arg(above, i), weights[0]),
                     y = weighed_by(graph, graph.arg(above, 1 - i), weights[1]);
        if (!x || !y || graph[x].type != Type::Float || graph[y].type != Type::Float) continue;
        const NodeId ratio = graph.make(u->op, {difference(graph, u->u, v->u)});
        return graph.add({x, graph.div({graph.sub(y, x), graph.add(graph.number(1), ratio)})});
    }
    return {};
}

} // namespace

NodeId exponential_ratio(Graph &graph, NodeId above, NodeId below) {
    if (graph[above].type != Type::Float || graph[below].type != Type::Float) return {};
    if (graph[below].op == Op::Tanh && graph.arg(below, 0) == above)
        return hyperbolic_ratio(graph, above);
    if (const NodeId sigmoid = sigmoid_ratio(graph, above, below)) return sigmoid;
    return mean_by_exponentials(graph, above, below);
}

} // namespace fathom::ir
