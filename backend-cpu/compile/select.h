// Which kernels an operation on vectors, matrices and hits becomes.
#pragma once

#include "backend-cpu/compile/code.h"

namespace fathom::cpu {

// One value a component of each argument, in and out. Not for what build.cpp does itself: inputs,
// calls, loops, data.
std::vector<Value> select(Builder &builder, const ir::Node &node,
                          std::span<const std::vector<Value>> args,
                          std::span<const ir::Type> types);

} // namespace fathom::cpu
