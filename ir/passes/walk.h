// Copies of expressions with parts replaced. In come a graph, a node and what stands for what; out
// goes a node of the same graph. It enters the bodies of loops and never those of functions, which
// are closed. (What a node reads, and its free variables: Graph::reads, Graph::free_vars.)
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// A copy of `root` in which every node that `map` names is replaced. A copied Loop gets variables
// of its own.
using Substitution = std::unordered_map<NodeId, NodeId>;
NodeId substitute(Graph &graph, NodeId root, const Substitution &map);
// The same, and counts the nodes that it looked at.
NodeId substitute(Graph &graph, NodeId root, const Substitution &map, std::size_t &visited);

// Of several expressions at once: what they have in common they have in common afterwards. (A loop
// that is copied twice is two loops, and what reads them are two nodes.)
std::vector<NodeId> substitute(Graph &graph, std::span<const NodeId> roots,
                               const Substitution &map);

} // namespace fathom::ir
