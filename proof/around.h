// A function of an angle times what vanishes on the angle's axis, as r*sin(5*a): it turns about the
// axis ever faster, and is ever less (docs/lipschitz.md, 2.19).
#pragma once

#include "proof/tape.h"

#include <optional>

namespace fathom::proof {

// The product is no steeper than `by` times [x, y], whose angle it is, and `rest_by` times `rest`,
// where there is such a number, times the size of `vanishing`, wherever the cut of `angle` is not
// seen, for all params and times of the context. Nothing where it is no such product.
struct Around {
    NodeId angle, vector;
    double by = 1;
    NodeId vanishing{}, rest{};
    double rest_by = 0;
    // Of a product of r and the angle alone: its slope along r, and across it.
    bool is_apart = false;
    double radial = 0, across = 0;
};
std::optional<Around> around_axis(Flattening &context, NodeId product);
// A sum of a number that is the same all around that axis, and `by` times such a product; the axis is
// one of coordinates.
struct BesideTurn {
    NodeId still;
    Around turns;
    double by = 1;
};
std::optional<BesideTurn> beside_turn(Flattening &context, NodeId sum);
// The same of m [cos(b), sin(b)], m of the vector's length and b of its angle.
bool is_polar_vector(ir::Graph &graph, NodeId vector);
std::optional<Around> vector_around_axis(Flattening &context, NodeId vector);

} // namespace fathom::proof
