// What is checked of a mesh that was simplified, and of pieces of it (docs/meshes.md, 11).
#pragma once

#include "mesh/grid.h"
#include "mesh/parallel.h"
#include "mesh/polygons.h"

namespace fathom::mesh {

// Places, about, where a mesh is no closed, oriented 2-manifold, or has a triangle without an area.
std::vector<Point> flaws_of(const Mesh &mesh);

// Of two pieces of a surface with the same vertices, though some are in no triangle: whether the
// second is an oriented 2-manifold with the border of the first, no more fans of triangles about a
// vertex, and as many pieces and handles.
bool is_like(const Mesh &fine, const Mesh &mesh);

// Whether triangles have more in common than the vertices and edges that they share.
bool crosses_itself(const Mesh &mesh);
// Pairs of triangles of which that is so, with one of those asked.
std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossings_with(const Mesh &mesh, const std::vector<std::uint32_t> &asked, unsigned threads,
               Progress &progress);
// Pairs of triangles of different owners of which that is so.
std::vector<std::pair<std::uint32_t, std::uint32_t>>
crossings_between(const Mesh &mesh, const std::vector<std::uint32_t> &owner, unsigned threads,
                  Progress &progress);

// The triangles of the fine mesh with a point that is not shown to be within the tolerance of the other.
std::vector<std::uint32_t> strays_of(const Mesh &fine, const Mesh &mesh, double tolerance,
                                     unsigned threads, Progress &progress);
// Whether some point of the fine piece is not shown to be within the tolerance of the other.
bool strays(const Mesh &fine, const Mesh &mesh, double tolerance);

} // namespace fathom::mesh
