// Where the surface crosses the octree, as far as signs at corners tell: the edges that it crosses,
// the segments that join them on faces, and the loops that these make round each cell, one a patch
// of surface. Knows no coordinates but the lattice's (docs/meshes.md, 3).
#pragma once

#include "mesh/grid.h"
#include "mesh/octree.h"

namespace fathom::mesh {

// An edge with a sign at each end, of the smallest cell about it; so no cell's corner lies on it.
// Round it lie four quarters, each in a leaf: with b and c the axes after its own, quarter 0 at
// b- c-, 1 at b+ c-, 2 at b+ c+, 3 at b- c+. A leaf may hold two of them. Face k lies between
// quarters k and k + 1.
struct Crossing {
    Index low{};             // its lower end
    std::int32_t length = 0; // in cells of the finest level
    std::uint8_t axis = 0;
    bool low_inside = false;
    std::array<Cell, 4> cells;                                    // by quarter
    std::array<std::int32_t, 4> segments{none, none, none, none}; // by face; none: within one cell
    std::array<std::int32_t, 4> patches{none, none, none, none};  // by quarter
};

// A part of the surface's way over a face between two cells: from one crossed edge to the next.
// Faces are those of the smaller cell of the two.
struct Segment {
    std::array<std::int32_t, 2> crossings{none, none};
    std::array<std::uint8_t, 2> faces{}; // which of each crossing's
    Cell owner;                          // the smaller cell
    std::uint8_t axis = 0;               // the face's, and at which of the cell's ends it lies
    bool high = false;
    bool alone = true; // no other segment lies on this face
};

// A piece of surface in a cell: what a loop of segments bounds. It goes through crossing k by
// `crossings[first + k]`, in an order of its own.
struct Patch {
    Cell cell;
    std::uint32_t first = 0, count = 0;
    bool alone = true; // the only one of its cell
};

struct Loops {
    std::vector<Crossing> crossings;
    std::vector<Segment> segments;
    std::vector<Patch> patches;
    std::vector<std::int32_t> members;                         // of patches: crossings
    std::vector<std::pair<std::int32_t, std::size_t>> several; // patches not alone, by their node
    // Leaves above the settled level whose surface is in more than one piece, or crosses a face more
    // than once, and those below it with several pieces and smaller leaves beside them: to be
    // divided.
    std::vector<Cell> tangled;
    std::size_t torn = 0; // faces whose signs contradict what was proved: no surface can be made
    Index torn_at{};
};

Loops find_loops(const Octree &octree, unsigned threads, Progress &progress);

// Only which cells beside those that were divided are tangled, and whether faces are torn there: the
// loops are not whole.
Loops find_tangled(const Octree &octree, const Region &changed, unsigned threads,
                   Progress &progress);

} // namespace fathom::mesh
