// fathom view: the window. What can be said before one opens is said here.
#include "cli/terminal.h"
#include "viewer/viewer.h"

#include <fmt/format.h>

namespace fathom::cli {

Exit run(const ViewCommand &command, Terminal &terminal) {
    if (command.scene.file == "-") {
        terminal.say("fathom: view follows a file, and standard input is none");
        return usage_error;
    }
    {
        // A wrong file name or -D is told at once; an error of the scene is shown in the window,
        // until it is mended.
        driver::Compilation first =
            driver::compile_file(command.scene.file, compile_options(command.scene));
        if (!first.unreadable.empty() || !first.usage_errors.empty())
            return report(first, command.scene, terminal);
    }
    viewer::Settings settings;
    settings.file = command.scene.file;
    settings.options = compile_options(command.scene);
    settings.width = command.width;
    settings.height = command.height;
    settings.record = command.record;
    settings.save_view = command.save_view;
    settings.still = command.still;
    settings.one_context = command.one_context;
    if (command.times) settings.tell = [&](const std::string &line) { terminal.say(line); };
    std::string error = viewer::run(settings);
    if (error.empty()) return done;
    terminal.say("fathom: " + error);
    return device_error;
}

} // namespace fathom::cli
