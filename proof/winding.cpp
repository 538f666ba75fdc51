// With w = x + i z and the angle a, both x cos a + z sin a and z cos a - x sin a are parts of
// w exp(-i a): a turn of w by b is one of a by -b. What else a field may read stays as it is when w is
// turned.
#include "proof/winding.h"

#include "proof/continuity.h"

#include <algorithm>
#include <map>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

constexpr std::size_t max_nodes_of_windings = 600;
constexpr ir::OpSet is_wave{Op::Sin, Op::Cos};

// One component of a vector, a product with a matrix as the sum that it is.
NodeId part_of(Graph &graph, NodeId vector, int i) {
    if (graph[vector].op == Op::Swizzle)
        return part_of(graph, graph.arg(vector, 0),
                       ir::swizzle_component(graph[vector].payload, i));
    if (graph[vector].op != Op::MatMul || !ir::is_vector(graph[vector].type))
        return component_of(graph, vector, i);
    const NodeId a = graph.arg(vector, 0), b = graph.arg(vector, 1);
    const bool left = ir::is_matrix(graph[a].type);
    const NodeId matrix = left ? a : b, of = left ? b : a;
    NodeId sum = graph.number(0);
    for (int k = 0; k < ir::components(graph[vector].type); ++k) {
        const auto m = left ? entry_of(graph, matrix, i, k) : entry_of(graph, matrix, k, i);
        if (!m) return component_of(graph, vector, i);
        sum = graph.add(sum, graph.mul(*m, part_of(graph, of, k)));
    }
    return sum;
}

// An angle as sign * (another) + number.
struct Apart {
    double sign = 1, number = 0;
};
std::optional<Apart> apart(Graph &graph, NodeId angle, NodeId from) {
    if (angle == from) return Apart{};
    if (const auto by = number_of(graph, graph.sub(angle, from))) return Apart{1, *by};
    if (const auto by = number_of(graph, graph.add(angle, from))) return Apart{-1, *by};
    return {};
}

struct Follower {
    Graph &graph;
    const int axis;
    const NodeId base, x,
        z; // the coordinates across the axis, in the order in which a turn takes them
    bool with_angle = true, against_angle = true; // which way w may turn with the angle
    std::unordered_map<NodeId, bool> known{};
    std::unordered_map<NodeId, double> signs{};

    // 1 or -1 of a wave of the angle or of its negative, give or take a number; else 0.
    double sign_of_wave(NodeId wave) {
        if (!is_wave[graph[wave].op] || graph[wave].type != ir::Type::Float) return 0;
        const auto [it, fresh] = signs.try_emplace(wave, 0.0);
        if (!fresh) return it->second;
        const auto of = apart(graph, graph.arg(wave, 0), base);
        return it->second = of ? of->sign : 0;
    }

    // Does its value stay when w and the angle turn?
    bool stays(NodeId id) {
        const Graph::Reads reads = graph.reads(id);
        if (reads.normal || reads.direction) return false;
        if (!reads.point) return true;
        if (const auto it = known.find(id); it != known.end()) return it->second;
        known[id] = false; // while it is looked at
        return known[id] = stays_by_parts(id) || stays_by_sums(id);
    }
    bool stays_by_parts(NodeId id) {
        const ir::Node node = graph[id];
        if (node.op == Op::Point || node.op == Op::Loop || node.op == Op::Call ||
            sign_of_wave(id) != 0)
            return false;
        if (node.op == Op::Swizzle && graph[graph.arg(id, 0)].op == Op::Point) {
            for (int i = 0; i < ir::components(node.type); ++i)
                if (ir::swizzle_component(node.payload, i) != axis) return false;
            return true;
        }
        const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        return !args.empty() && std::ranges::all_of(args, [&](NodeId a) { return stays(a); });
    }
    bool stays_by_sums(NodeId id) {
        const ir::Node node = graph[id];
        if (node.op == Op::Length)
            return stays(graph.make(Op::Dot, {graph.arg(id, 0), graph.arg(id, 0)}));
        if (node.type == ir::Type::Bool || node.type == ir::Type::Int || ir::is_matrix(node.type))
            return false;
        for (int i = 0; i < ir::components(node.type); ++i)
            if (!sum_stays(part_of(graph, id, i), id)) return false;
        return true;
    }

    // Of one product of others: the factors of x and z times cosine and sine, and of x*x, z*z, x*z.
    struct Parts {
        double xc = 0, xs = 0, zc = 0, zs = 0, xx = 0, zz = 0, xz = 0;
    };
    bool sum_stays(NodeId scalar, NodeId whole) {
        const auto terms = terms_of(graph, scalar);
        if (!terms) return false;
        std::map<std::vector<NodeId>, Parts> groups; // by the other factors, and the angle
        for (const Term &term : *terms) {
            int x_times = 0, z_times = 0;
            std::vector<NodeId> others;
            std::optional<NodeId> wave;
            for (NodeId f : term.factors) {
                if (f == x)
                    ++x_times;
                else if (f == z)
                    ++z_times;
                else if (sign_of_wave(f) != 0 && !wave)
                    wave = f;
                else if (f == whole || f == scalar || !stays(f))
                    return false;
                else
                    others.push_back(f);
            }
            const int degree = x_times + z_times;
            if (degree == 0 && !wave) continue;
            if (degree != (wave ? 1 : 2)) return false;
            if (wave) others.push_back(graph.arg(*wave, 0));
            Parts &parts = groups[others];
            const bool cosine = wave && graph[*wave].op == Op::Cos;
            double &to = wave           ? (x_times == 1 ? (cosine ? parts.xc : parts.xs)
                                                        : (cosine ? parts.zc : parts.zs))
                         : x_times == 2 ? parts.xx
                         : z_times == 2 ? parts.zz
                                        : parts.xz;
            to += wave && !cosine ? sign_of_wave(*wave) * term.by : term.by;
        }
        bool with = with_angle, against = against_angle;
        for (const auto &[others, parts] : groups) {
            if (parts.xx != parts.zz || parts.xz != 0) return false;
            with = with && parts.xc == parts.zs && parts.zc == -parts.xs;
            against = against && parts.xc == -parts.zs && parts.zc == parts.xs;
        }
        if (!with && !against) return false;
        with_angle = with, against_angle = against;
        return true;
    }
};

// The field with each wave of an angle that is no factor of what it turns as a wave of the angle and a
// number of which nothing is known.
struct WavesApart {
    Graph &graph;
    NodeId number{};
    std::unordered_map<NodeId, NodeId> known{};

    bool is_apart(NodeId parent, NodeId wave, NodeId other) const {
        constexpr ir::OpSet alone{Op::Add, Op::Sub,   Op::Neg, Op::Abs,        Op::Min,
                                  Op::Max, Op::Clamp, Op::Mix, Op::Smoothstep, Op::Pow};
        if (!is_wave[graph[wave].op] || graph[wave].type != ir::Type::Float ||
            !graph.reads(wave).point)
            return false;
        if (graph[parent].op == Op::Mul) return other == wave || !graph.reads(other).point;
        return alone[graph[parent].op];
    }
    NodeId apart(NodeId wave) {
        if (!number) number = graph.fresh_var(ir::Type::Float);
        const NodeId angle = graph.add(graph.arg(wave, 0), number);
        return graph.make(graph[wave].op, {angle});
    }
    NodeId written(NodeId id) {
        if (!graph.reads(id).point || known.size() > max_nodes_of_windings) return id;
        const auto [it, fresh] = known.try_emplace(id, id);
        if (!fresh) return it->second;
        const ir::Node node = graph[id];
        const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        std::vector<NodeId> made;
        for (std::size_t i = 0; i < args.size(); ++i) {
            const NodeId other = args[args.size() == 2 ? 1 - i : i];
            made.push_back(is_apart(id, args[i], other) ? apart(args[i]) : written(args[i]));
        }
        if (made == args) return id;
        return known[id] = graph.make(node.op, node.type, made, node.payload);
    }
};

std::optional<Winding> winding_as_it_is(Graph &graph, NodeId field) {
    std::vector<NodeId> todo{field};
    std::unordered_set<NodeId> seen;
    Winding found;
    found.field = field;
    std::vector<NodeId> candidates;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > max_nodes_of_windings) return {};
        const ir::Node node = graph[id];
        if (is_wave[node.op] && graph.reads(id).point) {
            found.waves.insert(id);
            const NodeId angle = graph.arg(id, 0);
            if (node.type == ir::Type::Float &&
                std::ranges::find(candidates, angle) == candidates.end())
                candidates.push_back(angle);
        }
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    std::ranges::sort(candidates);
    const NodeId point = graph.point(ir::Type::Vec3);
    for (const NodeId base : candidates) {
        found.angles.clear();
        for (const NodeId angle : candidates)
            if (const auto of = apart(graph, angle, base)) found.angles.emplace(angle, of->number);
        for (found.axis = 0; found.axis < 3; ++found.axis) {
            Follower follower{graph, found.axis, base,
                              component_of(graph, point, (found.axis + 1) % 3),
                              component_of(graph, point, (found.axis + 2) % 3)};
            if (std::ranges::all_of(found.angles,
                                    [&](const auto &one) { return follower.stays(one.first); }) &&
                follower.stays(field))
                return found;
        }
    }
    return {};
}

} // namespace

std::optional<Winding> winding_of(Graph &graph, NodeId field) {
    if (auto found = winding_as_it_is(graph, field)) return found;
    WavesApart waves{graph};
    const NodeId apart = waves.written(field);
    if (apart == field || waves.known.size() > max_nodes_of_windings) return {};
    return winding_as_it_is(graph, apart);
}

} // namespace fathom::proof
