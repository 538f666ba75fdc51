// What colour the surface has at a mesh's vertices.
#pragma once

#include "mesh/polygons.h"

namespace fathom::mesh {

// The diffuse colour at each vertex, linear, 0..1; of what is no number, 0. A vertex has one colour:
// where two paints meet, the colours run into each other over a triangle. `arm` is a length that is
// small for the mesh.
std::vector<Point> colors_of(const ir::Scene &scene, double time, const Mesh &mesh, double arm);

} // namespace fathom::mesh
