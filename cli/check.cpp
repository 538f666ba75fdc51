// fathom check: parses, types, proves; says what it found to people, or to editors as JSON.
#include "base/text.h"
#include "cli/terminal.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

// What `check` says of a whole scene (semantics.md, 19): the largest bound before division, the worst status.
struct Verdict {
    std::optional<double> lipschitz; // none: no shape, or no bound
    ir::ProofStatus status = ir::ProofStatus::Proved;
    bool exact = true;
};

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

std::string json_number(std::optional<double> number) {
    return number && std::isfinite(*number) ? format_shortest(*number) : "null";
}

std::string json_span(Span span, const Sources &sources) {
    const Source &source = sources[span.source];
    Position begin = position(source, span.begin), end = position(source, span.end);
    return fmt::format(R"({{"file": {}, "line": {}, "column": {}, "end_line": {}, "end_column": {}}})",
                       json_string(source.name), begin.line, begin.column, end.line, end.column);
}

std::string json_point(const std::array<double, 3> &point) {
    return fmt::format("[{}, {}, {}]", json_number(point[0]), json_number(point[1]), json_number(point[2]));
}

std::string json(const driver::Compilation &compilation) {
    std::string shapes, diagnostics, bounds = "null";
    Verdict verdict;
    if (compilation.good()) {
        const ir::Scene &scene = compilation.scene;
        verdict = judge(scene);
        if (scene.bounds.finite())
            bounds = fmt::format("[{}, {}]", json_point(scene.bounds.lo), json_point(scene.bounds.hi));
        for (const ir::TopLevel &top : scene.top_level) {
            const ir::ShapeFact &fact = scene.facts[top.shape.index];
            shapes += fmt::format(R"({}{{"span": {}, "lipschitz": {}, "status": "{}", "exact": {}}})",
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
        R"({{"ok": {}, "lipschitz": {}, "status": "{}", "exact": {}, "bounds": {}, "shapes": [{}], "diagnostics": [{}]}})"
        "\n",
        compilation.good(), json_number(verdict.lipschitz), status_name(verdict.status), verdict.exact, bounds, shapes,
        diagnostics);
}

std::string verdict_line(const driver::Compilation &compilation, const std::string &file) {
    Verdict verdict = judge(compilation.scene);
    return fmt::format("{}: ok, {}{}{}", file, status_name(verdict.status),
                       verdict.lipschitz ? fmt::format(", lipschitz {:.6g}", *verdict.lipschitz) : "",
                       verdict.exact ? ", exact" : "");
}

Exit say(const CheckCommand &command, const driver::Compilation &compilation, Terminal &terminal) {
    if (!command.json || !compilation.unreadable.empty() || !compilation.usage_errors.empty()) {
        Exit exit = report(compilation, command.scene, terminal);
        if (exit != done) return exit;
        if (!command.json) terminal.say(verdict_line(compilation, command.scene.file));
    }
    if (command.json) terminal.put(json(compilation));
    return compilation.good() ? done : scene_error;
}

} // namespace

Exit run(const CheckCommand &command, Terminal &terminal) {
    auto act = [&](const driver::Compilation &compilation) { return say(command, compilation, terminal); };
    if (command.watch) return watch_scene(command.scene, terminal, act);
    return act(driver::compile_file(command.scene.file, compile_options(command.scene)));
}

} // namespace fathom::cli
