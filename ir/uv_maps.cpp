// The uv_maps of uv_maps.h, and the slopes that they state. In the comments x' are coordinates
// divided by half sizes.
#include "ir/uv_maps.h"

#include <cmath>

namespace fathom::ir {
namespace {

constexpr double pi = 3.14159265358979323846;

// Short forms for what the uv_maps are made of.
struct Pen {
    Graph &g;
    NodeId n(double x) const { return g.number(x); }
    NodeId of(Op op, NodeId a) const { return g.make(op, {a}); }
    NodeId of(Op op, NodeId a, NodeId b) const { return g.make(op, {a, b}); }
    NodeId minimum(NodeId a, NodeId b) const { return of(Op::Min, a, b); }
    NodeId maximum(NodeId a, NodeId b) const { return of(Op::Max, a, b); }
    NodeId saturated(NodeId a) const { return g.make(Op::Clamp, {a, n(0), n(1)}); }
    NodeId within(NodeId a, NodeId half) const { return g.make(Op::Clamp, {a, g.neg(half), half}); }
    NodeId choose(NodeId c, NodeId a, NodeId b) const { return g.make(Op::Select, {c, a, b}); }
    NodeId pair(NodeId a, NodeId b) const { return g.make(Op::Make, Type::Vec2, {a, b}); }
    NodeId length(NodeId a, NodeId b) const { return of(Op::Length, pair(a, b)); }
    NodeId minimum_of(NodeId vector) const {
        return minimum(g.component(vector, 0),
                       minimum(g.component(vector, 1), g.component(vector, 2)));
    }
    // The angle round y from +z towards +x, in turns from 0 at the back: |grad| = 1/(2 pi rho).
    NodeId round_y(NodeId x, NodeId z) const {
        return g.add(n(0.5), g.mul(of(Op::Atan2, x, z), n(0.5 / pi)));
    }
};

} // namespace

// q = (p - middle)/half. weight = min(4 rho', 4 |q| - 1) in 0..1: nothing at the poles' axis and
// about the middle. With weight <= 4 rho', weight * |grad u| <= 4/(2 pi); where weight > 0, |q| >
// 1/4, and weight/(pi |q|) is most at |q| = 1/2: 2/pi = 4/(2 pi). All per |grad q| <= 1/least half.
UvMap ball_uv_map(Graph &graph, NodeId lo, NodeId hi) {
    const Pen k{graph};
    const NodeId half = graph.mul(graph.sub(hi, lo), k.n(0.5)),
                 middle = graph.mul(graph.add(lo, hi), k.n(0.5));
    const NodeId q = graph.div(graph.sub(graph.point(), middle), half);
    const NodeId x = graph.component(q, 0), y = graph.component(q, 1), z = graph.component(q, 2);
    const NodeId size = k.of(Op::Length, q), around = k.length(x, z), minimum = k.minimum_of(half);
    UvMap uv_map;
    uv_map.uv =
        k.pair(k.round_y(x, z), graph.mul(k.of(Op::Atan2, around, graph.neg(y)), k.n(1 / pi)));
    uv_map.weight = k.saturated(
        k.minimum(graph.mul(around, k.n(4)), graph.sub(graph.mul(size, k.n(4)), k.n(1))));
    uv_map.slope_u = uv_map.slope_v = graph.div(k.n(2 / pi), minimum);
    uv_map.slope_weight = graph.div(k.n(4), minimum);
    uv_map.around_u = true;
    return uv_map;
}

// A point belongs to the cap or the side that it lies less deep below. At the depth t the cap's
// disc has shrunk to R - t, so that the regions meet along lines of 45 degrees; stretched by R/(R -
// t) both reach the edge there: the outline's length s goes on continuously. |grad s| <= sqrt(2)
// R/(R - t). weight = min(4 rho/R, 2 - 4 t/m), m = min(R, h/2): weight * |grad s| is most at t =
// m/4: 4/3 sqrt(2).
UvMap has_uv_map(Graph &graph, NodeId radius, NodeId height) {
    const Pen k{graph};
    const NodeId p = graph.point(), x = graph.component(p, 0), y = graph.component(p, 1),
                 z = graph.component(p, 2);
    const NodeId half = graph.mul(height, k.n(0.5)), rho = k.length(x, z);
    const NodeId below_side = graph.sub(radius, rho), below_cap = graph.sub(half, k.of(Op::Abs, y));
    const auto stretched = [&](NodeId value, NodeId size, NodeId depth) {
        const NodeId left =
            k.maximum(graph.sub(size, k.maximum(depth, k.n(0))), graph.mul(size, k.n(0.5)));
        return k.within(graph.mul(value, graph.div(size, left)), size);
    };
    const NodeId on_cap = stretched(rho, radius, below_cap),
                 on_side = stretched(y, half, below_side);
    const NodeId total = graph.add(graph.mul(radius, k.n(2)), height);
    const NodeId cap = k.choose(k.of(Op::Less, y, k.n(0)), on_cap, graph.sub(total, on_cap));
    const NodeId side = graph.add(graph.add(radius, half), on_side);
    const NodeId s = k.choose(k.of(Op::Less, below_cap, below_side), cap, side);
    const NodeId minimum = k.minimum(radius, half), depth = k.minimum(below_side, below_cap);
    UvMap uv_map;
    uv_map.uv = k.pair(k.round_y(x, z), graph.div(s, total));
    uv_map.weight =
        k.saturated(k.minimum(graph.mul(rho, graph.div(k.n(4), radius)),
                              graph.sub(k.n(2), graph.mul(depth, graph.div(k.n(4), minimum)))));
    uv_map.slope_u = graph.div(k.n(2 / pi), radius);
    uv_map.slope_v = graph.div(k.n(4.0 / 3 * std::sqrt(2)), total);
    uv_map.slope_weight = graph.div(k.n(4), minimum);
    uv_map.around_u = true;
    return uv_map;
}

// As the can's: the face that the point lies least deep below, its other coordinates stretched by
// h/(h - t). They are 0..1 over the face, and the weight falls to 0 along a band of m/4 before the
// edges, where another face has another part of the image. With |grad stretched| <= sqrt(2) h/(h -
// t), t <= m/2: |grad weight| <= 4/m * 2 sqrt(2).
UvMap box_uv_map(Graph &graph, NodeId half) {
    const Pen k{graph};
    const NodeId p = graph.point();
    std::array<NodeId, 3> at, h, t;
    for (int i = 0; i < 3; ++i) {
        const auto j = static_cast<std::size_t>(i);
        at[j] = graph.component(p, i), h[j] = graph.component(half, i);
        t[j] = graph.sub(h[j], k.of(Op::Abs, at[j]));
    }
    const NodeId minimum = k.minimum(h[0], k.minimum(h[1], h[2]));
    const auto on_face = [&](std::size_t i, std::size_t face) { // -1..1
        const NodeId left =
            k.maximum(graph.sub(h[i], k.maximum(t[face], k.n(0))), graph.mul(h[i], k.n(0.5)));
        return k.within(graph.div(at[i], left), k.n(1));
    };
    const auto turned = [&](NodeId value, std::size_t face) { // seen from the other side
        return graph.mul(value, k.choose(k.of(Op::Less, at[face], k.n(0)), k.n(-1), k.n(1)));
    };
    const auto image = [&](NodeId right, NodeId up) {
        return k.pair(graph.add(k.n(0.5), graph.mul(right, k.n(0.5))),
                      graph.add(k.n(0.5), graph.mul(up, k.n(0.5))));
    };
    const auto band = [&](std::size_t i, std::size_t face) { // the way to the edge
        return graph.mul(h[i], graph.sub(k.n(1), k.of(Op::Abs, on_face(i, face))));
    };
    const std::array<NodeId, 3> uv{image(graph.neg(turned(on_face(2, 0), 0)), on_face(1, 0)),
                                   image(on_face(0, 1), graph.neg(turned(on_face(2, 1), 1))),
                                   image(turned(on_face(0, 2), 2), on_face(1, 2))};
    const std::array<NodeId, 3> edge{k.minimum(band(1, 0), band(2, 0)),
                                     k.minimum(band(0, 1), band(2, 1)),
                                     k.minimum(band(0, 2), band(1, 2))};
    const NodeId x_face = k.of(Op::And, k.of(Op::Less, t[0], t[1]), k.of(Op::Less, t[0], t[2]));
    const NodeId y_face = k.of(Op::Less, t[1], t[2]);
    const NodeId depth = k.minimum(t[0], k.minimum(t[1], t[2]));
    const NodeId over = graph.div(k.n(4), minimum);
    UvMap uv_map;
    uv_map.uv = k.choose(x_face, uv[0], k.choose(y_face, uv[1], uv[2]));
    const NodeId to_edge = k.choose(x_face, edge[0], k.choose(y_face, edge[1], edge[2]));
    uv_map.weight =
        k.saturated(k.minimum(graph.mul(to_edge, over), graph.sub(k.n(2), graph.mul(depth, over))));
    uv_map.slope_u = uv_map.slope_v = graph.div(k.n(2.0 / 3 * std::sqrt(2)), minimum);
    uv_map.slope_weight = graph.div(k.n(8 * std::sqrt(2)), minimum);
    return uv_map;
}

// weight = min(4 rho/R, 4 |q|/r - 1), q the point in the tube's section: nothing on the axis and on
// the centre line. weight/(2 pi |q|) is most at |q| = r/2: 1/(pi r).
UvMap ring_uv_map(Graph &graph, NodeId major, NodeId minor) {
    const Pen k{graph};
    const NodeId p = graph.point(), x = graph.component(p, 0), y = graph.component(p, 1),
                 z = graph.component(p, 2);
    const NodeId rho = k.length(x, z), out = graph.sub(rho, major);
    UvMap uv_map;
    // From the inside below to the outside, over the top and back: the image's middle lies on the
    // outer rim.
    uv_map.uv = k.pair(k.round_y(x, z),
                       graph.add(k.n(0.5), graph.mul(k.of(Op::Atan2, y, out), k.n(0.5 / pi))));
    uv_map.weight = k.saturated(
        k.minimum(graph.mul(rho, graph.div(k.n(4), major)),
                  graph.sub(graph.mul(k.length(out, y), graph.div(k.n(4), minor)), k.n(1))));
    uv_map.slope_u = graph.div(k.n(2 / pi), major);
    uv_map.slope_v = graph.div(k.n(1 / pi), minor);
    uv_map.slope_weight = graph.div(k.n(4), k.minimum(major, minor));
    uv_map.around_u = uv_map.around_v = true;
    return uv_map;
}

// Right and up on the plane as seen against the normal n. Up is what is left of y; of a plane that
// lies flat, of -z, so that a floor is read from the front.
UvMap plane_uv_map(Graph &graph, NodeId normal) {
    const Pen k{graph};
    const NodeId n = k.of(Op::Normalize, normal), p = graph.point();
    const NodeId lies = k.of(Op::Less, k.n(0.99), k.of(Op::Abs, graph.component(n, 1)));
    const NodeId hint = graph.make(Op::Select, {lies, graph.vec3(0, 0, -1), graph.vec3(0, 1, 0)});
    const NodeId right = k.of(Op::Normalize, k.of(Op::Cross, hint, n)),
                 up = k.of(Op::Cross, n, right);
    UvMap uv_map;
    uv_map.uv = k.pair(k.of(Op::Dot, p, right), k.of(Op::Dot, p, up));
    uv_map.weight = uv_map.slope_u = uv_map.slope_v = k.n(1);
    uv_map.slope_weight = k.n(0);
    return uv_map;
}

UvMap flat_uv_map(Graph &graph, Type point) {
    const Pen k{graph};
    const NodeId p = graph.point(point);
    UvMap uv_map;
    uv_map.uv = k.pair(graph.component(p, 0), graph.component(p, 1));
    uv_map.weight = uv_map.slope_u = uv_map.slope_v = k.n(1);
    uv_map.slope_weight = k.n(0);
    return uv_map;
}

// weight = 4 rho/R in 0..1, as the ball's.
UvMap rotated_uv_map(Graph &graph, NodeId radius) {
    const Pen k{graph};
    const NodeId p = graph.point(), x = graph.component(p, 0), z = graph.component(p, 2);
    const NodeId over = graph.div(k.n(4), radius);
    UvMap uv_map;
    uv_map.uv = k.pair(k.round_y(x, z), graph.component(p, 1));
    uv_map.weight = k.saturated(graph.mul(k.length(x, z), over));
    uv_map.slope_u = graph.div(k.n(2 / pi), radius);
    uv_map.slope_v = k.n(1);
    uv_map.slope_weight = over;
    uv_map.around_u = true;
    return uv_map;
}

} // namespace fathom::ir
