// Functions of two numbers that move along with both: F(a + t, b + t) = F(a, b) + s t, as all smooth
// minima and maxima do, however they are written. Where F rises with a and with b, its gradient is
// s times a mean of theirs (docs/lipschitz.md, 2.18).
#pragma once

#include "proof/tape.h"

#include <optional>

namespace fathom::proof {

// Looked for among the pairs of numbers that the scalar holds, and proved for all params and times of
// the context. Nothing where none is proved.
std::optional<Mean> mean_of(Flattening &context, NodeId scalar);

} // namespace fathom::proof
