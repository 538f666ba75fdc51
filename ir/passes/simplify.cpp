// Cheap identities, applied as nodes are made. Each keeps the value for all finite arguments (x*0
// is 0, also for an infinite x: an infinity that survives to a product with 0 is no number that a
// scene means).
#include "ir/graph.h"

#include <cassert>
#include <cmath>
#include <vector>

namespace fathom::ir {
namespace {

// A component of a vector-valued node, where it is known without computing.
NodeId part_of(Graph &graph, NodeId vector, int i) {
    const Node &node = graph[vector];
    if (node.op == Op::Make && !is_matrix(node.type)) return graph.arg(vector, i);
    if (node.op == Op::Splat && !is_matrix(node.type)) return graph.arg(vector, 0);
    return {};
}

NodeId simple_swizzle(Graph &graph, Type type, NodeId vector, std::uint32_t mask) {
    const int size = swizzle_size(mask);
    const Node node = graph[vector];
    bool identity = type == node.type;
    for (int i = 0; i < size; ++i) identity &= swizzle_component(mask, i) == i;
    if (identity) return vector;
    if (node.op == Op::Swizzle) {
        std::vector<int> parts;
        for (int i = 0; i < size; ++i)
            parts.push_back(swizzle_component(node.payload, swizzle_component(mask, i)));
        return graph.swizzle(graph.arg(vector, 0), parts);
    }
    if (node.op != Op::Make && node.op != Op::Splat) return {};
    std::vector<NodeId> parts;
    for (int i = 0; i < size; ++i)
        parts.push_back(part_of(graph, vector, swizzle_component(mask, i)));
    return size == 1 ? parts.front() : graph.make(Op::Make, type, parts);
}

// (v.x, v.y, v.z) is v; (s, s, s) is a splat.
NodeId simple_make(Graph &graph, Type type, std::span<const NodeId> args) {
    if (args.size() == 1) return args.front();
    if (is_matrix(type)) return {};
    bool equal = true, ordered = true;
    NodeId vector;
    std::vector<int> parts;
    for (NodeId arg : args) {
        equal &= arg == args.front();
        const Node &node = graph[arg];
        ordered &= node.op == Op::Swizzle && swizzle_size(node.payload) == 1;
        if (!ordered) continue;
        const NodeId from = graph.arg(arg, 0);
        ordered &= !vector || from == vector;
        vector = from;
        parts.push_back(swizzle_component(node.payload, 0));
    }
    if (ordered) return graph.swizzle(vector, parts);
    if (equal && !graph.is_constant(args.front()))
        return graph.make(Op::Splat, type, {args.front()});
    return {};
}

// sin(u)/u is 1 at 0, and not 0/0: u is taken no nearer to it than sin(u)/u is 1 in single
// precision.
NodeId sine_ratio(Graph &graph, NodeId u) {
    const Type type = graph[u].type;
    const NodeId least = graph.splat(graph.number(1e-3), type);
    if (graph[u].op == Op::Max && (graph.arg(u, 0) == least || graph.arg(u, 1) == least)) return {};
    const NodeId off = graph.make(Op::Max, type, {graph.make(Op::Abs, type, {u}), least});
    return graph.make(Op::Div, type, {graph.make(Op::Sin, type, {off}), off});
}

bool exponents_of(const Graph &graph, NodeId sum, Op exponential, std::vector<NodeId> &out) {
    if (graph[sum].op == exponential)
        out.push_back(graph.arg(sum, 0));
    else if (graph[sum].op != Op::Add)
        return false;
    else
        return exponents_of(graph, graph.arg(sum, 0), exponential, out) &&
               exponents_of(graph, graph.arg(sum, 1), exponential, out);
    return true;
}
// log(exp(a) + exp(b) + …), two by two as max(a, b) + log(1 + exp(-|a - b|)): the exponentials of
// numbers beyond 88 have no place in single precision.
NodeId log_of_exponentials(Graph &graph, Op log, Type type, NodeId sum) {
    const Op exponential = log == Op::Log ? Op::Exp : Op::Exp2;
    std::vector<NodeId> terms;
    if (!exponents_of(graph, sum, exponential, terms)) return {};
    NodeId all = terms.front();
    const NodeId one = graph.splat(graph.number(1), type);
    for (std::size_t i = 1; i < terms.size(); ++i) {
        const NodeId way = graph.make(Op::Abs, type, {graph.sub(all, terms[i])});
        const NodeId rest = graph.make(exponential, type, {graph.neg(way)});
        all = graph.add(graph.make(Op::Max, type, {all, terms[i]}),
                        graph.make(log, type, {graph.add(one, rest)}));
    }
    return all;
}

bool is_identity(const Constant &matrix) {
    const int n = side(matrix.type);
    for (int c = 0; c < n; ++c)
        for (int r = 0; r < n; ++r)
            if (matrix.value[static_cast<std::size_t>(c * n + r)] != (c == r ? 1 : 0)) return false;
    return true;
}

NodeId simple_hit(Graph &graph, Op op, std::span<const NodeId> args) {
    const NodeId hit = args.front();
    const Op made = graph[hit].op;
    if (op == Op::HitDistance) {
        if (made == Op::MakeHit) return graph.arg(hit, 0);
        if (made == Op::HitWith) return graph.arg(hit, 1);
        if (made == Op::FillPaint) return graph.make(Op::HitDistance, {graph.arg(hit, 0)});
        return {};
    }
    if (op == Op::HitPaint || op == Op::HitPoint || op == Op::HitExtra) {
        const int field = op == Op::HitPaint ? 1 : op == Op::HitPoint ? 2 : 3;
        if (made == Op::MakeHit) return graph.arg(hit, field);
        if (made == Op::HitWith) return graph.make(op, {graph.arg(hit, 0)});
        return {};
    }
    if (op == Op::HitWith) {
        if (made == Op::MakeHit)
            return graph.make(Op::MakeHit,
                              {args[1], graph.arg(hit, 1), graph.arg(hit, 2), graph.arg(hit, 3)});
        if (made == Op::HitWith) return graph.make(Op::HitWith, {graph.arg(hit, 0), args[1]});
        return {};
    }
    assert(op == Op::FillPaint);
    if (made != Op::MakeHit) return {};
    const std::optional<double> paint = graph.as_number(graph.arg(hit, 1));
    if (!paint) return {};
    if (*paint >= 0) return hit;
    return graph.make(Op::MakeHit, {graph.arg(hit, 0), args[1], args[2], args[3]});
}

} // namespace

NodeId Graph::simplified(Op op, Type type, std::span<const NodeId> args, std::uint32_t payload) {
    const auto is = [&](std::size_t i, double value) { return is_all(args[i], value); };
    const auto op_of = [&](std::size_t i) { return nodes_[args[i]].op; };
    const auto zero = [&] { return constant({type, {}}); };
    const auto all_ones = [&] {
        Constant ones{type, {}};
        for (int i = 0; i < components(type); ++i) ones.value[static_cast<std::size_t>(i)] = 1;
        return constant(ones);
    };
    const bool whole = type == Type::Int; // where saturation forbids re-association
    switch (op) {
    case Op::Neg: return op_of(0) == Op::Neg && !whole ? arg(args[0], 0) : NodeId{};
    case Op::Add:
        if (is(0, 0)) return args[1];
        if (is(1, 0)) return args[0];
        if (op_of(1) == Op::Neg && !whole) return make(Op::Sub, type, {args[0], arg(args[1], 0)});
        if (op_of(0) == Op::Neg && !whole) return make(Op::Sub, type, {args[1], arg(args[0], 0)});
        return {};
    case Op::Sub:
        if (is(1, 0)) return args[0];
        if (args[0] == args[1]) return zero();
        if (is(0, 0)) return make(Op::Neg, type, {args[1]});
        if (op_of(1) == Op::Neg && !whole) return make(Op::Add, type, {args[0], arg(args[1], 0)});
        return {};
    case Op::Mul:
        if (is(0, 1) || is(1, 0)) return args[1];
        if (is(1, 1) || is(0, 0)) return args[0];
        if (is(0, -1)) return make(Op::Neg, type, {args[1]});
        if (is(1, -1)) return make(Op::Neg, type, {args[0]});
        return {};
    case Op::Div:
        if (is(1, 1)) return args[0];
        if (op_of(0) == Op::Sin && arg(args[0], 0) == args[1]) return sine_ratio(*this, args[1]);
        if (is(1, -1)) return make(Op::Neg, type, {args[0]});
        if (!whole && is_constant(args[1]) && !is_constant(args[0])) {
            // By a power of two exactly, else division stays: it rounds once.
            Constant inverse = constant_of(args[1]);
            bool exact = true;
            for (int i = 0; i < components(type); ++i) {
                double &value = inverse.value[static_cast<std::size_t>(i)];
                int exponent = 0;
                exact &= std::frexp(value, &exponent) == 0.5 && exponent > -100 && exponent < 100;
                value = 1 / value;
            }
            if (exact) return make(Op::Mul, type, {args[0], constant(inverse)});
        }
        return {};
    case Op::Pow:
        if (is(1, 1)) return args[0];
        if (is(1, 0)) return all_ones();
        if (is(1, 2)) return make(Op::Mul, type, {args[0], args[0]});
        if (is(1, 3)) {
            const NodeId x = args[0];
            const NodeId square = make(Op::Mul, type, {x, x});
            return make(Op::Mul, type, {square, x});
        }
        return {};
    case Op::Min:
    case Op::Max: return args[0] == args[1] ? args[0] : NodeId{};
    case Op::Abs:
        if (op_of(0) == Op::Abs) return args[0];
        if (op_of(0) == Op::Neg && !whole) return make(Op::Abs, type, {arg(args[0], 0)});
        return {};
    case Op::Mix:
        if (is(2, 0)) return args[0];
        return is(2, 1) ? args[1] : NodeId{};
    case Op::Floor:
    case Op::Ceil:
    case Op::Trunc:
    case Op::Round: {
        const bool whole_already = op_of(0) == Op::Floor || op_of(0) == Op::Ceil ||
                                   op_of(0) == Op::Trunc || op_of(0) == Op::Round;
        return whole || whole_already ? args[0] : NodeId{};
    }
    case Op::And:
        if (is(0, 1) || is(1, 0)) return args[1];
        return is(1, 1) || is(0, 0) || args[0] == args[1] ? args[0] : NodeId{};
    case Op::Or:
        if (is(0, 0) || is(1, 1)) return args[1];
        return is(1, 0) || is(0, 1) || args[0] == args[1] ? args[0] : NodeId{};
    case Op::Not: return op_of(0) == Op::Not ? arg(args[0], 0) : NodeId{};
    case Op::Select:
        if (is(0, 1)) return args[1];
        if (is(0, 0)) return args[2];
        if (type == Type::Bool && is(1, 1) && is(2, 0)) return args[0];
        if (type == Type::Bool && is(1, 0) && is(2, 1)) return make(Op::Not, {args[0]});
        return args[1] == args[2] ? args[1] : NodeId{};
    case Op::ToFloat:
    case Op::ToInt: return nodes_[args[0]].type == type ? args[0] : NodeId{};
    case Op::Splat: return nodes_[args[0]].type == type ? args[0] : NodeId{};
    case Op::Make: return simple_make(*this, type, args);
    case Op::Swizzle: return simple_swizzle(*this, type, args[0], payload);
    case Op::Column:
        return op_of(0) == Op::Make ? arg(args[0], static_cast<int>(payload)) : NodeId{};
    case Op::MatMul:
        if (is_constant(args[0]) && is_matrix(nodes_[args[0]].type) &&
            is_identity(constant_of(args[0])))
            return args[1];
        if (is_constant(args[1]) && is_matrix(nodes_[args[1]].type) &&
            is_identity(constant_of(args[1])))
            return args[0];
        return {};
    case Op::Transpose: return op_of(0) == Op::Transpose ? arg(args[0], 0) : NodeId{};
    case Op::FoldResult: return payload == 0 ? args[0] : NodeId{};
    case Op::Union:
    case Op::Intersection:
    case Op::NearestHit:
    case Op::FarthestHit: return args.size() == 1 ? args[0] : NodeId{};
    case Op::Blend: return args.size() == 3 ? args[2] : NodeId{};
    case Op::HitDistance:
    case Op::HitPaint:
    case Op::HitPoint:
    case Op::HitExtra:
    case Op::HitWith:
    case Op::FillPaint: return simple_hit(*this, op, args);

    case Op::Log:
    case Op::Log2: return log_of_exponentials(*this, op, type, args[0]);

    case Op::Length:
        return type == nodes_[args[0]].type ? make(Op::Abs, type, {args[0]}) : NodeId{};

    case Op::Const:
    case Op::Point:
    case Op::Normal:
    case Op::Direction:
    case Op::Time:
    case Op::Param:
    case Op::Var:
    case Op::Mod:
    case Op::Step:
    case Op::Atan2:
    case Op::Sign:
    case Op::Fract:
    case Op::Sqrt:
    case Op::InverseSqrt:
    case Op::Exp:
    case Op::Exp2:
    case Op::Sin:
    case Op::Cos:
    case Op::Tan:
    case Op::Asin:
    case Op::Acos:
    case Op::Atan:
    case Op::Sinh:
    case Op::Cosh:
    case Op::Tanh:
    case Op::Clamp:
    case Op::Smoothstep:
    case Op::Dot:
    case Op::Cross:
    case Op::Normalize:
    case Op::Less:
    case Op::LessEqual:
    case Op::Equal:
    case Op::NotEqual:
    case Op::TableRead:
    case Op::Hash:
    case Op::Perlin:
    case Op::Simplex:
    case Op::ValueNoise:
    case Op::Worley:
    case Op::SpotNoise:
    case Op::Image:
    case Op::Grid:
    case Op::Call:
    case Op::Fold:
    case Op::Cached:
    case Op::MakeHit: return {};
    }
    return {};
}

} // namespace fathom::ir
