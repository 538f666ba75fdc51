// Long: one form for expressions, borders in it, and their cases share their state.
// A border of floor(u) is where u is a whole number K, a fresh variable that stands for all whole
// numbers at once. The field is written three times: for u a little less than K, for K, and for a
// little more; "a little" is an infinitesimal, at which every other step is evaluated, too. A step
// whose argument is then a number, a whole multiple of K and a multiple of the infinitesimal has
// one value (floor(u + 1) moves with floor(u)). Any other that the point moves is taken for
// unknown: one variable for equal arguments. Where a sum of products makes all three equal
// (continuity.h), the field does not see the jump, whatever the unknown steps are; so where steps
// turn together without our knowing, their jumps can be taken one after another
// (docs/lipschitz.md, 2).
#include "proof/discontinuities.h"

#include "ir/interval.h"
#include "ir/passes/inline.h"
#include "proof/continuity.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::Interval;
using ir::NodeId;
using ir::Op;

constexpr std::size_t max_nodes = 4'000; // of a field that is looked at
constexpr int max_depth = 400;

constexpr ir::OpSet is_step{Op::Floor, Op::Ceil, Op::Round, Op::Fract, Op::Mod, Op::Atan2};

// -- one form for equal expressions --------------------------------------------------------------

// Rewrites an expression so that equal ones become the same node more often: sums of products,
// vectors by component, whole numbers as what they are, `mix` at its ends, lengths as roots of
// sums. Steps are what `border` says of them.
struct Border;
struct Canonical {
    Graph &graph;
    Border *border = nullptr;
    bool moving = false; // as the border is neared, not what is reached there
    std::map<NodeId, NodeId> known{};
    bool failed = false;

    std::optional<double> number(NodeId id) const {
        if (graph[id].op == Op::Splat) return number(graph.arg(id, 0));
        if (!graph.is_constant(id)) return {};
        const ir::Constant &c = graph.constant_of(id);
        for (int i = 1; i < ir::components(c.type); ++i)
            if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
        return c.value[0];
    }

    // The Int that a Float is made of, where it is whole by its making.
    std::optional<NodeId> whole(NodeId id) {
        const ir::Node node = graph[id];
        if (node.type != ir::Type::Float) return {};
        if (auto c = graph.as_number(id))
            return std::floor(*c) == *c && std::fabs(*c) < 1e9
                       ? std::optional(graph.integer(static_cast<int>(*c)))
                       : std::nullopt;
        if (node.op == Op::ToFloat && graph[graph.arg(id, 0)].type == ir::Type::Int)
            return graph.arg(id, 0);
        if (node.op != Op::Add && node.op != Op::Sub && node.op != Op::Mul && node.op != Op::Neg)
            return {};
        std::vector<NodeId> parts;
        for (int i = 0; i < int(node.count); ++i) {
            auto part = whole(graph.arg(id, i));
            if (!part) return {};
            parts.push_back(*part);
        }
        return graph.make(node.op, ir::Type::Int, parts);
    }
    NodeId as_float(NodeId id) { // of an Int: sums and products outside of the conversion
        const ir::Node node = graph[id];
        if (auto c = graph.as_number(id)) return graph.number(*c);
        if (node.op == Op::Add || node.op == Op::Sub || node.op == Op::Mul || node.op == Op::Neg) {
            std::vector<NodeId> parts;
            for (int i = 0; i < int(node.count); ++i) parts.push_back(as_float(graph.arg(id, i)));
            return graph.make(node.op, ir::Type::Float, parts);
        }
        return graph.make(Op::ToFloat, ir::Type::Float, {id});
    }

    NodeId scalar(NodeId id);
    std::optional<NodeId> turned(Op op, NodeId angle);

    NodeId of(NodeId id, int depth = 0) {
        if (auto it = known.find(id); it != known.end()) return it->second;
        if (depth > max_depth || known.size() > 4 * max_nodes) failed = true;
        if (failed) return id;
        const ir::Node node = graph[id];
        NodeId out = id;
        if (is_step[node.op] && node.type != ir::Type::Int)
            out = step(id, node, depth);
        else if (node.count > 0)
            out = rewritten(id, node, depth);
        known[id] = out;
        return out;
    }
    NodeId step(NodeId id, const ir::Node &node, int depth);
    std::optional<NodeId> decided(const ir::Node &node, const std::vector<NodeId> &args);
    std::optional<NodeId> read_of(const ir::Node &node, NodeId index);

    NodeId rewritten(NodeId id, const ir::Node &node, int depth) {
        std::vector<NodeId> args;
        for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
            args.push_back(of(a, depth + 1));
        if (node.op == Op::Mix)
            if (auto t = number(args[2]); t && (*t == 0 || *t == 1)) return args[*t == 0 ? 0 : 1];
        if (const auto known_one = decided(node, args)) return *known_one;
        if (node.op == Op::TableRead)
            if (const auto read = read_of(node, args[0])) return *read;
        if (node.op == Op::ToFloat && graph[args[0]].type == ir::Type::Int)
            return scalar(as_float(args[0]));
        if (node.op == Op::ToInt)
            if (auto w = whole(args[0])) return *w;
        if ((node.op == Op::Sin || node.op == Op::Cos) && node.type == ir::Type::Float) {
            if (const auto sum = turned(node.op, args[0])) return *sum;
            args[0] = without_iterations(graph, args[0]);
        }
        if (node.op == Op::Length) {
            NodeId sum = graph.number(0);
            for (int i = 0; i < ir::components(graph[args[0]].type); ++i) {
                NodeId part = scalar(component_of(graph, args[0], i));
                sum = graph.add(sum, graph.mul(part, part));
            }
            return graph.make(Op::Sqrt, ir::Type::Float, {scalar(sum)});
        }
        NodeId made = graph.make(node.op, node.type, args, node.payload);
        if (node.type == ir::Type::Float) return scalar(made);
        if (node.type == ir::Type::Int) {
            auto w = whole(scalar(as_float(made)));
            return w ? *w : made;
        }
        if (ir::is_vector(node.type)) {
            std::vector<NodeId> parts;
            for (int i = 0; i < ir::components(node.type); ++i) {
                NodeId part = component_of(graph, made, i);
                if (graph[part].op == Op::Swizzle && graph.arg(part, 0) == made)
                    return made; // not made of scalars
                parts.push_back(scalar(part));
            }
            return graph.make(Op::Make, node.type, parts);
        }
        return made;
    }
};

// -- borders -------------------------------------------------------------------------------------

// Steps of one component that turn where `turning` is a whole number (of an Atan2: where its first
// argument is 0).
struct Group {
    NodeId turning;
    int component = 0;
    std::vector<NodeId> steps;
    bool is_angle = false;
};

// A node with one component replaced; the node's type may be a scalar.
NodeId with_component(Graph &graph, NodeId id, int component, NodeId value) {
    const ir::Type type = graph[id].type;
    if (!ir::is_vector(type)) return value;
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(type); ++i)
        parts.push_back(i == component ? value : component_of(graph, id, i));
    return graph.make(Op::Make, type, parts);
}

enum class Side { Before, At, After };
constexpr double sign_of(Side side) { return side == Side::Before ? -1.0 : 1.0; }

// A step's argument near a border: times K + number + slope * the infinitesimal. On the border
// itself the slope is that from after it, and rounds nothing.
struct Near {
    double times = 0, number = 0, slope = 0;
};

// Which of all whole numbers K is one of. `met`: what it would help to know of it.
struct Counts {
    std::optional<int> parity;
    Interval range = Interval::everything();
};
struct Met {
    std::vector<double> thresholds;
    bool parity = false;
};

// One side of a group's borders, where what turns is K, or K + 1/2.
struct Border {
    Graph &graph;
    const Group &group;
    const NodeId whole, little, little_angle, radius;      // K; how far from the border; by which
                                                           // angle; how far from an axis
    std::map<std::vector<std::uint32_t>, NodeId> &unknown; // by op and arguments, of all sides
    const bool half;
    const Side side;
    const Counts &counts;
    Met &met;
    Canonical limit{graph, this, false}, moving{graph, this, true};

    // What is known there of coordinates, and of the group's own arguments.
    void enter(Canonical &into, bool moves) {
        // counting an angle up across its cut, y falls
        NodeId border = group.is_angle ? graph.number(0)
                        : half         ? graph.add(whole, graph.number(0.5))
                                       : whole;
        if (moves)
            border = graph.add(
                border,
                graph.mul(graph.number(group.is_angle ? -sign_of(side) : sign_of(side)), little));
        const auto put = [&](NodeId node, NodeId value) {
            if (!graph.is_constant(node))
                into.known[node] = with_component(graph, node, group.component, value);
        };
        if (!moves && enter_turned(into, border)) return;
        if (auto at = solved(graph, component_of(graph, group.turning, group.component), border))
            into.known[at->vector] = with_component(graph, at->vector, at->component, at->value);
        put(group.turning, border);
        for (NodeId step : group.steps)
            if (graph[step].op == Op::Mod)
                put(graph.arg(step, 0),
                    graph.mul(border, component_of(graph, graph.arg(step, 1), group.component)));
    }

    // Where an angle of two coordinates turns: these by it and their distance from the axis.
    bool by_angle = false;
    bool enter_turned(Canonical &into, NodeId border) {
        if (group.is_angle) return false;
        const NodeId turning = component_of(graph, group.turning, group.component);
        std::optional<NodeId> angle;
        for (NodeId id : reached_below(graph, turning))
            if (graph[id].op == Op::Atan2) {
                if (angle) return false;
                angle = id;
            }
        const auto linear = angle ? linear_in(graph, turning, *angle) : std::nullopt;
        if (!linear || linear->by == 0 || !graph.is_constant(linear->rest)) return false;
        const NodeId y = graph.arg(*angle, 0), x = graph.arg(*angle, 1);
        if (graph[y].op != Op::Swizzle || graph[x].op != Op::Swizzle) return false;
        const NodeId vector = graph.arg(y, 0);
        if (graph.arg(x, 0) != vector || x == y) return false;
        const NodeId at = in_one_form(
            graph, graph.mul(graph.sub(border, linear->rest), graph.number(1 / linear->by)));
        by_angle = true;
        const auto with = [&](NodeId of, NodeId part, Op op) {
            return with_component(graph, of, ir::swizzle_component(graph[part].payload, 0),
                                  graph.mul(radius, of_angle(into, op, at)));
        };
        into.known[vector] = with(with(vector, x, Op::Cos), y, Op::Sin);
        into.known[x] = into.scalar(graph.mul(radius, of_angle(into, Op::Cos, at)));
        into.known[y] = into.scalar(graph.mul(radius, of_angle(into, Op::Sin, at)));
        into.known[*angle] = at;
        into.known[group.turning] = border;
        return true;
    }
    NodeId of_angle(Canonical &into, Op op, NodeId angle) {
        const auto sum = into.turned(op, angle);
        return sum ? *sum : graph.make(op, {angle});
    }
    static std::vector<NodeId> reached_below(const Graph &graph, NodeId root) {
        std::vector<NodeId> out, todo{root};
        std::unordered_set<NodeId> seen;
        while (!todo.empty() && out.size() < 200) {
            const NodeId id = todo.back();
            todo.pop_back();
            if (!seen.insert(id).second) continue;
            out.push_back(id);
            for (NodeId a : graph.args(id)) todo.push_back(a);
        }
        return out;
    }

    bool is_own(NodeId step, int component) const {
        return component == group.component &&
               std::find(group.steps.begin(), group.steps.end(), step) != group.steps.end();
    }

    // The argument of a step that rounds; nothing where it depends on more than the border.
    std::optional<Near> near(NodeId step, int component, int depth) {
        if (is_own(step, component)) return Near{1, half ? 0.5 : 0, sign_of(side)};
        NodeId t = part(moving, step, 0, component, depth);
        if (graph[step].op == Op::Mod) t = graph.div(t, part(moving, step, 1, component, depth));
        const auto sum = combination(graph, t, std::array{whole, little, little_angle});
        if (!sum) return {};
        const auto &c = *sum;
        // of two infinitesimals none is known to be the greater
        if (std::floor(c[0]) != c[0] || c[1] * c[2] < 0) return {};
        return Near{c[0], c[3], c[1] + c[2]};
    }
    NodeId part(Canonical &of, NodeId step, int arg, int component, int depth) {
        return component_of(graph, of.of(graph.arg(step, arg), depth + 1), component);
    }

    // Numbers that are whole but for rounding are whole. Where angles are cut pi may have been
    // written with few digits, and no evaluator tells 1e-9 from 0; near 0 others do.
    double snapped(double x) const {
        const double nearest = std::round(x), rounding = group.is_angle ? 1e-9 : 1e-13;
        return std::fabs(x - nearest) > rounding ? x : nearest;
    }
    // floor(number + slope * the infinitesimal)
    double floor_of(double number, double slope) const {
        const double x = snapped(number);
        return std::floor(x) == x && slope < 0 && side != Side::At ? x - 1 : std::floor(x);
    }

    // In single precision two steps turn at one number alone where the one's argument is the
    // other's, or a power of two times it.
    bool turns_with(NodeId step, int component, const Near &t) const {
        if (group.is_angle || is_own(step, component) || t.times == 0) return true;
        const double at = t.number + (graph[step].op == Op::Round ? 0.5 : 0);
        if (snapped(at) != std::floor(snapped(at))) return true; // not at its border
        const auto base = [&](NodeId id) {
            for (;;) {
                const ir::Node &node = graph[id];
                if (node.op == Op::Neg) {
                    id = graph.arg(id, 0);
                    continue;
                }
                if (node.op != Op::Mul) return id;
                const bool first = is_power_of_two(graph.arg(id, 0));
                if (!first && !is_power_of_two(graph.arg(id, 1))) return id;
                id = graph.arg(id, first ? 1 : 0);
            }
        };
        return base(graph.arg(step, 0)) == base(group.turning) ||
               (graph[step].op == Op::Mod && graph[group.turning].op == Op::Div &&
                graph.arg(step, 0) == graph.arg(group.turning, 0) &&
                graph.arg(step, 1) == graph.arg(group.turning, 1));
    }
    bool is_power_of_two(NodeId id) const {
        if (graph[id].op == Op::Splat) id = graph.arg(id, 0);
        if (!graph.is_constant(id)) return false;
        const ir::Constant &c = graph.constant_of(id);
        int exponent = 0;
        for (int i = 0; i < ir::components(c.type); ++i)
            if (std::fabs(std::frexp(c.value[static_cast<std::size_t>(i)], &exponent)) != 0.5)
                return false;
        return true;
    }

    NodeId value(NodeId step, int component, bool moves, int depth) {
        const Op op = graph[step].op;
        if (op == Op::Atan2) return angle(step, component, moves, depth);
        const auto t = near(step, component, depth);
        if (!t || !turns_with(step, component, *t)) return unknown_of(step, component, depth);
        const NodeId multiple = graph.mul(graph.number(t->times), whole);
        const auto rest = [&] { // t - floor(t)
            const NodeId left = graph.number(snapped(t->number) - floor_of(t->number, t->slope));
            return moves ? graph.add(left, graph.mul(graph.number(t->slope), little)) : left;
        };
        const auto floored = [&](double number, double slope) {
            return graph.number(floor_of(number, slope));
        };
        if (op == Op::Floor) return graph.add(multiple, floored(t->number, t->slope));
        if (op == Op::Round) return graph.add(multiple, floored(t->number + 0.5, t->slope));
        if (op == Op::Ceil) return graph.sub(multiple, floored(-t->number, -t->slope));
        if (op == Op::Fract) return rest();
        assert(op == Op::Mod); // the last that is_step knows
        return graph.mul(rest(), part(moves ? moving : limit, step, 1, component, depth));
    }

    // The angle that is cut here; of any other nothing is known.
    NodeId angle(NodeId step, int component, bool moves, int depth) {
        if (!group.is_angle || !is_own(step, component)) return unknown_of(step, component, depth);
        const bool after = side == Side::After;
        NodeId out = graph.number(after ? -std::numbers::pi : std::numbers::pi);
        if (moves) out = graph.add(out, after ? little_angle : graph.neg(little_angle));
        return out;
    }

    // Of steps that hang on other steps alone, the value is what it says; else anything, one for
    // equal arguments.
    NodeId unknown_of(NodeId step, int component, int depth) {
        std::vector<NodeId> args;
        std::vector<std::uint32_t> key{static_cast<std::uint32_t>(graph[step].op)};
        bool moves = false;
        for (int i = 0; i < int(graph[step].count); ++i) {
            args.push_back(limit.scalar(part(limit, step, i, component, depth)));
            key.push_back(args.back().index);
            moves = moves || graph.reads(args.back()).point ||
                    reads_little(part(moving, step, i, component, depth));
        }
        if (!moves && graph[step].op == Op::Mod)
            if (const auto parity = parity_of(args[0], args[1])) return *parity;
        if (!moves) return graph.make(graph[step].op, ir::Type::Float, args, graph[step].payload);
        const auto [it, fresh] = unknown.try_emplace(key);
        if (fresh) it->second = graph.fresh_var(ir::Type::Float);
        return it->second;
    }
    // (j K + n) % 2, j and n whole, by K % 2.
    std::optional<NodeId> parity_of(NodeId count, NodeId two) {
        const auto sum = combination(graph, count, std::array{whole});
        if (!sum || graph.as_number(two) != 2.0) return {};
        const double j = (*sum)[0], n = (*sum)[1];
        if (std::floor(j) != j || std::floor(n) != n) return {};
        const bool odd = std::fmod(n, 2) != 0;
        if (std::fmod(j, 2) == 0) return graph.number(odd ? 1 : 0);
        met.parity = true;
        if (counts.parity) return graph.number((*counts.parity + (odd ? 1 : 0)) % 2);
        const NodeId rest = graph.make(Op::Mod, ir::Type::Float, std::array{whole, two});
        return odd ? graph.sub(graph.number(1), rest) : rest;
    }
    // The sign of j K + n, where that is known of K.
    std::optional<int> sign_of_count(NodeId count) {
        const auto sum = combination(graph, count, std::array{whole});
        if (!sum) return {};
        const double j = (*sum)[0], n = (*sum)[1];
        const Interval all = Interval(j) * counts.range + Interval(n);
        if (j == 0) return n > 0 ? 1 : n < 0 ? -1 : 0;
        if (all.lo > 0) return 1;
        if (all.hi < 0) return -1;
        met.thresholds.push_back(-n / j);
        return {};
    }
    bool reads_little(NodeId id) const {
        for (NodeId var : graph.free_vars(id))
            if (var == little || var == little_angle) return true;
        return false;
    }
};

NodeId Canonical::step(NodeId id, const ir::Node &node, int depth) {
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(node.type); ++i)
        parts.push_back(border->value(id, i, moving, depth));
    failed = failed || border->limit.failed || border->moving.failed;
    return parts.size() == 1 ? scalar(parts[0]) : graph.make(Op::Make, node.type, parts);
}

NodeId Canonical::scalar(NodeId id) {
    return border && border->by_angle ? without_rounding(graph, id) : in_one_form(graph, id);
}

// The sine or cosine of a K + b by those of a K and of b.
std::optional<NodeId> Canonical::turned(Op op, NodeId angle) {
    if (!border) return {};
    const auto sum = combination(graph, angle, std::array{border->whole});
    if (!sum || (*sum)[0] == 0) return {};
    constexpr double grain = 0x1p32; // so that equal angles are one
    const NodeId part =
        graph.mul(graph.number(std::round((*sum)[0] * grain) / grain), border->whole);
    const NodeId sine = graph.make(Op::Sin, {part}), cosine = graph.make(Op::Cos, {part});
    const NodeId s = graph.number(std::sin((*sum)[1])), c = graph.number(std::cos((*sum)[1]));
    if (op == Op::Cos) return scalar(graph.sub(graph.mul(cosine, c), graph.mul(sine, s)));
    return scalar(graph.add(graph.mul(sine, c), graph.mul(cosine, s)));
}

// What compares and chooses by K, as far as that is known.
std::optional<NodeId> Canonical::decided(const ir::Node &node, const std::vector<NodeId> &args) {
    constexpr ir::OpSet compares{Op::Less, Op::LessEqual, Op::Equal, Op::NotEqual},
        extremes{Op::Min, Op::Max};
    if (node.op == Op::Select && graph.is_constant(args[0]))
        return args[graph.constant_of(args[0]).value[0] != 0 ? 1 : 2];
    if (!border || (!compares[node.op] && !extremes[node.op])) return {};
    const ir::Type type = graph[args[0]].type;
    if (type != ir::Type::Float && type != ir::Type::Int) return {};
    const auto number = [&](NodeId id) { return type == ir::Type::Int ? as_float(id) : id; };
    const auto sign = border->sign_of_count(graph.sub(number(args[0]), number(args[1])));
    if (!sign) return {};
    if (node.op == Op::Min) return args[*sign <= 0 ? 0 : 1];
    if (node.op == Op::Max) return args[*sign >= 0 ? 0 : 1];
    return graph.boolean(node.op == Op::Less        ? *sign < 0
                         : node.op == Op::LessEqual ? *sign <= 0
                         : node.op == Op::Equal     ? *sign == 0
                                                    : *sign != 0);
}

// A list is read at its first entry below that, and at its last beyond: so limits of the index
// that are no narrower say nothing.
std::optional<NodeId> Canonical::read_of(const ir::Node &node, NodeId index) {
    const int last = graph.table(ir::table_of(node.payload)).rows - 1;
    NodeId inner = index;
    for (bool again = true; again;) {
        again = false;
        const ir::Node limit = graph[inner];
        if (limit.op != Op::Min && limit.op != Op::Max) break;
        for (int i = 0; i < 2 && !again; ++i) {
            const auto end = graph.as_number(graph.arg(inner, i));
            if (!end || (limit.op == Op::Min ? *end < last : *end > 0)) continue;
            inner = graph.arg(inner, 1 - i);
            again = true;
        }
    }
    if (inner == index) return {};
    return graph.make(node.op, node.type, {inner}, node.payload);
}

// Is the field the same on all sides of the borders with these K?
bool cancels(Graph &graph, NodeId root, const Group &group, bool half, const Counts &counts,
             Met &met) {
    const bool one = counts.range.is_point();
    const NodeId whole = one ? graph.number(counts.range.lo)
                             : graph.make(Op::ToFloat, ir::Type::Float,
                                          {graph.fresh_var(ir::Type::Int)}),
                 little = graph.fresh_var(ir::Type::Float),
                 little_angle = graph.fresh_var(ir::Type::Float),
                 radius = graph.fresh_var(ir::Type::Float);
    std::map<std::vector<std::uint32_t>, NodeId> unknown;
    std::vector<NodeId> sides;
    bool same_for_all = true;
    for (const Side side : {Side::Before, Side::At, Side::After}) {
        Border border{graph,   group, whole, little, little_angle, radius,
                      unknown, half,  side,  counts, met};
        border.enter(border.limit, false);
        border.enter(border.moving, true);
        sides.push_back(border.limit.of(root));
        if (border.limit.failed || border.moving.failed) return false;
        same_for_all = same_for_all && same(graph, sides.front(), sides.back());
        if (!same_for_all && met.thresholds.empty() && !met.parity) return false;
    }
    return same_for_all;
}

// By cases for K: even and odd, and beside each number that it is compared with.
bool cancels_by_cases(Graph &graph, NodeId root, const Group &group, bool half, Met met) {
    constexpr std::size_t most_thresholds = 8;
    if (met.thresholds.empty() && !met.parity) return false;
    std::vector<double> whole;
    for (double t : met.thresholds)
        for (double k : {std::floor(t), std::ceil(t)}) whole.push_back(k);
    std::sort(whole.begin(), whole.end());
    whole.erase(std::unique(whole.begin(), whole.end()), whole.end());
    if (whole.size() > 2 * most_thresholds) return false;
    std::vector<Interval> ranges;
    double from = -ir::rounding::infinity;
    for (double k : whole) {
        if (from < k) ranges.push_back({from, k - 1});
        ranges.push_back(k);
        from = k + 1;
    }
    ranges.push_back({from, ir::rounding::infinity});
    for (const Interval &range : ranges)
        for (int parity = 0; parity < 2; ++parity) {
            const bool odd = std::fmod(std::fabs(range.lo), 2) == 1;
            if (range.is_point() && odd != (parity == 1)) continue;
            Met more;
            if (!cancels(graph, root, group, half, {parity, range}, more)) return false;
        }
    return true;
}

bool cancels(Graph &graph, NodeId root, const Group &group) {
    bool halves = false, wholes = false;
    for (NodeId step : group.steps) (graph[step].op == Op::Round ? halves : wholes) = true;
    for (const bool half : {false, true}) {
        if (half ? !halves : !wholes) continue;
        Met met;
        if (!cancels(graph, root, group, half, {}, met) &&
            !cancels_by_cases(graph, root, group, half, met))
            return false;
    }
    return true;
}

std::vector<NodeId> reached(const Graph &graph, NodeId root, bool enter_calls) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() <= max_nodes) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        if (enter_calls && graph[id].op == Op::Call)
            todo.push_back(graph.function(ir::FunctionId{graph[id].payload}).result);
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return out;
}

} // namespace

std::vector<NodeId> in_body(const Graph &graph, NodeId loop_node) {
    std::vector<NodeId> out;
    const ir::Loop loop = graph.loop(ir::LoopId{graph[loop_node].payload});
    std::vector<NodeId> roots = loop.next;
    roots.push_back(loop.count);
    if (loop.condition) roots.push_back(loop.condition);
    for (NodeId root : roots)
        for (NodeId id : reached(graph, root, true)) {
            out.push_back(id);
            if (graph[id].op != Op::Loop) continue;
            const std::vector<NodeId> inner = in_body(graph, id);
            out.insert(out.end(), inner.begin(), inner.end());
        }
    return out;
}

bool has_steps(const Graph &graph, NodeId root) {
    for (NodeId id : reached(graph, root, true))
        if (is_step[graph[id].op] && graph[id].type != ir::Type::Int) return true;
    return false;
}

NodeId written_out(Graph &graph, NodeId root) {
    const ir::WithoutCalls out = ir::without_calls(graph, root, max_nodes);
    return out.all ? out.root : root;
}

std::unordered_set<NodeId> cancelling_steps(Graph &graph, NodeId root) {
    const std::vector<NodeId> nodes = reached(graph, root, false);
    if (nodes.size() > max_nodes) return {};
    std::map<std::pair<NodeId, int>, Group> groups;
    std::unordered_set<NodeId> steps;
    for (NodeId id : nodes) {
        const ir::Node node = graph[id];
        if (!is_step[node.op] || !graph.reads(id).point || graph.reads(id).free_vars) continue;
        if (node.type != ir::Type::Float && !ir::is_vector(node.type)) continue;
        NodeId turning = graph.arg(id, 0);
        if (node.op == Op::Mod) turning = graph.div(turning, graph.arg(id, 1));
        steps.insert(id);
        for (int i = 0; i < ir::components(node.type); ++i) {
            // an angle's border is its own; others share that of their argument's component
            Group &group = groups[{node.op == Op::Atan2 ? id : turning, i}];
            group.turning = node.op == Op::Atan2 ? graph.arg(id, 0) : turning;
            group.component = i;
            group.is_angle = node.op == Op::Atan2;
            group.steps.push_back(id);
        }
    }
    if (groups.size() > 24) return {};
    for (const auto &[key, group] : groups)
        if (!cancels(graph, root, group))
            for (NodeId step : group.steps) steps.erase(step);
    for (NodeId id : nodes) // in a loop's body no border is entered
        if (graph[id].op == Op::Loop)
            for (NodeId inside : in_body(graph, id)) steps.erase(inside);
    return steps;
}

} // namespace fathom::proof
