// The frame of the error analysis: what is evaluated in which order, calls and loops. The rules for
// the ops stand in rounding_rules.cpp.
#include "proof/rounding.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

namespace fathom::proof {

using ir::rounding::infinity;

namespace {

Rounded joined(const Rounded &x, const Rounded &y) {
    if (x.value == y.value && x.error == y.error && x.relative == y.relative &&
        x.gradient == y.gradient && x.root_error == y.root_error && x.off == y.off)
        return x;
    return {hull(x.value, y.value),
            std::max(x.error, y.error),
            std::max(x.relative, y.relative),
            false,
            {}};
}

} // namespace

std::vector<NodeId> reached_from(const ir::Graph &graph, const std::vector<NodeId> &roots) {
    std::vector<NodeId> out, todo = roots;
    std::unordered_map<NodeId, bool> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.emplace(id, true).second) continue;
        out.push_back(id);
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    std::sort(out.begin(), out.end());
    return out;
}

RoundingMachine::RoundingMachine(const ir::Scene &scene, ir::FunctionId function)
    : scene_(scene), function_(function), vars_(scene.graph.var_count()) {}

RoundingMachine::Plan &RoundingMachine::plan_of(const std::vector<NodeId> &roots) {
    auto &found = plans_[roots];
    if (found) return *found;
    found = std::make_unique<Plan>();
    Plan &plan = *found;
    const ir::Graph &graph = scene_.graph;
    std::unordered_map<NodeId, std::uint32_t> places;
    std::uint32_t size = 0;
    for (NodeId id : reached_from(graph, roots)) {
        const ir::Node &node = graph[id];
        if (node.op == Op::LoopResult) { // lies beside the loop's other values
            const ir::Loop &loop = graph.loop(ir::LoopId{graph[graph.arg(id, 0)].payload});
            std::uint32_t at = places.at(graph.arg(id, 0));
            for (std::uint32_t k = 0; k < node.payload; ++k)
                at += static_cast<std::uint32_t>(ir::components(graph[loop.vars[k]].type));
            places[id] = at;
            continue;
        }
        Step step;
        step.id = id;
        step.n = ir::components(node.type);
        for (NodeId a : graph.args(id)) {
            step.args.push_back(places.at(a));
            step.sizes.push_back(ir::components(graph[a].type));
        }
        step.out = places[id] = size;
        int room = step.n;
        if (node.op == Op::Loop) {
            room = 0;
            for (NodeId var : graph.loop(ir::LoopId{node.payload}).vars)
                room += ir::components(graph[var].type);
        }
        size += static_cast<std::uint32_t>(room);
        plan.steps.push_back(std::move(step));
    }
    plan.frame.resize(size);
    for (NodeId root : roots) plan.results.push_back(places.at(root));
    return plan;
}

void RoundingMachine::set_var(NodeId var, const Rounded *values) {
    const ir::Node &node = scene_.graph[var];
    vars_[node.payload].assign(values, values + ir::components(node.type));
}

Ranges::Sampled RoundingMachine::sampled(Op op, std::uint32_t payload) {
    if (!sampled_) sampled_ = std::make_unique<Ranges>(ranges_of(scene_, reading_));
    const auto &all = op == Op::Image ? sampled_->images : sampled_->grids;
    return payload < all.size() ? all[payload] : Ranges::Sampled{Interval::everything(), infinity};
}

void RoundingMachine::run(Plan &plan) {
    const ir::Graph &graph = scene_.graph;
    for (const Step &step : plan.steps) {
        if (++work_ > limit_) return;
        const ir::Node &node = graph[step.id];
        if (node.op == Op::Call)
            run_call(plan, step, ir::FunctionId{node.payload});
        else if (node.op == Op::Cached)
            run_call(plan, step, graph.cache(ir::CacheId{node.payload}).field);
        else if (node.op == Op::Loop)
            run_loop(plan, step);
        else
            run_step(plan, step);
    }
}

void RoundingMachine::run_call(Plan &plan, const Step &step, ir::FunctionId id) {
    const ir::Function &function = scene_.graph.function(id);
    // Functions may share their parameters' variables: those of the caller come back.
    std::vector<std::vector<Rounded>> before;
    for (std::size_t i = 0; i < function.params.size(); ++i) {
        before.push_back(vars_[scene_.graph[function.params[i]].payload]);
        set_var(function.params[i], &plan.frame[step.args[i]]);
    }
    Plan &body = plan_of({function.result});
    run(body);
    for (std::size_t i = 0; i < function.params.size(); ++i)
        vars_[scene_.graph[function.params[i]].payload] = std::move(before[i]);
    std::copy_n(&body.frame[body.results[0]], step.n, &plan.frame[step.out]);
}

// Turn by turn; where it may end after more than one, all are joined.
void RoundingMachine::run_loop(Plan &plan, const Step &step) {
    const ir::Graph &graph = scene_.graph;
    const ir::Loop &loop = graph.loop(ir::LoopId{graph[step.id].payload});
    std::vector<NodeId> roots = loop.next;
    roots.push_back(loop.count);
    if (loop.condition) roots.push_back(loop.condition);
    Plan &count_plan = plan_of({loop.count});
    run(count_plan);
    const Interval count = count_plan.frame[count_plan.results[0]].value;
    Plan &body = plan_of(roots);
    for (std::size_t k = 0; k < loop.vars.size(); ++k)
        set_var(loop.vars[k], &plan.frame[step.args[k]]);
    bool ended = false;
    const auto may_end = [&] {
        Rounded *out = &plan.frame[step.out];
        for (NodeId var : loop.vars)
            for (const Rounded &x : vars_[graph[var].payload]) {
                *out = ended ? joined(*out, x) : x;
                ++out;
            }
        ended = true;
    };
    const double most = std::clamp(count.hi, 0.0, double(loop.max_count));
    for (int turn = 0;; ++turn) {
        if (turn >= count.lo || turn >= most) may_end();
        if (turn >= most || work_ > limit_) break;
        const Rounded index{double(turn), 0, 0, true, {}};
        set_var(loop.index, &index);
        run(body);
        if (loop.condition) {
            const Interval go = body.frame[body.results.back()].value;
            if (go.lo < 0.5) may_end();
            if (go.hi < 0.5) break;
        }
        for (std::size_t k = 0; k < loop.vars.size(); ++k)
            set_var(loop.vars[k], &body.frame[body.results[k]]);
    }
}

double RoundingMachine::error(const Cell &cell, Interval time,
                              const std::vector<std::array<Interval, 4>> &params) {
    time_ = time, params_ = params;
    misplaced_ = 0;
    limit_ = work_ + most_work;
    const ir::Function &function = scene_.graph.function(function_);
    std::array<Rounded, 3> point{};
    for (std::size_t i = 0; i < 3; ++i) {
        point[i].value = cell.p[i];
        point[i].gradient[i] = 1;
    }
    set_var(function.params[0], point.data());
    Plan &plan = plan_of({function.result});
    run(plan);
    if (work_ > limit_) return infinity;
    value_ = plan.frame[plan.results[0]].value;
    // A field that falls by at most 1 a unit differs by twice that between its sides; three borders
    // may meet.
    const Rounded &field = plan.frame[plan.results[0]];
    return field.error + ir::rounding::times(field.relative, field.value.magnitude()) +
           6 * misplaced_;
}

} // namespace fathom::proof
