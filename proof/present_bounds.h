// Bounds at the params' present values, of a scene that is drawn while they move: a shape's bound is
// the smaller one of what holds for the whole ranges and of a number that the host proves anew,
// sends as a uniform, and takes back once a value differs.
#pragma once

#include "base/stop.h"
#include "ir/scene.h"

#include <optional>
#include <vector>

namespace fathom::proof {

class BoundCache;

// What a present bound is until it is known: none at all.
constexpr double unknown_bound = 1e30;

// After the proof, before the lowering: gives each shape that is steep and reads params a present
// bound (ir::Scene::present_bounds), at most so many in a scene, those steepest first.
constexpr std::size_t most_present_bounds = 64;
void add_present_bounds(ir::Scene &scene);

// What is proved at the params' present values, at all of the scene's times.
struct PresentBounds {
    std::vector<double> values; // as Scene::present_bounds; at least 1
    double whole = 0;           // of the scene's raw field
};

// Of a scene that has them, of which it is the caller's own copy. Nothing where that was stopped.
std::optional<PresentBounds> prove_present_bounds(ir::Scene scene, BoundCache *cache, Stop *stop);

} // namespace fathom::proof
