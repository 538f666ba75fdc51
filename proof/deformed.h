// How steep a twisted, bent or tapered field is within a box, by branch and bound over the points q
// of the shape as it was. Knows fields and intervals, nothing of shapes.
#pragma once

#include "proof/field.h"

namespace fathom::proof {

struct Deformation {
    ir::MapKind map = ir::MapKind::Twist; // Twist, Bend or Taper
    int axis = 1;  // of a twist and a taper; of a bend the one about which the points turn
    Interval rate; // Twist, Bend: radians a unit
    Interval ratio, from, to; // Taper
    Cell box;                 // in the deformed space: where the slope is wanted
};

// >= the slope of the deformed field in the box; infinity where none was proved. `field`: the
// undeformed one, an expression in Point.
FieldBound bound_deformed(Flattening &context, const Ranges &ranges, NodeId field,
                          const Deformation &deformation, const Budget &budget);

} // namespace fathom::proof
