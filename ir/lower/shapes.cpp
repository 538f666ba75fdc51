// What each kind of shape computes, in the readings.
#include "ir/lower/lowering.h"
#include "ir/maps.h"
#include "ir/passes/cost.h"

#include <cassert>

namespace fathom::ir {

// -- values by reading

NodeId Lowering::minimum(Reading reading, std::span<const NodeId> values) {
    return reading == Reading::Hit ? graph_.make(Op::NearestHit, Type::Hit, values)
                                   : graph_.make(Op::Union, Type::Float, values);
}
NodeId Lowering::maximum(Reading reading, std::span<const NodeId> values) {
    if (reading == Reading::Hit && parts_.stride > 0)
        return farthest_part(graph_.make(Op::FarthestHit, Type::Hit, values), values.front());
    return reading == Reading::Hit ? graph_.make(Op::FarthestHit, Type::Hit, values)
                                   : graph_.make(Op::Intersection, Type::Float, values);
}
NodeId Lowering::distance_of(Reading reading, NodeId value) {
    return reading == Reading::Hit ? graph_.make(Op::HitDistance, {value}) : value;
}
NodeId Lowering::at_distance(Reading reading, NodeId value, NodeId distance) {
    return reading == Reading::Hit ? graph_.make(Op::HitWith, {value, distance}) : distance;
}
NodeId Lowering::negated(Reading reading, NodeId value) {
    return at_distance(reading, value, graph_.neg(distance_of(reading, value)));
}
NodeId Lowering::unpainted(NodeId distance) {
    return graph_.make(Op::MakeHit, {distance, graph_.integer(-1), graph_.vec3(0, 0, 0),
                                     graph_.constant({Type::Vec4, {}})});
}
NodeId Lowering::far_away(Reading reading, double distance) {
    const NodeId far = graph_.number(distance);
    return reading == Reading::Hit ? unpainted(far) : far;
}

// -- the readings

// Whether marched and hit go on to the children: min, max and negation, and what maps points
// without lengthening. For such a map q with q(result) inside the child's surface, |f(q(p))| <=
// dist(q(p), child) <= dist(p, result).
bool Lowering::passes_through(ShapeId id) const {
    const Shape &s = shape(id);
    switch (s.kind) {
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Empty:
    case ShapeKind::Contract: return true;
    case ShapeKind::Instances: return !shapes_.instance_tables[s.payload].smooth;
    case ShapeKind::Library: return !shapes_.libraries[s.payload].has_claims;
    case ShapeKind::Map:
        switch (s.map) {
        case MapKind::Translate:
        case MapKind::Rotate:
        case MapKind::MirrorFold:
        case MapKind::Revolve: return true;
        case MapKind::Scale: { // uniform: then the factor undoes the map's contraction
            if (!graph_.is_constant(s.args[2])) return graph_[s.args[2]].op == Op::Splat;
            const Constant &by = graph_.constant_of(s.args[2]);
            for (int i = 1; i < components(by.type); ++i)
                if (std::abs(by.value[static_cast<std::size_t>(i)]) != std::abs(by.value[0]))
                    return false;
            return true;
        }
        case MapKind::Twist:
        case MapKind::Bend:
        case MapKind::Taper:
        case MapKind::Distort: return false;
        }
        return false;
    case ShapeKind::Leaf:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Within: return false;
    }
    return false;
}

NodeId Lowering::answer(Reading reading, ShapeId id, Where frame) {
    const NodeId value = unmarked(reading, id, frame);
    return reading == Reading::Hit ? marked(id, value) : value;
}

NodeId Lowering::unmarked(Reading reading, ShapeId id, Where frame) {
    if (reading == Reading::Raw && fact(id).local) {
        const Box &box = fact(id).bounds;
        const NodeId q =
            graph_.make(Op::Clamp, {frame.p, graph_.vec3(box.lo[0], box.lo[1], box.lo[2]),
                                    graph_.vec3(box.hi[0], box.hi[1], box.hi[2])});
        return joined_distance(graph_, std::array{box_distance(graph_, box, frame.p),
                                                  structural(reading, id, at(frame, q))});
    }
    if (reading == Reading::Raw) return structural(reading, id, frame);
    if (reading == Reading::SafeRadius) return safe_radius(id, frame);
    if (reading == Reading::Hit && !paint_[id.index])
        return unpainted(expression_of(Reading::Marched, id, frame));
    if (passes_through(id)) return guarded(reading, id, frame, structural(reading, id, frame));
    const bool distance = reading == Reading::Marched || reading == Reading::Shaded;
    if (distance && shape(id).kind == ShapeKind::Within)
        return guarded(reading, id, frame, within(reading, id, frame));
    if (reading == Reading::Hit)
        return graph_.make(Op::HitWith,
                           {colored(id, frame), expression_of(Reading::Marched, id, frame)});
    if (reading == Reading::Shaded && is_stretched(id))
        return guarded(reading, id, frame, stretched(id, frame));
    if (reading == Reading::Shaded)
        return guarded(reading, id, frame, shaded(id, expression_of(Reading::Raw, id, frame)));
    if (has_cells(id)) return marched_in_box(id, frame);
    if (shape(id).kind == ShapeKind::Displace)
        return guarded(reading, id, frame, displaced(reading, id, frame));
    return guarded(reading, id, frame, divided(id, expression_of(Reading::Raw, id, frame)));
}

// The range shell: a displaced solid lies where f <= A, the most that it moves outward; further
// out the smooth field, less A, is the better bound, with its own slope. Inside, where f - a < 0,
// f - A is lower still: so signs agree. The same with the first terms of a sum, and the most that
// the others can add. The greatest of all of these is the marched field; what is left of a dear sum
// is evaluated only where it can be greater than what is known already. The safe radius is more
// where all of the field is evaluated: sqrt(2 f/M), with no rounding of f worth counting
// (lipschitz.md, 4).
NodeId Lowering::displaced(Reading reading, ShapeId id, Where frame) {
    const ShapeFact &known = fact(id);
    const bool reaches = reading == Reading::SafeRadius;
    NodeId raw = expression_of(Reading::Raw, id, frame);
    const auto whole_of = [&] {
        return has_cells(id) ? divided_by_cells(id, id, raw, frame.p) : divided(id, raw);
    };
    if (!std::isfinite(known.outward)) return whole_of();
    const ShapeId child = shape(id).children.front();
    const NodeId base = expression_of(Reading::Raw, child, frame), amount = shape(id).args.front();
    struct Known {
        NodeId best;    // a lower bound of the distance
        NodeId field;   // the base less the terms so far
        double minimum; // of the other terms
        double cost;    // of the terms so far
    };
    std::vector<Known> steps{
        {divided(child, graph_.sub(base, graph_.number(known.outward))), base, -known.inward, 0}};
    const auto slope_with = [&](double slope) { // of the base and so much of the sum
        return graph_.add({fact(child).lipschitz, graph_.number(slope)});
    };
    const std::size_t nested = known.partial.empty() ? 0 : known.partial.size() - 1;
    if (nested > 0) raw = graph_.sub(base, read(known.partial.back().terms, frame));
    const NodeId whole = whole_of();
    for (std::size_t i = 0; i < nested; ++i) {
        const PartialSum &partial = known.partial[i];
        const NodeId field = graph_.sub(base, read(partial.terms, frame));
        const NodeId bound = graph_.div(
            {graph_.sub(field, graph_.number(partial.maximum)), slope_with(partial.slope)});
        steps.push_back({graph_.make(Op::Max, {steps.back().best, bound}), field, partial.minimum,
                         cost_of(graph_, partial.terms)});
    }
    NodeId result = graph_.make(Op::Max, {whole, steps.back().best});
    if (reaches) {
        const NodeId bent =
            graph_.make(Op::Sqrt, {graph_.mul(raw, graph_.number(2 / known.curvature))});
        result = graph_.make(Op::Make, Type::Vec2, {result, graph_.make(Op::Max, {result, bent})});
    }
    // The field is at most f - least, which is divided by the next bound at least.
    for (std::size_t i = steps.size(); i-- > 0;) {
        const Known &step = steps[i];
        if (!std::isfinite(step.minimum) || cost_of(graph_, amount) - step.cost < guard_cost)
            continue;
        const NodeId highest = graph_.sub(step.field, graph_.number(step.minimum));
        const NodeId reach = i < nested ? graph_.div(highest, slope_with(known.partial[i].slope))
                                        : divided(id, highest);
        result = graph_.make(Op::Select, {graph_.make(Op::LessEqual, {reach, step.best}),
                                          reaches ? both(step.best) : step.best, result});
    }
    return result;
}

// raw / (L * times). A bound below 1 lengthens the step, as it may.
NodeId Lowering::divided(ShapeId id, NodeId raw, double times) {
    const ShapeFact &known = fact(id);
    if (known.lipschitz && !graph_.is_constant(known.lipschitz)) {
        const NodeId bound = graph_.mul(known.lipschitz, graph_.number(times));
        return graph_.div(raw, graph_.make(Op::Max, {bound, graph_.number(1e-6)}));
    }
    const double bound = known.lipschitz ? *graph_.as_number(known.lipschitz) : known.lipschitz_sup;
    // No proof, or a field that is constant: as it is. The first has been reported.
    if (!std::isfinite(bound) || bound <= 0) return raw;
    return graph_.div(raw, graph_.number(bound * times));
}

NodeId Lowering::guarded(Reading reading, ShapeId id, Where frame, NodeId value) {
    if (!fact(id).guard) return value;
    return at_distance(reading, value,
                       graph_.make(Op::Max, {distance_of(reading, value), guard(id, frame)}));
}

NodeId Lowering::guard(ShapeId id, Where frame) {
    const ShapeFact &known = fact(id);
    if (!std::isfinite(known.round)) return box_distance(graph_, known.bounds, frame.p);
    return cylinder_distance(graph_, known.bounds, turning_axis(shape(id)), known.round, frame.p);
}

NodeId Lowering::structural(Reading reading, ShapeId id, Where frame) {
    const Shape &s = shape(id);
    const auto child = [&](std::size_t i) { return expression_of(reading, s.children[i], frame); };
    const auto children = [&] {
        std::vector<NodeId> values;
        for (ShapeId one : s.children) values.push_back(expression_of(reading, one, frame));
        return values;
    };
    switch (s.kind) {
    case ShapeKind::Empty: return far_away(reading);
    case ShapeKind::Union:
        return s.children.empty() ? far_away(reading) : minimum(reading, children());
    case ShapeKind::Intersection:
        return s.children.empty() ? far_away(reading) : maximum(reading, children());
    case ShapeKind::Complement: {
        // -blend(-f, -g) is an intersection: so its surface is the farthest operand's
        // (semantics.md, 22).
        const ShapeId inner = s.children.front();
        if (reading == Reading::Hit && shape(inner).kind == ShapeKind::Blend) {
            std::vector<NodeId> hits;
            for (ShapeId operand : shape(inner).children)
                hits.push_back(negated(reading, expression_of(reading, operand, frame)));
            const NodeId farthest = maximum(reading, hits);
            return at_distance(reading, farthest,
                               graph_.neg(expression_of(Reading::Marched, inner, frame)));
        }
        return negated(reading, child(0));
    }
    case ShapeKind::Xor: {
        NodeId result = child(0);
        for (std::size_t i = 1; i < s.children.size(); ++i) {
            const std::array both{result, child(i)};
            result = maximum(reading, std::array{minimum(reading, both),
                                                 negated(reading, maximum(reading, both))});
        }
        return result;
    }
    case ShapeKind::Map: {
        const NodeId q = read(s.args[0], frame), factor = read(s.args[1], frame);
        const NodeId value = expression_of(reading, s.children.front(), at(frame, q));
        return at_distance(reading, value, graph_.mul(factor, distance_of(reading, value)));
    }
    case ShapeKind::Extrude: {
        const NodeId flat = graph_.swizzle(frame.p, std::array{0, 1});
        const NodeId value = expression_of(reading, s.children.front(), at(frame, flat));
        const NodeId half = graph_.mul({read(s.args[0], frame), graph_.number(0.5)});
        const NodeId cap = graph_.sub(graph_.make(Op::Abs, {graph_.component(frame.p, 2)}), half);
        return at_distance(reading, value,
                           joined_distance(graph_, std::array{distance_of(reading, value), cap}));
    }
    case ShapeKind::Repeat: return repeated(reading, id, frame);
    case ShapeKind::Instances: return many(reading, id, frame);
    case ShapeKind::Within: return within(reading, id, frame);
    case ShapeKind::Paint:
    case ShapeKind::Repaint: return reading == Reading::Hit ? painted(id, frame) : child(0);
    case ShapeKind::Mixed: return reading == Reading::Hit ? mixed(id, frame) : child(0);
    case ShapeKind::Library:
    case ShapeKind::Contract: return child(0);
    case ShapeKind::Leaf:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace: assert(reading == Reading::Raw); return raw_only(id, frame);
    }
    return {};
}

NodeId Lowering::raw_only(ShapeId id, Where frame) {
    const Shape &s = shape(id);
    const auto child = [&](std::size_t i) {
        return expression_of(Reading::Raw, s.children[i], frame);
    };
    const auto arg = [&](std::size_t i) { return read(s.args[i], frame); };
    if (s.kind == ShapeKind::Leaf) return arg(0);
    if (s.kind == ShapeKind::Blend) return blend(s, frame);
    if (s.kind == ShapeKind::Seam) return seam(s, frame);
    if (s.kind == ShapeKind::PseudoNorm) return pseudonorm(s, frame);
    if (s.kind == ShapeKind::Lerp) return graph_.make(Op::Mix, {child(1), child(0), arg(0)});
    if (s.kind == ShapeKind::Shell)
        return graph_.sub(
            {graph_.make(Op::Abs, {child(0)}), graph_.mul({arg(0), graph_.number(0.5)})});
    assert(s.kind == ShapeKind::Offset || s.kind == ShapeKind::Displace);
    return graph_.sub({child(0), arg(0)});
}

NodeId Lowering::blend(const Shape &s, Where frame) {
    std::vector<NodeId> args;
    for (NodeId number : s.args) {
        const NodeId value = read(number, frame);
        args.push_back(graph_.type(value) == Type::Int
                           ? graph_.make(Op::ToFloat, Type::Float, {value})
                           : value);
    }
    args.resize(2, graph_.number(1)); // a profile without a count
    for (ShapeId child : s.children) args.push_back(expression_of(Reading::Raw, child, frame));
    return graph_.make(Op::Blend, Type::Float, args, s.payload);
}

// The formulas of blends.h.
NodeId Lowering::seam(const Shape &s, Where frame) {
    Graph &g = graph_;
    const NodeId a = expression_of(Reading::Raw, s.children[0], frame),
                 b = expression_of(Reading::Raw, s.children[1], frame);
    const NodeId r = read(s.args[0], frame), half = g.number(0.5);
    const NodeId depth = s.args.size() > 1 ? read(s.args[1], frame) : r;
    const auto away = [&] { return g.make(Op::Abs, {b}); };
    switch (static_cast<SeamKind>(s.payload)) {
    case SeamKind::Pipe:
        return g.sub(g.make(Op::Length, {g.make(Op::Make, Type::Vec2, {a, b})}), r);
    case SeamKind::Engrave:
        return g.make(Op::Intersection, {a, g.mul(g.sub({g.add(a, r), away()}), half)});
    case SeamKind::Groove:
        return g.make(Op::Intersection,
                      {a, g.make(Op::Union, {g.add(a, depth), g.sub({g.mul(r, half), away()})})});
    case SeamKind::Tongue:
        return g.make(Op::Union, {a, g.make(Op::Intersection,
                                            {g.sub(a, depth), g.sub({away(), g.mul(r, half)})})});
    }
    return {};
}

NodeId Lowering::pseudonorm(const Shape &s, Where frame) {
    Graph &g = graph_;
    const NodeId zero = g.number(0), one = g.number(1);
    const NodeId p = g.make(Op::Max, {read(s.args[0], frame), one});
    const NodeId a = expression_of(Reading::Raw, s.children[0], frame),
                 b = expression_of(Reading::Raw, s.children[1], frame);
    const NodeId u = g.make(Op::Max, {g.sub(one, a), zero}),
                 v = g.make(Op::Max, {g.sub(one, b), zero});
    const NodeId larger = g.make(Op::Max, {u, v});
    const NodeId ratio =
        g.div({g.make(Op::Min, {u, v}), g.make(Op::Max, {larger, g.number(1e-9)})});
    const NodeId norm =
        g.mul(larger, g.make(Op::Pow, {g.add(one, g.make(Op::Pow, {ratio, p})), g.div(one, p)}));
    return g.sub(g.make(Op::Max, {one, g.make(Op::Union, {a, b})}), norm);
}

// -- within (semantics.md, 11; lipschitz.md, 6)

namespace {
template <class F> Region map_region(const Region &region, F read) {
    Region result = region;
    if (region.center) result.center = read(region.center);
    if (region.size) result.size = read(region.size);
    for (Region &less : result.less) less = map_region(less, read);
    return result;
}
} // namespace

Region Lowering::region_of(ShapeId id, Where frame) {
    return map_region(shapes_.regions[shape(id).payload],
                      [&](NodeId number) { return read(number, frame); });
}

Where Lowering::inside(ShapeId id, Where frame) {
    const Region region = region_of(id, frame);
    NodeId q = region_between_caps(graph_, region, region_nearest(graph_, region, point3(frame.p)));
    for (const Region &less : region.less) q = region_way_out(graph_, less, q).point;
    return point_of(frame, q);
}
Where Lowering::point_of(Where frame, NodeId p) {
    return at(frame, graph_.type(frame.p) == Type::Vec2 ? graph_.swizzle(p, std::array{0, 1}) : p);
}

// The field is evaluated where its bound L holds: at q, the point of the region R nearest to p;
// inside of what R leaves out, at the way out of it. With g the value there: in R max(g, sd_R);
// outside sqrt(|p-q|^2 + max(g, 0)^2). Both are |(max(sd_R,0), max(g,0))| + min(max(sd_R, g), 0).
// What is left out cuts with -sd. What is shaded has |p-q| + max(g, 0) outside, the way by q: a
// region that ends near a surface is then no nearer to what lies before it than the surface is.
NodeId Lowering::within(Reading reading, ShapeId id, Where frame) {
    Graph &g = graph_;
    const Region region = region_of(id, frame);
    const NodeId p = point3(frame.p);
    const ShapeId child = shape(id).children.front();
    NodeId field = expression_of(Reading::Raw, child, inside(id, frame));
    const NodeId nearest = region_nearest(g, region, p);
    NodeId q = region_between_caps(g, region, nearest);
    if (reading == Reading::Marched || reading == Reading::Shaded) {
        // Ways round a hole are longer than straight ones. In a hole, less the way out.
        if (reading == Reading::Shaded)
            field = shaded(child, field);
        else
            field = has_cells(id) ? divided_by_cells(id, child, field, q)
                                  : divided(child, field, fact(id).detour);
        NodeId out = q;
        for (const Region &less : region.less) out = region_way_out(g, less, out).point;
        if (out != nearest) field = g.sub(field, g.make(Op::Length, {g.sub(nearest, out)}));
    } else {
        // Continuous, as what uses the value needs: from the border's value at the way out to the
        // mean of two opposite ones in the middle. No step has to be safe by it.
        for (const Region &less : region.less) {
            NodeId mean = g.number(0);
            for (NodeId side : region_opposites(g, less, q))
                mean = g.add(mean, expression_of(Reading::Raw, child, point_of(frame, side)));
            const WayOut out = region_way_out(g, less, q);
            field = g.make(Op::Mix, {g.mul(mean, g.number(0.5)), field, out.part});
            q = out.point;
        }
    }
    Region convex = region;
    convex.less.clear();
    NodeId distance = field;
    if (region.kind != RegionKind::Everywhere) {
        const NodeId wall = region_distance(g, convex, p), zero = g.number(0);
        if (reading == Reading::Shaded)
            distance = g.add(g.add(g.make(Op::Max, {wall, zero}), g.make(Op::Max, {field, zero})),
                             g.make(Op::Min, {g.make(Op::Max, {wall, field}), zero}));
        else
            distance = joined_distance(g, std::array{wall, field});
    }
    for (const Region &less : region.less)
        distance = g.make(Op::Max, {distance, g.neg(region_distance(g, less, p))});
    return distance;
}

} // namespace fathom::ir
