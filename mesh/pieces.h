// Which piece of a mesh each vertex belongs to.
#pragma once

#include "mesh/polygons.h"

#include <cstdint>
#include <vector>

namespace fathom::mesh {

// By vertex: one vertex of its piece, the same for all of these. One that no triangle uses is its own.
std::vector<std::uint32_t> pieces_of(const Mesh &mesh);

} // namespace fathom::mesh
