// Of f = y + (x - y) h - k h (1 - h), the derivative by h is (x - y) - k (1 - 2 h), which is 0 for
// h = 1/2 + (y - x)/(2 k); at h = 0 and 1 h does not vary. So grad f = h grad x + (1 - h) grad y, a
// mean. With -k for k it is the maximum. The second form is the same function: where |x - y| < k,
// h^2/(4 k) = (k - |x - y|)^2/(4 k), and y + (x - y) h - k h (1 - h) with that h is the lesser less
// this.
#include "proof/smooth.h"

#include "proof/continuity.h"

#include <cmath>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

// The factors of a product, numbers apart; of x/n, x and 1/n.
struct Factored {
    double number = 1;
    std::vector<NodeId> factors;
};
void gather(Graph &graph, NodeId id, Factored &out) {
    constexpr std::size_t most = 32; // a factor may stand in both parts of another, again and again
    const ir::Node node = graph[id];
    if (out.factors.size() >= most) {
        out.factors.push_back(id);
    } else if (auto c = graph.as_number(id)) {
        out.number *= *c;
    } else if (node.op == Op::Mul) {
        gather(graph, graph.arg(id, 0), out);
        gather(graph, graph.arg(id, 1), out);
    } else if (node.op == Op::Neg) {
        out.number = -out.number;
        gather(graph, graph.arg(id, 0), out);
    } else if (node.op == Op::Div) {
        gather(graph, graph.arg(id, 0), out);
        const NodeId below = graph.arg(id, 1);
        if (auto c = graph.as_number(below); c && *c != 0)
            out.number /= *c;
        else
            out.factors.push_back(graph.div(graph.number(1), below));
    } else if (node.op == Op::Pow && graph.as_number(graph.arg(id, 1)) == 2.0) {
        gather(graph, graph.arg(id, 0), out);
        gather(graph, graph.arg(id, 0), out);
    } else {
        out.factors.push_back(id);
    }
}
// Takes one factor that equals `what` out; false where there is none.
bool take(Graph &graph, Factored &product, NodeId what) {
    for (auto it = product.factors.begin(); it != product.factors.end(); ++it)
        if (same(graph, *it, what)) {
            product.factors.erase(it);
            return true;
        }
    return false;
}
// x and 1/x leave each other.
void cancel(Graph &graph, Factored &product) {
    for (bool again = true; again;) {
        again = false;
        for (std::size_t i = 0; i < product.factors.size() && !again; ++i) {
            const NodeId f = product.factors[i];
            if (graph[f].op != Op::Div || graph.as_number(graph.arg(f, 0)) != 1.0) continue;
            Factored rest = product;
            rest.factors.erase(rest.factors.begin() + static_cast<std::ptrdiff_t>(i));
            again = take(graph, rest, graph.arg(f, 1));
            if (again) product = rest;
        }
    }
}
NodeId value(Graph &graph, const Factored &product, double by) {
    NodeId out = graph.number(product.number * by);
    for (NodeId f : product.factors) out = graph.mul(out, f);
    return out;
}

// x of max(x, 0), in either order.
std::optional<NodeId> above_zero(const Graph &graph, NodeId id) {
    if (graph[id].op != Op::Max) return {};
    for (int i = 0; i < 2; ++i)
        if (graph.as_number(graph.arg(id, i)) == 0.0) return graph.arg(id, 1 - i);
    return {};
}

// mix(y, x, h) - bulge
std::optional<Smooth> by_mix(Graph &graph, NodeId mix, const Factored &bulge) {
    const NodeId y = graph.arg(mix, 0), x = graph.arg(mix, 1), h = graph.arg(mix, 2);
    if (graph[h].op != Op::Clamp || graph.as_number(graph.arg(h, 1)) != 0.0 ||
        graph.as_number(graph.arg(h, 2)) != 1.0)
        return {};
    Factored rest = bulge;
    if (!take(graph, rest, h) || !take(graph, rest, graph.sub(graph.number(1), h))) return {};
    const NodeId k = value(graph, rest, 1), half = graph.number(0.5), way = graph.sub(y, x);
    for (NodeId slope : {graph.div(graph.mul(half, way), k), graph.mul(half, graph.div(way, k)),
                         graph.div(way, graph.mul(graph.number(2), k))})
        if (same(graph, graph.arg(h, 0), graph.add(half, slope)))
            return Smooth{x, y, k, k, false, true, false};
    return {};
}

// min(x, y) - h h c, or with the greater
std::optional<Smooth> by_least(Graph &graph, NodeId extremum, const Factored &bulge) {
    const NodeId x = graph.arg(extremum, 0), y = graph.arg(extremum, 1);
    Factored rest = bulge;
    NodeId h;
    for (NodeId f : rest.factors)
        if (above_zero(graph, f)) h = f;
    if (!h || !take(graph, rest, h) || !take(graph, rest, h)) return {};
    const bool cubic = take(graph, rest, h); // c*h*h*h with c = 1/(6 k k)
    // h = max(k - |x - y|, 0)
    const NodeId inner = *above_zero(graph, h);
    for (NodeId way : {graph.sub(x, y), graph.sub(y, x)}) {
        const NodeId size = graph.make(Op::Abs, {way});
        const NodeId k = in_one_form(graph, graph.add(inner, size));
        if (graph.reads(k).point) continue;
        Factored by = rest;
        by.number *= cubic ? 6 : 4;
        gather(graph, k, by);
        if (cubic) gather(graph, k, by);
        cancel(graph, by);
        if (by.factors.empty() && std::fabs(by.number - 1) < 1e-12)
            return Smooth{x, y, k, k, false, !graph.as_number(k), true, cubic};
        if (cubic) continue;
        // c may be 1/(4 max(k, tiny)): no more than 1/(4 k), and the same for all points; never 1/0
        // where tiny is a number above 0
        for (NodeId f : rest.factors) {
            if (rest.factors.size() != 1 || rest.number != 1 || graph[f].op != Op::Div) continue;
            Factored below;
            gather(graph, graph.arg(f, 1), below);
            if (below.number != 4 || below.factors.size() != 1) continue;
            const NodeId most = below.factors[0];
            if (graph[most].op == Op::Max)
                for (int i = 0; i < 2; ++i)
                    if (same(graph, graph.arg(most, i), k)) {
                        const auto tiny = graph.as_number(graph.arg(most, 1 - i));
                        return Smooth{x, y, k, most, false, !(tiny && *tiny > 0), true};
                    }
        }
    }
    return {};
}

} // namespace

std::optional<Smooth> smooth_extremum(Graph &graph, NodeId sum) {
    const ir::Node node = graph[sum];
    if ((node.op != Op::Add && node.op != Op::Sub) || node.type != ir::Type::Float) return {};
    for (int i = 0; i < (node.op == Op::Add ? 2 : 1); ++i) {
        const NodeId from = graph.arg(sum, i), less = graph.arg(sum, 1 - i);
        Factored bulge;
        gather(graph, less, bulge);
        if (node.op == Op::Add) bulge.number = -bulge.number;
        const Op op = graph[from].op;
        if (op == Op::Mix)
            if (auto s = by_mix(graph, from, bulge)) return s;
        if (op == Op::Min)
            if (auto s = by_least(graph, from, bulge)) return s;
        if (op == Op::Max) {
            bulge.number = -bulge.number;
            if (auto s = by_least(graph, from, bulge)) {
                s->greater = true;
                return s;
            }
        }
    }
    return {};
}

std::optional<LogSum> log_sum(Graph &graph, NodeId sum) {
    if (graph[sum].op != Op::Add || graph[sum].type != ir::Type::Float) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId most = graph.arg(sum, i), rest = graph.arg(sum, 1 - i);
        const Op log = graph[rest].op;
        if (graph[most].op != Op::Max || (log != Op::Log && log != Op::Log2)) continue;
        const NodeId a = graph.arg(most, 0), b = graph.arg(most, 1);
        for (NodeId way : {graph.sub(a, b), graph.sub(b, a)}) {
            const NodeId less = graph.make(log == Op::Log ? Op::Exp : Op::Exp2,
                                           {graph.neg(graph.make(Op::Abs, {way}))});
            if (graph.make(log, {graph.add(graph.number(1), less)}) == rest ||
                graph.make(log, {graph.add(less, graph.number(1))}) == rest)
                return LogSum{a, b, log};
        }
    }
    return {};
}

} // namespace fathom::proof
