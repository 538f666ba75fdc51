// The axes along which a claim is looked at: a body between two points is one along an axis, seen from
// there (case_search.h).
#include "proof/case_search.h"
#include "proof/tape.h"

#include <cmath>
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

} // namespace fathom::proof
