// A field that was made larger by a number, `s * f(p/s)` or `f(s*p) / s`: the number and its inverse
// meet in what the field measures, and neither is left. Decided on expressions.
#pragma once

#include "ir/graph.h"
#include "proof/work.h"

#include <map>
#include <optional>
#include <utility>
#include <vector>

namespace fathom::proof {

using ir::NodeId;

// A number above 0 that is the same for all points, times an expression or below it.
struct Factor {
    NodeId number;
    bool divides = false;
};

// The same value as an expression of which each sum, extremum, length, … is made of what the factor
// has met (docs/lipschitz.md, 2.22). Nothing where it meets no inverse of itself.
struct Rescaled {
    NodeId value;
    std::vector<std::pair<NodeId, NodeId>> made; // each node, and the one that is made of it
};
// What was found for one factor, by node and power of it, for other expressions that it is beside.
using RescaledNodes = std::map<std::pair<NodeId, int>, NodeId>;
std::optional<Rescaled> rescaled(ir::Graph &graph, Factor factor, NodeId expression,
                                 RescaledNodes &known, Work &work);

// What a node is times, or divided by: the factors of a product or quotient, numbers apart.
std::vector<Factor> factors_of(const ir::Graph &graph, NodeId product);

// The same field with each product of what moves and of what stands still in one order, so that two
// vectors of one scale read it through one: of `4*p/s` and `p/s`, 4*(p/s). For small fields.
NodeId with_factors_in_order(ir::Graph &graph, NodeId root);

} // namespace fathom::proof
