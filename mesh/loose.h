// Cells that stay undecided though nothing thin is seen there: where ranges and bound are loose.
#pragma once

#include "mesh/octree.h"

namespace fathom::mesh {

// How much smaller boxes have to be to leave surface out, in most of the cells; 0: they do not do it.
double shrunk_to_decide(const Field &field, const Lattice &lattice, const std::vector<Cell> &cells);

} // namespace fathom::mesh
