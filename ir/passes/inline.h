// Inlining: calls and iterations of loops written out where they stand. In come a graph and a call,
// a loop or an expression; out go nodes of the same graph with the same values. Names that a
// function or a loop binds are replaced by what is given for them. It never enters the body of a
// loop that it is not given, and removes nothing.
#pragma once

#include "ir/passes/walk.h"

#include <vector>

namespace fathom::ir {

// What a function gives of arguments: its result with these in its parameters' places, and with
// what else `also` replaces.
NodeId called(Graph &graph, FunctionId function, std::span<const NodeId> args,
              const Substitution &also = {});
NodeId called(Graph &graph, NodeId call); // of a Call node

// An expression of a loop's body in one iteration, by the values that the loop carries into it; and
// these values after it. Its condition is not evaluated.
NodeId in_iteration(Graph &graph, const Loop &loop, int iteration, std::span<const NodeId> values,
                    NodeId expression);
std::vector<NodeId> after_iteration(Graph &graph, const Loop &loop, int iteration,
                                    std::span<const NodeId> values);

// The expression with every call written out, loops' bodies apart. Where more than `most` nodes
// would have to be looked at, the rest stays as it is, and `all` is false.
struct WithoutCalls {
    NodeId root;
    bool all = true;
};
WithoutCalls without_calls(Graph &graph, NodeId root, std::size_t max_nodes);
// … and every loop whose count is a constant, outermost bodies first; others stay. A row of a table
// that is read by a known number is its numbers.
WithoutCalls without_loops(Graph &graph, NodeId root, std::size_t max_nodes);

// Long chains of sums, minima and maxima of numbers as trees, so that a part of the terms is a part
// of the tree. The same numbers but for rounding. `root` without calls and loops.
NodeId balanced(Graph &graph, NodeId root);

} // namespace fathom::ir
