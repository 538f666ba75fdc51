// What is known on one side of a border: the coordinates there, the angle and the distance from its
// axis, and each step whose argument is K times a number, a number and an infinitesimal.
#include "proof/border_sides.h"

#include "proof/continuity.h"
#include "proof/exact.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <numbers>
#include <unordered_set>

namespace fathom::proof {
namespace {

// A node with one component replaced; the node's type may be a scalar.
NodeId with_component(Graph &graph, NodeId id, int component, NodeId value) {
    const ir::Type type = graph[id].type;
    if (!ir::is_vector(type)) return value;
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(type); ++i)
        parts.push_back(i == component ? value : component_of(graph, id, i));
    return graph.make(Op::Make, type, parts);
}

} // namespace

void Border::enter(Canonical &into, bool moves) {
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
    const Turning of = undivided(border);
    if (auto at = solved(graph, of.number, of.border))
        into.known[at->vector] = with_component(graph, at->vector, at->component, at->value);
    put(group.turning, border);
    for (NodeId step : group.steps)
        if (graph[step].op == Op::Mod)
            put(graph.arg(step, 0),
                graph.mul(border, component_of(graph, graph.arg(step, 1), group.component)));
}

Border::Turning Border::undivided(NodeId border) {
    Turning out{component_of(graph, group.turning, group.component), border};
    for (;;) {
        const Op op = graph[out.number].op;
        if (op != Op::Div && op != Op::Sub && op != Op::Add) return out;
        const NodeId of = graph.arg(out.number, 0), by = graph.arg(out.number, 1);
        const auto number = graph.as_number(by);
        if (!number || (op == Op::Div && *number == 0)) return out;
        out = {of, op == Op::Div   ? graph.mul(out.border, by)
                   : op == Op::Sub ? graph.add(out.border, by)
                                   : graph.sub(out.border, by)};
    }
}

bool Border::enter_turned(Canonical &into, NodeId border) {
    if (group.is_angle) return false;
    const auto [turning, there] = undivided(border);
    std::optional<NodeId> angle;
    for (NodeId id : down_to_angles(graph, turning))
        if (graph[id].op == Op::Atan2) {
            if (angle) return false;
            angle = id;
        }
    const auto linear = angle ? linear_in(graph, turning, *angle) : std::nullopt;
    if (!linear || linear->by == 0 || !graph.is_constant(linear->rest)) return false;
    const NodeId y = graph.arg(*angle, 0), x = graph.arg(*angle, 1);
    if (graph.is_constant(y) || graph.is_constant(x) || x == y) return false;
    const NodeId at =
        in_one_form(graph, graph.mul(graph.sub(there, linear->rest), graph.number(1 / linear->by)));
    by_angle = true;
    const std::array<std::pair<NodeId, Op>, 2> parts{{{x, Op::Cos}, {y, Op::Sin}}};
    for (const auto &[part, op] : parts) { // the vector that it is of, if any, and itself
        const NodeId value = graph.mul(radius, of_angle(into, op, at));
        if (graph[part].op == Op::Swizzle) {
            const NodeId vector = graph.arg(part, 0);
            const auto found = into.known.find(vector);
            into.known[vector] =
                with_component(graph, found != into.known.end() ? found->second : vector,
                               ir::swizzle_component(graph[part].payload, 0), value);
        }
        into.known[part] = into.scalar(value);
    }
    into.known[*angle] = at;
    into.known[group.turning] = with_component(graph, group.turning, group.component, border);
    return true;
}

NodeId Border::of_angle(Canonical &into, Op op, NodeId angle) {
    const auto sum = into.turned(op, angle);
    return sum ? *sum : graph.make(op, {angle});
}

std::vector<NodeId> Border::down_to_angles(const Graph &graph, NodeId root) {
    std::vector<NodeId> out, todo{root};
    std::unordered_set<NodeId> seen;
    while (!todo.empty() && out.size() < 200) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (!seen.insert(id).second) continue;
        out.push_back(id);
        if (graph[id].op == Op::Atan2) continue; // what it is of is no part of the sum
        for (NodeId a : graph.args(id)) todo.push_back(a);
    }
    return out;
}

bool Border::is_own(NodeId step, int component) const {
    return component == group.component &&
           std::find(group.steps.begin(), group.steps.end(), step) != group.steps.end();
}

std::optional<Near> Border::near(NodeId step, int component, int depth) {
    if (is_own(step, component)) return Near{1, half ? 0.5 : 0, sign_of(side)};
    NodeId t = part(moving, step, 0, component, depth);
    if (graph[step].op == Op::Mod) t = graph.div(t, part(moving, step, 1, component, depth));
    const auto sum = combination(forms, t, std::array{whole, little, little_angle});
    if (!sum) return {};
    const auto &c = *sum;
    // of two infinitesimals none is known to be the greater
    if (std::floor(c[0]) != c[0] || c[1] * c[2] < 0) return {};
    return Near{c[0], c[3], c[1] + c[2]};
}

NodeId Border::part(Canonical &of, NodeId step, int arg, int component, int depth) {
    return component_of(graph, of.of(graph.arg(step, arg), depth + 1), component);
}

double Border::snapped(double x) const {
    const double nearest = std::round(x), rounding = group.is_angle ? 1e-9 : 1e-13;
    return std::fabs(x - nearest) > rounding ? x : nearest;
}

double Border::floor_of(double number, double slope) const {
    const double x = snapped(number);
    return std::floor(x) == x && slope < 0 && side != Side::At ? x - 1 : std::floor(x);
}

bool Border::turns_with(NodeId step, int component, const Near &t) const {
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
    const auto written = [&](NodeId vector, int i) {
        NodeId out = component_of(graph, vector, i);
        for (NodeId before; before != out; out = component_of(graph, out, 0)) before = out;
        return out;
    };
    const NodeId own = written(graph.arg(step, 0), component),
                 turning = written(group.turning, group.component);
    return base(own) == base(turning) ||
           (graph[step].op == Op::Mod && graph[turning].op == Op::Div &&
            own == graph.arg(turning, 0) &&
            written(graph.arg(step, 1), component) == graph.arg(turning, 1));
}

bool Border::is_power_of_two(NodeId id) const {
    if (graph[id].op == Op::Splat) id = graph.arg(id, 0);
    if (!graph.is_constant(id)) return false;
    const ir::Constant &c = graph.constant_of(id);
    int exponent = 0;
    for (int i = 0; i < ir::components(c.type); ++i)
        if (std::fabs(std::frexp(c.value[static_cast<std::size_t>(i)], &exponent)) != 0.5)
            return false;
    return true;
}

NodeId Border::value(NodeId step, int component, bool moves, int depth) {
    const Op op = graph[step].op;
    if (op == Op::Atan2) return angle(step, component, moves, depth);
    const auto t = near(step, component, depth);
    if (!t || !turns_with(step, component, *t)) return unknown_of(step, component, depth);
    // What moves along has to do so in all of its uses.
    if ((t->times != 0 || t->slope != 0) && !is_own(step, component) && !seen.all_uses_of(step))
        limit.failed = true;
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

NodeId Border::angle(NodeId step, int component, bool moves, int depth) {
    if (!group.is_angle || !is_own(step, component)) return unknown_of(step, component, depth);
    const bool after = side == Side::After;
    NodeId out = graph.number(after ? -std::numbers::pi : std::numbers::pi);
    if (moves) out = graph.add(out, after ? little_angle : graph.neg(little_angle));
    return out;
}

NodeId Border::unknown_of(NodeId step, int component, int depth) {
    std::vector<NodeId> args;
    std::vector<std::uint32_t> key{static_cast<std::uint32_t>(graph[step].op)};
    bool moves = false;
    for (int i = 0; i < int(graph[step].count); ++i) {
        args.push_back(limit.under(limit.scalar(part(limit, step, i, component, depth))));
        key.push_back(args.back().index);
        moves = moves || graph.reads(args.back()).point ||
                reads_little(part(moving, step, i, component, depth));
    }
    if (!moves && graph[step].op == Op::Mod)
        if (const auto parity = parity_of(args[0], args[1])) return *parity;
    if (!moves) { // a number of its own, as rounding has it
        for (int i = 0; i < int(graph[step].count); ++i)
            args[std::size_t(i)] = limit.exact(graph.arg(step, i), component, depth + 1);
        return graph.make(graph[step].op, ir::Type::Float, args, graph[step].payload);
    }
    constexpr ir::OpSet rounds{Op::Floor, Op::Ceil, Op::Round};
    const double offset = group.is_angle ? whole_offset(step, args) : 0;
    if (group.is_angle) key[1] = args[0].index;
    const auto [it, fresh] = unknown.try_emplace(key);
    if (fresh) {
        it->second = rounds[graph[step].op] ? graph.make(Op::ToFloat, ir::Type::Float,
                                                         {graph.fresh_var(ir::Type::Int)})
                                            : graph.fresh_var(ir::Type::Float);
        const bool sloped = graph[step].op != Op::Atan2 && ranges.is_sloped(args[0]) &&
                            (graph[step].op != Op::Mod || graph.as_number(args[1]));
        if (sloped) notes.sloped.insert(it->second);
        if (rounds[graph[step].op]) {
            const NodeId d = graph.fresh_var(ir::Type::Float); // ends included, where limits are
            notes.given[d] = graph[step].op == Op::Round   ? Interval(-0.5, 0.5)
                             : graph[step].op == Op::Floor ? Interval(-1, 0)
                                                           : Interval(0, 1);
            notes.rounded[it->second] = graph.add(args[0], d);
            if (sloped) notes.sloped.insert(d);
        }
        const auto width =
            graph[step].op == Op::Mod ? graph.as_number(args[1]) : std::optional(1.0);
        if (graph[step].op == Op::Atan2)
            notes.given[it->second] = {-3.15, 3.15};
        else if (!rounds[graph[step].op] && width) // with both ends, where limits are
            notes.given[it->second] = {std::min(*width, 0.0), std::max(*width, 0.0)};
    }
    return offset != 0 ? graph.add(it->second, graph.number(offset)) : it->second;
}

double Border::whole_offset(NodeId step, std::vector<NodeId> &args) {
    const Op op = graph[step].op;
    const auto width = op == Op::Mod ? graph.as_number(args[1]) : std::optional(1.0);
    if (op == Op::Atan2 || !width || *width == 0) return 0;
    const auto terms = terms_of(forms, args[0]);
    if (!terms) return 0;
    double number = 0;
    NodeId rest = graph.number(0);
    for (const Term &term : *terms) {
        if (term.factors.empty()) {
            number = term.by / *width;
            continue;
        }
        NodeId product = graph.number(term.by);
        for (NodeId factor : term.factors) product = graph.mul(product, factor);
        rest = graph.add(rest, product);
    }
    constexpr double grain = 0x1p30; // pi may have been written with few digits
    const double near = std::round(number * grain) / grain, whole_part = std::floor(near);
    args[0] = graph.add(rest, graph.number((near - whole_part) * *width));
    return op == Op::Mod || op == Op::Fract ? 0 : whole_part;
}

std::optional<NodeId> Border::parity_of(NodeId count, NodeId two) {
    const auto sum = combination(forms, count, std::array{whole});
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

std::optional<NodeId> Border::cosine_of_half_turns(double a) {
    const double n = half_turns(a);
    if (n == 0) return {};
    const auto odd = parity_of(graph.mul(graph.number(n), whole), graph.number(2));
    if (!odd) return {};
    return graph.sub(graph.number(1), graph.mul(graph.number(2), *odd));
}

std::optional<int> Border::sign_of_count(NodeId count) {
    const auto sum = combination(forms, count, std::array{whole});
    if (!sum) return {};
    const double j = (*sum)[0], n = (*sum)[1];
    const Interval all = Interval(j) * counts.range + Interval(n);
    if (j == 0) return n > 0 ? 1 : n < 0 ? -1 : 0;
    if (all.lo > 0) return 1;
    if (all.hi < 0) return -1;
    met.thresholds.push_back(-n / j);
    return {};
}

bool Border::reads_little(NodeId id) const {
    for (NodeId var : graph.free_vars(id))
        if (var == little || var == little_angle) return true;
    return false;
}

} // namespace fathom::proof
