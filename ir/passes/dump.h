// A graph and a tree of shapes as text, for goldens and for reading. Comes in: what was checked,
// proved or lowered; goes out: lines that are the same whenever it is the same. It changes nothing.
#pragma once

#include "ir/shape.h"

#include <string>

namespace fathom::ir {

// One line a node, numbered in the order of first use; folds and functions indented below.
std::string dump(const Graph &graph, NodeId root);
std::string dump(const Graph &graph, FunctionId function); // its parameters, then its body

std::string dump(const Graph &graph, const Shapes &shapes, ShapeId root); // an indented tree

} // namespace fathom::ir
