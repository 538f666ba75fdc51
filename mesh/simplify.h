// Fewer triangles: a mesh that is no farther than a tolerance from the one it comes from, by edges
// that meshoptimizer collapses (Garland and Heckbert 1997). What that library does not promise is
// checked here, block by block; where a check fails the block is tried again with a smaller aim, and at
// last stays as it was (docs/meshes.md, 11).
#pragma once

#include "mesh/polygons.h"

namespace fathom::mesh {

// What may not run together: by vertex, linear colours, or none; by triangle, a material, or none.
struct Paints {
    std::vector<Point> colors;
    std::vector<std::uint32_t> material_of;
};

struct SimplifySettings {
    double tolerance = 0; // in the scene's units
    double side = 0;      // of a drawing cell: the size of the triangles that come in
    unsigned threads = 1;
};

// What came of it, and what was not done.
struct Simplified {
    Mesh mesh;               // its vertices are some of the fine ones
    std::size_t before = 0;  // triangles
    std::size_t colored = 0; // of these, so many stayed since paints meet there
    std::size_t refused = 0; // so often a check of a block failed
    bool undone = false;     // the whole failed in the end: it is the fine mesh
};

// Of a closed, oriented 2-manifold that does not cross itself; so is what comes out, with as many
// pieces and handles. Every point of the fine mesh has a point of the new one within the tolerance.
// Triangles whose corners differ in colour by more than 1/64 stay, and those that touch another
// material; no colour that is left out differs from the new triangle's by more than 1/32 at the place
// nearest to it. Cancelled: the mesh as it was.
Simplified simplify(const Mesh &fine, const Paints &paints, const SimplifySettings &settings,
                    Progress &progress);

} // namespace fathom::mesh
