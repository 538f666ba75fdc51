// What an expression costs to compute, for the choices that depend on it: whether a field is worth
// storing in the noise cache (docs/noise-cache.md), whether it is worth testing first if it is
// needed at all. In comes an expression, out go nanoseconds a point as Mesa's llvmpipe takes on the
// machine of docs/noise-cache.md: only ratios matter. It changes nothing, and never says what may
// be left out for being dear. (operations.h counts; this weighs.)
#pragma once

#include "ir/scene.h"

namespace fathom::ir {

bool reads_worley(const Graph &graph, NodeId root); // itself, or by what it calls
double cost_of(const Graph &graph, NodeId root);    // each node once, loops by their largest count

// Measured by `fathom-bench noise-cache`. An octave of Perlin noise; spot noise with 4 a cell.
constexpr double octave_cost = 2.8, worley_cost = 20, spot_cost = 160;
// In the noise cache: one probe, which finds most of what is there, and one filtered fetch. 10 to
// 13, by what else the machine does.
constexpr double look_up_cost = 11;
// Of Worley noise about half of the cells lie at ridges and are refused (docs/noise-cache.md): a
// field that reads it saves so much of its cost. Alone, cached all the same, it took 0.59 of the
// exact rate.
constexpr double ridged_share = 0.5;
constexpr double guard_cost = 5; // a field of this cost is evaluated only where it can matter

// Why the values of a cached field are always computed.
enum class Cacheable { Yes, Cheap, Ridged, Moving, Steep };
Cacheable cached(const Scene &scene, CacheId cache);

// The most by which a cached value, interpolated between the corners of its cell, differs from the
// field's: with a slope of at most G, sum w_i |f(x_i) - f(p)| <= G sum w_i |x_i - p| <= G sqrt(sum
// w_i |x_i - p|^2), which is G * cell * sqrt(sum over the axes of u(1 - u)) <= G * cell *
// sqrt(3)/2. Both lie in the field's range, too.
double cached_error(const Scene &scene, CacheId cache);

} // namespace fathom::ir
