// Numbers in which a coordinate stands both by itself and in a wave of it, so that only the count of
// the cell is left: `p - fract(p)`, `p - (mod(p, 2) - 1)`.
#pragma once

#include "ir/graph.h"

namespace fathom::ir {

// Of the ops of one or two numbers those that tell numbers apart which rounding made different ones.
constexpr OpSet tells_apart{Op::Hash,  Op::Floor, Op::Ceil,  Op::Round, Op::Trunc,
                            Op::Fract, Op::Mod,   Op::ToInt, Op::Sign,  Op::Step};

// The same number or vector made of `floor` alone wherever what it is made of cancels; the node itself
// where nothing does. A sum that only rounding tells from a whole number has another rounding at each
// point, and what tells numbers apart (a hash, a step, a comparison) would tell these apart.
// `visits`: how many nodes were looked at is added to it.
NodeId without_waves(Graph &graph, NodeId id, std::size_t &visits);

} // namespace fathom::ir
