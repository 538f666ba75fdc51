// What a scene's proof rests on: the claims of library entries that it takes, what the user assumes
// or estimates.
#include "proof/prover.h"

#include <set>

namespace fathom::proof {

using ir::Axiom;
using ir::Shape;
using ir::ShapeKind;

void Prover::name_axioms() {
    std::set<std::string> named;
    const auto add = [&](Axiom::Kind kind, const std::string &says, Span at) {
        if (named.insert(says).second) scene.axioms.push_back({kind, says, at});
    };
    scene.axioms.clear();
    for (std::size_t i = 0; i < scene.shapes.size(); ++i) {
        const Shape &shape = scene.shapes[ir::ShapeId{i}];
        if (!places[i].reported) continue; // of no one, or below claims that are taken
        const std::string name = operation_name(scene, ir::ShapeId{i});
        if (shape.assumed > 0 && !held.contains(ir::ShapeId{i}))
            add(Axiom::Kind::Assumed, name + ": lipschitz " + number_text(shape.assumed),
                shape.origin);
        if (shape.estimate > 0)
            add(Axiom::Kind::Estimated, name + ": estimate " + number_text(shape.estimate),
                shape.origin);
        if (shape.kind != ShapeKind::Library) continue;
        const ir::Library &library = scene.shapes.libraries[shape.payload];
        if (!library.has_claims) continue;
        const ir::Claims &claims = library.claims;
        const auto claim = [&](bool made, const char *what) {
            if (made) add(Axiom::Kind::Library, library.name + ": " + what, shape.origin);
        };
        const bool exact = claims.kind == ir::FieldKind::Exact;
        claim(exact, "exact");
        claim(claims.kind == ir::FieldKind::Estimate, "estimate");
        const bool shown = held.contains(ir::ShapeId{i});
        claim(claims.lipschitz && !exact && !shown, "bound"); // a distance has slope 1
        claim(claims.lo || claims.hi, "box");
        bool symmetry = false; // that the field does not show by itself
        for (std::size_t a = 0; a < 3; ++a)
            symmetry = symmetry || (claims.symmetric[a] && !child(shape).fact.symmetric[a]);
        claim(symmetry, "symmetry");
        claim(claims.moment_arm[0] || claims.moment_arm[1] || claims.moment_arm[2], "moment arm");
    }
}

} // namespace fathom::proof
