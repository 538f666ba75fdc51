// The column `cost` of ir/ops.def. The numbers of noise and look-ups are measured
// (docs/noise-cache.md); the others are by their number of instructions. What holds other
// expressions (Call, Loop, Cached) costs what these do.
#include "ir/passes/cost.h"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace fathom::ir {
namespace {

constexpr double simple = 0.03, division = 0.1, curve = 0.4; // an instruction, …, sin or exp

double own_cost(const Node &node) {
    const double size = components(node.type), count = node.count;
    switch (node.op) {
#define FATHOM_OP(name, arity, rule, glsl, text, weight, cost, ...)                                \
    case Op::name: {                                                                               \
        return cost;                                                                               \
    }
#include "ir/ops.def"
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
        if (node.op == Op::Loop) {
            const Loop &loop = graph.loop(LoopId{node.payload});
            double iteration = loop.condition ? cost_of(graph, loop.condition) : 0;
            for (NodeId next : loop.next) iteration += cost_of(graph, next);
            cost += loop.max_count * iteration;
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
        if (node.op == Op::Loop)
            for (NodeId next : graph.loop(LoopId{node.payload}).next) todo.push_back(next);
        for (NodeId arg : graph.args(id)) todo.push_back(arg);
    }
    return false;
}

Cacheable cached(const Scene &scene, CacheId cache) {
    const NodeId field = scene.graph.function(scene.graph.cache(cache).field).result;
    if (scene.graph.reads(field).time) return Cacheable::Moving;
    const double cost = cost_of(scene.graph, field);
    if (cost < look_up_cost) return Cacheable::Cheap;
    if (reads_worley(scene.graph, field) && ridged_share * cost < look_up_cost)
        return Cacheable::Ridged;
    if (cache.index >= scene.caches.size() || !std::isfinite(scene.caches[cache.index].slope))
        return Cacheable::Steep;
    return Cacheable::Yes;
}

double cached_error(const Scene &scene, CacheId cache) {
    const CacheFact &fact = scene.caches[cache.index];
    const double by_slope = fact.slope * scene.graph.cache(cache).cell * std::sqrt(3.0) / 2;
    return std::min(by_slope, fact.span);
}

} // namespace fathom::ir
