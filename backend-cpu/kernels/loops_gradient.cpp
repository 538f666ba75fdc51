// The same kernels over dual numbers.
#include "backend-cpu/kernels/dual.h"

#include "backend-cpu/kernels/loops.h"

namespace fathom::cpu {

namespace base {

namespace {
constexpr auto gradients = all_loops<Dual, DualCell>();
}

} // namespace base

Loops<DualCell> gradient_loops() { return base::gradients; }

} // namespace fathom::cpu
