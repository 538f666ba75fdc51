// With k0 = |A v|, B = A A, weights m_i = (a_i v_i)^2/k0^2, the mean E of b_i by these, x_i = b_i/E and
// s = 1 - 1/k0, the gradient of k0 (k0 - 1)/k1 by v has the square 1 + s E[(x - 1)^2 (s x - 2)]. The
// mean of x is 1, so E[(x - 1)^2] <= (X - 1)(1 - x_0) for x in x_0 .. X.
#include "proof/ellipsoids.h"

#include "proof/continuity.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::Interval;
using ir::NodeId;
using ir::Op;
using ir::rounding::infinity;

constexpr std::size_t most_factors_of_ratio = 8;
constexpr double near_one = 1e-12, allowed = 1e-9; // of numbers that are rounded
constexpr int pieces_of_ratio = 32;

// A product as a number times powers.
struct FactorPowers {
    double by = 1;
    std::map<NodeId, int> powers;
};

bool gather_factors(const Graph &graph, NodeId id, int sign, FactorPowers &out) {
    std::vector<std::pair<NodeId, int>> todo{{id, sign}};
    std::size_t count = 0;
    while (!todo.empty()) {
        const auto [node, power] = todo.back();
        todo.pop_back();
        if (++count > 4 * most_factors_of_ratio) return false;
        if (const auto number = graph.as_number(node)) {
            if (*number == 0) return false;
            out.by = power > 0 ? out.by * *number : out.by / *number;
        } else if (graph[node].op == Op::Neg) {
            out.by = -out.by;
            todo.emplace_back(graph.arg(node, 0), power);
        } else if (graph[node].op == Op::Mul || graph[node].op == Op::Div) {
            const int below = graph[node].op == Op::Div ? -power : power;
            todo.emplace_back(graph.arg(node, 0), power);
            todo.emplace_back(graph.arg(node, 1), below);
        } else {
            out.powers[node] += power;
        }
    }
    std::erase_if(out.powers, [](const auto &one) { return one.second == 0; });
    return std::isfinite(out.by) && out.by != 0;
}

bool is_still_number(const Graph &graph, NodeId id) {
    const Graph::Reads reads = graph.reads(id);
    return !reads.point && !reads.free_vars && !reads.normal && !reads.direction;
}

NodeId product_of_powers(Graph &graph, const FactorPowers &of) {
    NodeId above = graph.number(of.by), below;
    for (const auto &[factor, power] : of.powers)
        for (int i = 0; i < std::abs(power); ++i)
            if (power > 0)
                above = graph.mul(above, factor);
            else
                below = below ? graph.mul(below, factor) : factor;
    return below ? graph.make(Op::Div, {above, below}) : above;
}

// x/y
FactorPowers over_powers(const FactorPowers &x, const FactorPowers &y) {
    FactorPowers out = x;
    out.by /= y.by;
    if (std::fabs(out.by - 1) < near_one) out.by = 1;
    for (const auto &[factor, power] : y.powers) out.powers[factor] -= power;
    std::erase_if(out.powers, [](const auto &one) { return one.second == 0; });
    return out;
}

// v and A of A v and A A v: by component A is the second over the first, and v the first over A.
bool find_parts(Graph &graph, NodeId first, NodeId second, Ellipsoid &out) {
    const int n = ir::components(graph.type(first));
    if (n < 2 || n > 3 || n != ir::components(graph.type(second))) return false;
    for (int i = 0; i < n; ++i) {
        FactorPowers a, b;
        if (!gather_factors(graph, component_of(graph, first, i), 1, a) ||
            !gather_factors(graph, component_of(graph, second, i), 1, b))
            return false;
        const FactorPowers inverse = over_powers(b, a), v = over_powers(a, inverse);
        if (inverse.powers.size() + v.powers.size() > most_factors_of_ratio) return false;
        for (const auto &[factor, power] : inverse.powers)
            if (!is_still_number(graph, factor)) return false;
        out.vector.push_back(product_of_powers(graph, v));
        out.inverse.push_back(product_of_powers(graph, inverse));
    }
    return true;
}

// Of max(|q|, a number) |q|.
NodeId length_of(const Graph &graph, NodeId id) {
    return graph[id].op == Op::Max && graph[graph.arg(id, 0)].op == Op::Length ? graph.arg(id, 0)
                                                                               : id;
}

NodeId least_inverse(Graph &graph, const Ellipsoid &of) {
    NodeId out;
    for (const NodeId one : of.inverse) {
        const NodeId size = graph.make(Op::Abs, {one});
        out = out ? graph.make(Op::Min, {out, size}) : size;
    }
    return out;
}

} // namespace

std::optional<Ellipsoid> ellipsoid(Graph &graph, NodeId product) {
    if (graph.type(product) != ir::Type::Float) return {};
    FactorPowers all;
    if (!gather_factors(graph, product, 1, all) || all.powers.size() != 3) return {};
    Ellipsoid out;
    out.by = all.by;
    NodeId less;
    for (const auto &[factor, power] : all.powers) {
        if (power != 1 && power != -1) return {};
        if (graph[length_of(graph, factor)].op == Op::Length)
            (power > 0 ? out.k0 : out.k1) = factor;
        else if (power > 0)
            less = factor;
    }
    if (!out.k0 || !out.k1 || !less) return {};
    if (number_of(graph, graph.sub(less, out.k0)) != -1.0) return {};
    const NodeId size = length_of(graph, out.k0), beside = length_of(graph, out.k1);
    if (!find_parts(graph, graph.arg(size, 0), graph.arg(beside, 0), out)) return {};
    const bool is_kept = size != out.k0;
    if (is_kept != (beside != out.k1)) return {};
    if (is_kept && (graph.as_number(graph.arg(out.k0, 1)) != 1.0 ||
                    graph.arg(out.k1, 1) != least_inverse(graph, out)))
        return {};
    return out;
}

NodeId kept_outside(Graph &graph, const Ellipsoid &of) {
    const NodeId one = graph.number(1), k0 = graph.make(Op::Max, {of.k0, one}),
                 least = least_inverse(graph, of), k1 = graph.make(Op::Max, {of.k1, least}),
                 less = graph.sub(k0, one), above = graph.mul(k0, less);
    return graph.mul(graph.number(of.by), graph.make(Op::Div, {above, k1}));
}

double slope_of_ellipsoid(const Interval &k0, const Interval &k1,
                          std::span<const Interval> inverse) {
    if (!(k0.lo > 0)) return infinity;
    std::vector<Interval> b;
    Interval all{infinity, 0}; // of b: from the least that one is to the most
    for (const Interval &a : inverse) {
        const double least = a.mignitude(), most = a.magnitude();
        if (!(least > 0) || !std::isfinite(most)) return infinity;
        b.push_back({least * least * (1 - allowed), most * most * (1 + allowed)});
        all = {std::min(all.lo, b.back().lo), std::max(all.hi, b.back().hi)};
    }
    double apart = 1; // the greatest b over the least
    for (std::size_t i = 0; i < b.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j)
            if (i != j) apart = std::max(apart, b[i].hi / b[j].lo);
    // The mean of b is (k1/k0)^2, too.
    const double ratio = std::max(k1.lo, 0.0) / k0.hi;
    const double mean = std::max(all.lo, ratio * ratio * (1 - allowed));
    const double most = std::min(apart, std::max(1.0, all.hi / mean)) * (1 + allowed);
    apart *= 1 + allowed;
    double square = 1;
    for (const double s : {1 - 1 / k0.lo, 1 - 1 / k0.hi}) {
        if (s == 0 || (s > 0 && s * most <= 2)) continue;
        for (int i = 0; i < pieces_of_ratio; ++i) {
            const double from = 1 + (most - 1) * i / pieces_of_ratio,
                         to = 1 + (most - 1) * (i + 1) / pieces_of_ratio;
            const double spread = (to - 1) * std::max(0.0, 1 - from / apart);
            const double weight = s > 0 ? s * std::max(0.0, s * to - 2) : -s * (2 - s * to);
            square = std::max(square, 1 + weight * spread);
        }
    }
    return ir::rounding::up(std::sqrt(square) * (1 + allowed), 4);
}

} // namespace fathom::proof
