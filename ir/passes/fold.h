// Ops on constants: the canonical semantics at work, in double. Used by the graph to fold, by tests
// to compare. Knows nothing of graphs' structure: inputs, calls, folds, tables and hits have no
// value here.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <span>

namespace fathom::ir {

// The value of an op whose arguments are constants of the right types; nothing for the ops named
// above.
std::optional<Constant> evaluate(Op op, Type type, std::span<const Constant> args,
                                 std::uint32_t payload);

} // namespace fathom::ir
