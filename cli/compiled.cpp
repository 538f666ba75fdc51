#include "cli/compiled.h"

#include "cli/outputs.h"

#include <fmt/format.h>

namespace fathom::cli {

driver::CompileOptions compile_options(const SceneArguments &scene) {
    driver::CompileOptions options;
    options.include_folders = scene.include_folders;
    for (const Definition &set : scene.overrides) options.overrides.push_back({set.name, set.text});
    options.limits = scene.limits;
    options.strict_proof = scene.strict_proof;
    return options;
}

driver::CompileOptions compile_options(const SceneArguments &scene, double first, double last) {
    driver::CompileOptions options = compile_options(scene);
    options.times = {first, last};
    return options;
}

void print_diagnostics(const Diagnostics &diagnostics, const Sources &sources, Terminal &terminal) {
    for (const Diagnostic &diagnostic : diagnostics.sorted())
        terminal.say_text(to_text(diagnostic, sources, terminal.color()));
    if (diagnostics.dropped() > 0)
        terminal.say(fmt::format("({} more are not shown)", diagnostics.dropped()));
}

Exit report(const driver::Compilation &compilation, const SceneArguments &scene,
            Terminal &terminal) {
    if (!compilation.unreadable.empty()) {
        terminal.say(
            fmt::format("fathom: cannot read `{}`: {}", scene.file, compilation.unreadable));
        return device_error;
    }
    print_diagnostics(compilation.diagnostics, compilation.sources, terminal);
    for (const std::string &error : compilation.usage_errors) terminal.say("fathom: " + error);
    if (compilation.diagnostics.has_errors()) return scene_error;
    return compilation.usage_errors.empty() ? done : usage_error;
}

bool in_proved_time(const ir::Scene &scene, double first, double last, Terminal &terminal) {
    v1::Facts facts;
    facts.time_end = scene.render.time_end;
    facts.reads_time = scene.graph.reads(scene.graph.function(scene.distance).result).time;
    return in_proved_time(facts, first, last, terminal);
}

bool overwrites(const driver::Compilation &compilation, const std::string &out,
                Terminal &terminal) {
    std::vector<std::filesystem::path> files;
    for (const auto &[file, stamp] : compilation.files)
        if (stamp.exists) files.push_back(file);
    return overwrites(files, out, terminal);
}

} // namespace fathom::cli
