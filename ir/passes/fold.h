// Constant folding: the canonical semantics at work. In come an op and constants of the
// right types, out goes its value. Used by the graph to fold, by the proof to try
// single precision (proof/trials.h), by tests to compare. It never looks
// at a graph: inputs, calls, loops, tables, samples and hits have no value here.
#pragma once

#include "ir/graph.h"

#include <optional>
#include <span>

namespace fathom::ir {

// The value of an op whose arguments are constants of the right types; nothing for the ops named
// above.
std::optional<Constant> evaluate(Op op, Type type, std::span<const Constant> args,
                                 std::uint32_t payload);
// The same by the arithmetic of single precision, as evaluators compute it.
std::optional<Constant> evaluate_single(Op op, Type type, std::span<const Constant> args,
                                        std::uint32_t payload);

} // namespace fathom::ir
