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

} // namespace fathom::proof
