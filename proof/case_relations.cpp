// What a number is on one side of a border to what it is on the other: the same, its negative, or
// unknown. Only the choices that turn there are looked into, so that a sign that a hundred edges turn
// is followed through the two of a vertex (docs/lipschitz.md, 2.1).
#include "proof/case_search.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace fathom::proof {
namespace {

bool is_negative_of(const Graph &graph, NodeId a, NodeId b) {
    if (graph[a].op == Op::Neg) return graph.arg(a, 0) == b;
    return graph.is_constant(a) && graph.is_constant(b) &&
           graph.constant_of(a).value[0] == -graph.constant_of(b).value[0];
}

} // namespace

bool Cases::turns(NodeId id) {
    return reads(id, claim_.choice) || (claim_.comparison && reads(id, claim_.comparison));
}

Relation Cases::relation(NodeId id) {
    if (fork_) return Relation::Unknown;
    if (!turns(id)) return Relation::Same;
    if (const auto it = relations_.find(id); it != relations_.end()) return it->second;
    const Relation out = relation_of(id);
    if (!fork_) relations_[id] = out;
    return out;
}

Relation Cases::relation_of(NodeId id) {
    const ir::Node node = graph_[id];
    const auto arg = [&](int k) { return graph_.arg(id, k); };
    const auto times = [](Relation a, Relation b) {
        if (a == Relation::Unknown || b == Relation::Unknown) return Relation::Unknown;
        return a == b ? Relation::Same : Relation::Opposite;
    };
    if (node.op == Op::Neg) return relation(arg(0));
    if (node.op == Op::Mul && node.type == ir::Type::Float) {
        const Relation out = times(relation(arg(0)), relation(arg(1)));
        if (out == Relation::Same || fork_) return out;
        for (int k = 0; k < 2; ++k)
            if (!turns(arg(k)) && vanishes(arg(k))) return Relation::Same;
        return out;
    }
    if (node.op == Op::Select && !turns(arg(0))) { // one arm on both sides
        const Relation out = relation(arg(1));
        return out == relation(arg(2)) ? out : Relation::Unknown;
    }
    if (node.op == Op::Select && node.type == ir::Type::Float) {
        std::array<NodeId, 2> arms;
        for (int side = 0; side < 2; ++side) {
            side_ = side;
            forget();
            const auto t = truth(arg(0));
            side_.reset();
            if (!t) return Relation::Unknown;
            arms[std::size_t(side)] = arg(*t ? 1 : 2);
        }
        forget();
        if (arms[0] == arms[1]) return relation(arms[0]);
        for (int k = 0; k < 2; ++k) {
            const NodeId one = arms[std::size_t(k)], other = arms[std::size_t(1 - k)];
            if (is_negative_of(graph_, one, other))
                return times(relation(other), Relation::Opposite);
        }
        return Relation::Unknown;
    }
    if (ir::components(node.type) != 1 || node.type == ir::Type::Bool) return Relation::Unknown;
    const auto args = graph_.args(id);
    const bool same = std::ranges::all_of(args, [&](NodeId a) {
        return graph_[a].type != ir::Type::Bool && relation(a) == Relation::Same;
    });
    return same ? Relation::Same : Relation::Unknown;
}

bool Cases::vanishes(NodeId id) {
    splits_ = false;
    forget();
    const bool out = is_0(id);
    splits_ = true;
    forget();
    return out;
}

bool Cases::is_0(NodeId id) {
    const ir::Node node = graph_[id];
    const auto arg = [&](int k) { return graph_.arg(id, k); };
    if (node.op == Op::Sqrt || node.op == Op::Abs) return is_0(arg(0));
    if (node.op == Op::Min) {
        std::vector<NodeId> parts = parts_of_min(id);
        if (!std::ranges::all_of(parts, [&](NodeId part) { return is_at_least_0(part); }))
            return false;
        // first those that are made of what the border is made of
        std::stable_partition(parts.begin(), parts.end(),
                              [&](NodeId part) { return is_of_border(part); });
        return std::ranges::any_of(parts, [&](NodeId part) { return is_0(part); });
    }
    if (node.op == Op::Length || (node.op == Op::Dot && arg(0) == arg(1))) {
        double size = 0; // of what is solved, where that is a place
        for (const auto &[a, sum] : case_.solved) {
            const auto c = as_constant(reduced(sum, case_));
            size = c ? std::max(size, std::fabs(*c)) : 0;
            if (!c) break;
        }
        double most = 0; // of a place's coordinates
        for (int i = 0; i < ir::components(graph_[arg(0)].type); ++i) {
            const auto x = value(arg(0), i);
            const auto c = x ? as_constant(*x) : std::nullopt;
            if (!c || std::fabs(*c) > granted_to_sides * size) return false;
            most = std::max(most, std::fabs(*c));
        }
        if (most > granted_to_doubles * size) { // its sign may turn there
            const double apart = 2 * std::sqrt(ir::components(graph_[arg(0)].type)) * most;
            Granted place{id, false};
            place.apart.fill(node.op == Op::Length ? apart : apart * apart);
            looked_.places.push_back(place);
        }
        return true;
    }
    return false;
}

std::vector<NodeId> Cases::parts_of_min(NodeId id) const {
    std::vector<NodeId> parts, todo{id};
    while (!todo.empty()) {
        const NodeId part = todo.back();
        todo.pop_back();
        if (graph_[part].op == Op::Min)
            todo.insert(todo.end(), {graph_.arg(part, 0), graph_.arg(part, 1)});
        else
            parts.push_back(part);
    }
    return parts;
}

bool Cases::is_of_border(NodeId id) {
    std::vector<NodeId> todo{claim_.u, claim_.v};
    while (!todo.empty()) {
        const NodeId part = todo.back();
        todo.pop_back();
        const ir::Node node = graph_[part];
        if (!graph_.reads(part).point || node.count == 0) continue;
        const bool is_coordinate =
            node.op == Op::Swizzle && graph_[graph_.arg(part, 0)].op == Op::Point;
        if (is_coordinate) continue;
        if (node.op != Op::Swizzle && reads(id, part)) return true;
        todo.insert(todo.end(), graph_.args(part).begin(), graph_.args(part).end());
    }
    return false;
}

bool Cases::is_at_least_0(NodeId id) const {
    const Op op = graph_[id].op;
    return op == Op::Length || op == Op::Sqrt || op == Op::Abs || is_square_sum(id);
}

} // namespace fathom::proof
