// fathom view: the window. What can be said before one opens is said here.
#include "cli/terminal.h"
#include "viewer/viewer.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

// A scene that an editor is about to write: its folder is there, and nothing of its name.
bool to_come(const std::string &file) {
    std::error_code none;
    std::filesystem::path path = std::filesystem::absolute(file, none);
    const std::string suffix = path.extension().string();
    return (suffix == ".sdf" || suffix == ".yaml" || suffix == ".yml") &&
           std::filesystem::is_directory(path.parent_path(), none) &&
           std::filesystem::symlink_status(path, none).type() ==
               std::filesystem::file_type::not_found;
}

} // namespace

Exit run(const ViewCommand &command, Terminal &terminal) {
    if (command.scene.file == "-") {
        terminal.say("fathom: view follows a file, and standard input is none");
        return usage_error;
    }
    // A wrong file name or -D is told at once; an error of the scene is shown in the window, until it
    // is fixed.
    if (to_come(command.scene.file))
        terminal.say(fmt::format("fathom: there is no `{}` yet; the window waits for it",
                                 command.scene.file));
    else if (const v1::CompileResult first =
                 v1::compile_file(command.scene.file, library_options(command.scene));
             !first && is_about_no_text(first))
        return report(first, terminal);
    viewer::Settings settings;
    settings.file = command.scene.file;
    settings.include_folders = command.scene.include_folders;
    for (const Definition &value : command.scene.overrides)
        settings.values.emplace_back(value.name, value.text);
    settings.limits = command.scene.limits;
    settings.strict_proof = command.scene.strict_proof;
    settings.width = command.width;
    settings.height = command.height;
    settings.record = command.record;
    settings.editor = command.editor;
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
