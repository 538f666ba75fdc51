// The Lipschitz analysis: proves, for every shape of a scene, how steep its raw field can be over
// all points and the values of params and times that it is proved for, and what else the lowering
// may rely on (ir::ShapeFact). Rules and proofs: docs/lipschitz.md. Knows nothing of syntax; places
// come from Shape::origin.
#pragma once

#include "base/diagnostic.h"
#include "base/limits.h"
#include "base/stop.h"
#include "ir/interval.h"
#include "ir/scene.h"
#include "proof/rules.h"

#include <optional>
#include <string>
#include <vector>

namespace fathom::proof {

// Bounds by cells are looked for where a shape's one bound is above this.
constexpr double steep = 1.5;

class BoundCache;

struct Options {
    // None: the proof holds for all values that the params' ranges and the scene's times allow.
    // Else for the params' present values (ir::Param::value) and these times, in seconds, alone.
    std::optional<ir::Interval> times;
    Rules rules;                              // tests weaken one to see it caught
    std::size_t field_instructions = 250'000; // work per field: interval instructions, never time
    // Also bounds by cells of what is marched and steep, at most so many cells along a side, 4 or
    // more; 0: none but those of fields in a region. Worth their work where many rays are cast.
    int cells = 0;
    std::size_t cell_instructions = 4'000'000; // for all of them, and once more for
                                               // those near surfaces
    bool tighten = true; // deformed shapes by their own expressions, too; tests ask for rules alone
    bool test_assumptions = true;           // sample `lipschitz:` and `estimate:`
    std::size_t work = Limits{}.proof;      // steps in all
    std::string limit_note{}, limit_help{}; // for an error that there was too much
    // What earlier proofs found, and what this one finds (bound_cache.h). Nothing that a proof says
    // or fills depends on it but how long that takes. None: one for this proof alone.
    BoundCache *cache = nullptr;
    Stop *stop = nullptr; // where it stops, what was filled and reported means nothing
};

// Fills scene.facts (one a shape), scene.bounds and scene.far. A shape without a proof is reported
// once, gets lipschitz_sup = infinity and facts that can be used all the same. The scene's graph
// grows by the bounds' formulas. Returns how many steps it took.
std::size_t prove(ir::Scene &scene, Diagnostics &diagnostics, const Options &options = {});

// Why a shape's bound is what it is: what `check --explain` prints. Children in order.
struct Explanation {
    ir::ShapeId shape;
    std::string operation; // "twist", "union", "sphere"
    std::string rule;      // in words: "shear by rate * moment arm: sigma(2 * 0.6)"
    double factor = 1;     // the operation's own: lipschitz_sup over the largest child's
    double lipschitz = 1;  // of the result
    double share =
        0; // of the final bound: log(factor) / log(the root's), 0..1; 0 where the root's is 1
    std::string region; // where it was proved: "everywhere", "ball(4)", …
    Span place;
    bool worst = false; // on the chain of steepest children
    std::vector<Explanation> children;
};
Explanation explain(const ir::Scene &scene);

} // namespace fathom::proof
