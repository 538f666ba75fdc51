// What an expression costs to compute, for the choices that depend on it: whether a field is worth
// keeping in the noise cache (docs/noise-cache.md), whether it is worth asking first if it is
// needed at all. In nanoseconds a point as Mesa's llvmpipe takes on the machine of
// docs/noise-cache.md: only ratios matter.
#pragma once

#include "ir/scene.h"

namespace fathom::ir {

double cost_of(const Graph &graph, NodeId root); // each node once, loops by their largest count

constexpr double look_up_cost = 7; // in the noise cache: four probes at most and one filtered fetch
constexpr double ask_first_from = 5; // a field this dear is asked only where it can matter

// Why the values of a cached field are always computed.
enum class Kept { Yes, Cheap, Moving, Steep };
Kept kept(const Scene &scene, CacheId cache);

// The most by which a kept value, interpolated between the corners of its cell, differs from the
// field's: with a slope of at most G, sum w_i |f(x_i) - f(p)| <= G sum w_i |x_i - p| <= G sqrt(sum
// w_i |x_i - p|^2), which is G * cell * sqrt(sum over the axes of u(1 - u)) <= G * cell *
// sqrt(3)/2. Both lie in the field's range, too.
double kept_error(const Scene &scene, CacheId cache);

} // namespace fathom::ir
