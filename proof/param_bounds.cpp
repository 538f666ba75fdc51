#include "proof/param_bounds.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

namespace {

constexpr std::size_t most_params = 4;
constexpr int pieces = 8; // of a range
constexpr int most_halvings = 3;
constexpr double pays_from = 1.25;     // times the present bound, from where on a formula is
constexpr double near_enough = 1.1;    // a line this near the bound in its middle is not halved
constexpr double allowance = 1 + 1e-5; // what single precision may lose of the formula

// The params of one number that a field reads: each with its nodes.
std::unordered_map<std::uint32_t, std::vector<NodeId>> params_of(const ir::Graph &graph,
                                                                 NodeId field) {
    std::unordered_map<std::uint32_t, std::vector<NodeId>> out;
    std::vector<NodeId> todo{field};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second || !graph.reads(id).params) continue;
        const ir::Node &node = graph[id];
        if (node.op == Op::Param) out[node.payload].push_back(id);
        if (node.op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{node.payload}).result);
        if (node.op == Op::Loop) {
            const ir::Loop &loop = graph.loop(ir::LoopId{node.payload});
            todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            todo.push_back(loop.condition);
            todo.push_back(loop.count);
        }
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    return out;
}

// Whether an expression is g + a h with a param a, and g and h that do not read it. Its slope in the
// point is then |grad g + a grad h|, whose supremum is a convex function of a.
class AffineIn {
  public:
    AffineIn(const ir::Graph &graph, std::uint32_t param) : graph_(graph), param_(param) {}
    bool operator()(NodeId id) { return degree(id) <= 1; }

  private:
    static constexpr int more = 2;
    int degree(NodeId id) {
        if (!id || !graph_.reads(id).params) return 0;
        if (const auto found = known_.find(id); found != known_.end()) return found->second;
        return known_[id] = compute(id);
    }
    int compute(NodeId id) {
        constexpr ir::OpSet read_elsewhere{Op::Call, Op::Cached, Op::Loop};
        constexpr ir::OpSet linear{Op::Add, Op::Sub, Op::Neg, Op::Make, Op::Swizzle, Op::ToFloat};
        constexpr ir::OpSet products{Op::Mul, Op::Dot};
        const ir::Node node = graph_[id];
        if (node.op == Op::Param) return node.payload == param_ ? 1 : 0;
        if (read_elsewhere[node.op]) return more;
        int most = 0, sum = 0;
        for (NodeId arg : graph_.args(id)) {
            const int d = degree(arg);
            most = std::max(most, d), sum += d;
        }
        if (most == 0 || linear[node.op]) return most;
        if (products[node.op]) return std::min(sum, int{more});
        return node.op == Op::Div && degree(graph_.arg(id, 1)) == 0 ? most : more;
    }
    const ir::Graph &graph_;
    std::uint32_t param_;
    std::unordered_map<NodeId, int> known_;
};

class ParamBounds {
  public:
    ParamBounds(Flattening &context, const Ranges &ranges, NodeId field, const Domain &domain,
                const Budget &budget)
        : context_(context), graph_(context.graph), ranges_(ranges), field_(field), domain_(domain),
          budget_(budget) {}

    ParamBound find(double whole) {
        const ir::Scene &scene = *ranges_.scene;
        auto read = params_of(graph_, field_);
        std::erase_if(read, [&](const auto &entry) {
            const ir::Param &p = scene.params[entry.first];
            const Interval &range = ranges_.params[entry.first][0];
            return p.structural || !p.has_range || !range.finite() || !(range.lo < range.hi) ||
                   (p.type != ir::Type::Float && p.type != ir::Type::Int);
        });
        if (read.empty() || read.size() > most_params) return {};
        Ranges present = ranges_;
        for (const auto &[index, nodes] : read)
            present.params[index][0] = Interval(scene.params[index].value[0]);
        if (!pays(whole, bound(present))) return {};
        ParamBound least;
        std::vector<std::uint32_t> order;
        for (const auto &entry : read) order.push_back(entry.first);
        std::ranges::sort(order);
        for (const std::uint32_t index : order) {
            if (!pays(whole, at(index, Interval(scene.params[index].value[0])))) continue;
            most_ = 0;
            const NodeId one = of_param(index, read[index].front());
            least.formula = least.formula ? graph_.make(Op::Min, {least.formula, one}) : one;
            least.most = std::min(least.most, most_);
        }
        return least;
    }

  private:
    static bool pays(double whole, double present) {
        return std::isfinite(whole) && whole > pays_from * present + 0.05;
    }
    double bound(const Ranges &ranges) {
        return bound_field(context_, ranges, field_, domain_, budget_).lipschitz * allowance;
    }
    double at(std::uint32_t index, Interval values) {
        Ranges ranges = ranges_;
        ranges.params[index][0] = values;
        const double found = bound(ranges);
        most_ = std::max(most_, found);
        return found;
    }

    NodeId of_param(std::uint32_t index, NodeId param) {
        const Interval range = ranges_.params[index][0];
        const NodeId value =
            graph_[param].type == ir::Type::Int ? graph_.make(Op::ToFloat, {param}) : param;
        return AffineIn(graph_, index)(field_) ? by_lines(index, value, range)
                                               : by_pieces(index, value, range);
    }

    // Chords of a convex function lie above it between their ends; the greatest of several, everywhere
    // between the first end and the last.
    NodeId by_lines(std::uint32_t index, NodeId value, Interval range) {
        std::vector<double> ends{range.lo, range.hi};
        if (range.lo < 0 && range.hi > 0) ends = {range.lo, 0, range.hi};
        NodeId most;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i)
            add_line(index, value, ends[i], at(index, Interval(ends[i])), ends[i + 1],
                     at(index, Interval(ends[i + 1])), most_halvings, most);
        return most;
    }
    void add_line(std::uint32_t index, NodeId value, double a, double at_a, double b, double at_b,
                  int halvings, NodeId &most) {
        const double middle = (a + b) / 2;
        if (halvings > 0) {
            const double there = at(index, Interval(middle));
            if ((at_a + at_b) / 2 > near_enough * there + 0.02) {
                add_line(index, value, a, at_a, middle, there, halvings - 1, most);
                add_line(index, value, middle, there, b, at_b, halvings - 1, most);
                return;
            }
        }
        const double slope = (at_b - at_a) / (b - a);
        const NodeId line =
            graph_.add(graph_.number(at_a - slope * a), graph_.mul(graph_.number(slope), value));
        most = most ? graph_.make(Op::Max, {most, line}) : line;
    }

    // Pieces of one ratio, where there is one: what scales by a param has it for a slope.
    static std::vector<double> ends_of_pieces(Interval range) {
        std::vector<double> out{range.lo};
        for (int i = 1; i < pieces; ++i) {
            const double way = double(i) / pieces;
            out.push_back(range.lo > 0 ? range.lo * std::pow(range.hi / range.lo, way)
                                       : range.lo + way * (range.hi - range.lo));
        }
        out.push_back(range.hi);
        return out;
    }
    NodeId by_pieces(std::uint32_t index, NodeId value, Interval range) {
        const std::vector<double> ends = ends_of_pieces(range);
        NodeId out;
        for (std::size_t i = pieces; i-- > 0;) {
            // A little wider than its place, for values that are rounded.
            const double lo = ends[i], hi = ends[i + 1],
                         rim = 1e-6 * std::max(std::fabs(lo), std::fabs(hi));
            const NodeId here = graph_.number(
                at(index, Interval(std::max(lo - rim, range.lo), std::min(hi + rim, range.hi))));
            out = out ? graph_.make(Op::Select,
                                    {graph_.make(Op::Less, {value, graph_.number(hi)}), here, out})
                      : here;
        }
        return out;
    }

    Flattening &context_;
    ir::Graph &graph_;
    const Ranges &ranges_;
    NodeId field_;
    Domain domain_;
    Budget budget_;
    double most_ = 0; // of the bounds that the formula in hand is made of
};

} // namespace

ParamBound bound_by_params(Flattening &context, const Ranges &ranges, NodeId field,
                           const Domain &domain, const Budget &budget, double whole) {
    if (!context.graph.reads(field).params || !ranges.scene) return {};
    return ParamBounds(context, ranges, field, domain, budget).find(whole);
}

} // namespace fathom::proof
