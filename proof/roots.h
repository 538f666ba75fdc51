// Square roots of what is a sum of squares, or a choice of such sums: lengths, so that they are
// nowhere infinitely steep. Decided on expressions. Knows nothing of tapes.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <optional>
#include <vector>

namespace fathom::proof {

// What an expression is made of and it itself, calls and loops as one; not all of a large one.
std::vector<ir::NodeId> nodes_below(const ir::Graph &graph, ir::NodeId root);

// sqrt of a choice of sums of squares as the choice of the roots, so that each is a length: of min,
// max, `if`, plus what is the same for both, times a number.
struct RootOfChoice {
    ir::NodeId choice; // of roots
    ir::NodeId from;   // the choice as it stood
};
std::optional<RootOfChoice> root_inward(ir::Graph &graph, ir::NodeId id);

// The parts of which the node is the length, a square root of a sum of squares.
std::optional<std::vector<ir::NodeId>> norm_parts(ir::Graph &graph, ir::NodeId id);

// The vector x of which the node is sqrt(x*x + c) by component, c at least 0 and the same for all
// points.
std::optional<ir::NodeId> rounded_sizes(ir::Graph &graph, ir::NodeId id);

// sign(d)*sqrt(|d|), which rises with d, of choices, of sums of squares and of their negatives: as
// the choice of lengths and their negatives, all over the expression below `root`.
ir::NodeId with_signed_roots(ir::Graph &graph, ir::NodeId root);

// |u| < |v| as |u|^2 < |v|^2, which is made of products, all over the expression below `root`.
ir::NodeId with_squares_compared(ir::Graph &graph, ir::NodeId root);

// A truth as a number that something else is multiplied by, `float(u > 0) * f`: as the choice of 1 and
// 0, all over the expression below `root`.
ir::NodeId with_chosen_factors(ir::Graph &graph, ir::NodeId root);

} // namespace fathom::proof
