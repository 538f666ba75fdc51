#include "proof/exact.h"

#include "proof/continuity.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
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

bool is_of_few_bits(double number) {
    constexpr double few = 0x1p20;
    return std::floor(number * few) == number * few && std::fabs(number) < few;
}

bool is_exact(const Graph &graph, const Polynomial &sum) {
    constexpr ir::OpSet one_of_them{Op::Abs, Op::Min, Op::Max, Op::Clamp}; // or its negative
    const auto is_atom = [&](NodeId f) {
        return is_whole(graph, f) || (one_of_them[graph[f].op] && is_made_whole(graph, f));
    };
    return std::ranges::all_of(sum, [&](const auto &term) {
        const auto &[factors, c] = term;
        return is_of_few_bits(c) && std::ranges::all_of(factors, is_atom);
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

bool is_made_whole(const Graph &graph, NodeId id, int depth) {
    constexpr int max_depth = 12;
    constexpr ir::OpSet keep{Op::Add, Op::Sub,   Op::Mul,  Op::Neg,  Op::Abs,     Op::Min,
                             Op::Max, Op::Clamp, Op::Sign, Op::Make, Op::Swizzle, Op::Splat};
    const ir::Node node = graph[id];
    if (graph.is_constant(id)) {
        const ir::Constant &c = graph.constant_of(id);
        for (int i = 0; i < ir::components(c.type); ++i)
            if (const double x = c.value[std::size_t(i)]; std::floor(x) != x) return false;
        return true;
    }
    if (node.type == ir::Type::Int || is_whole(graph, id)) return true;
    if (!keep[node.op] || depth > max_depth) return false;
    return std::ranges::all_of(graph.args(id),
                               [&](NodeId a) { return is_made_whole(graph, a, depth + 1); });
}

bool is_whole_power_of_two(const Graph &graph, NodeId id) {
    if (graph[id].op == Op::Splat) id = graph.arg(id, 0);
    if (!graph.is_constant(id)) return false;
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 0; i < ir::components(c.type); ++i) {
        int exponent = 0;
        if (std::frexp(c.value[std::size_t(i)], &exponent) != 0.5 || exponent < 1) return false;
    }
    return true;
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

namespace {

// n, where that many of `part` are the number in single precision, or all but what double precision
// loses; 0 where there is no such n of few digits.
double count_of(double part, double number) {
    constexpr double few = 64, rounding = 1e-15;
    const double n = std::round(number / part);
    if (n == 0) return 0;
    if (std::fabs(number / part - n) <= rounding * std::fabs(n)) return n;
    return std::fabs(n) <= few && float(number) == float(n * part) ? n : 0;
}

} // namespace

double half_turns(double angle) { return count_of(std::numbers::pi, angle); }

std::optional<double> of_quarter_turns(bool cosine, double angle) {
    const double n = count_of(std::numbers::pi / 2, angle);
    if (n == 0) return {};
    constexpr std::array<double, 4> sines{0, 1, 0, -1};
    const double at = n + (cosine ? 1 : 0);
    return sines[static_cast<std::size_t>(at - 4 * std::floor(at / 4))];
}

} // namespace fathom::proof
