// fathom check: parses, types, proves; says what it found to people, or to editors as JSON.
#include "cli/terminal.h"
#include "driver/verdict.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

std::string verdict_line(const driver::Compilation &compilation, const std::string &file) {
    driver::Verdict verdict = driver::judge(compilation.scene);
    return fmt::format("{}: ok, {}{}{}", file, driver::status_name(verdict.status),
                       verdict.lipschitz ? fmt::format(", lipschitz {:.6g}", *verdict.lipschitz) : "",
                       verdict.exact ? ", exact" : "");
}

Exit say(const CheckCommand &command, const driver::Compilation &compilation, Terminal &terminal) {
    if (!command.json || !compilation.unreadable.empty() || !compilation.usage_errors.empty()) {
        Exit exit = report(compilation, command.scene, terminal);
        if (exit != done) return exit;
        if (!command.json) terminal.say(verdict_line(compilation, command.scene.file));
    }
    if (command.json) terminal.put(driver::verdict_json(compilation));
    return compilation.good() ? done : scene_error;
}

} // namespace

Exit run(const CheckCommand &command, Terminal &terminal) {
    auto act = [&](const driver::Compilation &compilation) { return say(command, compilation, terminal); };
    if (command.watch) return watch_scene(command.scene, terminal, act);
    return act(driver::compile_file(command.scene.file, compile_options(command.scene)));
}

} // namespace fathom::cli
