// What the iterations of a loop of shapes have in common. Private to typecheck.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// What differs between shapes that one loop's body made.
struct IterationTable {
    ir::ShapeId symbolic;                        // the shape with the loops' numbers left open
    std::vector<ir::NodeId> places;              // the expressions in it that depend on them alone
    std::vector<std::vector<ir::Constant>> rows; // their values, by member
    std::vector<ir::NodeId> formulas;            // in `row`; invalid where float32 would miss a row
    ir::NodeId row;
};
// Nothing where these are no iterations of one loop, or not all in equal steps.
std::optional<IterationTable> table_of_iterations(Interpreter &ev,
                                                  const std::vector<ir::ShapeId> &members);

} // namespace fathom::typecheck
