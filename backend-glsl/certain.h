// What is certain of a node's value before anything runs: constants, and between which numbers an
// int lies. Decides where GLSL's own operators mean what ours do.
#pragma once

#include "backend-glsl/schedule.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::glsl {

struct Certain {
    const ir::Graph &graph;
    const Schedule &plan; // counters' ranges

    using NodeId = ir::NodeId;
    using Op = ir::Op;

    std::optional<ir::Constant> constant(NodeId id) const {
        if (!graph.is_constant(id)) return std::nullopt;
        return graph.constant_of(id);
    }

    bool is_nonzero(NodeId id) const {
        const auto c = constant(id);
        if (!c) return false;
        for (int i = 0; i < ir::components(c->type); ++i)
            if (static_cast<float>(c->value[static_cast<std::size_t>(i)]) == 0) return false;
        return true;
    }

    // Whether every component of a is below that of b.
    bool below(NodeId a, NodeId b) const {
        const auto x = constant(a), y = constant(b);
        if (!x || !y) return false;
        for (std::size_t i = 0; i < static_cast<std::size_t>(ir::components(x->type)); ++i)
            if (!(static_cast<float>(x->value[i]) < static_cast<float>(y->value[i]))) return false;
        return true;
    }

    // The exponent where it is one constant in all components, else 0.
    double exponent(NodeId id) const {
        const auto c = constant(id);
        if (!c) return 0;
        for (int i = 1; i < ir::components(c->type); ++i)
            if (c->value[static_cast<std::size_t>(i)] != c->value[0]) return 0;
        return c->value[0];
    }

    // Between which numbers an int certainly lies: counters and constants, mostly. Ints saturate
    // (semantics.h), GLSL's wrap; so only sums that cannot leave the range are written with GLSL's
    // operators.
    std::pair<double, double> range(NodeId id, int depth = 0) const {
        constexpr std::pair<double, double> all{-2147483648.0, 2147483647.0};
        const ir::Node &node = graph[id];
        if (depth > 8) return all;
        auto of = [&](int i) { return range(graph.arg(id, i), depth + 1); };
        if (node.op == Op::Const)
            return {graph.constant_of(id).value[0], graph.constant_of(id).value[0]};
        if (node.op == Op::Var) {
            const auto counter = plan.rows.find(id);
            if (counter != plan.rows.end() && counter->second > 0) return {0, counter->second};
        }
        if (node.op == Op::ToInt && graph[graph.arg(id, 0)].type == ir::Type::Bool) return {0, 1};
        if (node.op == Op::Add || node.op == Op::Sub || node.op == Op::Mul || node.op == Op::Neg) {
            const auto [lo, hi] = exact_range(id, depth);
            return {std::max(lo, all.first), std::min(hi, all.second)};
        }
        if (node.op == Op::Clamp) {
            const auto low = of(1), high = of(2);
            return {std::min(low.first, high.first), high.second};
        }
        if (node.op == Op::Mod) {
            const auto [lo, hi] = of(1);
            if (lo > 0) return {0, hi - 1};
        }
        if (node.op == Op::Div && plain_quotient(id, depth + 1))
            return {0, std::floor(of(0).second / of(1).first)};
        return all;
    }

    // Of what is not negative by what is positive GLSL's `/` and `%` are ours.
    bool plain_quotient(NodeId id, int depth = 0) const {
        return range(graph.arg(id, 0), depth + 1).first >= 0 &&
               range(graph.arg(id, 1), depth + 1).first > 0;
    }

    std::pair<double, double> exact_range(NodeId id, int depth = 0) const {
        const auto [a, b] = range(graph.arg(id, 0), depth + 1);
        const Op op = graph[id].op;
        if (op == Op::Neg) return {-b, -a};
        const auto [c, d] = range(graph.arg(id, 1), depth + 1);
        if (op == Op::Add) return {a + c, b + d};
        if (op == Op::Sub) return {a - d, b - c};
        return {std::min({a * c, a * d, b * c, b * d}), std::max({a * c, a * d, b * c, b * d})};
    }

    bool in_range(NodeId id) const {
        const auto [lo, hi] = exact_range(id);
        return lo >= -2147483648.0 && hi <= 2147483647.0;
    }
};

} // namespace fathom::glsl
