// Where an image lies on a solid: the natural parametrisation of the library's shapes
// (thesis, 4.6), as expressions in the shape's own Point. Images hang upright: u runs to the right
// as seen from outside, v from the bottom up, 0..1 over all of the solid. Knows shapes and their
// stated boxes; nothing of images.
//
// A uv_map is not continuous at its seams, so a displacement through it fades to the map's mean
// there, by `weight`; so it has a slope that can be stated: that of a map with slopes (gu, gv) and
// values within `span` of their mean is at most
//   gu * slope_u + gv * slope_v + span * slope_weight,
// because |grad(w * (h(u, v) - m))| <= w*gu*|grad u| + w*gv*|grad v| + |h - m|*|grad w|.
#pragma once

#include "ir/shape.h"

namespace fathom::ir {

// An image's coordinates on a shape, with the slopes that bound a texture's.
struct UvMap {
    NodeId uv;               // vec2
    NodeId weight;           // 0..1
    NodeId slope_u, slope_v; // sup of weight * |grad u|, weight * |grad v|: floats without Point
    NodeId slope_weight;     // sup of |grad weight|
    bool around_u = false,
         around_v = false; // the coordinate closes upon itself: only whole numbers of images fit
};

// Longitude and latitude about the middle of a box, the front (+z) in the image's middle: what most
// solids have.
UvMap ball_uv_map(Graph &graph, NodeId lo, NodeId hi);
// Of a solid of revolution about y like a cylinder: round it, and from the middle of its bottom
// along its outline to the middle of its top.
UvMap has_uv_map(Graph &graph, NodeId radius, NodeId height);
// Each face of a box about the origin has the whole image.
UvMap box_uv_map(Graph &graph, NodeId half);
// Of a torus in the xz plane: round the axis, and round the tube.
UvMap ring_uv_map(Graph &graph, NodeId major, NodeId minor);
// Of a plane through the origin: an image a unit of length, along two directions across the normal.
UvMap plane_uv_map(Graph &graph, NodeId normal);
// Of flat shapes (Vec2) and of what is made of them along z: an image a unit of length.
UvMap flat_uv_map(Graph &graph, Type point);
// Of what is turned about y: round it, and an image a unit of length. `radius` is how far it
// reaches.
UvMap rotated_uv_map(Graph &graph, NodeId radius);

} // namespace fathom::ir
