// What a search for a bound asks of its region (field.h).
#pragma once

#include "proof/field.h"
#include "proof/machine.h"

#include <array>
#include <optional>

namespace fathom::proof {

// What of a zone is the same for a copy that is shifted along these axes: tubes along the only one,
// and for a ball the tube that holds it.
std::optional<Zone> zone_along(const Zone &zone, const std::array<bool, 3> &shifted);
// A region turned about an axis by whatever angle: what of it is the same then. Nothing where that
// has no end.
std::optional<Zone> turned_about(const Domain &domain, int axis);
// Of the points of a zone.
Distances distances_of(const Zone &zone);

} // namespace fathom::proof
