// How thin walls and gaps are, by samples: nothing is proved by it. It says how small cells have to be
// to show something, and what is said to users.
#pragma once

#include "mesh/octree.h"

#include <span>

namespace fathom::mesh {

// What lies about a place that no corner shows.
struct Thin {
    double thickness =
        0;            // of the piece of solid or space there, the thinner one; 0: nothing is seen
    bool gap = false; // … and that is space, between two pieces of solid
    bool touches = false; // the field comes to 0 there, as where parts touch, and goes no farther
};

// Along the field's gradient, a cell of the side to both ways.
Thin thin_at(Evaluator &evaluator, const Lattice &lattice, double side, const Point &at);

// Of so many of the cells at most, evenly chosen: what is about their middles.
inline constexpr std::size_t most_places = 64;
std::vector<Thin> thin_in(const Field &field, const Lattice &lattice, std::span<const Cell> cells,
                          unsigned threads, Progress &progress, std::size_t most = most_places);

// Whether to divide many cells is in vain: what is in most of them is thinner than so many of the
// finest cells of an octree, so that these would show holes and crumbs, or does but touch. Of fewer
// than `few` cells it is not asked.
bool thinner_in(const Field &field, const Octree &octree, std::span<const Cell> cells,
                std::size_t few, double showing, unsigned threads, Progress &progress);

} // namespace fathom::mesh
