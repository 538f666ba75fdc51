// Crumbs: pieces of a mesh that only divided cells show. A tip or a sharp edge of the solid may be
// drawn as one where the cells between it and the rest were not divided.
#pragma once

#include "mesh/loops.h"

namespace fathom::mesh {

struct Crumbs {
    std::size_t count = 0;
    // The larger leaves that they end in, each once: surface may go on there that no corner shows.
    std::vector<Cell> larger;
};
// `loops` are whole, without tangled cells.
Crumbs find_crumbs(const Octree &octree, const Loops &loops);

} // namespace fathom::mesh
