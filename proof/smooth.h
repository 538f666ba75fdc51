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
//   min(x, y) - h^3/(6 k^2),     with the same h: another function, with the same bounds
// and whatever equals these as sums of products.
struct Smooth {
    ir::NodeId x, y, k;
    ir::NodeId divisor; // k, or max(k, …): where it varies with the point, this is another function
    bool greater = false; // where k > 0
    bool divides = false; // by k: not where k may be 0
    bool clipped = false; // below 0 k counts as 0; else it makes the other of least and greatest
    bool cubic = false;   // h^3/(6 k^2)
};
std::optional<Smooth> smooth_extremum(ir::Graph &graph, ir::NodeId sum);

// log(exp(a) + exp(b)) as max(a, b) + log(1 + exp(-|a - b|)), which the graph makes of it; or of
// log2 and exp2.
struct LogSum {
    ir::NodeId a, b;
    ir::Op log;
};
std::optional<LogSum> log_sum(ir::Graph &graph, ir::NodeId sum);

} // namespace fathom::proof
