// Let s > 0. Each rule is an identity: s (a + b) = s a + s b, s max(a, b) = max(s a, s b),
// s |v| = |s v|, s^n a^n = (s a)^n, s (x/s) = x, … An expression in which s meets no inverse stays a
// product with s.
#include "proof/rescaled.h"

#include "proof/forms.h"
#include "proof/guarded.h"
#include "proof/smooth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <span>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::Op;
using ir::OpSet;

class Inward {
  public:
    Inward(Graph &graph, Factor factor, RescaledNodes &known, Work &work)
        : graph_(graph), factor_(factor), known_(known), work_(work) {
        extremes_of(factor.divides ? Op::Max : Op::Min, factor.number, 0);
    }

    // s^power times the expression, power >= 1, where s meets an inverse of itself; else none.
    NodeId moved(NodeId id, int power) {
        const auto key = std::pair(id, power);
        if (const auto known = known_.find(key); known != known_.end()) return known->second;
        if (known_.size() > most_nodes || depth_ > max_depth || work_.spent()) return {};
        work_.take(2);
        ++depth_;
        const NodeId inside = made(id, power);
        --depth_;
        if (inside) pairs.emplace_back(id, inside);
        return known_[key] = inside;
    }
    std::vector<std::pair<NodeId, NodeId>> pairs;

  private:
    static constexpr std::size_t most_nodes = 20'000;
    static constexpr int max_depth = 200, max_power = 16;

    // … wherever s may be.
    NodeId times(NodeId id, int power) {
        if (const NodeId inside = moved(id, power)) return inside;
        for (int i = 0; i < power; ++i)
            id = factor_.divides ? graph_.div(id, factor_.number) : graph_.mul(id, factor_.number);
        return id;
    }

    // Of s = min(a, b, …), what it is the least of: s (x/a) = x min(s/a, 1). Of 1/max(a, b, …),
    // likewise, what the greatest is of.
    void extremes_of(Op op, NodeId id, int depth) {
        constexpr int most = 6; // of depths
        if (graph_[id].op != op || depth > most) {
            if (depth > 0) extremes_.push_back(id);
            return;
        }
        for (int i = 0; i < 2; ++i) extremes_of(op, graph_.arg(id, i), depth + 1);
    }
    bool is_extreme(NodeId id) const { return std::ranges::count(extremes_, id) > 0; }
    // s/a, or a/s, where that is at most 1; else s/a.
    NodeId share(NodeId a) {
        const NodeId s = factor_.number;
        const NodeId ratio = factor_.divides ? graph_.div(a, s) : graph_.div(s, a);
        return is_extreme(a) ? graph_.make(Op::Min, {ratio, graph_.number(1)}) : ratio;
    }
    // x/a, or x a, with a or one of its components one of those.
    NodeId by_shares(NodeId id) {
        const Op op = graph_[id].op;
        if (extremes_.empty() || op != (factor_.divides ? Op::Mul : Op::Div)) return {};
        const ir::Type type = graph_.type(id);
        for (int i = factor_.divides ? 0 : 1; i < 2; ++i) {
            const NodeId by = graph_.arg(id, i), of = graph_.arg(id, 1 - i);
            if (graph_.reads(by).point) continue;
            std::vector<NodeId> parts;
            bool any = false;
            for (int c = 0; c < ir::components(type); ++c) {
                parts.push_back(graph_.component(by, c));
                any |= is_extreme(parts.back());
            }
            if (!any) continue;
            for (NodeId &part : parts) part = share(part);
            const NodeId shares = parts.size() == 1 ? parts[0] : graph_.make(Op::Make, type, parts);
            return graph_.mul(of, shares);
        }
        return {};
    }

    bool is_factor(NodeId id) const {
        return id == factor_.number ||
               (graph_[id].op == Op::Splat && graph_.arg(id, 0) == factor_.number);
    }
    bool is_inverse(NodeId id) const {
        if (graph_[id].op == Op::Splat) return is_inverse(graph_.arg(id, 0));
        return graph_[id].op == Op::Div && is_factor(graph_.arg(id, 1)) &&
               graph_.as_number(graph_.arg(id, 0)) == 1.0;
    }

    // The node with these arguments scaled; none where the factor met nothing in any.
    NodeId with_args(NodeId id, int power, std::span<const std::size_t> which) {
        const ir::Node node = graph_[id];
        std::vector<NodeId> args(graph_.args(id).begin(), graph_.args(id).end());
        bool met = false;
        for (std::size_t i : which) met = bool(moved(args[i], power)) || met;
        if (!met) return {};
        for (std::size_t i : which) args[i] = times(args[i], power);
        return graph_.make(node.op, node.type, args, node.payload);
    }
    NodeId with_args(NodeId id, int power, std::initializer_list<std::size_t> which) {
        return with_args(id, power, std::span(which.begin(), which.size()));
    }
    NodeId with_all_args(NodeId id, int power) {
        std::vector<std::size_t> all(graph_[id].count);
        std::iota(all.begin(), all.end(), std::size_t{0});
        return with_args(id, power, all);
    }

    // Of x/s and s, x; of s x and 1/s, x; of 1/s and s, or the other way round, 1.
    NodeId without_inverse(NodeId id) const {
        const Op op = graph_[id].op;
        if (factor_.divides ? is_factor(id) : is_inverse(id))
            return graph_.splat(graph_.number(1), graph_.type(id));
        if (op != Op::Mul && op != Op::Div) return {};
        const NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
        if (op == Op::Div) return !factor_.divides && is_factor(b) ? a : NodeId();
        const auto meets = [&](NodeId x) { return factor_.divides ? is_factor(x) : is_inverse(x); };
        return meets(a) ? b : meets(b) ? a : NodeId();
    }

    // s^n a b as s^i a s^(n - i) b.
    NodeId product(NodeId id, int power) {
        const ir::Node node = graph_[id];
        NodeId a = graph_.arg(id, 0), b = graph_.arg(id, 1);
        if (power == 1) {
            if (const NodeId left = moved(a, 1))
                a = left;
            else if (const NodeId right = moved(b, 1))
                b = right;
            else
                return {};
        } else {
            const int first = power / 2, rest = power - first;
            if (!moved(a, first) && !moved(b, rest)) return {};
            a = times(a, first), b = times(b, rest);
        }
        return graph_.make(node.op, node.type, std::array{a, b}, node.payload);
    }

    // s a/b as (s a)/b, or as a/(b/s).
    NodeId quotient(NodeId id, int power) {
        if (const NodeId above = with_args(id, power, {0}); above || power > 1) return above;
        RescaledNodes known;
        Inward inverse(graph_, {factor_.number, !factor_.divides}, known, work_);
        inverse.depth_ = depth_;
        const NodeId below = inverse.moved(graph_.arg(id, 1), 1);
        return below ? graph_.div(graph_.arg(id, 0), below) : NodeId();
    }

    // b^c: c a constant, and power/c whole.
    NodeId power_of(NodeId id, double exponent, int power) {
        const double inner = power / exponent;
        if (!(inner >= 1 && inner <= max_power) || std::floor(inner) != inner) return {};
        const NodeId scaled = with_args(id, int(inner), {0});
        // Ranges may say of the one that it is not below 0, and of the other no more.
        const bool is_root = std::floor(exponent) != exponent;
        const bool is_kept = scaled && is_root && is_never_negative(graph_, graph_.arg(id, 0));
        return is_root && !is_kept ? NodeId{} : scaled;
    }

    // The smooth extremum of s x and s y within s k, written as it was (smooth.h).
    NodeId smooth(const Smooth &of) {
        if (of.divisor != of.k) return {};
        if (!moved(of.x, 1) && !moved(of.y, 1)) return {};
        const NodeId x = times(of.x, 1), y = times(of.y, 1);
        const NodeId k = times(of.k, 1), zero = graph_.number(0), one = graph_.number(1);
        if (!of.clipped) {
            const NodeId width = of.greater ? graph_.neg(k) : k;
            const NodeId way = graph_.div(graph_.mul(graph_.number(0.5), graph_.sub(y, x)), width);
            const NodeId h =
                graph_.make(Op::Clamp, {graph_.add(graph_.number(0.5), way), zero, one});
            const NodeId bulge = graph_.mul({graph_.mul(width, h), graph_.sub(one, h)});
            return graph_.sub(graph_.make(Op::Mix, {y, x, h}), bulge);
        }
        const NodeId way = graph_.make(Op::Abs, {graph_.sub(x, y)});
        const NodeId h = graph_.make(Op::Max, {graph_.sub(k, way), zero}),
                     square = graph_.mul(h, h);
        const NodeId bulge = of.cubic ? graph_.div({graph_.mul(square, h),
                                                    graph_.mul(graph_.number(6), graph_.mul(k, k))})
                                      : graph_.div({square, graph_.mul(graph_.number(4), k)});
        const NodeId most = graph_.make(of.greater ? Op::Max : Op::Min, {x, y});
        return of.greater ? graph_.add(most, bulge) : graph_.sub(most, bulge);
    }

    // The wave of s x with periods s m, and its step for the step of the other.
    NodeId waving(NodeId id, NodeId of, NodeId period, const HeldWaveParts *held) {
        const NodeId x = moved(of, 1);
        if (!x) return {};
        const NodeId m = times(period, 1);
        const NodeId round = graph_.make(Op::Round, {graph_.div(x, m)});
        const NodeId turns = held ? graph_.make(Op::Clamp, {round, held->lo, held->hi}) : round;
        if (const auto step = step_of(id)) pairs.emplace_back(*step, round);
        return graph_.sub(x, graph_.mul(m, turns));
    }
    // A wave's own step, and none that its x or its period is made with: what rounds in the second
    // term, if only one thing does, or the remainder that is a term.
    std::optional<NodeId> step_of(NodeId sum) const {
        std::unordered_set<NodeId> rounding;
        find_rounding(graph_.arg(sum, 1), 0, rounding);
        if (!rounding.empty())
            return rounding.size() == 1 ? std::optional(*rounding.begin()) : std::nullopt;
        for (NodeId term : graph_.args(sum))
            if (graph_[term].op == Op::Mod || graph_[term].op == Op::Fract) return term;
        return {};
    }
    void find_rounding(NodeId id, int depth, std::unordered_set<NodeId> &found) const {
        constexpr OpSet through{Op::Mul, Op::Clamp};
        if (graph_[id].op == Op::Round) found.insert(id);
        if (depth > 3 || !through[graph_[id].op]) return;
        for (NodeId arg : graph_.args(id)) find_rounding(arg, depth + 1, found);
    }

    // Of sums whose terms only make sense together; the node itself where it is none.
    NodeId known_form(NodeId id, int power) {
        if (const auto of = wave(graph_, id))
            return power == 1 ? waving(id, of->x, of->m, nullptr) : NodeId();
        if (const auto of = held_wave(graph_, id))
            return power == 1 ? waving(id, of->x, of->m, &*of) : NodeId();
        if (graph_.type(id) == ir::Type::Float)
            if (const auto of = smooth_extremum(graph_, id))
                return power == 1 ? smooth(*of) : NodeId();
        return id;
    }

    // A sum whose terms only make sense together is scaled as what it is.
    NodeId sum(NodeId id, int power) {
        const NodeId by_terms = with_all_args(id, power);
        if (!by_terms && !step_of(id)) return {};
        const NodeId form = known_form(id, power);
        return form != id ? form : by_terms;
    }

    NodeId made(NodeId id, int power) {
        constexpr OpSet by_all{Op::Neg,  Op::Abs,   Op::Min,     Op::Max,   Op::Clamp,
                               Op::Make, Op::Splat, Op::Swizzle, Op::Union, Op::Intersection},
            products{Op::Mul, Op::Dot};
        const ir::Node node = graph_[id];
        if (power == 1) {
            if (const NodeId x = without_inverse(id)) return x;
            if (const NodeId x = by_shares(id)) return x;
        }
        if (node.op == Op::Add || node.op == Op::Sub) return sum(id, power);
        if (by_all[node.op]) return with_all_args(id, power);
        if (products[node.op]) return product(id, power);
        if (node.op == Op::Length) return power == 1 ? with_all_args(id, 1) : NodeId();
        if (node.op == Op::Mix) return with_args(id, power, {0, 1});
        if (node.op == Op::Select) return with_args(id, power, {1, 2});
        if (node.op == Op::Div) return quotient(id, power);
        if (node.op == Op::Sqrt) return power_of(id, 0.5, power);
        if (node.op == Op::Pow) {
            const auto exponent = graph_.as_number(graph_.arg(id, 1));
            return exponent ? power_of(id, *exponent, power) : NodeId();
        }
        if (node.op == Op::MatMul && ir::is_vector(node.type))
            return with_args(id, power, {ir::is_vector(graph_.type(graph_.arg(id, 0))) ? 0u : 1u});
        return {};
    }

    Graph &graph_;
    Factor factor_;
    std::vector<NodeId> extremes_;
    RescaledNodes &known_;
    Work &work_;
    int depth_ = 0;
};

void gather(const Graph &graph, NodeId id, bool divides, std::vector<Factor> &out, int depth) {
    constexpr std::size_t most = 8;
    constexpr int max_depth = 16;
    const ir::Node node = graph[id];
    if (out.size() >= most || node.op == Op::Const || depth > max_depth) return;
    if (node.op == Op::Splat) return gather(graph, graph.arg(id, 0), divides, out, depth + 1);
    if (node.op == Op::Mul || node.op == Op::Div) {
        gather(graph, graph.arg(id, 0), divides, out, depth + 1);
        gather(graph, graph.arg(id, 1), node.op == Op::Div ? !divides : divides, out, depth + 1);
    } else if (node.type == ir::Type::Float) {
        out.push_back({id, divides});
    }
}

// Products of one factor that moves and of others that do not, in one order.
class InOrder {
  public:
    explicit InOrder(Graph &graph) : graph_(graph) {}

    NodeId of(NodeId id) {
        if (!graph_.reads(id).point) return id;
        if (const auto known = known_.find(id); known != known_.end()) return known->second;
        const ir::Node node = graph_[id];
        NodeId out = id;
        if (const NodeId chain = in_order(id)) {
            out = chain;
        } else if (node.count > 0 && node.op != Op::Loop && node.op != Op::LoopResult) {
            std::vector<NodeId> args(graph_.args(id).begin(), graph_.args(id).end());
            for (NodeId &arg : args) arg = of(arg);
            out = graph_.make(node.op, node.type, args, node.payload);
        }
        return known_[id] = out;
    }

  private:
    Graph &graph_;
    std::unordered_map<NodeId, NodeId> known_;
    struct Chain {
        NodeId moves;               // one factor
        std::vector<Factor> others; // that are no numbers
        std::vector<Factor> numbers;
        bool is_such = true;
    };

    void take(NodeId id, bool divides, ir::Type type, Chain &out) {
        constexpr std::size_t most = 8;
        const ir::Node node = graph_[id];
        const bool splat = node.op == Op::Splat, moves = graph_.reads(id).point;
        const bool is_product = node.op == Op::Mul || node.op == Op::Div;
        out.is_such = out.is_such && out.others.size() + out.numbers.size() < most;
        if (!out.is_such) return;
        if (is_product || (splat && !moves)) {
            take(graph_.arg(id, 0), divides, type, out);
            if (is_product)
                take(graph_.arg(id, 1), node.op == Op::Div ? !divides : divides, type, out);
            return;
        }
        if (moves) {
            out.is_such = !out.moves && !divides && node.type == type;
            out.moves = id;
            return;
        }
        const NodeId factor = node.type == type ? id : graph_.splat(id, type);
        (graph_.is_constant(id) ? out.numbers : out.others).push_back({factor, divides});
    }
    NodeId in_order(NodeId id) {
        const ir::Node node = graph_[id];
        const bool by_component = node.type == ir::Type::Float || ir::is_vector(node.type);
        if ((node.op != Op::Mul && node.op != Op::Div) || !by_component) return {};
        Chain chain;
        take(id, false, node.type, chain);
        if (!chain.is_such || !chain.moves || chain.others.empty()) return {};
        std::ranges::sort(chain.others, [](const Factor &a, const Factor &b) {
            return a.divides != b.divides ? a.divides : a.number < b.number;
        });
        NodeId out = of(chain.moves);
        for (const std::vector<Factor> *some : {&chain.others, &chain.numbers})
            for (const Factor &factor : *some)
                out = factor.divides ? graph_.div(out, factor.number)
                                     : graph_.mul(out, factor.number);
        return out;
    }
};

} // namespace

NodeId with_factors_in_order(Graph &graph, NodeId root) { return InOrder(graph).of(root); }

std::optional<Rescaled> rescaled(Graph &graph, Factor factor, NodeId expression,
                                 RescaledNodes &known, Work &work) {
    Inward inward(graph, factor, known, work);
    const NodeId out = inward.moved(expression, 1);
    if (!out) return {};
    return Rescaled{out, std::move(inward.pairs)};
}

std::vector<Factor> factors_of(const Graph &graph, NodeId product) {
    std::vector<Factor> out;
    gather(graph, product, false, out, 0);
    return out;
}

} // namespace fathom::proof
