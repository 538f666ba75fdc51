// The same kernels over dual numbers.
#include "backend-cpu/kernels/dual.h"

#define FATHOM_ISA gradient
#include "backend-cpu/kernels/loops.h"

namespace fathom::cpu {

namespace gradient {

namespace {
constexpr auto loops = all_loops<Dual, DualCell>();
}

} // namespace gradient

Loops<DualCell> gradient_loops() { return gradient::loops; }

} // namespace fathom::cpu
