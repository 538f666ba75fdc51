// fathom check: parses, types, proves; says what it found to people, or to editors as JSON.
#include "base/encode.h"
#include "cli/terminal.h"

#include <fathom/explain.h>

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <new>

namespace fathom::cli {
namespace {

std::string_view word_of(v1::Status status) {
    switch (status) {
    case v1::Status::Proved: return "proved";
    case v1::Status::Assumed: return "assumed";
    case v1::Status::Estimated: return "estimated";
    }
    return "";
}

// Where an assumed bound is not the one that was stated: that one, and what makes it another.
std::string of_stated(const v1::Scene &scene) {
    const std::optional<v1::Explanation> root = v1::explain(scene);
    if (!root) throw std::bad_alloc();
    std::string steps;
    const v1::Explanation *at = &*root;
    for (const v1::Explanation *next = at; next;) {
        at = next, next = nullptr;
        for (const v1::Explanation &child : at->children)
            if (child.steepest) next = &child;
        if (next && std::abs(at->factor - 1) > 1e-6)
            steps = fmt::format("; {} makes it {:.4g} times as much: {}", at->operation, at->factor,
                                at->rule) +
                    steps;
    }
    if (at->rule != "assumed" || steps.empty()) return "";
    return fmt::format(" ({:.6g} is stated{})", at->lipschitz, steps);
}

std::string verdict_line(const v1::CompileResult &result, const std::string &file, bool given) {
    const v1::Facts &facts = result.scene->facts();
    const bool at_values =
        (given && !result.scene->params().empty()) ||
        std::ranges::count(result.diagnostics, "range-unproved", &v1::Diagnostic::code) > 0;
    const std::string stated =
        facts.status == v1::Status::Assumed ? of_stated(*result.scene) : std::string();
    return fmt::format("{}: ok, {}{}{}{}{}", file, word_of(facts.status),
                       at_values ? " at the present values" : "",
                       facts.lipschitz ? fmt::format(", lipschitz {:.6g}", *facts.lipschitz) : "",
                       stated, facts.exact ? ", exact" : "");
}

// A line for an operation: what it is, the bound after it, what it does to its children's, and
// where it was written.
// `*` marks the chain of the steepest.
void explain(const v1::Explanation &node, const std::string &lead, const std::string &below,
             Terminal &terminal) {
    std::string line = fmt::format("{}{} {}: {:.4g}", lead, node.steepest ? "*" : " ",
                                   node.operation, node.lipschitz);
    if (std::abs(node.factor - 1) > 1e-9) line += fmt::format(" (x {:.4g})", node.factor);
    if (node.share > 0.005) line += fmt::format(", {:.0f} % of the bound", 100 * node.share);
    if (!node.rule.empty()) line += ", " + node.rule;
    if (!node.region.empty() && node.region != "everywhere") line += ", in " + node.region;
    if (node.at.line > 0) line += fmt::format("  [{}:{}]", node.at.file, node.at.line);
    terminal.put(for_terminal(line) + "\n");
    for (std::size_t i = 0; i < node.children.size(); ++i) {
        bool last = i + 1 == node.children.size();
        explain(node.children[i], below + (last ? "`-" : "|-"), below + (last ? "  " : "| "),
                terminal);
    }
}

// What the bound rests on beside the proof, an entry of the library a line.
void explain_axioms(const v1::Facts &facts, Terminal &terminal) {
    if (facts.axioms.empty()) terminal.put("rests on no axiom\n");
    for (const std::string &axiom : facts.axioms)
        terminal.put(for_terminal(fmt::format("rests on {}", axiom)) + "\n");
}

void explain_params(const v1::Scene &scene, Terminal &terminal) {
    for (const v1::Param &param : scene.params())
        terminal.put(fmt::format(
            "param {}: {}\n", param.name,
            param.structural ? "each value is a scene of its own: moving it builds the scene anew"
                             : "a number of the shader: moving it costs nothing"));
}

void explain_pruning(const v1::Scene &scene, Terminal &terminal) {
    const v1::Pruning pruning = v1::pruning(scene);
    terminal.put(fmt::format(
        "pruning: {}, with {:.0f} shapes to choose from\n",
        pruning.by_cells ? "the processor computes for each cell of space what can matter there"
                         : "not worth it",
        pruning.shapes));
    for (int rows : pruning.rows)
        terminal.put(fmt::format("a loop over {} rows: where GL 4.3 draws, each cell of "
                                 "space has a list of those that can matter in it, or "
                                 "one number if none is near\n",
                                 rows));
}

void explain(const v1::Scene &scene, Terminal &terminal) {
    const std::optional<v1::Explanation> root = v1::explain(scene);
    if (!root) throw std::bad_alloc();
    explain(*root, "", "", terminal);
    explain_axioms(scene.facts(), terminal);
    explain_params(scene, terminal);
    explain_pruning(scene, terminal);
}

// Whether the params' present values alone are proved.
bool are_values_given(const CheckCommand &command) {
    return command.time || !command.scene.overrides.empty();
}

Exit say(const CheckCommand &command, const SceneArguments &scene, const v1::CompileResult &result,
         Terminal &terminal) {
    if (!command.json || is_about_no_text(result)) {
        const Exit exit = report(result, terminal);
        if (exit != done) {
            if (command.json) terminal.put(v1::verdict_json(result));
            return exit;
        }
        if (command.explain) explain(*result.scene, terminal);
        if (!command.json)
            terminal.say(verdict_line(result, scene.file, are_values_given(command)));
    }
    if (command.json) terminal.put(v1::verdict_json(result));
    return result ? done : scene_error;
}

} // namespace

Exit run(const CheckCommand &command, Terminal &terminal) {
    Exit worst = done;
    for (const std::string &file : command.files) {
        SceneArguments scene = command.scene;
        scene.file = file;
        const auto act = [&](const v1::CompileResult &result) {
            const bool beyond =
                result && command.time &&
                !in_proved_time(result.scene->facts(), *command.time, *command.time, terminal);
            return beyond ? usage_error : say(command, scene, result, terminal);
        };
        v1::CompileOptions options = library_options(scene);
        if (are_values_given(command))
            options.times = {command.time.value_or(0),
                             command.time.value_or(std::numeric_limits<double>::infinity())};
        worst = std::max(worst, command.watch ? watch_scene(scene, options, terminal, act)
                                              : act(v1::compile_file(file, options)));
    }
    return worst;
}

} // namespace fathom::cli
