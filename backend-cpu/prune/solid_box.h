// Where a solid lies: the box about {p : distance(p) <= 0}, found by the values that a marched
// distance takes over cells of space, as ranges, and at their middles.
#pragma once

#include "backend-cpu/tape.h"

namespace fathom::cpu {

// Half the side of the space that is searched where nothing is known of where a solid is. What
// comes to its faces is taken to have no end.
constexpr double endless_from = 16384;

// The box of the part of the solid that lies in `domain`, a finite box: it holds all of that part,
// and each of its sides is at most a few thousandths of its diagonal from it, as far as a counted
// amount of work can tell. Empty where there is no such part. At the scene's present values. Takes
// the operations on boxes that it does off `work`; where too few are left, `work` is 0 and the box
// stays as it is.
ir::Box solid_box(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                  double time, double &work);

} // namespace fathom::cpu
