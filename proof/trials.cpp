#include "proof/trials.h"

#include "base/single.h"
#include "ir/passes/fold.h"
#include "proof/rounding.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Constant;
using ir::Op;
using ir::rounding::infinity;

namespace {

constexpr std::size_t most_work_of_trial = 30'000; // nodes at one point

// What decides: between its steps it is the same for all points.
constexpr ir::OpSet deciding{Op::Floor, Op::Ceil,  Op::Round,    Op::Trunc, Op::Sign,
                             Op::Step,  Op::ToInt, Op::Less,     Op::Equal, Op::LessEqual,
                             Op::And,   Op::Or,    Op::NotEqual, Op::Not,   Op::Hash};
// What keeps the digits of numbers that differ from cell to cell: their error is the error of where
// the cell lies.
constexpr ir::OpSet placing{Op::Add,       Op::Sub,    Op::Mul,         Op::Div,
                            Op::Neg,       Op::Make,   Op::Splat,       Op::Swizzle,
                            Op::Column,    Op::MatMul, Op::Transpose,   Op::ToFloat,
                            Op::MakeHit,   Op::Select, Op::HitDistance, Op::HitWith,
                            Op::FillPaint, Op::Var,    Op::LoopResult};

// As graphics cards have it: what is below the least normal number is 0.
Constant rounded(Constant x) {
    if (x.type != ir::Type::Int && x.type != ir::Type::Bool)
        for (int c = 0; c < ir::components(x.type); ++c) {
            double &v = x.value[static_cast<std::size_t>(c)];
            v = flushed(to_single(v));
        }
    return x;
}

} // namespace

double Trial::error() const {
    if (!std::isfinite(meant)) return 0; // not asked for
    return std::isfinite(computed) ? std::fabs(meant - computed) : infinity;
}

Trials::Trials(const ir::Scene &scene, ir::FunctionId function)
    : scene_(scene), function_(function), vars_(scene.graph.var_count()) {}

Trials::Plan &Trials::plan_of(const std::vector<NodeId> &roots) {
    auto &found = plans_[roots];
    if (found) return *found;
    found = std::make_unique<Plan>();
    const ir::Graph &graph = scene_.graph;
    std::unordered_map<NodeId, std::uint32_t> places;
    std::vector<std::pair<std::uint32_t, NodeId>> constants;
    std::uint32_t size = 0;
    for (NodeId id : reached_from(graph, roots)) {
        const ir::Node &node = graph[id];
        if (node.op == Op::LoopResult) {
            places[id] = places.at(graph.arg(id, 0)) + node.payload;
            continue;
        }
        if (node.op == Op::Const) {
            constants.emplace_back(size, id);
            places[id] = size++;
            continue;
        }
        Plan::Step step{id, {}, size};
        for (NodeId a : graph.args(id)) step.args.push_back(places.at(a));
        places[id] = size;
        size += node.op == Op::Loop
                    ? static_cast<std::uint32_t>(graph.loop(ir::LoopId{node.payload}).vars.size())
                    : 1;
        found->steps.push_back(std::move(step));
    }
    found->frame.resize(size);
    for (const auto &[place, id] : constants) {
        const Constant value = rounded(graph.constant_of(id));
        found->frame[place] = {value, value, Varies::Never};
    }
    for (NodeId root : roots) found->results.push_back(places.at(root));
    return *found;
}

void Trials::run(Plan &plan) {
    const ir::Graph &graph = scene_.graph;
    for (const Plan::Step &step : plan.steps) {
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

void Trials::run_call(Plan &plan, const Plan::Step &step, ir::FunctionId id) {
    const ir::Function &function = scene_.graph.function(id);
    const auto var = [&](std::size_t i) -> Number & {
        return vars_[scene_.graph[function.params[i]].payload];
    };
    // Functions may share their parameters' variables: those of the caller come back.
    std::vector<Number> before;
    for (std::size_t i = 0; i < function.params.size(); ++i) {
        before.push_back(var(i));
        var(i) = plan.frame[step.args[i]];
    }
    Plan &body = plan_of({function.result});
    run(body);
    for (std::size_t i = 0; i < function.params.size(); ++i) var(i) = before[i];
    plan.frame[step.out] = body.frame[body.results[0]];
}

void Trials::run_loop(Plan &plan, const Plan::Step &step) {
    const ir::Graph &graph = scene_.graph;
    const ir::Loop &loop = graph.loop(ir::LoopId{graph[step.id].payload});
    std::vector<NodeId> roots = loop.next;
    if (loop.condition) roots.push_back(loop.condition);
    Plan &count_plan = plan_of({loop.count}), &body = plan_of(roots);
    run(count_plan);
    const Number count = count_plan.frame[count_plan.results[0]];
    const auto var = [&](std::size_t k) -> Number & { return vars_[graph[loop.vars[k]].payload]; };
    for (std::size_t k = 0; k < loop.vars.size(); ++k) var(k) = plan.frame[step.args[k]];
    const double turns = std::min(count.computed.value[0], double(loop.max_count));
    Varies decided = count.varies;
    for (int turn = 0; turn < turns && work_ <= limit_; ++turn) {
        Constant index{ir::Type::Int, {}};
        index.value[0] = turn;
        vars_[graph[loop.index].payload] = {index, index, Varies::Never};
        run(body);
        if (loop.condition) {
            const Number &go = body.frame[body.results.back()];
            decided = std::max(decided, go.varies);
            if (go.computed.value[0] == 0) break;
        }
        for (std::size_t k = 0; k < loop.vars.size(); ++k) var(k) = body.frame[body.results[k]];
    }
    for (std::size_t k = 0; k < loop.vars.size(); ++k) {
        Number &out = plan.frame[step.out + k];
        out = var(k);
        out.varies = std::max(out.varies, decided);
    }
}

void Trials::run_step(Plan &plan, const Plan::Step &step) {
    const ir::Graph &graph = scene_.graph;
    const ir::Node &node = graph[step.id];
    const auto arg = [&](std::size_t i) -> const Number & { return plan.frame[step.args[i]]; };
    Number &r = plan.frame[step.out];
    r.varies = Varies::Never;
    for (std::size_t i = 0; i < step.args.size(); ++i) r.varies = std::max(r.varies, arg(i).varies);
    const std::size_t n = static_cast<std::size_t>(ir::components(node.type));
    const auto still = [&](const Constant &value) { r.meant = r.computed = rounded(value); };
    Constant given{node.type, {}};
    switch (node.op) {
    case Op::Var: r = vars_[node.payload]; return;
    case Op::Time: given.value[0] = time_; return still(given);
    case Op::Param:
        for (std::size_t c = 0; c < n; ++c) given.value[c] = params_[node.payload][c];
        return still(given);
    case Op::TableRead: {
        const ir::Table &table = graph.table(ir::table_of(node.payload));
        const int row = static_cast<int>(
            std::clamp(arg(0).computed.value[0], 0.0, double(std::max(table.rows - 1, 0))));
        const auto from =
            static_cast<std::size_t>(row * table.stride + ir::column_of(node.payload));
        for (std::size_t c = 0; c < n && from + c < table.data.size(); ++c)
            given.value[c] = double(table.data[from + c]);
        return still(given);
    }
    case Op::FillPaint:
    case Op::HitDistance:
    case Op::MakeHit: r = arg(0); return; // of a hit its distance alone is followed
    case Op::HitWith: r = arg(1); return;
    case Op::NearestHit:
    case Op::FarthestHit: {
        const double sign = node.op == Op::NearestHit ? 1 : -1;
        Number best = arg(0);
        for (std::size_t a = 1; a < step.args.size(); ++a) {
            best.meant.value[0] =
                sign * std::min(sign * best.meant.value[0], sign * arg(a).meant.value[0]);
            best.computed.value[0] =
                sign * std::min(sign * best.computed.value[0], sign * arg(a).computed.value[0]);
        }
        best.varies = r.varies;
        r = best;
        return;
    }
    case Op::Image:
    case Op::Grid:
    case Op::Point: // those of functions are variables
    case Op::Normal:
    case Op::Direction:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra: return still(given);
#define FATHOM_BOUND(...)
#define FATHOM_OP(name, ...) case Op::name:
#include "ir/ops.def"
    case Op::Const: // plan_of
    case Op::Call:
    case Op::Loop:
    case Op::LoopResult:
    case Op::Cached: break; // run
    }
    args_.clear();
    for (std::size_t i = 0; i < step.args.size(); ++i) args_.push_back(arg(i).computed);
    r.computed = rounded(*ir::evaluate_single(node.op, node.type, args_, node.payload));
    const bool decides = deciding[node.op];
    if (decides) r.varies = std::min(r.varies, Varies::Steps);
    if (decides || r.varies == Varies::Never || (r.varies == Varies::Steps && !placing[node.op])) {
        r.meant = r.computed;
        return;
    }
    args_.clear();
    for (std::size_t i = 0; i < step.args.size(); ++i) args_.push_back(arg(i).meant);
    r.meant = *ir::evaluate(node.op, node.type, args_, node.payload);
    if (node.op != Op::Fract && node.op != Op::Mod && node.op != Op::Atan2) return;
    // What follows from a decision follows from that of single precision.
    for (std::size_t c = 0; c < n; ++c) {
        double &v = r.meant.value[c];
        const auto of = [&](std::size_t a) {
            return arg(a).meant.value[arg(a).meant.type == node.type ? c : 0];
        };
        const auto computed = [&](std::size_t a) {
            return arg(a).computed.value[arg(a).computed.type == node.type ? c : 0];
        };
        if (node.op == Op::Fract) v = of(0) - std::floor(computed(0));
        if (node.op == Op::Mod && computed(1) != 0)
            v = of(0) - of(1) * std::floor(to_single(computed(0) / computed(1)));
        if (node.op == Op::Atan2) {
            const double turn = 6.283185307179586, apart = r.computed.value[c] - v;
            if (std::fabs(apart) > turn / 2) v += apart > 0 ? turn : -turn;
        }
    }
}

Trial Trials::at(const std::array<double, 3> &point, double time,
                 const std::vector<std::array<double, 4>> &params) {
    time_ = time, params_ = params;
    limit_ = work_ + most_work_of_trial;
    const ir::Function &function = scene_.graph.function(function_);
    Constant p{ir::Type::Vec3, {}};
    for (std::size_t i = 0; i < 3; ++i) p.value[i] = point[i];
    p = rounded(p);
    vars_[scene_.graph[function.params[0]].payload] = {p, p, Varies::Smoothly};
    Plan &plan = plan_of({function.result});
    run(plan);
    if (work_ > limit_) return {NAN, NAN};
    const Number &d = plan.frame[plan.results[0]];
    return {d.meant.value[0], d.computed.value[0]};
}

} // namespace fathom::proof
