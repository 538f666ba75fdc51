// fathom check: parses, types, proves; says what it found to people, or to editors as JSON.
#include "backend-cpu/trace/march.h"
#include "backend-glsl/emit.h"
#include "base/encode.h"
#include "cli/terminal.h"
#include "driver/verdict.h"
#include "proof/prove.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

std::string verdict_line(const driver::Compilation &compilation, const std::string &file) {
    driver::Verdict verdict = driver::judge(compilation.scene);
    return fmt::format("{}: ok, {}{}{}", file, driver::status_name(verdict.status),
                       verdict.lipschitz ? fmt::format(", lipschitz {:.6g}", *verdict.lipschitz)
                                         : "",
                       verdict.exact ? ", exact" : "");
}

// A line for an operation: what it is, the bound after it, what it does to its children's, and
// where it was written.
// `*` marks the chain of the steepest.
void explain(const proof::Explanation &node, const Sources &sources, const std::string &lead,
             const std::string &below, Terminal &terminal) {
    std::string line = fmt::format("{}{} {}: {:.4g}", lead, node.worst ? "*" : " ", node.operation,
                                   node.lipschitz);
    if (std::abs(node.factor - 1) > 1e-9) line += fmt::format(" (x {:.4g})", node.factor);
    if (node.share > 0.005) line += fmt::format(", {:.0f} % of the bound", 100 * node.share);
    if (!node.rule.empty()) line += ", " + node.rule;
    if (!node.region.empty() && node.region != "everywhere") line += ", in " + node.region;
    if (node.place.source) {
        const Source &source = sources[node.place.source];
        line += fmt::format("  [{}:{}]", source.name, position(source, node.place.begin).line);
    }
    terminal.put(for_terminal(line) + "\n");
    for (std::size_t i = 0; i < node.children.size(); ++i) {
        bool last = i + 1 == node.children.size();
        explain(node.children[i], sources, below + (last ? "`-" : "|-"),
                below + (last ? "  " : "| "), terminal);
    }
}

// What the bound rests on beside the proof, an entry of the library a line.
void explain_axioms(const ir::Scene &scene, Terminal &terminal) {
    if (scene.axioms.empty()) terminal.put("rests on no axiom\n");
    for (const ir::Axiom &axiom : scene.axioms)
        terminal.put(for_terminal(fmt::format("rests on {}", axiom.says)) + "\n");
}

void explain_params(const ir::Scene &scene, Terminal &terminal) {
    for (const ir::Param &param : scene.params)
        terminal.put(fmt::format("param {}: {}\n", param.name,
                                 param.structural
                                     ? "decides what there is: moving it builds the scene anew"
                                     : "a number of the shader: moving it costs nothing"));
}

// Which cells hold which shapes is found while a picture is drawn; whether it will be is known now.
void explain_pruning(const ir::Scene &scene, Terminal &terminal) {
    const float shapes = cpu::shapes_of(scene);
    terminal.put(
        fmt::format("pruning: {}, with {:.0f} shapes to choose from\n",
                    shapes >= cpu::prune_from
                        ? "the processor computes for each cell of space what can matter there"
                        : "not worth it",
                    shapes));
}

Exit say(const CheckCommand &command, const SceneArguments &scene,
         const driver::Compilation &compilation, Terminal &terminal) {
    if (!command.json || !compilation.unreadable.empty() || !compilation.usage_errors.empty()) {
        Exit exit = report(compilation, scene, terminal);
        if (exit != done) return exit;
        if (command.explain) {
            explain(proof::explain(compilation.scene), compilation.sources, "", "", terminal);
            explain_axioms(compilation.scene, terminal);
            explain_params(compilation.scene, terminal);
            explain_pruning(compilation.scene, terminal);
            for (int rows : glsl::prunable_rows(compilation.scene))
                terminal.put(fmt::format("a loop over {} rows: where GL 4.3 draws, each cell of "
                                         "space has a list of those that can matter in it, or "
                                         "one number if none is near\n",
                                         rows));
        }
        if (!command.json) terminal.say(verdict_line(compilation, scene.file));
    }
    if (command.json) terminal.put(driver::verdict_json(compilation));
    return compilation.good() ? done : scene_error;
}

} // namespace

Exit run(const CheckCommand &command, Terminal &terminal) {
    Exit worst = done;
    for (const std::string &file : command.files) {
        SceneArguments scene = command.scene;
        scene.file = file;
        const auto act = [&](const driver::Compilation &compilation) {
            return say(command, scene, compilation, terminal);
        };
        worst = std::max(worst, command.watch
                                    ? watch_scene(scene, compile_options(scene), terminal, act)
                                    : act(driver::compile_file(file, compile_options(scene))));
    }
    return worst;
}

} // namespace fathom::cli
