// The point kernels, compiled once for every instruction set (CMakeLists.txt, FATHOM_ISA). Its own
// function's name carries the set; kernels.cpp chooses.
#include "backend-cpu/kernels/loops.h"

namespace fathom::cpu::FATHOM_ISA {

namespace {
constexpr auto loops = all_loops<float, std::uint32_t>();
}

Loops<std::uint32_t> point_loops();
Loops<std::uint32_t> point_loops() { return loops; }

} // namespace fathom::cpu::FATHOM_ISA
