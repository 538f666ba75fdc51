// Convex regions as expressions: signed distance, nearest point, and the way out. And the distance
// to a box of bounds.
#include "ir/lower/lowering.h"

namespace fathom::ir {

// |d+| + min(max d, 0), for d the distances along perpendicular directions: exact outside, at least
// exact's sign inside. The same form joins an extrusion's sides and caps, and a region with the
// solid in it.
NodeId joined_distance(Graph &graph, std::span<const NodeId> d) {
    NodeId maximum = d.front();
    std::vector<NodeId> outside;
    for (std::size_t i = 0; i < d.size(); ++i) {
        outside.push_back(graph.make(Op::Max, {d[i], graph.number(0)}));
        if (i > 0) maximum = graph.make(Op::Max, {maximum, d[i]});
    }
    const NodeId out = graph.make(
        Op::Length, {graph.make(Op::Make, vector_type(static_cast<int>(d.size())), outside)});
    return graph.add(out, graph.make(Op::Min, {maximum, graph.number(0)}));
}

namespace {

// The part of p across the tube's axis.
NodeId across(Graph &graph, NodeId p, int axis) {
    return graph.swizzle(p, std::array{(axis + 1) % 3, (axis + 2) % 3});
}

// p with its part across the axis replaced.
NodeId with_across(Graph &graph, NodeId p, int axis, NodeId flat) {
    std::array<NodeId, 3> parts;
    parts[static_cast<std::size_t>(axis)] = graph.component(p, axis);
    parts[static_cast<std::size_t>((axis + 1) % 3)] = graph.component(flat, 0);
    parts[static_cast<std::size_t>((axis + 2) % 3)] = graph.component(flat, 1);
    return graph.make(Op::Make, Type::Vec3, parts);
}

// v shortened to length r where it is longer: v * min(1, r/|v|), total at 0.
NodeId shortened(Graph &graph, NodeId v, NodeId r) {
    const NodeId length = graph.make(Op::Max, {graph.make(Op::Length, {v}), graph.number(1e-20)});
    return graph.mul(v, graph.make(Op::Min, {graph.number(1), graph.div(r, length)}));
}

// v lengthened to length r where it is shorter; 0 goes along the first axis.
NodeId lengthened(Graph &graph, NodeId v, NodeId r) {
    const NodeId length = graph.make(Op::Length, {v});
    const NodeId some = graph.make(Op::Less, {graph.number(1e-20), length});
    std::array<double, 3> first{1, 0, 0};
    const std::size_t n = static_cast<std::size_t>(components(graph.type(v)));
    const NodeId direction = graph.make(
        Op::Select, {some, graph.make(Op::Normalize, {v}), graph.vec(std::span(first).first(n))});
    return graph.mul(direction, graph.make(Op::Max, {length, r}));
}

NodeId convex_distance(Graph &graph, const Region &region, NodeId p) {
    switch (region.kind) {
    case RegionKind::Everywhere: return graph.number(-nowhere);
    case RegionKind::Ball:
        return graph.sub(graph.make(Op::Length, {graph.sub(p, region.center)}), region.size);
    case RegionKind::Tube:
        return graph.sub(graph.make(Op::Length, {across(graph, p, region.axis)}), region.size);
    case RegionKind::Box: {
        const NodeId d = graph.sub(graph.make(Op::Abs, {graph.sub(p, region.center)}),
                                   graph.mul(region.size, graph.number(0.5)));
        return joined_distance(
            graph, std::array{graph.component(d, 0), graph.component(d, 1), graph.component(d, 2)});
    }
    }
    return {};
}

} // namespace

NodeId region_distance(Graph &graph, const Region &region, NodeId p) {
    NodeId distance = convex_distance(graph, region, p);
    for (const Region &less : region.less)
        distance = graph.make(Op::Max, {distance, graph.neg(region_distance(graph, less, p))});
    return distance;
}

NodeId region_nearest(Graph &graph, const Region &region, NodeId p) {
    switch (region.kind) {
    case RegionKind::Everywhere: return p;
    case RegionKind::Ball:
        return graph.add(region.center, shortened(graph, graph.sub(p, region.center), region.size));
    case RegionKind::Tube:
        return with_across(graph, p, region.axis,
                           shortened(graph, across(graph, p, region.axis), region.size));
    case RegionKind::Box: {
        const NodeId half = graph.mul(region.size, graph.number(0.5));
        return graph.make(Op::Clamp,
                          {p, graph.sub(region.center, half), graph.add(region.center, half)});
    }
    }
    return {};
}

// From p inside a hole straight away from its middle (or, of a tube, its axis) to its border, and
// how far out p is: 0 in the middle, 1 at the border and beyond.
WayOut region_way_out(Graph &graph, const Region &hole, NodeId p) {
    const NodeId one = graph.number(1), some = graph.number(1e-20);
    switch (hole.kind) {
    case RegionKind::Everywhere: return {p, one}; // there is none; nothing of the solid is left
    case RegionKind::Ball:
    case RegionKind::Tube: {
        const bool tube = hole.kind == RegionKind::Tube;
        const NodeId v = tube ? across(graph, p, hole.axis) : graph.sub(p, hole.center);
        const NodeId out = lengthened(graph, v, hole.size);
        const NodeId part =
            graph.div(graph.make(Op::Length, {v}), graph.make(Op::Max, {hole.size, some}));
        return {tube ? with_across(graph, p, hole.axis, out) : graph.add(hole.center, out),
                graph.make(Op::Min, {part, one})};
    }
    case RegionKind::Box: {
        const NodeId half = graph.make(
            Op::Max, {graph.mul(hole.size, graph.number(0.5)), graph.splat(some, Type::Vec3)});
        const NodeId v = graph.sub(p, hole.center);
        const NodeId d = graph.make(Op::Abs, {graph.div(v, half)});
        const NodeId part = graph.make(
            Op::Max, {graph.make(Op::Max, {graph.component(d, 0), graph.component(d, 1)}),
                      graph.component(d, 2)});
        const NodeId inside = graph.make(Op::Min, {part, one});
        const NodeId face = graph.make(
            Op::Make, Type::Vec3, {graph.component(half, 0), graph.number(0), graph.number(0)});
        const NodeId out =
            graph.make(Op::Select, {graph.make(Op::Less, {graph.number(1e-6), inside}),
                                    graph.div(v, graph.make(Op::Max, {inside, some})), face});
        return {graph.add(hole.center, out), inside};
    }
    }
    return {p, one};
}

// Two points of the hole's border that lie opposite to each other; of a tube, at p's height.
std::array<NodeId, 2> region_opposites(Graph &graph, const Region &hole, NodeId p) {
    const NodeId zero = graph.number(0);
    switch (hole.kind) {
    case RegionKind::Everywhere: break;
    case RegionKind::Ball: {
        const NodeId by = graph.make(Op::Make, Type::Vec3, {hole.size, zero, zero});
        return {graph.add(hole.center, by), graph.sub(hole.center, by)};
    }
    case RegionKind::Tube: {
        const NodeId by = graph.make(Op::Make, Type::Vec2, {hole.size, zero});
        return {with_across(graph, p, hole.axis, by),
                with_across(graph, p, hole.axis, graph.neg(by))};
    }
    case RegionKind::Box: {
        const NodeId half = graph.mul(graph.component(hole.size, 0), graph.number(0.5));
        const NodeId by = graph.make(Op::Make, Type::Vec3, {half, zero, zero});
        return {graph.add(hole.center, by), graph.sub(hole.center, by)};
    }
    }
    return {p, p};
}

// A ball less a tube through it: what is above the ring where both meet is evaluated at the ring's
// height, so that the way out of the tube ends inside the ball.
NodeId region_between_caps(Graph &graph, const Region &region, NodeId q) {
    if (region.kind != RegionKind::Ball) return q;
    for (const Region &less : region.less) {
        if (less.kind != RegionKind::Tube) continue;
        const NodeId rest =
            graph.sub(graph.mul(region.size, region.size), graph.mul(less.size, less.size));
        const NodeId height = graph.make(Op::Sqrt, {graph.make(Op::Max, {rest, graph.number(0)})});
        const NodeId middle = graph.component(region.center, less.axis);
        std::array<NodeId, 3> parts;
        for (int i = 0; i < 3; ++i) parts[static_cast<std::size_t>(i)] = graph.component(q, i);
        NodeId &along = parts[static_cast<std::size_t>(less.axis)];
        along =
            graph.make(Op::Clamp, {along, graph.sub(middle, height), graph.add(middle, height)});
        q = graph.make(Op::Make, Type::Vec3, parts);
    }
    return q;
}

NodeId box_distance(Graph &graph, const Box &box, NodeId p) {
    std::vector<NodeId> d;
    for (int i = 0; i < components(graph.type(p)); ++i) {
        const double lo = box.lo[static_cast<std::size_t>(i)],
                     hi = box.hi[static_cast<std::size_t>(i)];
        const NodeId x = graph.component(p, i);
        if (std::isfinite(lo) && std::isfinite(hi))
            d.push_back(graph.sub(graph.make(Op::Abs, {graph.sub(x, graph.number((lo + hi) / 2))}),
                                  graph.number((hi - lo) / 2)));
        else if (std::isfinite(lo))
            d.push_back(graph.sub(graph.number(lo), x));
        else if (std::isfinite(hi))
            d.push_back(graph.sub(x, graph.number(hi)));
    }
    return d.empty() ? graph.number(-nowhere) : joined_distance(graph, d);
}

NodeId cylinder_distance(Graph &graph, const Box &box, int axis, double radius, NodeId p) {
    const double lo = box.lo[static_cast<std::size_t>(axis)],
                 hi = box.hi[static_cast<std::size_t>(axis)];
    const NodeId side =
        graph.sub(graph.make(Op::Length, {across(graph, p, axis)}), graph.number(radius));
    const NodeId along = graph.sub(graph.component(p, axis), graph.number((lo + hi) / 2));
    return joined_distance(graph, std::array{side, graph.sub(graph.make(Op::Abs, {along}),
                                                             graph.number((hi - lo) / 2))});
}

} // namespace fathom::ir
