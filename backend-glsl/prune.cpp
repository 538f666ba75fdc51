#include "backend-glsl/prune.h"

#include "backend-glsl/module.h"
#include "backend-glsl/slope.h"
#include "backend-glsl/template.h"
#include "ir/passes/inline.h"
#include "ir/passes/walk.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/type_ptr.hpp>
#include <set>
#include <tuple>
#include <unordered_set>

namespace fathom::glsl {

using ir::Graph;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

// The distance of a hit's expression; none where it is not plain.
NodeId distance_of(Graph &graph, NodeId id, int depth = 0) {
    constexpr int max_depth = 12; // a hit may stand in both arms of another, again and again
    const ir::Node node = graph[id];
    if (node.type == Type::Float) return id;
    if (depth > max_depth) return {};
    const std::vector<NodeId> args(graph.args(id).begin(), graph.args(id).end());
    if (node.op == Op::MakeHit) return args[0];
    if (node.op == Op::HitWith) return args[1];
    if (node.op == Op::FillPaint) return distance_of(graph, args[0], depth + 1);
    if (node.op == Op::Select) {
        const NodeId yes = distance_of(graph, args[1], depth + 1),
                     no = distance_of(graph, args[2], depth + 1);
        return yes && no ? graph.make(Op::Select, {args[0], yes, no}) : NodeId{};
    }
    return {};
}

constexpr std::size_t most_written_out = 2000; // nodes of what is differentiated

// In diagonals of a cell.
constexpr double far_from = 0.625; // a cell is far whose centre is farther from surfaces
constexpr double min_way = 0.125;  // a shorter way ahead is none

class Planner {
  public:
    Planner(const ir::Scene &scene, const std::map<std::uint32_t, NodeId> &results)
        : plan_{scene, {}, {}}, graph_(plan_.scene.graph), results_(results) {
        point_ = graph_.fresh_var(Type::Vec3);
        row_ = graph_.fresh_var(Type::Int);
        acc_ = graph_.fresh_var(Type::Float);
    }

    PrunePlan run() {
        std::set<std::uint32_t> seen;
        for (ir::FunctionId id : {plan_.scene.distance, plan_.scene.hit, plan_.scene.shaded})
            if (id && (seen.insert(id.index).second)) look_through(id);
        return std::move(plan_);
    }

  private:
    // The loops of a function's own body, those apart whose record two of them share.
    void look_through(ir::FunctionId id) {
        const ir::Function &function = graph_.function(id);
        const auto other = results_.find(id.index);
        std::vector<NodeId> todo{other == results_.end() ? function.result : other->second}, loops;
        const NodeId point = function.params[0];
        std::unordered_set<NodeId> seen;
        std::map<std::uint32_t, int> uses;
        while (!todo.empty()) {
            const NodeId node = todo.back();
            todo.pop_back();
            if (!seen.insert(node).second) continue;
            todo.insert(todo.end(), graph_.args(node).begin(), graph_.args(node).end());
            if (graph_[node].op != Op::Loop) continue;
            loops.push_back(node);
            ++uses[graph_[node].payload];
        }
        std::ranges::sort(loops);
        for (NodeId loop : loops)
            if (uses[graph_[loop].payload] == 1) add(loop, point);
    }

    void add(NodeId node, NodeId point) {
        const std::uint32_t index = graph_[node].payload;
        const ir::Loop loop = graph_.loop(ir::LoopId{index});
        const auto count = graph_.as_number(loop.count);
        if (loop.vars.size() != 1 || loop.condition || !count || *count < min_pruned ||
            *count != loop.max_count)
            return;
        const NodeId next = loop.next[0];
        const Op op = graph_[next].op;
        const std::size_t first = op == Op::Blend ? 2 : 0;
        if (op != Op::Blend && op != Op::Union && op != Op::NearestHit) return;
        // Other profiles may be steeper than what they join.
        if (op == Op::Blend &&
            graph_[next].payload != static_cast<std::uint32_t>(ir::Profile::Smooth))
            return;
        const std::vector<NodeId> args(graph_.args(next).begin(), graph_.args(next).end());
        if (args.size() != first + 2 || args[first] != loop.vars[0]) return;

        const ir::Substitution plain{{point, point_}, {loop.index, row_}, {loop.vars[0], acc_}};
        const auto renamed = [&](NodeId id) { return id ? ir::substitute(graph_, id, plain) : id; };
        const NodeId value = renamed(distance_of(graph_, args[first + 1])),
                     start = renamed(distance_of(graph_, graph_.arg(node, 0)));
        const NodeId radius = op == Op::Blend ? args[0] : graph_.number(0);
        if (!value || !start || !reads_only(value, {point_, row_}) ||
            !reads_only(start, {point_}) || !reads_only(radius, {}))
            return;
        NodeId joined = graph_.make(Op::Union, {acc_, value});
        if (op == Op::Blend) joined = renamed(next);
        if (!reads_only(joined, {point_, row_, acc_})) return;

        const auto key = std::make_tuple(value, start, joined);
        const auto [it, fresh] = known_.try_emplace(key, static_cast<int>(plan_.grids.size()));
        if (fresh) {
            PrunedLoop made;
            made.slope = slope(value);
            made.acc_slope = std::max(made.slope, slope(start));
            if (!(made.acc_slope <= steepest_pruned) || plan_.grids.size() >= max_grids) {
                it->second = -1;
                return;
            }
            made.blended = op == Op::Blend;
            made.rows = loop.max_count;
            made.value = graph_.add_function({"value", {}, {point_, row_}, value});
            made.start = graph_.add_function({"start", {}, {point_}, start});
            made.joined = graph_.add_function({"joined", {}, {acc_, point_, row_}, joined});
            made.radius = graph_.add_function({"radius", {}, {point_}, radius});
            plan_.grids.push_back(made);
        }
        if (it->second >= 0) plan_.loops[index] = {it->second, loop.max_count, point};
    }

    bool reads_only(NodeId id, std::initializer_list<NodeId> vars) const {
        const Graph::Reads reads = graph_.reads(id);
        if (reads.point || reads.normal || reads.direction) return false;
        return std::ranges::all_of(graph_.free_vars(id), [&](NodeId var) {
            return std::ranges::find(vars, var) != vars.end();
        });
    }

    double slope(NodeId id) {
        return slope_of(graph_, ir::without_calls(graph_, id, most_written_out).root, point_);
    }

    PrunePlan plan_;
    Graph &graph_;
    const std::map<std::uint32_t, NodeId> &results_;
    NodeId point_, row_, acc_;
    std::map<std::tuple<NodeId, NodeId, NodeId>, int> known_; // -1: cannot be pruned
};

} // namespace

std::optional<PrunePlan> plan_pruning(const ir::Scene &scene,
                                      const std::map<std::uint32_t, NodeId> &results) {
    if (scene.bounds.empty() || !scene.bounds.finite()) return std::nullopt;
    const auto long_loop = [&](ir::LoopId id) {
        return scene.graph.loop(id).max_count >= min_pruned;
    };
    bool any = false;
    for (std::size_t i = 0; i < scene.graph.loop_count(); ++i) any |= long_loop(ir::LoopId{i});
    if (!any) return std::nullopt;
    PrunePlan plan = Planner(scene, results).run();
    if (plan.grids.empty()) return std::nullopt;
    return plan;
}

std::string prune_look_up(const ir::Box &bounds) {
    return expand("prune_rows", {{"LO", vec3_literal(glm::make_vec3(bounds.lo.data()))},
                                 {"HI", vec3_literal(glm::make_vec3(bounds.hi.data()))}});
}

std::string far_look_up(const std::string &outside) {
    return expand("prune_far", {{"OUTSIDE", outside}, {"MIN_WAY", float_literal(min_way)}});
}

std::string prune_around(const std::string &hit) { return expand("prune_around", {{"HIT", hit}}); }

std::string far_kernel(const std::string &sdf) {
    return expand("prune_make_far", {{"SDF", sdf}, {"FAR_FROM", float_literal(far_from)}});
}

std::string prune_kernel(const PrunedLoop &loop, const PruneNames &names) {
    const Values values{
        {"BLENDED", loop.blended ? "1" : ""},
        {"ROWS", fmt::to_string(loop.rows)},
        {"SLOPE", float_literal(static_cast<float>((loop.slope + loop.acc_slope) * 1.000001))},
        {"VALUE", names.value},
        {"START", names.start},
        {"JOINED", names.joined},
        {"BLEND_RADIUS", names.radius}};
    return expand("prune_kernel", values);
}

} // namespace fathom::glsl
