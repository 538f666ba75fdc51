// How steep a lowered expression is in a point: a number that its slope, of a vector the norm of
// its Jacobian, nowhere exceeds; infinity where nothing simple shows one. For pruning (prune.h),
// which needs it of one row's distance; what shapes say of their own bounds is the proof's.
//
// f: R^3 -> R^n gets L with |f(p) - f(q)| <= L |p - q|. By node, for parts a, b of the point and c
// that is not: |a + b|: La + Lb; c a: |c| La; min, max, clamp: the largest; length: that of its
// vector; a vector of components: sqrt(sum Li^2), or the largest where they read parts of one
// vector that do not overlap (then the Jacobian is a block diagonal one times the vector's);
// length(max(q, 0)) + min(max(q.x, q.y, …), 0): that of q, since one of the two is always 0.
#pragma once

#include "ir/graph.h"

namespace fathom::glsl {

// `point`: a Var. Expressions may read other Vars; the bound holds for all their values that tables
// give.
double slope_of(const ir::Graph &graph, ir::NodeId root, ir::NodeId point);

} // namespace fathom::glsl
