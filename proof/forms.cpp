// Forms are found on the nodes as written, factors in either order; nothing is expanded here.
#include "proof/forms.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Graph;

std::optional<double> number(Graph &graph, NodeId id) {
    const ir::Node &node = graph[id];
    if (node.op == Op::Splat) return number(graph, graph.arg(id, 0));
    if (node.op == Op::Neg) {
        if (auto x = number(graph, graph.arg(id, 0))) return -*x;
        return {};
    }
    if (node.op != Op::Const) return {};
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 1; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
    return c.value[0];
}

namespace {

bool all_zero(Graph &graph, NodeId id) {
    if (!graph.is_constant(id)) return false;
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 0; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != 0) return false;
    return true;
}

// x of max(x, 0), or of min(x, 0).
std::optional<NodeId> above_zero(Graph &graph, Op op, NodeId id) {
    if (graph[id].op != op) return {};
    for (int i = 0; i < 2; ++i)
        if (all_zero(graph, graph.arg(id, i))) return graph.arg(id, 1 - i);
    return {};
}
void greatest_of(Graph &graph, NodeId id, std::vector<NodeId> &out) {
    if (graph[id].op == Op::Max && graph[id].type == ir::Type::Float) {
        greatest_of(graph, graph.arg(id, 0), out);
        greatest_of(graph, graph.arg(id, 1), out);
    } else if (out.size() < 4) {
        out.push_back(id);
    }
}

bool is_half(Graph &graph, NodeId half, NodeId whole) {
    auto a = number(graph, half), b = number(graph, whole);
    if (a && b) return *a == *b / 2;
    if (graph[half].op == Op::Splat && graph[whole].op == Op::Splat)
        return is_half(graph, graph.arg(half, 0), graph.arg(whole, 0));
    if (graph[half].op == Op::Const && graph[whole].op == Op::Const) {
        const auto &x = graph.constant_of(half), &y = graph.constant_of(whole);
        for (int i = 0; i < ir::components(x.type); ++i)
            if (x.value[static_cast<std::size_t>(i)] != y.value[static_cast<std::size_t>(i)] / 2)
                return false;
        return x.type == y.type;
    }
    if (graph[half].op == Op::Div && graph.arg(half, 0) == whole &&
        number(graph, graph.arg(half, 1)) == 2.0)
        return true;
    if (graph[half].op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (graph.arg(half, i) == whole && number(graph, graph.arg(half, 1 - i)) == 0.5)
                return true;
    return false;
}

// The parts whose squares the sum is made of; a constant c >= 0 is the square of its root.
bool squares(Graph &graph, NodeId sum, std::vector<NodeId> &parts) {
    const ir::Node node = graph[sum];
    if (node.op == Op::Add)
        return squares(graph, graph.arg(sum, 0), parts) && squares(graph, graph.arg(sum, 1), parts);
    if ((node.op == Op::Mul || node.op == Op::Dot) && graph.arg(sum, 0) == graph.arg(sum, 1)) {
        parts.push_back(graph.arg(sum, 0));
        return true;
    }
    if (node.op == Op::Pow && number(graph, graph.arg(sum, 1)) == 2.0) {
        parts.push_back(graph.arg(sum, 0));
        return true;
    }
    if (auto c = graph.as_number(sum); c && *c >= 0) {
        parts.push_back(graph.number(std::sqrt(*c)));
        return true;
    }
    return false;
}

} // namespace

std::optional<WaveParts> wave(Graph &graph, NodeId id) {
    const ir::Node node = graph[id]; // a copy: nodes are added below
    if (node.op != Op::Sub && node.op != Op::Add) return {};
    NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
    auto less_half = [&](NodeId part, NodeId m) {
        if (node.op == Op::Sub) return is_half(graph, part, m);
        if (graph[part].op == Op::Neg) return is_half(graph, graph.arg(part, 0), m);
        auto x = number(graph, part), y = number(graph, m);
        return x && y && *x == -*y / 2;
    };
    for (int i = 0; i < (node.op == Op::Add ? 2 : 1); ++i, std::swap(a, b)) {
        if (graph[a].op == Op::Mod && less_half(b, graph.arg(a, 1))) {
            NodeId m = graph.arg(a, 1);
            // x % m - m/2 = w(x - m/2), w the wave that passes through 0 at 0.
            return WaveParts{graph.sub(graph.arg(a, 0), node.op == Op::Sub ? b : graph.neg(b)), m};
        }
        if (graph[a].op == Op::Fract) {
            auto half = number(graph, b);
            if (half && *half == (node.op == Op::Sub ? 0.5 : -0.5)) {
                NodeId one = graph.number(1);
                if (ir::components(node.type) > 1) one = graph.splat(one, node.type);
                return WaveParts{
                    graph.sub(graph.arg(a, 0), graph.splat(graph.number(0.5), node.type)), one};
            }
        }
    }
    if (node.op == Op::Sub && graph[b].op == Op::Round && graph.arg(b, 0) == a)
        return WaveParts{a, graph.splat(graph.number(1), node.type)};
    if (node.op == Op::Sub && graph[b].op == Op::Mul)
        for (int i = 0; i < 2; ++i) {
            NodeId m = graph.arg(b, i), r = graph.arg(b, 1 - i);
            if (graph[r].op != Op::Round) continue;
            NodeId q = graph.arg(r, 0);
            if (graph[q].op == Op::Div && graph.arg(q, 0) == a && graph.arg(q, 1) == m)
                return WaveParts{a, m};
            auto step = number(graph, m); // x/m may have become x*(1/m)
            if (step && graph[q].op == Op::Mul)
                for (int k = 0; k < 2; ++k) {
                    auto inverse = number(graph, graph.arg(q, 1 - k));
                    if (graph.arg(q, k) == a && inverse && *inverse * *step == 1)
                        return WaveParts{a, m};
                }
        }
    return {};
}

std::optional<std::vector<NodeId>> norm_parts(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type != ir::Type::Float) return {};
    std::vector<NodeId> parts;
    bool root =
        node.op == Op::Sqrt || (node.op == Op::Pow && number(graph, graph.arg(id, 1)) == 0.5);
    if (root && squares(graph, graph.arg(id, 0), parts)) return parts;
    return {};
}

std::optional<NodeId> corner(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Add || graph[id].type != ir::Type::Float) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId length = graph.arg(id, i), inside = graph.arg(id, 1 - i);
        if (graph[length].op != Op::Length || graph[inside].op != Op::Min) continue;
        const auto v = above_zero(graph, Op::Max, graph.arg(length, 0)),
                   most = above_zero(graph, Op::Min, inside);
        if (!v || !most) continue;
        std::vector<NodeId> found, wanted;
        greatest_of(graph, *most, found);
        for (int c = 0; c < ir::components(graph[*v].type); ++c)
            wanted.push_back(graph.component(*v, c));
        std::sort(found.begin(), found.end());
        std::sort(wanted.begin(), wanted.end());
        if (found == wanted) return v;
    }
    return {};
}

std::optional<OddPowerParts> odd_power(Graph &graph, NodeId id) {
    if (graph[id].op != Op::Mul) return {};
    for (int i = 0; i < 2; ++i) {
        const NodeId x = graph.arg(id, i), power = graph.arg(id, 1 - i);
        if (graph[power].op != Op::Pow || graph[graph.arg(power, 0)].op != Op::Abs) continue;
        const NodeId exponent = graph.arg(power, 1);
        const auto c = number(graph, exponent);
        if (graph.arg(graph.arg(power, 0), 0) == x && c && *c > 0)
            return OddPowerParts{x, exponent};
    }
    return {};
}

} // namespace fathom::proof
