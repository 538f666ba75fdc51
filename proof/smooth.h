// Smooth minima and maxima of two numbers as people write them: their slope is a mean of both,
// which the rules for sums and products do not see. Decided on expressions.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <vector>

namespace fathom::proof {

// The smooth minimum of x and y (or maximum, where `greater`), within k of it, by
//   mix(y, x, h) - k h (1 - h),  h = clamp(1/2 + (y - x)/(2 k), 0, 1)
//   min(x, y) - h^2/(4 k),       h = max(k - |x - y|, 0)
// and whatever equals these as sums of products.
struct Smooth {
    ir::NodeId x, y, k;
    bool greater = false; // where k > 0; the other where k < 0
    bool divides = false; // by k: not where k may be 0
};
std::optional<Smooth> smooth_extremum(ir::Graph &graph, ir::NodeId sum);

// The terms of log(exp(a) + exp(b) + …), or of log2 and exp2; empty where it is none.
std::vector<ir::NodeId> log_of_exponentials(const ir::Graph &graph, ir::NodeId log);

} // namespace fathom::proof
