// Shapes of kind Map: for each MapKind the one place that says how q and the factor follow from p
// and the kind's numbers (shape.h: the result is factor * f(q)). The checker builds with these, the
// analysis relies on them, the lowering only reads args[0] and args[1]. Numbers are expressions
// without Point, constant or of params and time.
//
// Every function hands back a Shape to refine (origin, assumed) and to give to Shapes::add. Axes
// are 0, 1, 2 for x, y, z. Transforms act on the object: the shape moves by +by, turns
// counter-clockwise seen from the axis' tip.
#pragma once

#include "ir/shape.h"

namespace fathom::ir {

Shape translated(Graph &graph, ShapeId child, NodeId by); // by: vec3, or vec2 (flat)
Shape rotated(Graph &graph, ShapeId child,
              NodeId matrix); // mat3, or mat2 (flat): an isometry, det -1 is welcome
Shape scaled(Graph &graph, ShapeId child,
             NodeId by); // vec3 or vec2, no component 0; negative ones mirror
Shape folded(Graph &graph, ShapeId child,
             NodeId q); // q: continuous, 1-Lipschitz in Point; see below for some
Shape revolved(Graph &graph, ShapeId flat_child,
               NodeId offset); // about y: q = (length(p.xz) - offset, p.y)

// The cross-section at height h along the axis is turned by rate*h: q = p turned by -rate*(p along
// axis).
Shape twisted(Graph &graph, ShapeId child, NodeId rate, int axis);

// The stretch along `axis` curves towards +`towards` on both sides of the origin: q is p turned by
// rate*(p along axis) in the (towards, axis) plane. axis != towards.
Shape bent(Graph &graph, ShapeId child, NodeId rate, int axis, int towards);
// The axis that a twist or bend turns points about.
inline int turning_axis(const Shape &shape) {
    return shape.map == MapKind::Bend ? 3 - shape.axis - shape.towards : int(shape.axis);
}

// The cross-section is scaled by c(h), 1 at h = from and `ratio` at h = to, linear between,
// constant beyond: c * f(p / c across the axis, p along it). ratio >= 0; c is kept above
// min_taper.
Shape tapered(Graph &graph, ShapeId child, NodeId ratio, NodeId from, NodeId to, int axis);
constexpr double min_taper = 1e-4;
NodeId taper_factor(Graph &graph, NodeId height, NodeId ratio, NodeId from, NodeId to); // c(h)

// Any q in Point (vec3 -> vec3; flat: vec2 -> vec2). `lipschitz` and `estimate` go into the Shape's
// fields afterwards.
Shape distorted(Graph &graph, ShapeId child, NodeId q);

// A point, for `folded`: p with |p.axis|.
NodeId mirror_point(Graph &graph, NodeId p, int axis);
// sign(x)*|x|^v by component (thesis 6.3), as x*|x|^(v - 1), for `distorted`.
NodeId hyperize_point(Graph &graph, NodeId p, NodeId v);

// Matrices. Angles in radians; axes of any length but 0 (a zero axis gives the identity).
NodeId rotation(Graph &graph, NodeId axis, NodeId angle); // mat3, Rodrigues
NodeId rotation2(Graph &graph, NodeId angle);             // mat2, counter-clockwise
NodeId rotation_euler(Graph &graph, NodeId angles);       // mat3: about x, then y, then z
NodeId rotation_between(Graph &graph, NodeId from,
                        NodeId to); // mat3: the shortest turn that takes from's direction to to's

// The other two axes, in the cyclic order that makes (first, second, axis) right-handed: of Y they
// are Z and X.
constexpr int first_across(int axis) { return (axis + 1) % 3; }
constexpr int second_across(int axis) { return (axis + 2) % 3; }

} // namespace fathom::ir
