// Equal expressions as one node: sums of products, vectors by component, whole numbers as what they
// are, `mix` at its ends, lengths as roots of sums, sines of counts by those of their parts.
#include "proof/border_sides.h"
#include "proof/continuity.h"
#include "proof/exact.h"

#include <array>
#include <cmath>

namespace fathom::proof {

constexpr int max_depth_of_form = 400;
constexpr std::size_t steps_of_a_form = 100; // in time

std::optional<double> Canonical::number(NodeId id) const {
    if (graph[id].op == Op::Splat) return number(graph.arg(id, 0));
    if (!graph.is_constant(id)) return {};
    const ir::Constant &c = graph.constant_of(id);
    for (int i = 1; i < ir::components(c.type); ++i)
        if (c.value[static_cast<std::size_t>(i)] != c.value[0]) return {};
    return c.value[0];
}

std::optional<NodeId> Canonical::whole(NodeId id) {
    const auto it = wholes.find(id);
    return it != wholes.end() ? it->second : wholes[id] = whole_of(id);
}

std::optional<NodeId> Canonical::whole_of(NodeId id) {
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

NodeId Canonical::as_float(NodeId id) {
    const auto it = floats.find(id);
    return it != floats.end() ? it->second : floats[id] = float_of(id);
}

NodeId Canonical::float_of(NodeId id) {
    const ir::Node node = graph[id];
    if (auto c = graph.as_number(id)) return graph.number(*c);
    if (node.op == Op::Add || node.op == Op::Sub || node.op == Op::Mul || node.op == Op::Neg) {
        std::vector<NodeId> parts;
        for (int i = 0; i < int(node.count); ++i) parts.push_back(as_float(graph.arg(id, i)));
        return graph.make(node.op, ir::Type::Float, parts);
    }
    return graph.make(Op::ToFloat, ir::Type::Float, {id});
}

NodeId Canonical::of(NodeId id, int depth) {
    if (auto it = known.find(id); it != known.end()) return it->second;
    if (depth > max_depth_of_form || known.size() > 4 * max_nodes) failed = true;
    if (border) border->work.pass(steps_of_a_form);
    failed = failed || (border && border->work.spent());
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

// A Loop stands for its first value, in whose place another expression may be. Its other values are
// read from a loop all the same.
NodeId Canonical::loop_of_others(NodeId loop, bool exactly, int depth) {
    if (const auto it = loops.find({loop, exactly}); it != loops.end()) return it->second;
    const ir::Node node = graph[loop];
    std::vector<NodeId> args;
    for (NodeId a : std::vector<NodeId>(graph.args(loop).begin(), graph.args(loop).end()))
        args.push_back(exactly ? exact_argument(a, depth + 1) : of(a, depth + 1));
    const NodeId made = graph.make(node.op, node.type, args, node.payload);
    loops[{loop, exactly}] = made;
    return made;
}

NodeId Canonical::rewritten(NodeId id, const ir::Node &node, int depth) {
    std::vector<NodeId> args;
    for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
        args.push_back(node.op == Op::LoopResult ? loop_of_others(a, false, depth + 1)
                       : border && tells_apart[node.op] && graph[a].type != ir::Type::Int
                           ? exact_argument(a, depth + 1)
                           : of(a, depth + 1));
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
        if (const auto angle = graph.as_number(args[0]); angle && border)
            if (const auto is = of_quarter_turns(node.op == Op::Cos, *angle))
                return graph.number(*is);
        if (const auto sum = turned_by_cut(node.op, args[0])) return *sum;
        args[0] = without_iterations(graph, args[0]);
        // where an angle is cut, pi may have few digits
        const double nothing = border && border->group.is_angle ? 1e-9 : 1e-15;
        if (const auto a = graph.as_number(args[0]); a && border)
            if (std::fabs(node.op == Op::Sin ? std::sin(*a) : std::cos(*a)) < nothing)
                return graph.number(0);
    }
    if (node.op == Op::Length) {
        NodeId sum = graph.number(0);
        for (int i = 0; i < ir::components(graph[args[0]].type); ++i) {
            NodeId part = scalar(component_of(graph, args[0], i));
            sum = graph.add(sum, graph.mul(part, part));
        }
        const NodeId root = graph.make(Op::Sqrt, ir::Type::Float, {noted(under(scalar(sum)), sum)});
        return noted(root, graph.make(Op::Length, ir::Type::Float, {args[0]}));
    }
    if (node.type == ir::Type::Float && (node.op == Op::Abs || node.op == Op::Sqrt))
        args[0] = under(args[0]);
    if (ir::is_vector(node.type) && node.op == Op::Abs) {
        std::vector<NodeId> parts;
        for (int i = 0; i < ir::components(node.type); ++i)
            parts.push_back(under(scalar(component_of(graph, args[0], i))));
        args[0] = graph.make(Op::Make, node.type, parts);
    }
    if (node.op == Op::MatMul && ir::is_vector(node.type))
        if (const auto product = written_product(args[0], args[1])) return *product;
    NodeId made = graph.make(node.op, node.type, args, node.payload);
    if (node.type == ir::Type::Float) return noted(scalar(made), made);
    if (node.type == ir::Type::Int) {
        auto w = whole(scalar(as_float(made)));
        return w ? *w : made;
    }
    if (ir::is_vector(node.type)) {
        std::vector<NodeId> parts;
        for (int i = 0; i < ir::components(node.type); ++i) {
            if (const auto known_one = decided_part(node, args, i)) {
                parts.push_back(scalar(*known_one));
                continue;
            }
            NodeId part = component_of(graph, made, i);
            if (graph[part].op == Op::Swizzle && graph.arg(part, 0) == made)
                return made; // not made of scalars
            parts.push_back(scalar(part));
        }
        return graph.make(Op::Make, node.type, parts);
    }
    return made;
}

NodeId Canonical::exact_argument(NodeId id, int depth) {
    const ir::Type type = graph[id].type;
    if (type != ir::Type::Float && !ir::is_vector(type)) return of(id, depth);
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(type); ++i) parts.push_back(exact(id, i, depth));
    return parts.size() == 1 ? parts[0] : graph.make(Op::Make, type, parts);
}

NodeId Canonical::exact(NodeId id, int component, int depth) {
    if (auto it = exacts.find({id, component}); it != exacts.end()) return it->second;
    const NodeId form = component_of(graph, of(id, depth + 1), component);
    if (failed || is_exact(graph, form)) return form;
    const NodeId out = as_computed(id, component, depth + 1);
    if (is_exact(graph, out)) return exacts[{id, component}] = scalar(out);
    // a K that is a number is computed with here, in another precision
    failed = failed || (border && border->counts.range.is_point());
    return exacts[{id, component}] = out;
}

NodeId Canonical::as_computed(NodeId id, int component, int depth) {
    const ir::Node node = graph[id];
    if (node.op == Op::Swizzle)
        return exact(graph.arg(id, 0), ir::swizzle_component(node.payload, component), depth);
    if (node.op == Op::Splat) return exact(graph.arg(id, 0), 0, depth);
    if (node.op == Op::Make && ir::is_vector(node.type))
        return exact(graph.arg(id, component), 0, depth);
    const bool known_there = node.count == 0 || (is_step[node.op] && node.type != ir::Type::Int);
    if (known_there || (node.type != ir::Type::Float && !ir::is_vector(node.type)))
        return component_of(graph, of(id, depth), component);
    constexpr ir::OpSet mixes{Op::Cross, Op::Normalize, Op::MatMul, Op::Dot, Op::Length};
    const bool parted = ir::info(node.op).rule == ir::TypeRule::Same && !mixes[node.op];
    std::vector<NodeId> args;
    for (NodeId a : std::vector<NodeId>(graph.args(id).begin(), graph.args(id).end()))
        args.push_back(node.op == Op::LoopResult ? loop_of_others(a, true, depth)
                       : parted ? exact(a, ir::is_vector(graph[a].type) ? component : 0, depth)
                                : exact_argument(a, depth));
    if (failed) return component_of(graph, id, component);
    if (parted) return graph.make(node.op, ir::Type::Float, args, node.payload);
    return component_of(graph, graph.make(node.op, node.type, args, node.payload), component);
}

NodeId Canonical::step(NodeId id, const ir::Node &node, int depth) {
    std::vector<NodeId> parts;
    for (int i = 0; i < ir::components(node.type); ++i)
        parts.push_back(border->value(id, i, moving, depth));
    failed = failed || border->limit.failed || border->moving.failed;
    return parts.size() == 1 ? scalar(parts[0]) : graph.make(Op::Make, node.type, parts);
}

NodeId Canonical::scalar(NodeId id) {
    Work *const work = border ? &border->work : nullptr;
    failed = failed || (work && work->spent());
    if (failed) return id;
    return border && border->by_angle ? without_rounding(graph, id, work)
                                      : in_one_form(graph, id, work);
}

NodeId Canonical::noted(NodeId form, NodeId made) {
    if (border && !failed) border->notes.keep(form, made);
    return form;
}

// What a root or a size is of, or a step of which nothing is known.
NodeId Canonical::under(NodeId id) {
    return border && (border->by_angle || border->group.is_angle) ? with_round_numbers(graph, id)
                                                                  : id;
}

std::optional<NodeId> Canonical::written_product(NodeId a, NodeId b) {
    const bool first = ir::is_matrix(graph[a].type);
    const NodeId matrix = first ? a : b, vector = first ? b : a;
    const int n = ir::components(graph[vector].type);
    std::vector<NodeId> parts;
    for (int i = 0; i < n; ++i) {
        NodeId sum = graph.number(0);
        for (int k = 0; k < n; ++k) {
            const auto factor =
                first ? entry_of(graph, matrix, i, k) : entry_of(graph, matrix, k, i);
            if (!factor) return {};
            sum = graph.add(sum, graph.mul(*factor, component_of(graph, vector, k)));
        }
        parts.push_back(scalar(sum));
    }
    return graph.make(Op::Make, graph[vector].type, parts);
}

// The sine or cosine of a K + b by those of a K and of b.
std::optional<NodeId> Canonical::turned(Op op, NodeId angle) {
    if (!border) return {};
    const auto sum = combination(border->forms, angle, std::array{border->whole});
    if (!sum || (*sum)[0] == 0) return {};
    if (const auto cosine = border->cosine_of_half_turns((*sum)[0]))
        return scalar(graph.mul(
            *cosine, graph.number(op == Op::Cos ? std::cos((*sum)[1]) : std::sin((*sum)[1]))));
    constexpr double grain = 0x1p32; // so that equal angles are one
    const NodeId part =
        graph.mul(graph.number(std::round((*sum)[0] * grain) / grain), border->whole);
    const bool negative = (*sum)[0] < 0; // sin(-a K) as -sin(a K)
    const NodeId size =
        negative ? graph.mul(graph.number(std::round(-(*sum)[0] * grain) / grain), border->whole)
                 : part;
    const NodeId positive = graph.make(Op::Sin, {size}), cosine = graph.make(Op::Cos, {size});
    const NodeId sine = negative ? graph.neg(positive) : positive;
    const NodeId s = graph.number(std::sin((*sum)[1])), c = graph.number(std::cos((*sum)[1]));
    if (op == Op::Cos) return scalar(graph.sub(graph.mul(cosine, c), graph.mul(sine, s)));
    return scalar(graph.add(graph.mul(sine, c), graph.mul(cosine, s)));
}

// Where an angle is cut, of an angle and a number by those of the two: a turn by a part of a whole
// one. Numbers of 44 bits, so that the cosine and the sine of half a right angle are one.
std::optional<NodeId> Canonical::turned_by_cut(Op op, NodeId angle) {
    if (!border || !border->group.is_angle) return {};
    const auto terms = terms_of(graph, angle);
    if (!terms) return {};
    double number = 0;
    NodeId rest = graph.number(0);
    for (const Term &term : *terms) {
        if (term.factors.empty()) {
            number = term.by;
            continue;
        }
        NodeId product = graph.number(term.by);
        for (NodeId factor : term.factors) product = graph.mul(product, factor);
        rest = graph.add(rest, product);
    }
    if (number == 0 || !(std::fabs(number) < 1e3)) return {};
    const auto rounded_to_bits = [&](double x) { // pi may have few digits
        constexpr double grain = 0x1p44, nothing = 1e-9;
        return graph.number(std::fabs(x) < nothing ? 0 : std::round(x * grain) / grain);
    };
    rest = without_iterations(graph, rest);
    const NodeId s = rounded_to_bits(std::sin(number)), c = rounded_to_bits(std::cos(number));
    const bool is_cosine = op == Op::Cos;
    if (graph.as_number(rest)) return is_cosine ? c : s;
    const NodeId sine = graph.make(Op::Sin, {rest}), cosine = graph.make(Op::Cos, {rest});
    return scalar(is_cosine ? graph.sub(graph.mul(c, cosine), graph.mul(s, sine))
                            : graph.add(graph.mul(c, sine), graph.mul(s, cosine)));
}

// What compares and chooses by K, as far as that is known.
std::optional<NodeId> Canonical::decided(const ir::Node &node, const std::vector<NodeId> &args) {
    constexpr ir::OpSet compares{Op::Less, Op::LessEqual, Op::Equal, Op::NotEqual},
        extremes{Op::Min, Op::Max};
    if (node.op == Op::Select && graph.is_constant(args[0]))
        return args[graph.constant_of(args[0]).value[0] != 0 ? 1 : 2];
    if (border && node.op == Op::Clamp)
        if (const auto is = clamped_count(args)) return is;
    if (border && node.type == ir::Type::Float) {
        if (node.op == Op::Clamp) return border->ranges.beyond(args[0], args[1], args[2]);
        if (node.op == Op::Smoothstep) {
            if (const auto end = border->ranges.faded(args[0], args[1], args[2]))
                return graph.number(*end);
            return {};
        }
    }
    if (!border || (!compares[node.op] && !extremes[node.op])) return {};
    const ir::Type type = graph[args[0]].type;
    if (type != ir::Type::Float && type != ir::Type::Int) return {};
    const auto number = [&](NodeId id) { return type == ir::Type::Int ? as_float(id) : id; };
    const auto sign = border->sign_of_count(graph.sub(number(args[0]), number(args[1])));
    if (!sign && extremes[node.op] && type == ir::Type::Float)
        return border->ranges.outermost(node.op, args[0], args[1]);
    if (!sign) return {};
    if (node.op == Op::Min) return args[*sign <= 0 ? 0 : 1];
    if (node.op == Op::Max) return args[*sign >= 0 ? 0 : 1];
    return graph.boolean(node.op == Op::Less        ? *sign < 0
                         : node.op == Op::LessEqual ? *sign <= 0
                         : node.op == Op::Equal     ? *sign == 0
                                                    : *sign != 0);
}

// min(max(x, least), most) of what differs from both by K times a number, and a number.
std::optional<NodeId> Canonical::clamped_count(const std::vector<NodeId> &args) {
    const ir::Type type = graph[args[0]].type;
    if (type != ir::Type::Float && type != ir::Type::Int) return {};
    const auto gap = [&](std::size_t limit) {
        const NodeId x = type == ir::Type::Int ? as_float(args[0]) : args[0],
                     end = type == ir::Type::Int ? as_float(args[limit]) : args[limit];
        return graph.sub(x, end);
    };
    const auto below = border->sign_of_count(gap(1)), above = border->sign_of_count(gap(2));
    if (above && *above >= 0) return args[2];
    if (below && *below <= 0) return graph.make(Op::Min, {args[1], args[2]});
    return below && above ? std::optional(args[0]) : std::nullopt;
}

// One component of what is done to each alone.
std::optional<NodeId> Canonical::decided_part(const ir::Node &node, const std::vector<NodeId> &args,
                                              int component) {
    constexpr ir::OpSet by_part{Op::Min, Op::Max, Op::Clamp, Op::Smoothstep};
    if (!border || !by_part[node.op]) return {};
    ir::Node part = node;
    part.type = ir::Type::Float;
    std::vector<NodeId> parts;
    for (NodeId arg : args) parts.push_back(component_of(graph, arg, component));
    return decided(part, parts);
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

} // namespace fathom::proof
