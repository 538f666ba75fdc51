// Signs of determinants of points that are floats, without rounding: in double precision where its
// error cannot matter, else by sums of doubles that do not overlap (Shewchuk 1997). And what is
// decided by them: whether two triangles of a mesh cross.
#pragma once

#include "mesh/field.h"

#include <optional>
#include <span>

namespace fathom::mesh {

// 1: d lies above the plane of a, b and c, from where they go counterclockwise; -1: below; 0: in it.
int side_of(const Point &a, const Point &b, const Point &c, const Point &d);
// The same of a, b and c as seen down an axis: 1 where they go counterclockwise about it.
int turn_of(const Point &a, const Point &b, const Point &c, std::size_t axis);
// Whether a triangle has no area.
bool is_flat(const Point &a, const Point &b, const Point &c);

// About where two triangles, which have areas, have more in common than the vertices or the edge that
// they share; none where they have not.
std::optional<Point> crossing_of(std::span<const Point> points,
                                 const std::array<std::uint32_t, 3> &s,
                                 const std::array<std::uint32_t, 3> &t);

} // namespace fathom::mesh
