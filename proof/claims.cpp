// What a shape states of itself: the claims of the library's solids, and the bounds that a type
// `shape<L>` demands. Proofs: docs/lipschitz.md, 3.
#include "proof/homogeneous.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::FieldKind;
using ir::ProofStatus;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::infinity;

Derived Prover::know_library(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::Library library = scene.shapes.libraries[shape.payload];
    Derived k = of_child(shape);
    if (!library.has_claims) return k;
    const ir::Claims &claims = library.claims;
    bool exact = claims.kind == FieldKind::Exact;
    if (claims.lo && claims.hi) {
        Vec lo = vector(claims.lo), hi = vector(claims.hi);
        Box box;
        for (std::size_t i = 0; i < 3; ++i) {
            bool flat = shape.dims == 2 && i == 2;
            box.lo[i] = flat ? 0 : lo[i].lo;
            box.hi[i] = flat ? 0 : hi[i].hi;
        }
        k.fact.bounds = box;
        k.growth_rate = exact                ? 1
                        : claims.growth_rate ? number(claims.growth_rate).magnitude()
                                             : infinity;
        k.outer = Box::everything();
        k.outer_growth_rate = 0;
    }
    if (claims.kind == FieldKind::Estimate)
        k.fact.kind = FieldKind::Estimate;
    else if (exact)
        k.fact.kind = FieldKind::Exact;
    else if (k.fact.kind != FieldKind::Exact || claims.lipschitz)
        k.fact.kind = FieldKind::Bound;
    for (std::size_t a = 0; a < 3; ++a)
        k.fact.symmetric[a] = k.fact.symmetric[a] || claims.symmetric[a];
    if (exact) {
        k.fact.exact_outside = k.parts_exact = true;
        k.parts = k.fact.bounds;
        if (claims.lo && claims.hi) k.growth_rate = 1;
        for (int a = 0; a < 3; ++a)
            k.fact.moment_arm[static_cast<std::size_t>(a)] = radius_about(k.parts, a);
    } else if (claims.lipschitz) {
        k.fact.exact_outside = k.parts_exact = false;
        k.parts = Box::everything();
        k.fact.moment_arm = {infinity, infinity, infinity};
    }
    for (std::size_t a = 0; a < 3; ++a)
        if (claims.moment_arm[a]) {
            double moment_arm = number(claims.moment_arm[a]).magnitude();
            k.fact.moment_arm[a] = std::min(k.fact.moment_arm[a], moment_arm);
        }
    if (claims.lipschitz || exact) {
        k.failed = false;
        k.fact.status =
            claims.kind == FieldKind::Estimate ? ProofStatus::Estimated : ProofStatus::Proved;
        if (exact)
            set_lipschitz(k, 1);
        else
            set_lipschitz(k, claims.lipschitz, number(claims.lipschitz).magnitude());
        if (!exact) hold_claim(id, k);
    }
    if (claims.kind == FieldKind::Estimate) {
        k.fact.status = ProofStatus::Estimated;
    }
    return k;
}

// A bound that is stated and that the field shows by itself is no axiom, and none is greater.
void Prover::hold_claim(ShapeId id, Derived &k) {
    const Shape body = scene.shapes[scene.shapes[id].children[0]];
    if (!place(id).reported || body.kind != ir::ShapeKind::Leaf || work.spent()) return;
    if (k.fact.lipschitz_sup <= 1 + slack) return; // most are no less
    constexpr std::size_t instructions = 50'000;   // a face
    Budget budget;
    budget.instructions = std::min(instructions, options.field_instructions);
    const double stated = k.fact.lipschitz_sup;
    const auto found =
        bound_along_rays(flattening, ranges, body.args[0], budget, stated * (1 + slack), 0);
    if (!found) return;
    held.insert(id);
    if (*found < stated * (1 - slack)) set_lipschitz(k, *found);
}

Derived Prover::know_contract(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::Contract contract = scene.shapes.contracts[shape.payload];
    Derived k = of_child(shape);
    if (!k.failed && k.fact.lipschitz_sup > contract.lipschitz * (1 + slack)) {
        if (Diagnostic *d =
                report(id, Code::LipschitzContract,
                       "this shape's bound is " + number_text(k.fact.lipschitz_sup) +
                           ", and `shape<" + number_text(contract.lipschitz) + ">` is wanted")) {
            if (contract.demanded.source) d->label(contract.demanded, "demanded here");
            for (const std::string &line : chain(shape.children[0])) d->note(line);
        }
    }
    return k;
}

} // namespace fathom::proof
