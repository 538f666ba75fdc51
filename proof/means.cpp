// Let F(a + t, b + c t) = F(a, b) + s t for all t, c one of 1 and -1. With t = -c b,
// F(a, b) = G(a - c b) + s c b for G(d) = F(d, 0), so grad F = G' grad a + c (s - G') grad b. Where
// G' lies between 0 and s, |G'| + |s - G'| = |s|. That is so where 2 G(d)/s - d has a slope of at
// most 1, which is asked of the machine: d takes the place of a coordinate.
#include "proof/means.h"

#include "ir/passes/content.h"
#include "ir/passes/walk.h"
#include "proof/field.h"

#include <algorithm>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::Graph;

constexpr std::size_t max_nodes_of_mean = 96, max_pairs = 6, max_instructions = 20'000,
                      max_parts_of_mean = 32;
constexpr double max_steepness = 1.3; // 1 + 2e
// Sizes of both numbers; within the lesser ones exponentials of them are in single precision.
constexpr double reaches[] = {1e6, 10};
constexpr ir::OpSet opaque{Op::Point, Op::Loop, Op::LoopResult, Op::Call, Op::Cached};
constexpr double rounding = 1e-9; // of the bound on a weight

// Two numbers, and which way b moves as a does.
struct MovedPair {
    NodeId a, b;
    double other = 1;
    friend bool operator==(const MovedPair &, const MovedPair &) = default;
};

// How far a node moves where a moves by 1 and b by `other`, whatever a and b are; nothing where that
// is not one number.
class Moves {
  public:
    Moves(const Graph &graph, const MovedPair &moved) : graph_(graph) {
        known_[moved.a] = 1;
        known_[moved.b] = moved.other;
    }
    std::optional<double> of(NodeId id) {
        if (const auto it = known_.find(id); it != known_.end()) return it->second;
        if (known_.size() > max_nodes_of_mean) return {};
        const auto found = found_of(id);
        known_[id] = found;
        return found;
    }

  private:
    std::optional<double> found_of(NodeId id) {
        const ir::Graph::Reads reads = graph_.reads(id);
        if (graph_[id].op == Op::Var || reads.normal || reads.direction) return {};
        if (!reads.point && !reads.free_vars) return 0;
        std::vector<double> args;
        for (NodeId arg : graph_.args(id)) {
            const auto one = of(arg);
            if (!one) return {};
            args.push_back(*one);
        }
        const Op op = graph_[id].op;
        const auto number = [&](int i) { return graph_.as_number(graph_.arg(id, i)); };
        if (op == Op::Neg) return -args[0];
        if (op == Op::Add) return args[0] + args[1];
        if (op == Op::Sub) return args[0] - args[1];
        if (op == Op::Mul && number(0)) return *number(0) * args[1];
        if (op == Op::Mul && number(1)) return *number(1) * args[0];
        if (op == Op::Div && number(1).value_or(0) != 0) return args[0] / *number(1);
        constexpr ir::OpSet one_of_all{Op::Min, Op::Max, Op::Clamp},
            orders{Op::Less, Op::LessEqual};
        const bool alike = std::ranges::all_of(args, [&](double x) { return x == args[0]; });
        if (one_of_all[op] && alike) return args[0];
        if (orders[op] && alike) return 0;
        if (op == Op::Mix && args[2] == 0 && args[0] == args[1]) return args[0];
        if (op == Op::Select && args[0] == 0 && args[1] == args[2]) return args[1];
        const bool still = std::ranges::all_of(args, [](double x) { return x == 0; });
        return still && !opaque[op] ? std::optional(0.0) : std::nullopt;
    }

    const Graph &graph_;
    std::unordered_map<NodeId, std::optional<double>> known_;
};

// Pairs of numbers that stand together in a least, a greatest, a sum or a comparison, from the top
// of the expression down; those of the top itself say nothing new.
std::vector<MovedPair> pairs_in(const Graph &graph, NodeId root) {
    std::vector<MovedPair> out;
    std::vector<NodeId> level{root};
    std::unordered_set<NodeId> seen{root};
    for (std::size_t at = 0; at < level.size() && level.size() < max_nodes_of_mean; ++at) {
        const NodeId id = level[at];
        const Op op = graph[id].op;
        constexpr ir::OpSet together{Op::Min, Op::Max,  Op::Add,      Op::Sub,
                                     Op::Mix, Op::Less, Op::LessEqual};
        if (id != root && together[op]) {
            const NodeId a = graph.arg(id, 0), b = graph.arg(id, 1);
            const auto may_be = [&](NodeId x) {
                return graph[x].type == ir::Type::Float &&
                       (graph.reads(x).point || graph.reads(x).free_vars);
            };
            const MovedPair moved{a, b, op == Op::Add ? -1.0 : 1.0};
            if (a != b && may_be(a) && may_be(b) && std::ranges::find(out, moved) == out.end())
                out.push_back(moved);
            if (out.size() == max_pairs) return out;
        }
        if (opaque[op]) continue;
        for (NodeId arg : graph.args(id))
            if (seen.insert(arg).second) level.push_back(arg);
    }
    return out;
}

// How steep 2 G(d)/s - d is at most, for the params and times of the ranges.
double steepness(Flattening &context, const Ranges &ranges, NodeId twice, double reach) {
    double most = 0;
    for (const double end : {-2 * reach, 2 * reach}) { // most turn where d is 0: on each side of it
        Domain line;
        line.box.p = {Interval(std::min(end, 0.0), std::max(end, 0.0)), Interval(0.0),
                      Interval(0.0)};
        const Budget budget{max_instructions, 1 + rounding / 2, 1 + rounding / 2};
        most = std::max(most, bound_field(context, ranges, twice, line, budget).lipschitz);
    }
    return most;
}

// The same, with the params that it reads in as many parts as that takes.
double steepest(Flattening &context, NodeId twice, double reach) {
    const ir::Content content = ir::content_of(context.graph, twice);
    std::vector<Ranges> parts{*context.ranges};
    std::vector<double> steep{steepness(context, parts[0], twice, reach)};
    while (parts.size() < max_parts_of_mean) {
        const auto worst = std::size_t(std::ranges::max_element(steep) - steep.begin());
        if (steep[worst] <= 1 + rounding) break;
        std::optional<std::uint32_t> widest;
        const auto range = [&](std::uint32_t param) -> Interval & {
            return parts[worst].params[param][0];
        };
        for (std::uint32_t param : content.params)
            if (range(param).finite() && (!widest || range(param).width() > range(*widest).width()))
                widest = param;
        if (!widest || range(*widest).width() == 0) break;
        Ranges upper = parts[worst];
        upper.params[*widest][0].lo = range(*widest).hi = range(*widest).middle();
        steep[worst] = steepness(context, parts[worst], twice, reach);
        steep.push_back(steepness(context, upper, twice, reach));
        parts.push_back(std::move(upper));
    }
    return std::ranges::max(steep);
}

// How far beyond 0..1 the weights may lie, and up to which sizes; nothing where that is too far.
struct Weights {
    double beyond, reach;
};
std::optional<Weights> weights_of(Flattening &context, NodeId scalar, const MovedPair &moved,
                                  double by) {
    Graph &graph = context.graph;
    const NodeId d = graph.component(graph.point(), 0);
    const NodeId g = ir::substitute(graph, scalar, {{moved.a, d}, {moved.b, graph.number(0)}});
    const NodeId twice = graph.sub(graph.mul(graph.number(2 / by), g), d);
    for (const double reach : reaches) {
        const double most = steepest(context, twice, reach);
        if (most <= max_steepness) return Weights{most <= 1 + rounding ? 0 : (most - 1) / 2, reach};
        if (std::isfinite(most)) break;
    }
    return {};
}

} // namespace

std::optional<Mean> mean_of(Flattening &context, NodeId scalar) {
    const ir::Graph::Reads reads = context.graph.reads(scalar);
    if (!context.ranges || !(reads.point || reads.free_vars)) return {};
    if (context.graph[scalar].type != ir::Type::Float) return {};
    if (const auto known = context.means.find(scalar); known != context.means.end())
        return known->second;
    std::optional<Mean> out;
    for (const MovedPair &moved : pairs_in(context.graph, scalar)) {
        const auto by = Moves(context.graph, moved).of(scalar);
        if (!by || *by == 0) continue;
        if (const auto found = weights_of(context, scalar, moved, *by)) {
            out = Mean{moved.a, moved.b, *by, *by * moved.other, found->beyond, found->reach};
            break;
        }
    }
    context.means[scalar] = out;
    return out;
}

} // namespace fathom::proof
