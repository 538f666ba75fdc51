// With A the angle of q = (x, y), x = |q| cos A and y = |q| sin A, also where q is 0. So for
// a = s A + c with s = 1 or -1, |q| (cos a, sin a) is (x, s y) turned by c. A wave of A is A less
// m times a whole number, which turns by steps.
#include "proof/polar.h"

#include "ir/passes/walk.h"
#include "proof/continuity.h"
#include "proof/forms.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr std::size_t max_nodes_of_angles = 1500;
constexpr ir::OpSet is_rounding{Op::Floor, Op::Ceil, Op::Round};

std::vector<NodeId> all_below(const Graph &graph, NodeId root) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() <= max_nodes_of_angles) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return out;
}

// … down to angles: what these are of is no part of the sum that they stand in.
std::vector<NodeId> down_to_angles(const Graph &graph, NodeId root) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() <= max_nodes_of_angles) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        if (graph[id].op == Op::Atan2) continue;
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return out;
}

struct Angles {
    Graph &graph;
    Turned out;

    std::optional<NodeId> angle_in(NodeId scalar) const { // the only one
        std::optional<NodeId> found;
        for (NodeId id : down_to_angles(graph, scalar))
            if (graph[id].op == Op::Atan2) {
                if (found) return {};
                found = id;
            }
        return found;
    }

    // x % m as x - m*v, in an angle; `floors` says of each v that it is floor(x/m).
    NodeId by_steps(NodeId angle, std::vector<NodeId> &waves, ir::Substitution &floors) {
        ir::Substitution map;
        for (NodeId id : down_to_angles(graph, angle)) {
            const ir::Node node = graph[id];
            if ((node.op != Op::Mod && node.op != Op::Fract) || node.type != ir::Type::Float ||
                !angle_in(id))
                continue;
            const NodeId x = graph.arg(id, 0),
                         m = node.op == Op::Mod ? graph.arg(id, 1) : graph.number(1);
            if (!graph.as_number(m)) continue;
            const NodeId var = graph.fresh_var(ir::Type::Float);
            floors[var] = graph.make(Op::Floor, {graph.div(x, m)});
            map[id] = graph.sub(x, graph.mul(m, var));
            waves.push_back(id);
        }
        return map.empty() ? angle : ir::substitute(graph, angle, map);
    }
    // |a| <= pi: a wave of no more than a turn.
    bool within_half_turn(NodeId angle) {
        const auto parts = wave(graph, angle);
        const auto m = parts ? number(graph, parts->m) : std::nullopt;
        return m && *m > 0 && *m <= 2 * std::numbers::pi * (1 + 1e-6);
    }

    // (x, s y) turned, of |q| and an angle; nothing where it is not the angle of q.
    std::optional<NodeId> turned(NodeId length, NodeId angle) {
        const auto whole = angle_in(angle);
        if (!whole || graph[length].op != Op::Length) return {};
        const NodeId q = graph.arg(length, 0), y = graph.arg(*whole, 0), x = graph.arg(*whole, 1);
        if (ir::components(graph[q].type) != 2) return {};
        const NodeId q0 = component_of(graph, q, 0), q1 = component_of(graph, q, 1);
        if (!(same(graph, q0, x) && same(graph, q1, y)) &&
            !(same(graph, q0, y) && same(graph, q1, x)))
            return {};
        std::vector<NodeId> waves;
        ir::Substitution steps, back; // a step stays the node that it is
        const NodeId stepped = by_steps(angle, waves, back);
        for (NodeId id : down_to_angles(graph, stepped))
            if (is_rounding[graph[id].op] && graph[id].type == ir::Type::Float) {
                const NodeId var = graph.fresh_var(ir::Type::Float);
                steps[id] = var, back[var] = id;
            }
        const auto linear = linear_in(graph, ir::substitute(graph, stepped, steps), *whole);
        if (!linear || std::fabs(linear->by) != 1 || waves.size() > 1) return {};
        const NodeId c = ir::substitute(graph, linear->rest, back);
        for (NodeId id : down_to_angles(graph, c))
            if (graph[id].op == Op::Floor && !waves.empty() && angle_in(id))
                out.steps.emplace_back(waves[0], id);
        const NodeId cosine = graph.make(Op::Cos, {c}), sine = graph.make(Op::Sin, {c});
        const NodeId turn =
            graph.make(Op::Make, ir::Type::Mat2, {cosine, sine, graph.neg(sine), cosine});
        const NodeId mirrored = linear->by > 0 ? y : graph.neg(y);
        const NodeId u = graph.make(Op::Make, ir::Type::Vec2, {x, mirrored});
        return graph.make(Op::MatMul, ir::Type::Vec2, {turn, u});
    }

    // Steps whose arguments are written anew are others: which these are, where only one becomes it.
    void keep_steps(const std::vector<NodeId> &nodes, const ir::Substitution &map) {
        constexpr ir::OpSet steps{Op::Floor, Op::Ceil, Op::Round, Op::Fract, Op::Mod, Op::Atan2};
        std::map<NodeId, std::vector<NodeId>> made;
        for (NodeId id : nodes)
            if (steps[graph[id].op]) made[ir::substitute(graph, id, map)].push_back(id);
        for (const auto &[image, of] : made)
            if (of.size() == 1 && of[0] != image) out.steps.emplace_back(of[0], image);
    }

    // |q| times a cosine, a sine, or the size of a sine.
    std::optional<NodeId> product(NodeId length, NodeId wave) {
        const ir::Node node = graph[wave];
        if (node.op == Op::Abs) {
            const auto inner = product(length, graph.arg(wave, 0));
            return inner ? std::optional(graph.make(Op::Abs, {*inner})) : std::nullopt;
        }
        if (node.op != Op::Cos && node.op != Op::Sin) return {};
        NodeId angle = graph.arg(wave, 0);
        const bool size = graph[angle].op == Op::Abs;
        if (size) angle = graph.arg(angle, 0);
        if (size && node.op == Op::Sin && !within_half_turn(angle)) return {};
        const auto point = turned(length, angle);
        if (!point) return {};
        const NodeId part = graph.component(*point, node.op == Op::Cos ? 0 : 1);
        return size && node.op == Op::Sin ? graph.make(Op::Abs, {part}) : part;
    }

    std::optional<NodeId> rewritten(NodeId id) {
        const ir::Node node = graph[id];
        if (node.op != Op::Mul) return {};
        for (int i = 0; i < 2; ++i) {
            const NodeId other = graph.arg(id, 1 - i);
            NodeId length = graph.arg(id, i);
            if (node.type == ir::Type::Float) {
                if (const auto found = product(length, other)) return found;
                continue;
            }
            if (graph[length].op != Op::Splat || graph[other].op != Op::Make) continue;
            length = graph.arg(length, 0);
            std::vector<NodeId> parts;
            for (int c = 0; c < ir::components(node.type); ++c)
                if (const auto part = product(length, component_of(graph, other, c)))
                    parts.push_back(*part);
            if (int(parts.size()) == ir::components(node.type))
                return graph.make(Op::Make, node.type, parts);
        }
        return {};
    }
};

} // namespace

Turned without_angles(Graph &graph, NodeId root) {
    constexpr int most_rounds = 4; // of turned points that angles of others are of
    Angles angles{graph, {root, {}}};
    for (int round = 0; round < most_rounds; ++round) {
        const std::vector<NodeId> nodes = all_below(graph, angles.out.root);
        const bool any =
            std::ranges::any_of(nodes, [&](NodeId id) { return graph[id].op == Op::Atan2; });
        if (!any || nodes.size() > max_nodes_of_angles) break;
        ir::Substitution map;
        for (NodeId id : nodes)
            if (const auto other = angles.rewritten(id)) map[id] = *other;
        if (map.empty()) break;
        angles.keep_steps(nodes, map);
        angles.out.root = ir::substitute(graph, angles.out.root, map);
    }
    return std::move(angles.out);
}

std::unordered_set<NodeId> stepped_angles(const Graph &graph, NodeId root,
                                          const std::unordered_set<NodeId> &steps) {
    std::vector<NodeId> nodes = all_below(graph, root);
    if (nodes.size() > max_nodes_of_angles) return {};
    std::sort(nodes.begin(), nodes.end()); // arguments first
    std::unordered_set<NodeId> out;
    std::unordered_map<NodeId, std::unordered_set<NodeId>> reads; // of each node: angles as such
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        std::unordered_set<NodeId> all;
        for (NodeId a : graph.args(id)) all.insert(reads[a].begin(), reads[a].end());
        constexpr ir::OpSet linear{Op::Add, Op::Sub, Op::Neg, Op::Mul, Op::Div},
            rounds = is_rounding;
        if (rounds[node.op] && steps.contains(id)) continue; // a step
        if (linear[node.op] && node.type == ir::Type::Float && id != root) {
            reads[id] = std::move(all);
            continue;
        }
        for (NodeId angle : all) out.erase(angle);
        if (node.op != Op::Atan2) continue;
        out.insert(id);
        reads[id] = {id};
    }
    for (NodeId angle : reads[root]) out.erase(angle);
    return out;
}

std::optional<NodeId> angle_to_axis(Graph &graph, NodeId angle) {
    NodeId ratio = graph.arg(angle, 0);
    if (graph[angle].type != ir::Type::Float) return {};
    const auto is = [&](NodeId id, double x) { return graph.as_number(id) == x; };
    for (int depth = 0; depth < 4; ++depth) { // kept in -1..1, where it is
        const ir::Node node = graph[ratio];
        const bool kept =
            (node.op == Op::Clamp && is(graph.arg(ratio, 1), -1) && is(graph.arg(ratio, 2), 1)) ||
            (node.op == Op::Min && is(graph.arg(ratio, 1), 1)) ||
            (node.op == Op::Max && is(graph.arg(ratio, 1), -1));
        if (!kept) break;
        ratio = graph.arg(ratio, 0);
    }
    if (graph[ratio].op != Op::Div) return {};
    const NodeId part = graph.arg(ratio, 0), length = graph.arg(ratio, 1);
    if (graph[length].op != Op::Length) return {};
    const NodeId v = graph.arg(length, 0);
    for (int c = 0; c < ir::components(graph[v].type); ++c)
        if (component_of(graph, v, c) == part || graph.component(v, c) == part) return length;
    return {};
}

} // namespace fathom::proof
