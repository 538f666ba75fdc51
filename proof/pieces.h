// Vectors and numbers that are affine by pieces: projections to a segment, folds, swaps, what `if`
// chooses among moved copies. On each piece the Jacobian is a constant matrix times that of the
// parts they are made of; the largest of these norms bounds all (docs/lipschitz.md, 2.7). Knows
// nothing of cells.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <vector>

namespace fathom::proof {

struct Pieces {
    std::vector<ir::NodeId> parts; // scalars, or one vector, that the pieces are affine in
    double norm = 0;               // of every piece's matrix, at most
    bool at_right_angles = false;  // the longest piece's rows: nothing less is true
};

// Of a scalar, or of the vector of several scalars or vectors; nothing where it is not made so, or
// of too many pieces. `steps` counts up by the expressions looked at, and ends it at `most_steps`.
std::optional<Pieces> by_pieces(ir::Graph &graph, const std::vector<ir::NodeId> &of, int &steps);

constexpr int most_steps_of_pieces = 30'000; // of one field

} // namespace fathom::proof
