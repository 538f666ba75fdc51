// Space divided where the surface may be. A cell is left out only where no surface is in it: where
// the ranges of the field over it leave 0 out, or where the proof says that the ball about its
// middle which holds it is free (docs/meshes.md, 2).
#pragma once

#include "mesh/field.h"
#include "mesh/lattice.h"
#include "mesh/parallel.h"

namespace fathom::mesh {

inline constexpr std::int32_t none = -1;

// Some ten million cells that are crossed: what comes of them takes a few gigabytes.
inline constexpr std::size_t most_nodes = std::size_t{1} << 25;

enum class Space : std::uint8_t { Outside, Inside, Open }; // Open: it may hold surface

// A cell: divided into eight, or a leaf.
struct Node {
    std::int32_t children =
        none;                 // the first of eight: bit 0 of their number is x, bit 1 y, bit 2 z
    std::int32_t task = none; // whose tape holds in it
    Space space = Space::Open;
    // Of an open leaf: bit c is set where the field is not positive at corner c.
    std::uint8_t signs = 0;
    // Of its faces whose corners have two signs by turns: bit 2 axis + end where the solid corners are
    // joined over the face, and six bits higher where that is not clear.
    std::uint16_t faces = 0;
    bool joins(std::size_t axis, bool high) const { return faces >> (2 * axis + high) & 1; }
    bool unclear(std::size_t axis, bool high) const { return faces >> (6 + 2 * axis + high) & 1; }
    bool crossed() const { return signs != 0 && signs != 0xff; }
};

struct Cell {
    std::int32_t node = none;
    int level = 0;
    Index at{}; // its least corner
};

struct Octree {
    Lattice lattice;
    std::vector<Node> nodes;    // the first is all of it
    std::vector<TapePtr> tapes; // by task
    // Open leaves without a crossed one beside them: the field does not say whether surface is in
    // them, by the work that was spent on it.
    std::vector<Cell> undecided;
    // Open leaves of the same kind that are solid but for gaps of this width together at most, or empty
    // but for sheets of this thickness: parts only touch there.
    std::vector<std::int32_t> seams; // nodes
    double seam_width = 0;
    bool full = false; // more than most_nodes were wanted: it is not whole
    double wanted = 0; // so many, about; 0: they were not estimated, since they are few
    // Tangled cells are divided to this level, and below it only where smaller ones lie beside them;
    // no farther is searched for what no corner shows.
    int settled = 0;
};

struct OctreeSettings {
    bool trusts_bounds = true; // else ranges alone leave cells out
    unsigned threads = 1;
    int extra = 3;        // Octree::settled lies so many levels below the lattice's
    bool searches = true; // for what no corner shows; else the cells that may hold it are listed
};

// All leaves are of the lattice's level or left out; then those open ones that no crossed cell
// touches are divided further until they are crossed, touched or left out: to the finest level, or as
// far as a counted amount of work goes.
Octree make_octree(const Field &field, const Lattice &lattice, const OctreeSettings &settings,
                   Progress &progress);

// Divides leaves once. Their parts are all open.
void divide(Octree &octree, const Field &field, const std::vector<Cell> &leaves,
            const OctreeSettings &settings, Progress &progress);

// Divides open leaves once, and leaves out those of their parts in which no surface is.
void refine(Octree &octree, const Field &field, const std::vector<Cell> &leaves,
            const OctreeSettings &settings, Progress &progress);

// Whether surface may be in box k, after ranges_over; box k + 8 is its middle, a point. `half`: half
// its diagonal. `closed`: what is 0 all over is solid too, as in an octree; else it is open.
Space space_of(const Evaluator &evaluator, std::size_t k, double half, double ulp,
               bool trusts_bounds, bool closed = false);

// Slabs that are no thicker than this are not looked into for surface (seams.h).
inline double seam_thickness(const Lattice &lattice) { return 2 * lattice.ulp; }

std::vector<Cell> open_leaves(const Octree &octree); // in the order of the octree
// The leaf that holds a cell of the finest level; `node` is none outside of the cube.
Cell leaf_at(const Octree &octree, const Index &finest);

inline Index corner(const Index &at, std::int32_t side, int number) {
    return {at[0] + (number & 1 ? side : 0), at[1] + (number & 2 ? side : 0),
            at[2] + (number & 4 ? side : 0)};
}
inline Point point_of(const Lattice &lattice, const Index &at) {
    return {lattice.at(0, at[0]), lattice.at(1, at[1]), lattice.at(2, at[2])};
}

} // namespace fathom::mesh
