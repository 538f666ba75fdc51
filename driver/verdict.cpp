#include "driver/verdict.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

namespace fathom::driver {

std::string_view status_name(ir::ProofStatus status) {
    switch (status) {
    case ir::ProofStatus::Proved: return "proved";
    case ir::ProofStatus::Assumed: return "assumed";
    case ir::ProofStatus::Estimated: return "estimated";
    }
    return "";
}

Verdict judge(const ir::Scene &scene) {
    Verdict verdict;
    verdict.exact = !scene.top_level.empty();
    for (const ir::TopLevel &top : scene.top_level) {
        const ir::ShapeFact &fact = scene.facts[top.shape.index];
        verdict.lipschitz = std::max(verdict.lipschitz.value_or(0), fact.lipschitz_sup);
        verdict.status = std::max(verdict.status, fact.status);
        verdict.exact = verdict.exact && fact.kind == ir::FieldKind::Exact;
    }
    return verdict;
}

namespace {

using Json = nlohmann::ordered_json;

// JSON knows no infinity.
Json json_number(std::optional<double> number) {
    return number && std::isfinite(*number) ? Json(*number) : Json();
}

std::string_view axiom_kind(ir::Axiom::Kind kind) {
    switch (kind) {
    case ir::Axiom::Kind::Library: return "library";
    case ir::Axiom::Kind::Assumed: return "assumed";
    case ir::Axiom::Kind::Estimated: return "estimated";
    case ir::Axiom::Kind::Rounding: return "rounding";
    }
    return "";
}

} // namespace

std::string verdict_json(const Compilation &compilation) {
    Json shapes = Json::array(), axioms = Json::array(), diagnostics = Json::array();
    Json bounds, status; // null of a scene that has errors
    Verdict verdict;
    verdict.exact = false;
    if (compilation.good()) {
        const ir::Scene &scene = compilation.scene;
        verdict = judge(scene);
        status = status_name(verdict.status);
        if (scene.bounds.finite()) bounds = {scene.bounds.lo, scene.bounds.hi};
        for (const ir::TopLevel &top : scene.top_level) {
            const ir::ShapeFact &fact = scene.facts[top.shape.index];
            shapes.push_back({{"span", place_json(compilation.sources, top.span)},
                              {"lipschitz", json_number(fact.lipschitz_sup)},
                              {"status", status_name(fact.status)},
                              {"exact", fact.kind == ir::FieldKind::Exact}});
        }
        for (const ir::Axiom &axiom : scene.axioms)
            axioms.push_back(
                {{"kind", axiom_kind(axiom.kind)},
                 {"says", axiom.says},
                 {"span", axiom.at.source ? place_json(compilation.sources, axiom.at) : Json()}});
    }
    for (const Diagnostic &diagnostic : compilation.diagnostics.sorted())
        diagnostics.push_back(to_json(diagnostic, compilation.sources));
    return json_text({{"ok", compilation.good()},
                      {"lipschitz", json_number(verdict.lipschitz)},
                      {"status", status},
                      {"exact", verdict.exact},
                      {"bounds", bounds},
                      {"shapes", shapes},
                      {"axioms", axioms},
                      {"diagnostics", diagnostics}}) +
           "\n";
}

} // namespace fathom::driver
