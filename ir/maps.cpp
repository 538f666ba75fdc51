// The point at which each kind of Map evaluates its child, as expressions.
#include "ir/maps.h"

#include <cassert>

namespace fathom::ir {
namespace {

Shape mapped(Graph &graph, MapKind kind, ShapeId child, NodeId q, std::vector<NodeId> numbers,
             NodeId factor = {}) {
    Shape shape;
    shape.kind = ShapeKind::Map;
    shape.map = kind;
    shape.dims = graph.type(q) == Type::Vec2 ? 2 : 3;
    shape.children = {child};
    shape.args = {q, factor ? factor : graph.number(1)};
    shape.args.insert(shape.args.end(), numbers.begin(), numbers.end());
    return shape;
}

// p with the plane of the axes (u, v) turned by -angle: the point of the object that a turn by
// `angle` brings to p.
NodeId turned_back(Graph &graph, NodeId p, int u, int v, NodeId angle) {
    const NodeId c = graph.make(Op::Cos, {angle}), s = graph.make(Op::Sin, {angle});
    const NodeId pu = graph.component(p, u), pv = graph.component(p, v);
    std::array<NodeId, 3> q;
    q[static_cast<std::size_t>(3 - u - v)] = graph.component(p, 3 - u - v);
    q[static_cast<std::size_t>(u)] = graph.add(graph.mul(c, pu), graph.mul(s, pv));
    q[static_cast<std::size_t>(v)] = graph.sub(graph.mul(c, pv), graph.mul(s, pu));
    return graph.make(Op::Make, Type::Vec3, q);
}

NodeId matrix3(Graph &graph, std::array<NodeId, 9> m) { // by columns
    std::array<NodeId, 3> columns;
    for (std::size_t c = 0; c < 3; ++c)
        columns[c] = graph.make(Op::Make, Type::Vec3, {m[3 * c], m[3 * c + 1], m[3 * c + 2]});
    return graph.make(Op::Make, Type::Mat3, columns);
}

NodeId axis_vector(Graph &graph, int axis) {
    return graph.vec3(axis == 0 ? 1 : 0, axis == 1 ? 1 : 0, axis == 2 ? 1 : 0);
}

} // namespace

Shape translated(Graph &graph, ShapeId child, NodeId by) {
    return mapped(graph, MapKind::Translate, child, graph.sub(graph.point(graph.type(by)), by),
                  {by});
}

Shape rotated(Graph &graph, ShapeId child, NodeId matrix) {
    const Type type = vector_type(side(graph.type(matrix)));
    // A row vector times R is transpose(R) times the column.
    const NodeId q = graph.make(Op::MatMul, type, {graph.point(type), matrix});
    return mapped(graph, MapKind::Rotate, child, q, {matrix});
}

Shape scaled(Graph &graph, ShapeId child, NodeId by) {
    const Type type = graph.type(by);
    const NodeId sizes = graph.make(Op::Abs, {by});
    NodeId factor = graph.component(sizes, 0);
    for (int i = 1; i < components(type); ++i)
        factor = graph.make(Op::Min, {factor, graph.component(sizes, i)});
    return mapped(graph, MapKind::Scale, child, graph.div(graph.point(type), by), {by}, factor);
}

Shape folded(Graph &graph, ShapeId child, NodeId q) {
    return mapped(graph, MapKind::MirrorFold, child, q, {});
}

Shape revolved(Graph &graph, ShapeId flat_child, NodeId offset) {
    const NodeId p = graph.point();
    const NodeId radius = graph.make(Op::Length, {graph.swizzle(p, std::array{0, 2})});
    const NodeId q =
        graph.make(Op::Make, Type::Vec2, {graph.sub(radius, offset), graph.component(p, 1)});
    Shape shape = mapped(graph, MapKind::Revolve, flat_child, q, {offset});
    shape.dims = 3;
    return shape;
}

Shape twisted(Graph &graph, ShapeId child, NodeId rate, int axis) {
    const NodeId p = graph.point();
    const NodeId angle = graph.mul(rate, graph.component(p, axis));
    const NodeId q = turned_back(graph, p, first_across(axis), second_across(axis), angle);
    Shape shape = mapped(graph, MapKind::Twist, child, q, {rate});
    shape.axis = static_cast<std::uint8_t>(axis);
    return shape;
}

Shape bent(Graph &graph, ShapeId child, NodeId rate, int axis, int towards) {
    assert(axis != towards);
    const NodeId p = graph.point();
    const NodeId angle = graph.mul(rate, graph.component(p, axis));
    // The axis' tip leans towards `towards`: a turn from axis to towards; so (u, v) = (axis,
    // towards).
    const NodeId q = turned_back(graph, p, axis, towards, angle);
    Shape shape = mapped(graph, MapKind::Bend, child, q, {rate});
    shape.axis = static_cast<std::uint8_t>(axis);
    shape.towards = static_cast<std::uint8_t>(towards);
    return shape;
}

NodeId taper_factor(Graph &graph, NodeId height, NodeId ratio, NodeId from, NodeId to) {
    const NodeId zero = graph.number(0), one = graph.number(1);
    const NodeId t =
        graph.make(Op::Clamp, {graph.div(graph.sub(height, from), graph.sub(to, from)), zero, one});
    return graph.make(Op::Max, {graph.make(Op::Mix, {one, ratio, t}), graph.number(min_taper)});
}

Shape tapered(Graph &graph, ShapeId child, NodeId ratio, NodeId from, NodeId to, int axis) {
    const NodeId p = graph.point();
    const NodeId c = taper_factor(graph, graph.component(p, axis), ratio, from, to);
    std::array<NodeId, 3> q;
    for (int i = 0; i < 3; ++i) {
        const NodeId part = graph.component(p, i);
        q[static_cast<std::size_t>(i)] = i == axis ? part : graph.div(part, c);
    }
    Shape shape = mapped(graph, MapKind::Taper, child, graph.make(Op::Make, Type::Vec3, q),
                         {ratio, from, to}, c);
    shape.axis = static_cast<std::uint8_t>(axis);
    return shape;
}

Shape distorted(Graph &graph, ShapeId child, NodeId q) {
    return mapped(graph, MapKind::Distort, child, q, {});
}

NodeId mirror_point(Graph &graph, NodeId p, int axis) {
    std::array<NodeId, 3> parts;
    const int n = components(graph.type(p));
    for (int i = 0; i < n; ++i) {
        const NodeId part = graph.component(p, i);
        parts[static_cast<std::size_t>(i)] = i == axis ? graph.make(Op::Abs, {part}) : part;
    }
    return graph.make(Op::Make, graph.type(p), std::span(parts).first(static_cast<std::size_t>(n)));
}

NodeId hyperize_point(Graph &graph, NodeId p, NodeId v) {
    const NodeId power = graph.splat(graph.sub(v, graph.number(1)), graph.type(p));
    return graph.mul(p, graph.make(Op::Pow, {graph.make(Op::Abs, {p}), power}));
}

// Rodrigues: R = cos I + (1 - cos) a a^T + sin [a]x, for the unit axis a.
NodeId rotation(Graph &graph, NodeId axis, NodeId angle) {
    const NodeId a = graph.make(Op::Normalize, {axis});
    // A zero axis normalises to 0, which leaves cos I: so the cosine is made 1 there.
    const NodeId some = graph.make(Op::Less, {graph.number(0), graph.make(Op::Dot, {a, a})});
    const NodeId c = graph.make(Op::Select, {some, graph.make(Op::Cos, {angle}), graph.number(1)});
    const NodeId s = graph.make(Op::Sin, {angle});
    const NodeId t = graph.sub(graph.number(1), c);
    std::array<NodeId, 9> m;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row) {
            const NodeId outer =
                graph.mul(t, graph.mul(graph.component(a, row), graph.component(a, column)));
            NodeId value;
            if (row == column) {
                value = graph.add(c, outer);
            } else {
                const NodeId turn = graph.mul(s, graph.component(a, 3 - row - column));
                // [a]x has -a_k above the cyclic diagonal: (row, column) = (0,1): -z, (1,2): -x,
                // (2,0): -y
                value = column == (row + 1) % 3 ? graph.sub(outer, turn) : graph.add(outer, turn);
            }
            m[static_cast<std::size_t>(3 * column + row)] = value;
        }
    return matrix3(graph, m);
}

NodeId rotation2(Graph &graph, NodeId angle) {
    const NodeId c = graph.make(Op::Cos, {angle}), s = graph.make(Op::Sin, {angle});
    return graph.make(Op::Make, Type::Mat2,
                      {graph.make(Op::Make, Type::Vec2, {c, s}),
                       graph.make(Op::Make, Type::Vec2, {graph.neg(s), c})});
}

NodeId rotation_euler(Graph &graph, NodeId angles) {
    NodeId result;
    for (int axis = 0; axis < 3; ++axis) {
        const NodeId turn =
            rotation(graph, axis_vector(graph, axis), graph.component(angles, axis));
        result = result ? graph.make(Op::MatMul, Type::Mat3, {turn, result}) : turn;
    }
    return result;
}

// For unit a and b: the two reflections I - 2 u u^T, first in the plane across a + b, then in that
// across b, give the turn from a to b. Where a = -b any u across a does; it is taken from the axis
// that a is least along.
NodeId rotation_between(Graph &graph, NodeId from, NodeId to) {
    const NodeId a = graph.make(Op::Normalize, {from}), b = graph.make(Op::Normalize, {to});
    const NodeId x = graph.make(Op::Abs, {graph.component(a, 0)});
    const NodeId y = graph.make(Op::Abs, {graph.component(a, 1)});
    const NodeId z = graph.make(Op::Abs, {graph.component(a, 2)});
    const NodeId min_x =
        graph.make(Op::And, {graph.make(Op::LessEqual, {x, y}), graph.make(Op::LessEqual, {x, z})});
    const NodeId other = graph.make(
        Op::Select, {min_x, axis_vector(graph, 0),
                     graph.make(Op::Select, {graph.make(Op::LessEqual, {y, z}),
                                             axis_vector(graph, 1), axis_vector(graph, 2)})});
    const NodeId sum = graph.add(a, b);
    const NodeId near =
        graph.make(Op::Less, {graph.number(1e-12), graph.make(Op::Dot, {sum, sum})});
    const NodeId u = graph.make(
        Op::Normalize, {graph.make(Op::Select, {near, sum, graph.make(Op::Cross, {a, other})})});
    // a = -b: reflecting across u leaves a, then across b takes it to -a = b.
    const auto reflected = [&](NodeId v) {
        std::array<NodeId, 9> m;
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r)
                m[static_cast<std::size_t>(3 * c + r)] =
                    graph.sub(graph.number(r == c ? 1 : 0),
                              graph.mul(graph.number(2),
                                        graph.mul(graph.component(v, r), graph.component(v, c))));
        return matrix3(graph, m);
    };
    return graph.make(Op::MatMul, Type::Mat3, {reflected(b), reflected(u)});
}

} // namespace fathom::ir
