// Numbers that single precision computes exactly. What tells numbers apart that rounding alone makes
// different ones (a hash, a step) may count as equal of those alone, or of what is the same node:
// `hash(n + 0.3)` is another number than `hash(0.1 * (k + 3))` where n is 0.1 k.
#pragma once

#include "proof/polynomials.h"

namespace fathom::proof {

// Ops whose values may differ by much for arguments that differ by rounding.
constexpr ir::OpSet tells_apart{ir::Op::Hash,  ir::Op::Floor, ir::Op::Ceil, ir::Op::Round,
                                ir::Op::Trunc, ir::Op::Fract, ir::Op::Mod,  ir::Op::ToInt};

// Whole numbers (below 2^24) and their products, each times a number of few bits.
bool is_exact(const ir::Graph &graph, const Polynomial &sum);
bool is_exact(ir::Graph &graph, ir::NodeId scalar);
bool is_of_few_bits(double number);
// May single precision have a number so wrong that its fraction is another? So it is of what a sine, a
// root or another fraction goes into, which hashes multiply with large numbers: the sine of a number
// near 300, times 43758.5, may be wrong by 1. Of a hash like that nothing is known but its range.
bool single_is_far_off(const ir::Graph &graph, ir::NodeId number);
// Is every component whole by its making, also in single precision? Is it 2^k, k >= 0?
bool is_made_whole(const ir::Graph &graph, ir::NodeId id, int depth = 0);
bool is_whole_power_of_two(const ir::Graph &graph, ir::NodeId id);
// The same node, or the same exact number, by component.
bool exactly_same(ir::Graph &graph, ir::NodeId a, ir::NodeId b);

// The sine or cosine of so many quarters of a turn, where single precision has no other number for
// that: pi is written with many digits or with few.
std::optional<double> of_quarter_turns(bool cosine, double angle);
// How many half turns an angle is, likewise; 0 where it is none.
double half_turns(double angle);

} // namespace fathom::proof
