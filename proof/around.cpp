// F = m(r) g(a), a the angle and r the length of q = [x, y]: along r it changes by m' g, across by
// m g'/r. Where |m| <= k r and |m'| <= c both are bounded, though g'/r is not. Of m(r) g(h a + s)
// there is m g' times what s does besides.
#include "proof/around.h"

#include "proof/continuity.h"
#include "proof/field.h"

#include "ir/passes/walk.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numbers>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr std::size_t max_nodes_of_turn = 60, max_instructions = 20'000;

// Does an expression change with the point through this number alone?
bool reads_alone(const Graph &graph, NodeId root, NodeId number) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (id == number || !seen.insert(id).second) continue;
        const ir::Graph::Reads reads = graph.reads(id);
        if (!reads.point && !reads.free_vars) continue;
        constexpr ir::OpSet opaque{Op::Point, Op::Var,        Op::Loop,
                                   Op::Call,  Op::LoopResult, Op::Cached};
        if (opaque[graph[id].op] || seen.size() > max_nodes_of_turn) return false;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return true;
}

std::optional<NodeId> angle_in(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && seen.size() <= max_nodes_of_turn) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        if (graph[id].op == Op::Atan2 && graph[id].type == ir::Type::Float) return id;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return {};
}

// The sum h*angle + rest by which alone an expression changes with the point.
struct Turned {
    NodeId sum, rest;
    double by = 0;
};
std::optional<Turned> turned_in(Graph &graph, NodeId root, NodeId angle) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && seen.size() <= max_nodes_of_turn) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        const bool sum = graph[id].type == ir::Type::Float &&
                         (graph[id].op == Op::Add || graph[id].op == Op::Sub);
        if (sum && reads_alone(graph, root, id))
            if (const auto line = linear_in(graph, id, angle); line && line->by != 0)
                return Turned{id, line->rest, line->by};
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return {};
}

// A number that is at most `size` r, and has at most `slope` by r; `radial`: of r alone.
struct Vanishing {
    double size = 1, slope = 1;
    bool radial = true;
};
struct Axis {
    Graph &graph;
    NodeId x, y;

    std::optional<Vanishing> of(NodeId id, int depth = 0) const {
        constexpr int max_depth = 12;
        if (depth > max_depth) return {};
        if (id == x || id == y) return Vanishing{1, 1, false};
        const ir::Node node = graph[id];
        const auto arg = [&](int i) { return graph.arg(id, i); };
        const auto scaled = [](std::optional<Vanishing> v, double by, double slope) {
            if (v) v->size *= by, v->slope *= slope;
            return v;
        };
        if (node.op == Op::Length && graph[arg(0)].type == ir::Type::Vec2) {
            const NodeId a = component_of(graph, arg(0), 0), b = component_of(graph, arg(0), 1);
            const bool own = (a == x && b == y) || (a == y && b == x);
            return own ? std::optional(Vanishing()) : std::nullopt;
        }
        if (node.op == Op::Neg || node.op == Op::Abs || node.op == Op::Sin || node.op == Op::Tanh)
            return of(arg(0), depth + 1);
        if (node.op == Op::Mul)
            for (int i = 0; i < 2; ++i)
                if (const auto by = graph.as_number(arg(i)))
                    return scaled(of(arg(1 - i), depth + 1), std::fabs(*by), std::fabs(*by));
        if (node.op == Op::Div)
            if (const auto by = graph.as_number(arg(1)); by && *by != 0)
                return scaled(of(arg(0), depth + 1), 1 / std::fabs(*by), 1 / std::fabs(*by));
        if (node.op == Op::Min) // with what is not below 0, at most the greater of both
            for (int i = 0; i < 2; ++i)
                if (const auto most = graph.as_number(arg(i)); most && *most >= 0)
                    return of(arg(1 - i), depth + 1);
        if (node.op == Op::Clamp && graph.as_number(arg(1)).value_or(1) <= 0 &&
            graph.as_number(arg(2)).value_or(-1) >= 0)
            return of(arg(0), depth + 1);
        if (node.op == Op::Smoothstep && graph.as_number(arg(0)) == 0.0)
            if (const auto end = graph.as_number(arg(1)); end && *end > 0)
                return scaled(of(arg(2), depth + 1), 1.125 / *end, 1.5 / *end);
        return {};
    }
};

// What a number g of the angle alone is at most, or of the angle and another number, and how steep it
// is by the angle.
struct AlongTurn {
    NodeId angle;
    std::optional<Turned> turned;
    double most = 0, steep = 0;

    double across() const { return steep * (turned ? std::fabs(turned->by) : 1); }
};
std::optional<AlongTurn> along_turn(Flattening &context, NodeId g) {
    Graph &graph = context.graph;
    const auto angle = angle_in(graph, g);
    if (!angle) return {};
    AlongTurn out{*angle, {}};
    if (!reads_alone(graph, g, *angle) && !(out.turned = turned_in(graph, g, *angle))) return {};
    const NodeId turn = graph.component(graph.point(), 0);
    const NodeId along = ir::substitute(graph, g, {{out.turned ? out.turned->sum : *angle, turn}});
    Domain line;
    constexpr double half_turn = std::numbers::pi * (1 + 1e-6);
    line.box.p = {out.turned ? Interval::everything() : Interval(-half_turn, half_turn),
                  Interval(0.0), Interval(0.0)};
    Budget budget;
    budget.instructions = max_instructions;
    out.steep = bound_field(context, *context.ranges, along, line, budget).lipschitz;
    out.most = out.turned ? range_of(context, *context.ranges, along, line.box)[0].magnitude()
                          : bound_magnitude(context, *context.ranges, along, line, budget);
    return out;
}

Around around_of(Graph &graph, const AlongTurn &along, NodeId m, double by) {
    const NodeId y = graph.arg(along.angle, 0), x = graph.arg(along.angle, 1);
    Around out{along.angle, graph.make(Op::Make, ir::Type::Vec2, {x, y}), ir::rounding::up(by, 16)};
    if (along.turned) {
        out.vanishing = m, out.rest = along.turned->rest;
        out.rest_by = ir::rounding::up(along.steep, 4);
    }
    return out;
}

std::optional<Vanishing> vanishing_of(Graph &graph, NodeId m, NodeId angle) {
    return Axis{graph, graph.arg(angle, 1), graph.arg(angle, 0)}.of(m);
}

std::optional<Around> found_around(Flattening &context, NodeId m, NodeId g) {
    Graph &graph = context.graph;
    const auto angle = angle_in(graph, g);
    if (!angle || !vanishing_of(graph, m, *angle)) return {};
    const auto along = along_turn(context, g);
    if (!along) return {};
    const auto vanishing = vanishing_of(graph, m, along->angle);
    const double radial = along->most * vanishing->slope,
                 across = along->across() * vanishing->size;
    const double by = vanishing->radial ? std::hypot(radial, across) : radial + across;
    if (!std::isfinite(by)) return {};
    Around out = around_of(graph, *along, m, by);
    out.is_apart = vanishing->radial;
    out.radial = ir::rounding::up(radial, 16), out.across = ir::rounding::up(across, 16);
    return out;
}

// Does an expression keep its value where [x, y], two coordinates of the point, are turned?
struct AllAround {
    Graph &graph;
    NodeId x, y;
    std::unordered_map<NodeId, bool> known{};

    bool keeps(NodeId id) {
        const ir::Graph::Reads reads = graph.reads(id);
        if (reads.normal || reads.direction || reads.free_vars) return false;
        if (!reads.point) return true;
        if (const auto it = known.find(id); it != known.end()) return it->second;
        known[id] = false; // while it is looked at
        const bool out = known.size() <= max_nodes_of_turn && (by_parts(id) || by_squares(id));
        return known[id] = out;
    }

  private:
    bool by_parts(NodeId id) {
        constexpr ir::OpSet opaque{Op::Point, Op::Loop, Op::Call, Op::LoopResult, Op::Cached};
        const ir::Node node = graph[id];
        if (opaque[node.op] || id == x || id == y || node.count == 0) return false;
        if (node.op == Op::Swizzle && graph.arg(id, 0) == graph.arg(x, 0)) {
            for (int i = 0; i < ir::components(node.type); ++i) {
                const NodeId part = component_of(graph, id, i);
                if (part == x || part == y) return false;
            }
            return true;
        }
        const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
        return std::ranges::all_of(args, [&](NodeId arg) { return keeps(arg); });
    }
    // A sum of x*x + y*y, times what keeps its value, and such.
    bool by_squares(NodeId id) {
        const Op op = graph[id].op;
        if (op == Op::Length) {
            const NodeId v = graph.arg(id, 0);
            return by_squares(graph.make(Op::Dot, {v, v}));
        }
        if (op != Op::Dot && op != Op::Add) return false;
        const auto terms = terms_of(graph, id);
        if (!terms) return false;
        std::map<std::vector<NodeId>, std::array<double, 2>> squares; // by the other factors
        for (const Term &term : *terms) {
            std::vector<NodeId> others;
            std::array<int, 2> times{};
            for (const NodeId factor : term.factors) {
                if (factor == x || factor == y)
                    ++times[factor == x ? 0 : 1];
                else if (factor == id || !keeps(factor))
                    return false;
                else
                    others.push_back(factor);
            }
            if (times[0] + times[1] == 0) continue;
            if (times[0] != 2 && times[1] != 2) return false;
            if (times[0] + times[1] != 2) return false;
            squares[others][times[0] == 2 ? 0 : 1] += term.by;
        }
        return std::ranges::all_of(squares,
                                   [](const auto &one) { return one.second[0] == one.second[1]; });
    }
};

// m and b of m [cos(b), sin(b)], in either order and with any signs.
struct PolarVector {
    NodeId m, b;
};
std::optional<PolarVector> polar_vector(Graph &graph, NodeId id) {
    const ir::Node node = graph[id];
    if (node.type != ir::Type::Vec2 || (node.op != Op::Mul && node.op != Op::Make)) return {};
    NodeId common;
    if (node.op == Op::Mul)
        for (int i = 0; i < 2; ++i)
            if (const NodeId part = graph.arg(id, i); graph[part].op == Op::Splat)
                common = graph.arg(part, 0), id = graph.arg(id, 1 - i);
    if (graph[id].op != Op::Make || graph[id].count != 2) return {};
    PolarVector out;
    bool cosine = false, sine = false;
    for (int i = 0; i < 2; ++i) {
        NodeId part = graph.arg(id, i), m = common;
        if (graph[part].op == Op::Neg) part = graph.arg(part, 0);
        for (int k = 0; !common && graph[part].op == Op::Mul && k < 2; ++k)
            if (const NodeId wave = graph.arg(part, k);
                graph[wave].op == Op::Sin || graph[wave].op == Op::Cos) {
                m = graph.arg(part, 1 - k), part = wave;
                break;
            }
        const Op op = graph[part].op;
        if (!m || (op != Op::Sin && op != Op::Cos)) return {};
        (op == Op::Sin ? sine : cosine) = true;
        const NodeId b = graph.arg(part, 0);
        if (i == 1 && (m != out.m || b != out.b)) return {};
        out = {m, b};
    }
    return cosine && sine ? std::optional(out) : std::nullopt;
}

} // namespace

std::optional<Around> around_axis(Flattening &context, NodeId product) {
    Graph &graph = context.graph;
    if (!context.ranges || graph[product].type != ir::Type::Float || graph[product].op != Op::Mul)
        return {};
    const NodeId a = graph.arg(product, 0), b = graph.arg(product, 1);
    if (const auto found = found_around(context, a, b)) return found;
    return found_around(context, b, a);
}

std::optional<BesideTurn> beside_turn(Flattening &context, NodeId sum) {
    Graph &graph = context.graph;
    const ir::Node node = graph[sum];
    if ((node.op != Op::Add && node.op != Op::Sub) || node.type != ir::Type::Float) return {};
    for (int i = 0; i < 2; ++i) {
        BesideTurn out{graph.arg(sum, 1 - i), {}, 1};
        NodeId product = graph.arg(sum, i);
        if (!graph.reads(out.still).point || !angle_in(graph, product)) continue;
        auto around = around_axis(context, product);
        while (!around) { // a number times it
            NodeId inner;
            if (graph[product].op == Op::Neg) inner = graph.arg(product, 0);
            for (int k = 0; graph[product].op == Op::Mul && k < 2; ++k)
                if (const auto by = graph.as_number(graph.arg(product, k)))
                    inner = graph.arg(product, 1 - k), out.by *= std::fabs(*by);
            if (!inner) break;
            product = inner, around = around_axis(context, product);
        }
        if (!around || !around->is_apart) continue;
        const NodeId y = graph.arg(around->angle, 0), x = graph.arg(around->angle, 1);
        const auto is_coordinate = [&](NodeId id) {
            return graph[id].op == Op::Swizzle && graph[graph.arg(id, 0)].op == Op::Point;
        };
        if (x == y || !is_coordinate(x) || !is_coordinate(y) || graph.arg(x, 0) != graph.arg(y, 0))
            continue; // of one point
        if (!AllAround{graph, x, y}.keeps(out.still)) continue;
        out.turns = *around;
        return out;
    }
    return {};
}

bool is_polar_vector(ir::Graph &graph, NodeId vector) {
    return polar_vector(graph, vector).has_value();
}

std::optional<Around> vector_around_axis(Flattening &context, NodeId vector) {
    Graph &graph = context.graph;
    if (!context.ranges) return {};
    const auto found = polar_vector(graph, vector);
    if (!found) return {};
    const auto angle = angle_in(graph, found->b);
    if (!angle || !vanishing_of(graph, found->m, *angle)) return {};
    const auto along = along_turn(context, found->b);
    if (!along) return {};
    const auto vanishing = vanishing_of(graph, found->m, along->angle);
    if (!vanishing->radial) return {};
    const double by = std::max(vanishing->slope, along->across() * vanishing->size);
    if (!std::isfinite(by)) return {};
    return around_of(graph, *along, found->m, by);
}

} // namespace fathom::proof
