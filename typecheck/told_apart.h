// What ops read that tell apart numbers which rounding made different ones.
#pragma once

#include "typecheck/interpreter.h"

namespace fathom::typecheck {

// The number as such an op (ir/passes/without_waves.h) is to read it. Counted as work of `place`.
ir::NodeId told_apart(Interpreter &ev, ir::NodeId number, Span place);

} // namespace fathom::typecheck
