// The last of simplification: vertices that the planes about them do not need are taken away one by
// one, wherever they lie, until faces that are flat have few triangles (Garland and Heckbert 1997).
#pragma once

#include "mesh/polygons.h"

namespace fathom::mesh {

// The triangles that are left of a closed, oriented 2-manifold where edges are collapsed into one of
// their ends: as long as what is left is such a manifold, no triangle is a sliver that was none, none
// turns by more than 60 degrees, and the end is no farther than `tolerance`, in the mean, from the
// planes that triangles of both ends had. Locked vertices stay (by vertex); with colours a vertex stays that differs from
// one beside it by more than `paint`.
std::vector<std::array<std::uint32_t, 3>> collapsed(const Mesh &mesh,
                                                    const std::vector<std::uint8_t> &locked,
                                                    const std::vector<Point> &colors, float paint,
                                                    double tolerance);

} // namespace fathom::mesh
