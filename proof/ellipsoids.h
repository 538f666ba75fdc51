// k0 (k0 - 1)/k1, the distance from an ellipsoid to first order: k0 = |A v| and k1 = |A A v| for
// numbers A by component (docs/lipschitz.md, 2.46). Decided on expressions.
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom::proof {

struct Ellipsoid {
    std::vector<ir::NodeId> vector;  // v by component
    std::vector<ir::NodeId> inverse; // A by component: the radii's inverses
    ir::NodeId k0, k1;
    double by = 1; // the expression is this times k0 (k0 - 1)/k1
};
// Of what is kept outside, too: k0 and k1 are then what was kept.
std::optional<Ellipsoid> ellipsoid(ir::Graph &graph, ir::NodeId product);

// The same where k0 >= 1, and 0 elsewhere, without a pole: with max(k0, 1) and max(k1, the least |A|).
ir::NodeId kept_outside(ir::Graph &graph, const Ellipsoid &of);

// How steep k0 (k0 - 1)/k1 is by v at most, where k0 and k1 are in these, and A in `inverse`; infinity
// where nothing is known.
double slope_of_ellipsoid(const ir::Interval &k0, const ir::Interval &k1,
                          std::span<const ir::Interval> inverse);

} // namespace fathom::proof
