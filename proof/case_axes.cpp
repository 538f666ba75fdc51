// The axes along which a claim is looked at: a body between two points is one along an axis, seen from
// there (case_search.h).
#include "ir/passes/walk.h"
#include "proof/case_search.h"
#include "proof/continuity.h"
#include "proof/read_through.h"
#include "proof/tape.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace fathom::proof {
namespace {

using Vector = std::array<double, 3>;

std::optional<Vector> constant_vector(const Graph &graph, NodeId id) {
    if (!graph.is_constant(id) || graph[id].type != ir::Type::Vec3) return {};
    const auto &value = graph.constant_of(id).value;
    return Vector{value[0], value[1], value[2]};
}

// p, p - a or p + a: what is taken off the point.
std::optional<Vector> origin_of(const Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.op == Op::Point && node.type == ir::Type::Vec3) return Vector{};
    if (node.op != Op::Sub && node.op != Op::Add) return {};
    if (graph[graph.arg(id, 0)].op != Op::Point) return {};
    auto a = constant_vector(graph, graph.arg(id, 1));
    if (a && node.op == Op::Add)
        for (double &x : *a) x = -x;
    return a;
}

Vector cross(const Vector &a, const Vector &b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
double length(const Vector &a) { return std::hypot(a[0], a[1], a[2]); }
Vector scaled(const Vector &a, double by) { return {a[0] * by, a[1] * by, a[2] * by}; }

std::optional<Axes> axes_along(const Vector &direction, const Vector &origin) {
    const double size = length(direction);
    if (!(size > 0) || !(length(origin) < near_enough / 4)) return {};
    const Vector y = scaled(direction, 1 / size);
    std::size_t least = 0; // the axis that it leans to least
    int leaning = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (std::fabs(y[i]) < std::fabs(y[least])) least = i;
        leaning += y[i] != 0;
    }
    if (leaning < 2) return {}; // it is an axis
    Vector unit{};
    unit[least] = 1;
    const Vector across = cross(y, unit);
    const Vector x = scaled(across, 1 / length(across));
    return Axes{{x, y, cross(x, y)}, origin};
}

} // namespace

namespace {

// What is taken off coordinates of the point, by axis: of `p - a`, `p.xy - a` and `p.x - a`.
struct Taken {
    std::array<std::set<double>, 3> off;

    void look_at(const Graph &graph, NodeId id) {
        const Op op = graph[id].op;
        if (op != Op::Sub && op != Op::Add) return;
        for (int k = 0; k < 2; ++k) {
            const NodeId of = graph.arg(id, k), number = graph.arg(id, 1 - k);
            const bool swizzled = graph[of].op == Op::Swizzle;
            const NodeId point = swizzled ? graph.arg(of, 0) : of;
            if (!graph.is_constant(number) || graph[point].op != Op::Point) continue;
            const auto &value = graph.constant_of(number).value;
            for (int i = 0; i < ir::components(graph[of].type); ++i) {
                const int axis = swizzled ? ir::swizzle_component(graph[of].payload, i) : i;
                const double c = value[std::size_t(i)];
                if (c != 0) off[std::size_t(axis)].insert(op == Op::Add ? -c : c);
            }
        }
    }
};

} // namespace

// Far from the origin the numbers of squares are large, and rounding beside them is no rounding of
// the solid: there a claim is looked at from where its parts lie.
std::optional<Axes> near_parts(const Graph &graph, const Claim &claim) {
    constexpr double far = 2;
    std::vector<NodeId> todo{claim.of, claim.u, claim.v};
    std::set<NodeId> seen;
    Taken taken;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        taken.look_at(graph, id);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    Axes out{{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, {}};
    bool any = false;
    for (std::size_t i = 0; i < 3; ++i) {
        const auto &off = taken.off[i];
        if (off.empty()) continue;
        const double middle = (*off.begin() + *off.rbegin()) / 2;
        if (std::fabs(middle) < far) continue;
        out.origin[i] = *std::ranges::min_element(off, {}, [&](double x) {
            return std::fabs(x - middle); // one of them, so that its own difference is exact
        });
        any = true;
    }
    return any ? std::optional(out) : std::nullopt;
}

std::optional<Axes> axes_of(const Graph &graph, const Claim &claim) {
    std::vector<NodeId> todo{claim.of, claim.u, claim.v};
    std::set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (graph[id].op == Op::Dot)
            for (int k = 0; k < 2; ++k) {
                const auto direction = constant_vector(graph, graph.arg(id, k));
                const auto origin =
                    direction ? origin_of(graph, graph.arg(id, 1 - k)) : std::nullopt;
                if (auto axes = origin ? axes_along(*direction, *origin) : std::nullopt)
                    return axes;
            }
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return {};
}

// Claims about what is moved, turned, scaled or folded first: a vector that the point is read through
// alone may be any point, so the claim holds if it does with the point in its place.

namespace {

constexpr std::size_t max_nodes_of_claim = 400;
struct Bases {
    Graph &graph;
    ReadThrough read{graph};

    // No component is more where no coordinate is more than `near_enough`; infinity: not known.
    double reach(NodeId id, int depth = 0) {
        constexpr int max_depth = 40;
        const ir::Node node = graph[id];
        const auto of = [&](int k) { return reach(graph.arg(id, k), depth + 1); };
        if (depth > max_depth) return ir::rounding::infinity;
        if (graph.is_constant(id)) {
            double most = 0;
            for (int i = 0; i < ir::components(node.type); ++i)
                most = std::max(most, std::fabs(graph.constant_of(id).value[std::size_t(i)]));
            return most;
        }
        if (node.op == Op::Point) return near_enough;
        if (node.op == Op::Sin || node.op == Op::Cos || node.op == Op::Fract) return 1;
        if (node.op == Op::Add || node.op == Op::Sub) return of(0) + of(1);
        if (node.op == Op::Mul) return of(0) * of(1);
        if (node.op == Op::MatMul && ir::is_vector(node.type)) {
            const bool left = ir::is_matrix(graph[graph.arg(id, 0)].type);
            return row_sum(graph.arg(id, left ? 0 : 1), left, depth) * of(left ? 1 : 0);
        }
        if (node.op == Op::Make) {
            double most = 0;
            for (int k = 0; k < int(node.count); ++k) most = std::max(most, of(k));
            return most;
        }
        if (node.op == Op::Neg || node.op == Op::Abs || node.op == Op::Swizzle ||
            node.op == Op::Splat)
            return of(0);
        return ir::rounding::infinity;
    }

    // The most that the sizes of a row's numbers are together, or of a column's.
    double row_sum(NodeId matrix, bool row, int depth) {
        const int side = ir::side(graph[matrix].type);
        double most = 0;
        for (int i = 0; i < side; ++i) {
            double sum = 0;
            for (int k = 0; k < side; ++k) {
                const auto entry = entry_of(graph, matrix, row ? i : k, row ? k : i);
                sum += entry ? reach(*entry, depth + 1) : ir::rounding::infinity;
            }
            most = std::max(most, sum);
        }
        return most;
    }

    std::optional<Claim> seen_through(const Claim &claim, NodeId vector) {
        std::vector<NodeId> parts;
        const NodeId point = graph.point(ir::Type::Vec3);
        for (int axis = 0; axis < 3; ++axis)
            if (read.below(vector).coordinates & (1u << axis))
                parts.push_back(graph.component(point, axis));
        const int n = ir::components(graph[vector].type);
        if (int(parts.size()) < n) return {};
        parts.resize(std::size_t(n));
        const NodeId there = n == 3 ? point : graph.make(Op::Make, graph[vector].type, parts);
        const ir::Substitution map{{vector, there}};
        std::vector<NodeId> all{claim.of, claim.choice, claim.u, claim.v};
        if (claim.comparison) all.push_back(claim.comparison);
        const auto seen = ir::substitute(graph, all, map); // else the choice is another one
        const Claim out{seen[0], seen[1], claim.comparison ? seen[4] : NodeId{}, seen[2], seen[3]};
        const bool same_op = graph[out.choice].op == graph[claim.choice].op;
        return same_op ? std::optional(out) : std::nullopt;
    }
};

} // namespace

std::vector<Inside> seen_from_inside(Graph &graph, const Claim &claim) {
    constexpr double farthest = 4 * near_enough;
    Bases bases{graph};
    std::vector<NodeId> todo{claim.of, claim.u, claim.v}, vectors;
    std::set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (seen.size() > max_nodes_of_claim) return {};
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        const ir::Node node = graph[id];
        const bool vector = node.type == ir::Type::Vec2 || node.type == ir::Type::Vec3;
        const bool is_leaf = node.op == Op::Point || node.op == Op::Swizzle;
        if (vector && !is_leaf && graph.reads(id).point && bases.read.below(id).is_fold)
            vectors.push_back(id);
    }
    std::ranges::sort(vectors); // arguments first
    std::erase_if(vectors, [&](NodeId id) {
        return (bases.read.below(id).coordinates &
                bases.read.beside({claim.of, claim.u, claim.v}, {id})) != 0 ||
               !(bases.reach(id) <= farthest);
    });
    std::vector<NodeId> chosen;
    const auto choose = [&](auto begin, auto end, auto may) {
        const auto it = std::find_if(begin, end, may);
        if (it != end && std::ranges::find(chosen, *it) == chosen.end()) chosen.push_back(*it);
    };
    const auto is_affine = [&](NodeId id) { return bases.read.below(id).is_affine; };
    const auto is_fold = [&](NodeId id) { return !bases.read.below(id).is_affine; };
    choose(vectors.rbegin(), vectors.rend(), is_affine); // all that is moved and turned
    choose(vectors.begin(), vectors.end(), is_fold);
    choose(vectors.rbegin(), vectors.rend(), is_fold);
    std::vector<Inside> out;
    for (const NodeId id : chosen)
        if (const auto inside = bases.seen_through(claim, id))
            out.push_back({*inside, id, std::max(bases.reach(id), near_enough)});
    return out;
}

} // namespace fathom::proof
