// What corners with two signs by turns leave open: whether the solid or what is empty is joined over
// such a face, and whether several patches of one cell can be drawn apart (docs/meshes.md, 3 and 4).
#pragma once

#include "mesh/loops.h"

#include <optional>

namespace fathom::mesh {

// Over a face whose corners have two signs by turns either the solid is joined or what is empty: that
// of the two diagonals whose sign stays, as far as corners of the finest cells would tell. Of cells
// with their signs, in which the tape holds.
void join_corners(Evaluator &evaluator, const cpu::ShortTape &tape, const Lattice &lattice,
                  const std::vector<Cell> &cells, std::vector<Node> &nodes);

// A plane across a cell, whose least corner is 0 and whose side is 1.
struct Across {
    std::array<int, 3> normal{};
    double offset = 0;
    double height(const std::array<double, 3> &at) const {
        return normal[0] * at[0] + normal[1] * at[1] + normal[2] * at[2] - offset;
    }
};
// One that two patches of a cell lie on different sides of, wherever they cross their edges, which are
// the cell's own: the first one where the height is above 0. None: not all edges are, or there is none.
std::optional<Across> plane_between(const Lattice &lattice, const Loops &loops, const Patch &x,
                                    const Patch &y);
// Whether both pass through one face of their cell whose corners have two signs by turns.
bool share_face(const Loops &loops, const Patch &x, const Patch &y);

} // namespace fathom::mesh
