// Numbers that stand still between steps, interpolated by the fractions of what the steps are of:
// value noise, written by hand (docs/lipschitz.md, 2.20). Knows nothing of tapes.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <map>
#include <optional>
#include <vector>

namespace fathom::proof {

// A scalar that is affine in each of some weights, each a polynomial of fract(x) in 0..1 for an x of
// its own.
struct Interpolation {
    std::vector<ir::NodeId>
        corners;                   // its values where each weight is 0 or 1; the others lie between
    std::vector<ir::NodeId> along; // the scalars x
    double steepness = 0; // >= its slope by all x together, over the width of the corners' range
};
// By the weights' polynomials, what was found for them.
using SteepnessOfWeights = std::map<std::vector<std::vector<double>>, double>;
std::optional<Interpolation> interpolation(ir::Graph &graph, ir::NodeId scalar,
                                           SteepnessOfWeights &known, Work &work);

} // namespace fathom::proof
