// The same kernels over dual numbers.
#include "backend-cpu/dual.h"

#define FATHOM_ISA gradient
#include "backend-cpu/loops.h"

namespace fathom::cpu {

namespace gradient {

namespace {
constexpr auto loops = all_loops<Dual, DualCell>();
}

} // namespace gradient

Loops<DualCell> gradient_loops() { return gradient::loops; }

} // namespace fathom::cpu
