#include "proof/param_bounds.h"

#include "ir/passes/inline.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <span>
#include <unordered_map>
#include <unordered_set>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;

namespace {

constexpr std::size_t most_params = 4, most_moving = 2, most_nodes = 4000;
constexpr double least_width = 1e-3; // of what moves: of one moment it is what rounding makes of it
constexpr int range_pieces = 8;      // of a range on one side of 0
// … that ends at 0, or has it inside: the ways from there to an end.
constexpr std::array ways_to_one{1 / 64.0, 1 / 16.0, 1 / 8.0, 1 / 4.0, 3 / 8.0,
                                 1 / 2.0,  5 / 8.0,  3 / 4.0, 7 / 8.0};
constexpr std::array ways_to_both{1 / 8.0, 1 / 4.0, 1 / 2.0, 3 / 4.0};
constexpr int most_halvings = 3;
constexpr std::size_t instructions_apart =
    8;                                  // a part of those for the bound itself, for each number
constexpr std::size_t most_joint = 121; // proofs for a formula of several params
constexpr std::size_t most_joint_work =
    1'000'000;                         // … as many as take so much, at the present values
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

// A number that stands still, and the field as it depends on that.
struct Input {
    NodeId value; // a float
    NodeId field; // in which `node` is this number
    Op op;        // of `node`: a Param, or a Var
    std::uint32_t payload;
    Interval range;
    double present;
};

// Fractions and sines of the time, each once, where what stands above them reads more than the time;
// and the time itself, where it stands elsewhere, too.
std::vector<NodeId> moving_with_time(const ir::Graph &graph, NodeId field) {
    constexpr ir::OpSet bounded{Op::Fract, Op::Mod, Op::Sin, Op::Cos};
    std::vector<NodeId> out, alone, todo{field};
    std::unordered_set<NodeId> seen;
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!id || !seen.insert(id).second || !graph.reads(id).time) continue;
        const ir::Node &node = graph[id];
        const ir::Graph::Reads reads = graph.reads(id);
        if (node.op == Op::Time) {
            alone.push_back(id);
            continue;
        }
        if (bounded[node.op] && node.type == ir::Type::Float && !reads.point && !reads.params &&
            !reads.free_vars) {
            out.push_back(id);
            continue;
        }
        if (node.op == Op::Loop) {
            const ir::Loop &loop = graph.loop(ir::LoopId{node.payload});
            todo.insert(todo.end(), loop.next.begin(), loop.next.end());
            todo.push_back(loop.condition);
        }
        todo.insert(todo.end(), graph.args(id).begin(), graph.args(id).end());
    }
    // The sine and the cosine of one angle turn a vector, which is seen of both alone.
    for (NodeId one : out)
        if (std::ranges::none_of(out, [&](NodeId other) {
                return other != one && graph.arg(other, 0) == graph.arg(one, 0);
            }))
            alone.push_back(one);
    std::ranges::sort(alone, {}, &NodeId::index);
    return alone;
}

// Whether an expression is g + a h with an input a, and g and h that do not read it. Its slope in the
// point is then |grad g + a grad h|, whose supremum is a convex function of a.
class AffineIn {
  public:
    AffineIn(const ir::Graph &graph, const Input &input) : graph_(graph), input_(input) {}
    bool operator()() { return degree(input_.field) <= 1; }

  private:
    static constexpr int more = 2;
    int degree(NodeId id) {
        if (!id || !(graph_.reads(id).params || graph_.reads(id).free_vars)) return 0;
        if (const auto found = known_.find(id); found != known_.end()) return found->second;
        return known_[id] = compute(id);
    }
    int compute(NodeId id) {
        constexpr ir::OpSet read_elsewhere{Op::Call, Op::Cached, Op::Loop};
        constexpr ir::OpSet linear{Op::Add, Op::Sub, Op::Neg, Op::Make, Op::Swizzle, Op::ToFloat};
        constexpr ir::OpSet products{Op::Mul, Op::Dot};
        const ir::Node node = graph_[id];
        if (node.op == Op::Param || node.op == Op::Var)
            return node.op == input_.op && node.payload == input_.payload ? 1 : 0;
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
    const Input &input_;
    std::unordered_map<NodeId, int> known_;
};

class ParamBounds {
  public:
    ParamBounds(Flattening &context, const Ranges &ranges, NodeId field, const Domain &domain,
                const Budget &budget)
        : context_(context), graph_(context.graph), ranges_(ranges), field_(field), domain_(domain),
          budget_(budget) {
        budget_.instructions /= instructions_apart;
    }

    ParamBound find(double whole) {
        whole_ = whole;
        ParamBound least;
        const std::vector<Input> params = read_params();
        if (!params.empty() && params.size() <= most_params) {
            const std::size_t left = context_.work.left;
            const double present = bound(with_present(params), field_);
            one_proof_ = left - context_.work.left;
            if (pays(whole, present)) {
                const double together = add_joint(params, present, least);
                if (pays(std::min(whole, together), present))
                    for (const Input &param : params)
                        add(param, std::min(whole, least.most), least);
            }
        }
        budget_.instructions *= instructions_apart; // of the time there are few inputs
        const std::vector<Input> moving = read_moving();
        if (moving.size() <= most_moving)
            for (const Input &input : moving) add(input, std::min(whole, least.most), least);
        return least;
    }

  private:
    std::vector<Input> read_params() {
        const ir::Scene &scene = *ranges_.scene;
        std::vector<Input> out;
        for (const auto &[index, nodes] : params_of(graph_, field_)) {
            const ir::Param &p = scene.params[index];
            const Interval &range = ranges_.params[index][0];
            if (p.structural || !p.has_range || !range.finite() || !(range.lo < range.hi) ||
                (p.type != ir::Type::Float && p.type != ir::Type::Int))
                continue;
            const NodeId node = nodes.front(),
                         value = p.type == ir::Type::Int ? graph_.make(Op::ToFloat, {node}) : node;
            out.push_back({value, field_, Op::Param, index, range, p.value[0]});
        }
        std::ranges::sort(out, {}, &Input::payload);
        return out;
    }
    // Each as a variable of its own.
    std::vector<Input> read_moving() {
        if (!graph_.reads(field_).time) return {};
        const ir::WithoutCalls written = ir::without_calls(graph_, field_, most_nodes);
        if (!written.all) return {};
        std::vector<Input> out;
        for (NodeId node : moving_with_time(graph_, written.root)) {
            const Interval range = range_of(context_, ranges_, node, Cell{})[0];
            if (!range.finite() || !(range.width() > least_width)) continue;
            const NodeId variable = graph_.fresh_var(ir::Type::Float);
            const bool is_time = graph_[node].op == Op::Time;
            out.push_back({node, ir::substitute(graph_, written.root, {{node, variable}}), Op::Var,
                           graph_[variable].payload, range, is_time ? range.lo : range.middle()});
        }
        return out;
    }

    Ranges with_present(const std::vector<Input> &params) const {
        Ranges out = ranges_;
        for (const Input &param : params) out.params[param.payload][0] = Interval(param.present);
        return out;
    }

    // What several params do together: in `a * sin(b * p.x)` each alone may make the field steep, and
    // both are mostly small. Where there are too many, those that make it steep while the others stand
    // where they are. The formula's value at the present values; infinity where there is none.
    double add_joint(std::vector<Input> inputs, double present, ParamBound &least) {
        if (proofs_of(inputs) > most_joint) {
            const Ranges standing = with_present(inputs);
            std::erase_if(inputs, [&](const Input &input) {
                Ranges one = standing;
                one.params[input.payload][0] = input.range;
                return !pays(bound(one, field_), present);
            });
        }
        const std::size_t proofs = proofs_of(inputs);
        if (inputs.size() < 2 || proofs > most_joint || proofs * one_proof_ > most_joint_work)
            return ir::rounding::infinity;
        std::stable_partition(inputs.begin(), inputs.end(),
                              [&](const Input &input) { return AffineIn(graph_, input)(); });
        Ranges at = ranges_;
        most_ = 0;
        const Found found = joint(inputs, at);
        least = {found.formula, most_};
        return found.present;
    }
    std::size_t proofs_of(const std::vector<Input> &inputs) const {
        std::size_t out = 1;
        for (const Input &input : inputs)
            out *= AffineIn(graph_, input)() ? ends_of_lines(input.range).size()
                                             : ends_of_pieces(input.range).size() + 1;
        return out;
    }
    struct Found {
        NodeId formula;
        double present = ir::rounding::infinity; // its value at the present values
    };
    // Convex in each param that the field is affine in, while the others stand still: of a box its
    // corners tell. So these come first, and the numbers at the corners are chosen by the others.
    Found joint(std::span<const Input> inputs, Ranges &at) {
        if (inputs.empty()) {
            const double here = bound(at, field_);
            most_ = std::max(most_, here);
            return {graph_.number(here), here};
        }
        const Input &input = inputs.front();
        const auto over = [&](Interval values) {
            at.params[input.payload][0] = values;
            const Found found = joint(inputs.subspan(1), at);
            at.params[input.payload][0] = input.range;
            return found;
        };
        Found out;
        if (!AffineIn(graph_, input)()) {
            out.formula = pieces(input, [&](double lo, double hi) {
                const Found here = over(around(input, lo, hi));
                if (lo == hi && lo == input.present) out.present = here.present;
                return here.formula;
            });
            return out;
        }
        const std::vector<double> ends = ends_of_lines(input.range);
        Found from = over(Interval(ends[0]));
        for (std::size_t i = 0; i + 1 < ends.size(); ++i) {
            const double a = ends[i], b = ends[i + 1];
            const Found to = over(Interval(b));
            const NodeId beyond = graph_.sub(input.value, graph_.number(a));
            const NodeId way = graph_.mul(beyond, graph_.number(1 / (b - a)));
            const NodeId rise = graph_.sub(to.formula, from.formula);
            const NodeId line = graph_.add(from.formula, graph_.mul(way, rise));
            out.formula = i ? choice(Op::Less, input.value, a, out.formula, line) : line;
            if (a <= input.present && input.present <= b)
                out.present = std::lerp(from.present, to.present, (input.present - a) / (b - a));
            from = to;
        }
        return out;
    }

    void add(const Input &input, double whole, ParamBound &least) {
        const std::size_t left = context_.work.left;
        if (!pays(whole, at(input, Interval(input.present)))) return;
        // A formula of the time is worth no refusal for want of work.
        constexpr std::size_t searches = 2 * (range_pieces + most_halvings);
        if (input.op == Op::Var && (left - context_.work.left) * searches > context_.work.left / 2)
            return;
        most_ = 0;
        const NodeId one = AffineIn(graph_, input)() ? by_lines(input) : by_pieces(input);
        least.formula = least.formula ? graph_.make(Op::Min, {least.formula, one}) : one;
        least.most = std::min(least.most, most_);
    }

    static bool pays(double whole, double present) {
        return std::isfinite(whole) && whole > pays_from * present + 0.05;
    }
    double bound(const Ranges &ranges, NodeId field) {
        // With less work one of these may be refused where the whole is not.
        return std::min(bound_field(context_, ranges, field, domain_, budget_).lipschitz, whole_) *
               allowance;
    }
    double at(const Input &input, Interval values) {
        Ranges ranges = ranges_;
        (input.op == Op::Param ? ranges.params[input.payload] : ranges.vars[input.payload])[0] =
            values;
        const double found = bound(ranges, input.field);
        most_ = std::max(most_, found);
        return found;
    }

    // Chords of a convex function lie above it between their ends; the greatest of several, everywhere
    // between the first end and the last.
    NodeId by_lines(const Input &input) {
        const std::vector<double> ends = ends_of_lines(input.range);
        NodeId most;
        for (std::size_t i = 0; i + 1 < ends.size(); ++i)
            add_line(input, ends[i], at(input, Interval(ends[i])), ends[i + 1],
                     at(input, Interval(ends[i + 1])), most_halvings, most);
        return most;
    }
    static std::vector<double> ends_of_lines(Interval range) {
        if (range.lo < 0 && range.hi > 0) return {range.lo, 0, range.hi};
        return {range.lo, range.hi};
    }
    void add_line(const Input &input, double a, double at_a, double b, double at_b, int halvings,
                  NodeId &most) {
        const double middle = (a + b) / 2;
        if (halvings > 0) {
            const double there = at(input, Interval(middle));
            if ((at_a + at_b) / 2 > near_enough * there + 0.02) {
                add_line(input, a, at_a, middle, there, halvings - 1, most);
                add_line(input, middle, there, b, at_b, halvings - 1, most);
                return;
            }
        }
        const double slope = (at_b - at_a) / (b - a);
        const NodeId line = graph_.add(graph_.number(at_a - slope * a),
                                       graph_.mul(graph_.number(slope), input.value));
        most = most ? graph_.make(Op::Max, {most, line}) : line;
    }

    // Pieces of one ratio where the range is on one side of 0, for what scales by a param has it for a
    // slope; else narrower ones towards 0.
    static std::vector<double> ends_of_pieces(Interval range) {
        if (range.hi <= 0) {
            std::vector<double> out = ends_of_pieces(Interval(-range.hi, -range.lo));
            for (double &end : out) end = -end;
            std::ranges::reverse(out);
            return out;
        }
        std::vector<double> out{range.lo};
        if (range.lo > 0)
            for (int i = 1; i < range_pieces; ++i)
                out.push_back(range.lo * std::pow(range.hi / range.lo, double(i) / range_pieces));
        if (range.lo < 0) {
            for (double way : ways_to_both) out.insert(out.begin() + 1, way * range.lo);
            out.push_back(0);
            for (double way : ways_to_both) out.push_back(way * range.hi);
        }
        if (range.lo == 0)
            for (double way : ways_to_one) out.push_back(way * range.hi);
        out.push_back(range.hi);
        return out;
    }
    // The values from `lo` to `hi`, and a little further, for values that are rounded.
    static Interval around(const Input &input, double lo, double hi) {
        const double rim = 1e-6 * std::max(std::fabs(lo), std::fabs(hi));
        return {std::max(lo - rim, input.range.lo), std::min(hi + rim, input.range.hi)};
    }
    NodeId by_pieces(const Input &input) {
        return pieces(input, [&](double lo, double hi) {
            return graph_.number(at(input, around(input, lo, hi)));
        });
    }
    // One of several formulas, by where the input is: `over` gives that of a piece of its range.
    NodeId pieces(const Input &input, const std::function<NodeId(double lo, double hi)> &over) {
        const std::vector<double> ends = ends_of_pieces(input.range);
        NodeId out;
        for (std::size_t i = ends.size() - 1; i-- > 0;) {
            const NodeId here = over(ends[i], ends[i + 1]);
            out = out ? choice(Op::Less, input.value, ends[i + 1], here, out) : here;
        }
        // Where a slider mostly stands: where the text puts it, and at nothing.
        if (input.op == Op::Param) {
            const NodeId here = over(input.present, input.present);
            out = choice(Op::Equal, input.value, input.present, here, out);
            if (input.range.lo <= 0 && input.range.hi >= 0 && input.present != 0) {
                const NodeId none = over(0, 0);
                out = choice(Op::Equal, input.value, 0, none, out);
            }
        }
        return out;
    }
    NodeId choice(Op comparison, NodeId value, double with, NodeId then, NodeId otherwise) {
        const NodeId condition = graph_.make(comparison, {value, graph_.number(with)});
        return graph_.make(Op::Select, {condition, then, otherwise});
    }

    Flattening &context_;
    ir::Graph &graph_;
    const Ranges &ranges_;
    NodeId field_;
    Domain domain_;
    Budget budget_;
    double whole_ = ir::rounding::infinity; // the bound for all values
    std::size_t one_proof_ = 0;             // work
    double most_ = 0;                       // of the bounds that the formula in hand is made of
};

} // namespace

ParamBound bound_by_params(Flattening &context, const Ranges &ranges, NodeId field,
                           const Domain &domain, const Budget &budget, double whole) {
    const ir::Graph::Reads reads = context.graph.reads(field);
    if (!(reads.params || reads.time) || !ranges.scene) return {};
    return ParamBounds(context, ranges, field, domain, budget).find(whole);
}

} // namespace fathom::proof
