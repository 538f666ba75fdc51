// fathom import and fathom export: the YAML save format, both ways.
#include "cli/outputs.h"

#include <fathom/files.h>
#include <fathom/save_format.h>

#include <fmt/format.h>

namespace fathom::cli {
namespace {

constexpr std::size_t max_save_bytes = 16 * Limits{}.source * mebibyte;

// The way from the folder of one file to that of another, with a slash at its end, or empty where
// they are the same.
std::string way(const std::filesystem::path &from_file, const std::filesystem::path &to_file) {
    std::error_code error;
    std::filesystem::path from = std::filesystem::absolute(from_file, error).parent_path();
    std::filesystem::path to = std::filesystem::absolute(to_file, error).parent_path();
    std::filesystem::path path = to.lexically_normal().lexically_relative(from.lexically_normal());
    return path == "." || path.empty() ? "" : path.string() + "/";
}

} // namespace

Exit run(const ImportCommand &command, Terminal &terminal) {
    if (overwrites(command.file, command.out, terminal) ||
        misnamed(command.out, Content::Scene, terminal))
        return usage_error;
    bool standard_input = command.file == "-";
    std::string error;
    std::optional<std::string> text = standard_input
                                          ? v1::read_standard_input(max_save_bytes, error)
                                          : v1::read_file(command.file, max_save_bytes, error);
    if (!text) {
        terminal.say(fmt::format("fathom: cannot read `{}`: {}", command.file, error));
        return device_error;
    }
    const bool to_file = !command.out.empty() && command.out != "-";
    v1::ImportOptions options;
    options.strict = command.strict;
    if (!standard_input && to_file) options.asset_prefix = way(command.out, command.file);
    options.scene = to_file ? command.out : command.file;
    const v1::Imported result =
        v1::import_yaml(standard_input ? "<stdin>" : command.file, *text, options);
    print_diagnostics(result.diagnostics, result.dropped, result.texts, terminal);
    const bool errors = has_errors(result.diagnostics);
    if (!errors || (command.partial && !result.complete)) {
        Exit exit = write_result(command.out, result.text, terminal);
        if (exit != done) return exit;
    } else if (!result.complete) {
        terminal.say(
            fmt::format("fathom: nothing was written; --partial writes the {} nodes that were read",
                        result.nodes));
    }
    return errors ? scene_error : done;
}

Exit run(const ExportCommand &command, Terminal &terminal) {
    if (overwrites(command.scene.file, command.out, terminal) ||
        misnamed(command.out, Content::SaveFile, terminal))
        return usage_error;
    const v1::CompileResult result =
        v1::compile_file(command.scene.file, library_options(command.scene));
    if (const Exit exit = report(result, terminal); exit != done) return exit;
    if (overwrites(result.files, command.out, terminal)) return usage_error;
    std::vector<v1::Diagnostic> diagnostics;
    v1::ExportOptions options;
    if (!command.out.empty() && command.out != "-") options.out = command.out;
    const std::string yaml = v1::export_yaml(*result.scene, options, &diagnostics);
    print_diagnostics(diagnostics, 0, result.texts, terminal);
    return has_errors(diagnostics) ? scene_error : write_result(command.out, yaml, terminal);
}

} // namespace fathom::cli
