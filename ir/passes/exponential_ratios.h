// Quotients of exponentials that are 0/0, or infinity over infinity, in single precision where the
// number that they stand for is none of these.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// above/below as a node of the same value; none where it is not of such a form:
// - x/(1 - exp(u)), u a multiple of x, which is a number where u is 0;
// - u/tanh(u), likewise;
// - (x exp(u) + y exp(v))/(exp(u) + exp(v)), a mean of x and y whatever size the exponentials have.
NodeId exponential_ratio(Graph &graph, NodeId above, NodeId below);

} // namespace fathom::ir
