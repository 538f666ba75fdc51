// One row an op. The numbers of noise and look-ups are measured (docs/noise-cache.md); the others
// are by their number of instructions.
#include "ir/passes/cost.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::ir {
namespace {

constexpr double simple = 0.03, division = 0.1, curve = 0.4;

double own_cost(const Node &node) {
    const double size = components(node.type);
    switch (node.op) {
    case Op::Const:
    case Op::Point:
    case Op::Normal:
    case Op::Direction:
    case Op::Time:
    case Op::Param:
    case Op::Var:
    case Op::Splat:
    case Op::Make:
    case Op::Swizzle:
    case Op::Column:
    case Op::Transpose:
    case Op::FoldResult:
    case Op::HitDistance:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra:
    case Op::MakeHit:
    case Op::HitWith: return 0;
    case Op::Neg:
    case Op::Not:
    case Op::Add:
    case Op::Sub:
    case Op::Mul:
    case Op::Min:
    case Op::Max:
    case Op::Abs:
    case Op::Sign:
    case Op::Step:
    case Op::Floor:
    case Op::Ceil:
    case Op::Round:
    case Op::Trunc:
    case Op::Fract:
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::And:
    case Op::Or:
    case Op::Select:
    case Op::ToFloat:
    case Op::ToInt: return simple * size;
    case Op::Clamp:
    case Op::Mix:
    case Op::Smoothstep: return 3 * simple * size;
    case Op::Div:
    case Op::Mod:
    case Op::Sqrt:
    case Op::InverseSqrt: return division * size;
    case Op::Dot:
    case Op::Cross:
    case Op::MatMul: return 9 * simple;
    case Op::Length:
    case Op::Normalize: return division + 6 * simple;
    case Op::Union:
    case Op::Intersection: return simple * node.count;
    case Op::NearestHit:
    case Op::FarthestHit:
    case Op::FillPaint: return 9 * simple * node.count;
    case Op::Blend: return 8 * simple * node.count;
    case Op::Pow:
    case Op::Atan2:
    case Op::Exp:
    case Op::Exp2:
    case Op::Log:
    case Op::Log2:
    case Op::Sin:
    case Op::Cos:
    case Op::Tan:
    case Op::Asin:
    case Op::Acos:
    case Op::Atan:
    case Op::Sinh:
    case Op::Cosh:
    case Op::Tanh: return curve * size;
    case Op::TableRead: return 0.5;
    case Op::Hash: return 0.4;
    case Op::Perlin:
    case Op::Simplex: return octave_cost;
    case Op::ValueNoise: return 1.8;
    case Op::Worley: return worley_cost;
    case Op::SpotNoise: return spot_cost;
    case Op::Image:
    case Op::Grid: return 3;
    case Op::Call:
    case Op::Fold:
    case Op::Cached: return 0; // by what they hold
    }
    return 0;
}

} // namespace

double cost_of(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    double cost = 0;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        const Node &node = graph[id];
        cost += own_cost(node);
        if (node.op == Op::Call)
            cost += cost_of(graph, graph.function(FunctionId{node.payload}).result);
        if (node.op == Op::Cached)
            cost += cost_of(graph, graph.function(graph.cache(CacheId{node.payload}).field).result);
        if (node.op == Op::Fold) {
            const Fold &fold = graph.fold(FoldId{node.payload});
            double turn = fold.condition ? cost_of(graph, fold.condition) : 0;
            for (NodeId next : fold.next) turn += cost_of(graph, next);
            cost += fold.max_count * turn;
        }
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
    }
    return cost;
}

bool reads_worley(const Graph &graph, NodeId root) {
    std::vector<NodeId> todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second) continue;
        const Node &node = graph[id];
        if (node.op == Op::Worley) return true;
        if (node.op == Op::Call) todo.push_back(graph.function(FunctionId{node.payload}).result);
        if (node.op == Op::Cached)
            todo.push_back(graph.function(graph.cache(CacheId{node.payload}).field).result);
        if (node.op == Op::Fold)
            for (NodeId next : graph.fold(FoldId{node.payload}).next) todo.push_back(next);
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
    }
    return false;
}

Kept kept(const Scene &scene, CacheId cache) {
    const NodeId field = scene.graph.function(scene.graph.cache(cache).field).result;
    if (scene.graph.reads(field).time) return Kept::Moving;
    const double cost = cost_of(scene.graph, field);
    if (cost < look_up_cost) return Kept::Cheap;
    if (reads_worley(scene.graph, field) && ridged_share * cost < look_up_cost) return Kept::Ridged;
    if (cache.index >= scene.caches.size() || !std::isfinite(scene.caches[cache.index].slope))
        return Kept::Steep;
    return Kept::Yes;
}

double kept_error(const Scene &scene, CacheId cache) {
    const CacheFact &fact = scene.caches[cache.index];
    const double by_slope = fact.slope * scene.graph.cache(cache).cell * std::sqrt(3.0) / 2;
    return std::min(by_slope, fact.span);
}

} // namespace fathom::ir
