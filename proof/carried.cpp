#include "proof/carried.h"

#include "ir/interval.h"
#include "ir/noise.h"
#include "proof/exact.h"
#include "proof/machine.h"
#include "proof/work.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <unordered_map>
#include <unordered_set>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::rounding::infinity;
using ir::rounding::times;

constexpr std::size_t max_nodes_carried = 2'000;

// Errors of all components of a node alike, in one box.
struct Moved {
    const Graph &graph;
    Enclosed values;
    bool stand = false;                          // choices and steps do
    std::unordered_map<NodeId, double> errors{}; // of what the granted value moves

    double error(NodeId id) const {
        const auto it = errors.find(id);
        return it == errors.end() ? 0 : it->second;
    }
    int components(NodeId id) const { return ir::components(graph[id].type); }
    // What all components may be, moved or not.
    Interval enclosed(NodeId id) {
        if (ir::is_matrix(graph[id].type)) return of_matrix(id);
        Interval all = values.of(id);
        for (int i = 1; i < components(id); ++i) all = hull(all, values.of(id, i));
        const double e = error(id);
        return e == 0 ? all : Interval(all.lo - e, all.hi + e);
    }
    Interval of_matrix(NodeId id) {
        if (!graph.is_constant(id)) return Interval::everything();
        double most = 0;
        for (int i = 0; i < components(id); ++i)
            most =
                std::max(most, std::fabs(graph.constant_of(id).value[static_cast<std::size_t>(i)]));
        return {-most, most};
    }
    double size(NodeId id) { return enclosed(id).magnitude(); }

    double product(NodeId a, NodeId b) {
        return times(size(a), error(b)) + times(size(b), error(a));
    }
    double quotient(NodeId a, NodeId b) {
        const double least = enclosed(b).mignitude();
        if (!(least > 0)) return infinity;
        return error(a) / least + times(size(a) / least, error(b) / least);
    }
    // A root and an inverse sine are infinitely steep at an end, and move no further than this there.
    static double holder(Op op, double e) {
        if (op == Op::Sqrt) return std::sqrt(e);
        return op == Op::Asin || op == Op::Acos ? 2.3 * std::sqrt(e) : infinity;
    }
    double smooth(NodeId x, Op op, Interval slope) const {
        return std::min(times(slope.magnitude(), error(x)), holder(op, error(x)));
    }
    double power(NodeId x, NodeId y) {
        const Interval exponent = enclosed(y), base = enclosed(x);
        if (error(y) > 0 || !exponent.is_point()) return infinity;
        const double n = exponent.lo;
        if (n >= 1) return times(n * std::pow(base.magnitude(), n - 1), error(x));
        if (n > 0) return std::pow(error(x), n);
        return base.mignitude() > 0
                   ? times(std::fabs(n) * std::pow(base.mignitude(), n - 1), error(x))
                   : infinity;
    }
    double of_noise(NodeId x, double slope) const {
        return slope * std::sqrt(components(x)) * error(x);
    }
    std::optional<double> standing(NodeId id);
    double carried(NodeId id);
};

// What stands where it is, though its argument moves.
std::optional<double> Moved::standing(NodeId id) {
    constexpr ir::OpSet stands{Op::Sign,  Op::Step,  Op::Less,     Op::LessEqual, Op::Equal,
                               Op::Floor, Op::Ceil,  Op::Round,    Op::Trunc,     Op::NotEqual,
                               Op::And,   Op::Or,    Op::Not,      Op::Hash,      Op::ToInt,
                               Op::Param, Op::Time,  Op::Var,      Op::Point,     Op::Image,
                               Op::Grid,  Op::Const, Op::TableRead};
    const ir::Node node = graph[id];
    if (stands[node.op]) return 0.0;
    if (node.op == Op::ToFloat || node.op == Op::Fract) return error(graph.arg(id, 0));
    if (node.op == Op::Select) return std::max(error(graph.arg(id, 1)), error(graph.arg(id, 2)));
    if (node.op == Op::Mod) { // x - m n
        const NodeId m = graph.arg(id, 1);
        const double least = enclosed(m).mignitude();
        if (error(m) > 0 && !(least > 0)) return infinity;
        const double turns = error(m) > 0 ? size(graph.arg(id, 0)) / least + 1 : 0;
        return error(graph.arg(id, 0)) + times(turns, error(m));
    }
    if (node.op == Op::Normalize) {
        const NodeId q = graph.arg(id, 0);
        double squares = 0;
        for (int i = 0; i < components(q); ++i) squares += square(values.of(q, i)).lo;
        return squares > 0 ? std::sqrt(components(q)) * error(q) / std::sqrt(squares) : infinity;
    }
    return {};
}

double Moved::carried(NodeId id) {
    const ir::Node node = graph[id];
    const auto arg = [&](int k) { return graph.arg(id, k); };
    if (stand)
        if (const auto is = standing(id)) return *is;
    double most = 0;
    for (const NodeId a : graph.args(id)) most = std::max(most, error(a));
    if (!std::isfinite(most)) return infinity;
    switch (node.op) {
    case Op::Neg:
    case Op::Abs:
    case Op::Min:
    case Op::Max:
    case Op::Union:
    case Op::Intersection:
    case Op::Clamp:
    case Op::Splat:
    case Op::Swizzle:
    case Op::Make:
    case Op::Column:
    case Op::Transpose: return most;
    case Op::Add:
    case Op::Sub: return error(arg(0)) + error(arg(1));
    case Op::Mul: return product(arg(0), arg(1));
    case Op::Div: return node.type == ir::Type::Int ? infinity : quotient(arg(0), arg(1));
    case Op::Dot: return components(arg(0)) * product(arg(0), arg(1));
    case Op::Cross: return 2 * product(arg(0), arg(1));
    case Op::MatMul: {
        const NodeId of = ir::is_matrix(graph[arg(0)].type) ? arg(0) : arg(1);
        return ir::side(graph[of].type) * product(arg(0), arg(1));
    }
    case Op::Length: return std::sqrt(components(arg(0))) * error(arg(0));
    case Op::Mix:
        return error(arg(0)) + times(size(arg(2)), error(arg(0)) + error(arg(1))) +
               times(size(arg(0)) + size(arg(1)), error(arg(2)));
    case Op::Pow: return power(arg(0), arg(1));
    case Op::Smoothstep: {
        const double width = (enclosed(arg(1)) - enclosed(arg(0))).mignitude();
        if (error(arg(0)) > 0 || error(arg(1)) > 0 || !(width > 0)) return infinity;
        return 1.5 * error(arg(2)) / width;
    }
    case Op::Sign:
    case Op::Step: {
        const Interval way =
            node.op == Op::Sign ? enclosed(arg(0)) : enclosed(arg(1)) - enclosed(arg(0));
        return way.contains(0) ? infinity : 0;
    }
    case Op::Less:
    case Op::LessEqual: return (enclosed(arg(1)) - enclosed(arg(0))).contains(0) ? infinity : 0;
    case Op::Select: return error(arg(0)) > 0 ? infinity : most;
#define FATHOM_FUNCTION(name, function, ...)                                                       \
    case Op::name:                                                                                 \
        return smooth(arg(0), node.op, ir::slope::function(enclosed(arg(0))));
#include "ir/ops.def"
    case Op::Perlin: return of_noise(arg(0), ir::sem::perlin_slope);
    case Op::Simplex: return of_noise(arg(0), ir::sem::simplex_slope);
    case Op::ValueNoise: return of_noise(arg(0), ir::sem::value_noise_slope);
    case Op::Worley: return of_noise(arg(0), ir::sem::worley_slope);
    case Op::Atan2: {
        const double least = std::hypot(enclosed(arg(0)).mignitude(), enclosed(arg(1)).mignitude());
        const bool cut = enclosed(arg(0)).contains(0) && enclosed(arg(1)).lo <= 0;
        return least > 0 && !cut ? (error(arg(0)) + error(arg(1))) / least : infinity;
    }
    case Op::Normalize:
    case Op::Mod:
    case Op::Floor:
    case Op::Ceil:
    case Op::Round:
    case Op::Trunc:
    case Op::Fract:
    case Op::Hash:
    case Op::ToInt:
    case Op::ToFloat:
    case Op::Equal:
    case Op::NotEqual:
    case Op::And:
    case Op::Or:
    case Op::Not:
    case Op::SpotNoise:
    case Op::Image:
    case Op::Grid:
    case Op::TableRead:
    case Op::Blend:
    case Op::Const:
    case Op::Param:
    case Op::Time:
    case Op::Var:
    case Op::Point:
    case Op::Normal:
    case Op::Direction:
    case Op::Call:
    case Op::Cached:
    case Op::Loop:
    case Op::LoopResult:
    case Op::FillPaint:
    case Op::HitDistance:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra:
    case Op::HitWith:
    case Op::MakeHit:
    case Op::NearestHit:
    case Op::FarthestHit: break;
    }
    return infinity;
}

// What the field is made of by way of `at`, arguments first.
std::vector<NodeId> users_of(const Graph &graph, NodeId field, NodeId at) {
    std::vector<NodeId> all, todo{field};
    std::unordered_map<NodeId, bool> reads;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (id < at || !reads.emplace(id, id == at).second) continue; // users have later ids
        all.push_back(id);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    std::sort(all.begin(), all.end());
    std::erase_if(all, [&](NodeId id) {
        for (const NodeId a : graph.args(id)) {
            const auto it = reads.find(a);
            reads[id] = reads[id] || (it != reads.end() && it->second);
        }
        return !reads[id] || id == at;
    });
    return all;
}

} // namespace

double written_off(const Graph &graph, NodeId value, Enclosed values, Work &work) {
    std::vector<NodeId> all, todo{value};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        all.push_back(id);
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    if (all.size() > max_nodes_carried) return infinity;
    work.take(16 * all.size());
    std::sort(all.begin(), all.end());
    Moved moved{graph, std::move(values), true};
    for (const NodeId id : all) {
        double off = 0;
        if (graph.is_constant(id)) {
            for (int i = 0; i < ir::components(graph[id].type); ++i) {
                const double x = graph.constant_of(id).value[static_cast<std::size_t>(i)];
                if (!is_of_few_bits(x)) off = std::max(off, written_of_numbers * std::fabs(x));
            }
        } else {
            off = moved.carried(id);
        }
        moved.errors[id] = off;
    }
    return moved.error(value);
}

Carried is_carried(const Graph &graph, NodeId field, const Granted &granted, const Ranges *ranges,
                   Work &work, Apart &moved) {
    const std::vector<NodeId> users = users_of(graph, field, granted.at);
    if (users.size() > max_nodes_carried) return Carried::Nowhere;
    Carried out = Carried::Nowhere;
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        constexpr std::size_t of_node = 16;
        work.take(of_node * (users.size() + 1));
        if (work.spent()) return Carried::Nowhere;
        const auto index = std::size_t(scale - least_scale);
        const double distance = distance_at(scale);
        const double most = granted_to_sides * most_size_at(distance);
        std::array<Interval, 3> box;
        box.fill(Interval(-distance, distance));
        const Enclosed values(graph, ranges, box);
        const auto carried = [&](double off) {
            Moved from{graph, values};
            from.errors[granted.at] = off;
            for (const NodeId id : users) from.errors[id] = from.carried(id);
            return from.error(field);
        };
        double all = granted.apart[index] > 0 ? carried(granted.apart[index]) : 0;
        moved[index] = std::max(moved[index], all);
        if (granted.beside && granted.at != field) {
            const double size = Moved{graph, values}.size(granted.at);
            all = carried(std::max(granted.apart[index], std::min(granted_to_sides * size, most)));
        }
        if (!(all <= most)) return out;
        if (distance >= near_enough) out = Carried::Near;
    }
    return Carried::Everywhere;
}

bool is_unseen(const Apart &apart, const std::array<Interval, 3> *region) {
    constexpr double of_region = 2e-5; // of what it is from its middle to its sides
    double reach = 0, half = 0;
    if (region)
        for (const Interval &side : *region) {
            reach = std::max(reach, side.magnitude());
            half = std::max(half, side.width() / 2);
        }
    const bool ends = region && std::isfinite(reach);
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        const double distance = distance_at(scale), off = apart[std::size_t(scale - least_scale)];
        if (off > (ends ? of_region * half : most_written_at(distance))) return false;
        if (ends ? distance >= reach : distance >= near_enough) return true;
    }
    return true;
}

} // namespace fathom::proof
