// Vectors that are made longer or shorter by a function of their length, as a sphere's inversion and
// ball folds do: v/|v|^2, v * clamp(1/dot(v, v), 1, 4). Decided on expressions.
#pragma once

#include "ir/graph.h"

#include <optional>

namespace fathom::proof {

// v of a product of v, or of some of its components, with a factor that is, piece by piece, a number
// or c/|v|^q with 0 <= q <= 2: it is no steeper than the factor's size times v (docs/lipschitz.md,
// 2.25). Of a quotient the factor is 1/`factor`. Nothing where it is no such.
struct Radial {
    ir::NodeId vector, factor;
    bool divides = false;
};
std::optional<Radial> radial(ir::Graph &graph, ir::NodeId product);

} // namespace fathom::proof
