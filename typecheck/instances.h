// Tables of instances: shapes of one form with different numbers become the rows of a table.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// -- iterations.cpp
// After a loop in shape position: what its iterations made, each from `starts[i]` on; `iteration`
// runs its body for a value of its variable.
constexpr std::size_t min_computed = 64; // shapes from which on a table's rows are worth a formula
void note_iterations(
    Interpreter &ev, const std::vector<Value> &items, const std::vector<std::size_t> &starts,
    const std::vector<Contribution> &made,
    const std::function<void(const Value &item, std::vector<Contribution> &out)> &iteration);

// -- instances.cpp
// Appends every expression of a tree of shapes.
void shape_nodes(const ir::Scene &scene, ir::ShapeId id, std::vector<ir::NodeId> &out);
// The shapes with those of one form, eight or more, replaced by a table of them.
std::vector<ir::ShapeId> gather_instances(Interpreter &ev, std::vector<ir::ShapeId> shapes,
                                          int dims, Span place);
// A smooth union of width k of shapes of one form, as a table; none where they are not.
std::optional<ir::ShapeId> smooth_instances(Interpreter &ev, const std::vector<ir::ShapeId> &shapes,
                                            ir::NodeId k, int dims);
// The union of shapes, with tables where that is possible.
ir::ShapeId unite(Interpreter &ev, std::vector<ir::ShapeId> shapes, int dims, Span origin);

} // namespace fathom::typecheck
