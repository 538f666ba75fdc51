// How far two distances differ at most: branch and bound on the places where one of them is 0, or
// both have not the same sign.
#pragma once

#include "proof/field.h"

namespace fathom::proof {

// `inside`: both are distances inside of their solids, too. The domain holds both solids.
double bound_gap(Flattening &context, const Ranges &ranges, NodeId f, NodeId g, bool inside,
                 const Cell &domain, const Budget &budget);

// How far two fields differ at most in a domain, which may be endless, as their expressions say.
double bound_difference(Flattening &context, const Ranges &ranges, NodeId f, NodeId g,
                        const Cell &domain);

} // namespace fathom::proof
