#include "driver/verdict.h"

#include "base/encode.h"
#include "base/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

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

std::string json_number(std::optional<double> number) {
    return number && std::isfinite(*number) ? format_shortest(*number) : "null";
}

std::string json_span(Span span, const Sources &sources) {
    const Source &source = sources[span.source];
    Position begin = position(source, span.begin), end = position(source, span.end);
    return fmt::format(
        R"({{"file": {}, "line": {}, "column": {}, "end_line": {}, "end_column": {}}})",
        for_json(source.name), begin.line, begin.column, end.line, end.column);
}

std::string json_point(const std::array<double, 3> &point) {
    return fmt::format("[{}, {}, {}]", json_number(point[0]), json_number(point[1]),
                       json_number(point[2]));
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

std::string json_axioms(const Compilation &compilation) {
    std::string out;
    for (const ir::Axiom &axiom : compilation.scene.axioms)
        out += fmt::format(R"({}{{"kind": "{}", "says": {}, "span": {}}})", out.empty() ? "" : ", ",
                           axiom_kind(axiom.kind), for_json(axiom.says),
                           axiom.at.source ? json_span(axiom.at, compilation.sources) : "null");
    return out;
}

} // namespace

std::string verdict_json(const Compilation &compilation) {
    std::string shapes, diagnostics, axioms, bounds = "null";
    Verdict verdict;
    if (compilation.good()) {
        const ir::Scene &scene = compilation.scene;
        verdict = judge(scene);
        if (scene.bounds.finite())
            bounds =
                fmt::format("[{}, {}]", json_point(scene.bounds.lo), json_point(scene.bounds.hi));
        axioms = json_axioms(compilation);
        for (const ir::TopLevel &top : scene.top_level) {
            const ir::ShapeFact &fact = scene.facts[top.shape.index];
            shapes +=
                fmt::format(R"({}{{"span": {}, "lipschitz": {}, "status": "{}", "exact": {}}})",
                            shapes.empty() ? "" : ", ", json_span(top.span, compilation.sources),
                            json_number(fact.lipschitz_sup), status_name(fact.status),
                            fact.kind == ir::FieldKind::Exact);
        }
    } else {
        verdict.exact = false;
        verdict.status = ir::ProofStatus::Estimated;
    }
    for (const Diagnostic &diagnostic : compilation.diagnostics.sorted())
        diagnostics += (diagnostics.empty() ? "" : ", ") + to_json(diagnostic, compilation.sources);
    return fmt::format(
        R"({{"ok": {}, "lipschitz": {}, "status": "{}", "exact": {}, "bounds": {}, "shapes": [{}], "axioms": [{}], "diagnostics": [{}]}})"
        "\n",
        compilation.good(), json_number(verdict.lipschitz), status_name(verdict.status),
        verdict.exact, bounds, shapes, axioms, diagnostics);
}

} // namespace fathom::driver
