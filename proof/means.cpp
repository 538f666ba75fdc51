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

constexpr std::size_t max_nodes_of_mean = 96, max_pairs = 8, max_instructions = 20'000,
                      max_parts_of_mean = 32;
constexpr double max_steepness = 1.3; // 1 + 2e
// Sizes of both numbers; within the lesser ones exponentials of them are in single precision.
constexpr double sizes_of_both[] = {1e6, 10};
constexpr ir::OpSet opaque_to_means{Op::Point, Op::Loop, Op::LoopResult, Op::Call, Op::Cached};
constexpr double rounding = 1e-9; // of the bound on a weight

// Two numbers, and which way b moves as a does.
struct MovedPair {
    NodeId a, b;
    double other = 1;
    friend bool operator==(const MovedPair &, const MovedPair &) = default;
};

// A number times a power of one that is the same for all points.
struct Rate {
    double by = 0;
    NodeId held{}; // none where it is a number alone
    int power = 0;
    friend bool operator==(const Rate &, const Rate &) = default;
};
Rate rate(double by, NodeId held = {}, int power = 0) {
    return by == 0 || power == 0 ? Rate{by, {}, 0} : Rate{by, held, power};
}

// How far a node moves where a moves by 1 and b by `other`, whatever a and b are; nothing where that
// is not one number, or one over or times what does not vary.
class Moves {
  public:
    Moves(const Graph &graph, const MovedPair &moved) : graph_(graph) {
        known_[moved.a] = rate(1);
        known_[moved.b] = rate(moved.other);
    }
    std::optional<double> of(NodeId id) {
        const auto found = rate_of(id);
        return found && found->power == 0 ? std::optional(found->by) : std::nullopt;
    }

  private:
    using Found = std::optional<Rate>;

    Found rate_of(NodeId id) {
        if (const auto it = known_.find(id); it != known_.end()) return it->second;
        if (known_.size() > max_nodes_of_mean) return {};
        const auto found = found_of(id);
        known_[id] = found;
        return found;
    }
    static Found sum(const Rate &x, const Rate &y, double sign) {
        if (x.by == 0) return rate(sign * y.by, y.held, y.power);
        if (y.by == 0) return x;
        if (x.held != y.held || x.power != y.power) return {};
        return rate(x.by + sign * y.by, x.held, x.power);
    }
    // x times what does not vary, or over it.
    Found times(const Rate &x, NodeId factor, int power) const {
        if (graph_.reads(factor).point || graph_.reads(factor).free_vars) return {};
        double by = 1;
        while (true) { // a number times what is left
            const ir::Node node = graph_[factor];
            const auto number = [&](int i) { return graph_.as_number(graph_.arg(factor, i)); };
            if (node.op == Op::Neg)
                by = -by, factor = graph_.arg(factor, 0);
            else if (node.op == Op::Mul && number(0))
                by *= *number(0), factor = graph_.arg(factor, 1);
            else if (node.op == Op::Mul && number(1))
                by *= *number(1), factor = graph_.arg(factor, 0);
            else if (node.op == Op::Div && number(1).value_or(0) != 0)
                by /= *number(1), factor = graph_.arg(factor, 0);
            else
                break;
        }
        if (const auto number = graph_.as_number(factor)) {
            by *= *number;
            if (power < 0 && by == 0) return {};
            return rate(x.by * (power < 0 ? 1 / by : by), x.held, x.power);
        }
        if (power < 0 && by == 0) return {};
        if (x.by == 0 || (x.power != 0 && x.held != factor))
            return x.by == 0 ? Found(x) : std::nullopt;
        return rate(x.by * (power < 0 ? 1 / by : by), factor, x.power + power);
    }
    Found found_of(NodeId id) {
        const ir::Graph::Reads reads = graph_.reads(id);
        if (graph_[id].op == Op::Var || reads.normal || reads.direction) return {};
        if (!reads.point && !reads.free_vars) return rate(0);
        std::vector<Rate> args;
        for (NodeId arg : graph_.args(id)) {
            const auto one = rate_of(arg);
            if (!one) return {};
            args.push_back(*one);
        }
        const Op op = graph_[id].op;
        const bool still = std::ranges::all_of(args, [](const Rate &x) { return x.by == 0; });
        if (still) return opaque_to_means[op] ? Found() : Found(rate(0));
        if (op == Op::Neg) return rate(-args[0].by, args[0].held, args[0].power);
        if (op == Op::Add) return sum(args[0], args[1], 1);
        if (op == Op::Sub) return sum(args[0], args[1], -1);
        if (op == Op::Mul && args[0].by == 0) return times(args[1], graph_.arg(id, 0), 1);
        if (op == Op::Mul && args[1].by == 0) return times(args[0], graph_.arg(id, 1), 1);
        if (op == Op::Div && args[1].by == 0) return times(args[0], graph_.arg(id, 1), -1);
        constexpr ir::OpSet one_of_all{Op::Min, Op::Max, Op::Clamp},
            orders{Op::Less, Op::LessEqual};
        const bool alike = std::ranges::all_of(args, [&](const Rate &x) { return x == args[0]; });
        if (one_of_all[op] && alike) return args[0];
        if (orders[op] && alike) return rate(0);
        if (op == Op::Mix && args[2].by == 0 && args[0] == args[1]) return args[0];
        if (op == Op::Select && args[0].by == 0 && args[1] == args[2]) return args[1];
        return {};
    }

    const Graph &graph_;
    std::unordered_map<NodeId, Found> known_;
};

// Two numbers without what both are times, or over, that does not vary.
MovedPair without_common(const Graph &graph, MovedPair pair) {
    for (bool again = true; again;) {
        again = false;
        const ir::Node a = graph[pair.a], b = graph[pair.b];
        if (a.op != b.op) break;
        const auto held = [&](NodeId id) {
            return !graph.reads(id).point && !graph.reads(id).free_vars;
        };
        for (int i = 0; i < (a.op == Op::Mul ? 2 : 1) && !again; ++i) {
            const bool unary = a.op == Op::Neg, binary = a.op == Op::Div || a.op == Op::Mul;
            if (!unary && !binary) break;
            const NodeId shared = binary ? graph.arg(pair.a, 1 - i) : NodeId{};
            if (binary && (shared != graph.arg(pair.b, 1 - i) || !held(shared))) continue;
            pair.a = graph.arg(pair.a, i), pair.b = graph.arg(pair.b, i);
            again = true;
        }
    }
    return pair;
}

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
            const bool both = a != b && may_be(a) && may_be(b);
            for (const MovedPair &pair : {moved, without_common(graph, moved)})
                if (both && std::ranges::find(out, pair) == out.end()) out.push_back(pair);
            if (out.size() >= max_pairs) return out;
        }
        if (opaque_to_means[op]) continue;
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

// Numbers that are the same for all points, and that something else is divided by.
std::vector<NodeId> divisors_in(const Graph &graph, NodeId root) {
    constexpr std::size_t most = 2;
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() < most && seen.size() < max_nodes_of_mean) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!graph.reads(id).point || opaque_to_means[graph[id].op] || !seen.insert(id).second)
            continue;
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
        if (graph[id].op != Op::Div) continue;
        const NodeId by = graph.arg(id, 1);
        const ir::Graph::Reads reads = graph.reads(by);
        const bool is_held = !reads.point && !reads.free_vars && (reads.params || reads.time);
        if (is_held && graph[by].type == ir::Type::Float && std::ranges::find(out, by) == out.end())
            out.push_back(by);
    }
    return out;
}

// G(d), and 2 G(d)/s - d.
struct Halves {
    Flattening &context;
    NodeId scalar;
    MovedPair moved;
    double by;

    NodeId at(NodeId d) {
        return ir::substitute(context.graph, scalar,
                              {{moved.a, d}, {moved.b, context.graph.number(0)}});
    }
    NodeId twice(NodeId g, NodeId d) {
        Graph &graph = context.graph;
        return graph.sub(graph.mul(graph.number(2 / by), g), d);
    }
    double steepest_for(double reach) {
        Graph &graph = context.graph;
        const NodeId d = graph.component(graph.point(), 0), g = at(d), plain = twice(g, d);
        const double at_once = steepness(context, *context.ranges, plain, reach);
        if (at_once <= 1 + rounding) return at_once;
        // With d = q x the slope by d is that of G(q x)/q by x, in which widths of q cancel.
        for (const NodeId q : divisors_in(graph, g)) {
            const Interval size = range_of(context, *context.ranges, q, {})[0];
            if (!(size.lo > 0) || !size.finite()) continue;
            const NodeId scaled = twice(graph.div(at(graph.mul(q, d)), q), d);
            const double most = steepness(context, *context.ranges, scaled, reach / size.lo);
            if (most <= 1 + rounding) return most;
        }
        return steepest(context, plain, reach);
    }
};

// How far beyond 0..1 the weights may lie, and up to which sizes; nothing where that is too far.
struct Weights {
    double beyond, reach;
};
std::optional<Weights> weights_of(Flattening &context, NodeId scalar, const MovedPair &moved,
                                  double by) {
    Halves halves{context, scalar, moved, by};
    for (const double reach : sizes_of_both) {
        const double most = halves.steepest_for(reach);
        if (most <= max_steepness) return Weights{most <= 1 + rounding ? 0 : (most - 1) / 2, reach};
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
