// Triangles between vertices: round every crossed edge, so that the mesh is closed, oriented, and
// does not cross itself (docs/meshes.md, 3 and 4).
#pragma once

#include "mesh/vertices.h"

namespace fathom::mesh {

// Vertices as floats, with the surface's normal about there, of length 1; triangles counterclockwise as
// seen from outside.
struct Mesh {
    std::vector<Point> vertices, normals;
    std::vector<std::array<std::uint32_t, 3>> triangles;
};

Mesh make_polygons(const Lattice &lattice, const Loops &loops, const Vertices &vertices);

} // namespace fathom::mesh
