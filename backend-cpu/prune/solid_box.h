// Where a solid lies: the box about {p : distance(p) <= 0}, and how far it reaches along directions,
// found by the values that a marched distance takes over cells of space, as ranges, and at their
// middles.
#pragma once

#include "backend-cpu/tape.h"

#include <span>
#include <vector>

namespace fathom::cpu {

// Half the side of the space that is searched where nothing is known of where a solid is. What
// comes to its faces is taken to have no end.
constexpr double endless_from = 16384;

// A solid's box, empty where there is none; and the greatest product of each direction that was asked
// for with one of its points.
struct Extent {
    ir::Box box;
    std::vector<double> reach; // minus infinity where there is no solid
};
// Of both solids together.
Extent hull(Extent a, const Extent &b);

// The extent of the part of the solid that lies in `domain`, a finite box: it holds all of that part,
// and each of its sides is at most a few thousandths of the box's diagonal from it, as far as a
// counted amount of work can tell. At the scene's present values. Takes the operations on boxes that
// it does off `work`; where too few are left, `work` is 0 and the extent stays as it is.
Extent solid_extent(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                    std::span<const std::array<double, 3>> directions, double time, double &work);
// Its box alone.
ir::Box solid_box(const ir::Scene &scene, ir::FunctionId distance, const ir::Box &domain,
                  double time, double &work);

} // namespace fathom::cpu
