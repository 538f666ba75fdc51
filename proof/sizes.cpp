// Sizes that single precision cannot compute with: the square of a length has to fit, and what is
// divided by it (base/single.h).
#include "proof/prover.h"

#include "base/single.h"

#include <cmath>
#include <fmt/format.h>

namespace fathom::proof {

using ir::ShapeId;
using ir::ShapeKind;

constexpr double reach = longest * 1.001;   // boxes are rounded outward
constexpr double slow = 1e3, useless = 1e6; // bounds: a picture takes long, or never ends

static std::string short_text(double x) { return fmt::format("{:.3g}", x); } // also of 1e-20

// How far a finite end of the box lies from the origin.
static double farthest(const ir::Box &box) {
    double far = 0;
    for (std::size_t i = 0; i < 3; ++i)
        for (const double end : {box.lo[i], box.hi[i]})
            if (std::isfinite(end)) far = std::max(far, std::abs(end));
    return far;
}

// The least width of a box that has one.
static double thinnest(const ir::Box &box) {
    double thin = longest;
    for (std::size_t i = 0; i < 3; ++i)
        if (const double width = box.hi[i] - box.lo[i]; width > 0) thin = std::min(thin, width);
    return thin;
}

void Prover::check_size(ShapeId id, Derived &k) {
    if (k.failed) return;
    const ir::Shape &shape = scene.shapes[id];
    const std::string name = operation_name(scene, id);
    std::string wrong;
    if (const double far = farthest(k.fact.bounds); far > reach)
        wrong = name + " reaches " + short_text(far) + " from the origin, and a shape may reach " +
                short_text(longest);
    else if (const double thin = thinnest(k.fact.bounds);
             thin < shortest && (shape.kind == ShapeKind::Leaf || shape.kind == ShapeKind::Map ||
                                 shape.kind == ShapeKind::Library))
        wrong = name + " is " + short_text(thin) + " wide, and a shape is at least " +
                short_text(shortest) + " wide";
    const bool steep = wrong.empty() && k.fact.lipschitz_sup > longest;
    if (steep)
        wrong = name + " has a bound of " + short_text(k.fact.lipschitz_sup) +
                ", and a bound is at most " + short_text(longest);
    const bool leaf = shape.kind == ShapeKind::Leaf;
    if (wrong.empty() && leaf && k.fact.status == ir::ProofStatus::Proved &&
        k.fact.lipschitz_sup > slow)
        if (Diagnostic *d = report(
                id, Code::SteepField,
                name + " has a bound of " + short_text(k.fact.lipschitz_sup) +
                    ": where it is that steep " +
                    (k.fact.lipschitz_sup > useless ? "no ray gets on" : "rays hardly get on")))
            d->note("a step is the field's value divided by the bound")
                .help("choose a smaller region, fewer turns of a loop or smaller numbers, or march "
                      "by an estimate, `estimate: 2`, which is no proof");
    if (wrong.empty()) return;
    Diagnostic *d = report(id, Code::NumberRange, wrong);
    if (d && steep)
        d->note("no step could be divided by that")
            .help(std::string("choose a smaller region, fewer turns of a loop or smaller numbers") +
                  (leaf ? std::string(", or ") + state_a_bound : ""));
    else if (d)
        d->note("fields are computed in single precision, which has to hold the squares of "
                "lengths")
            .help("choose another unit of length, so that sizes are near to 1");
    fail(k);
}

} // namespace fathom::proof
