// A border of floor(u) is where u is a whole number K. Left of it the floor is K - 1, on it K; so
// the field does not see the jump where it is one expression with K - 1 and with K in the floor's
// place and K in u's. K is a fresh variable, which stands for all whole numbers at once. All steps
// that turn at the same border are replaced together. Where a sum of products makes both sides
// equal (continuity.h), each piece is continuous up to the border, so the field is continuous
// across it, and a bound of its slope on each side bounds it on both.
#include "proof/steps.h"

#include "ir/passes/inline.h"
#include "proof/continuity.h"

#include <cassert>
#include <cmath>
#include <map>
#include <numbers>
#include <optional>
#include <vector>

namespace fathom::proof {
namespace {

using ir::Graph;
using ir::NodeId;
using ir::Op;

constexpr std::size_t most_nodes = 4'000; // of a field that is looked at
constexpr int most_depth = 400;

constexpr ir::OpSet is_step{Op::Floor, Op::Ceil, Op::Round, Op::Fract, Op::Mod, Op::Atan2};

// -- one form for equal expressions --------------------------------------------------------------

// Rewrites an expression so that equal ones become the same node more often: sums of products,
// vectors by component, whole numbers as what they are, `mix` at its ends, lengths as roots of
// sums.
struct Canonical {
    Graph &graph;
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

    NodeId scalar(NodeId id) { return in_one_form(graph, id); }

    NodeId of(NodeId id, int depth = 0) {
        if (auto it = known.find(id); it != known.end()) return it->second;
        if (depth > most_depth || known.size() > 4 * most_nodes) failed = true;
        if (failed) return id;
        const ir::Node node = graph[id];
        NodeId out = id;
        if (node.count > 0) out = rewritten(id, node, depth);
        known[id] = out;
        return out;
    }

    NodeId rewritten(NodeId id, const ir::Node &node, int depth) {
        std::vector<NodeId> args;
        for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
            args.push_back(of(a, depth + 1));
        constexpr ir::OpSet rounds{Op::Floor, Op::Ceil, Op::Round}, turns{Op::Sin, Op::Cos};
        if (node.op == Op::Mix)
            if (auto t = number(args[2]); t && (*t == 0 || *t == 1)) return args[*t == 0 ? 0 : 1];
        if (node.op == Op::ToFloat && graph[args[0]].type == ir::Type::Int)
            return scalar(as_float(args[0]));
        if (node.op == Op::ToInt || rounds[node.op])
            if (auto w = whole(args[0])) return node.op == Op::ToInt ? *w : args[0];
        if (node.op == Op::Fract && whole(args[0])) return graph.number(0);
        if (node.op == Op::Mod) { // at a multiple of the divisor, up to the rounding of the numbers
                                  // that say so
            auto x = number(args[0]), m = number(args[1]);
            if (x && m && *m != 0 && std::fabs(*x / *m - std::round(*x / *m)) < 1e-9)
                return zero(node.type);
        }
        if (turns[node.op] && node.type == ir::Type::Float) args[0] = without_turns(graph, args[0]);
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
    NodeId zero(ir::Type type) {
        ir::Constant c;
        c.type = type;
        return graph.constant(c);
    }
};

// -- borders -------------------------------------------------------------------------------------

// Steps of one component that turn where `turning` is a whole number (of an Atan2: where its first
// argument is 0).
struct Group {
    NodeId turning;
    int component = 0;
    std::vector<NodeId> steps;
    std::vector<NodeId> dividends; // of the group's Mods: also fixed at the border
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

// What a step gives left of a border (`after` false) and on it, where its argument is `border` = K
// + half / 2.
NodeId limit(Graph &graph, NodeId step, int component, NodeId whole, bool half, bool after) {
    const auto one = [&] { return graph.number(1); };
    const Op op = graph[step].op;
    if (op == Op::Floor) return after || half ? whole : graph.sub(whole, one());
    if (op == Op::Ceil) return after || half ? graph.add(whole, one()) : whole;
    if (op == Op::Round) return half && after ? graph.add(whole, one()) : whole;
    if (op == Op::Fract) return half ? graph.number(0.5) : graph.number(after ? 0 : 1);
    if (op == Op::Mod) {
        NodeId m = component_of(graph, graph.arg(step, 1), component);
        return half ? graph.mul(m, graph.number(0.5)) : after ? graph.number(0) : m;
    }
    assert(op == Op::Atan2); // the last that is_step knows
    return graph.number(after ? -std::numbers::pi : std::numbers::pi);
}

bool cancels(Graph &graph, NodeId root, const Group &group) {
    const NodeId whole = graph.make(Op::ToFloat, ir::Type::Float, {graph.fresh_var(ir::Type::Int)});
    bool halves = false, wholes = false;
    for (NodeId step : group.steps) (graph[step].op == Op::Round ? halves : wholes) = true;
    for (const bool half : {false, true}) {
        if (half ? !halves : !wholes) continue;
        NodeId border = half ? graph.add(whole, graph.number(0.5)) : whole;
        if (group.is_angle) border = graph.number(0);
        auto side = [&](bool after) {
            ir::Substitution map;
            auto put = [&](NodeId node, NodeId value) {
                if (!graph.is_constant(node))
                    map[node] = with_component(graph, node, group.component, value);
            };
            if (auto at =
                    solved(graph, component_of(graph, group.turning, group.component), border))
                map[at->vector] = with_component(graph, at->vector, at->component, at->value);
            put(group.turning, border);
            for (NodeId mod : group.steps)
                if (graph[mod].op == Op::Mod)
                    put(graph.arg(mod, 0),
                        graph.mul(border, component_of(graph, graph.arg(mod, 1), group.component)));
            for (NodeId step : group.steps)
                put(step, limit(graph, step, group.component, whole, half, after));
            return ir::substitute(graph, root, map);
        };
        Canonical one{graph};
        const NodeId left = one.of(side(false)), right = one.of(side(true));
        if (one.failed || !same(graph, left, right)) return false;
    }
    return true;
}

std::vector<NodeId> reached(const Graph &graph, NodeId root, bool enter_calls) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() <= most_nodes) {
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

bool has_steps(const Graph &graph, NodeId root) {
    for (NodeId id : reached(graph, root, true))
        if (is_step[graph[id].op] && graph[id].type != ir::Type::Int) return true;
    return false;
}

NodeId written_out(Graph &graph, NodeId root) {
    const ir::WithoutCalls out = ir::without_calls(graph, root, most_nodes);
    return out.all ? out.root : root;
}

std::unordered_set<NodeId> cancelling_steps(Graph &graph, NodeId root) {
    const std::vector<NodeId> nodes = reached(graph, root, false);
    if (nodes.size() > most_nodes) return {};
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
    return steps;
}

} // namespace fathom::proof
