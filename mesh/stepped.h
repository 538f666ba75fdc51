// Kernels whose numbers jump as their inputs pass some value, and others that bend: what their slopes
// are beside that (docs/measure.md, 2).
#pragma once

#include "mesh/varying.h"

namespace fathom::mesh {

// The first number is below the second: true or false.
Varying comparison_of(const Varying &a, const Varying &b);
// Whole parts, signs, rests, angles and powers; others are not known.
Varying stepped(cpu::Kernel kernel, const std::vector<Varying> &in);

} // namespace fathom::mesh
