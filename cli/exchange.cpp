// fathom import and fathom export: the YAML save format, both ways.
#include "cli/outputs.h"
#include "save-format/save_format.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

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
    std::optional<std::string> text =
        standard_input ? driver::read_standard_input(driver::max_save_bytes, error)
                       : driver::read_file(command.file, driver::max_save_bytes, error);
    if (!text) {
        terminal.say(fmt::format("fathom: cannot read `{}`: {}", command.file, error));
        return device_error;
    }
    Sources sources;
    Diagnostics diagnostics;
    SourceId source = sources.add(standard_input ? "<stdin>" : command.file, std::move(*text));
    save::ImportOptions options;
    options.strict = command.strict;
    if (!standard_input && !command.out.empty() && command.out != "-")
        options.asset_prefix = way(command.out, command.file);
    const bool to_file = !command.out.empty() && command.out != "-";
    driver::leave_out_unusable(sources[source].name, sources[source].text,
                               to_file ? command.out : command.file, options);
    save::ImportResult result = save::import_yaml(sources, source, diagnostics, options);
    print_diagnostics(diagnostics, sources, terminal);
    bool write = !diagnostics.has_errors() || (command.partial && result.structural_error);
    if (write) {
        Exit exit = write_result(command.out, result.sdf, terminal);
        if (exit != done) return exit;
    } else if (result.structural_error) {
        terminal.say(
            fmt::format("fathom: nothing was written; --partial writes the {} nodes that were read",
                        result.nodes));
    }
    return diagnostics.has_errors() ? scene_error : done;
}

Exit run(const ExportCommand &command, Terminal &terminal) {
    if (overwrites(command.scene.file, command.out, terminal) ||
        misnamed(command.out, Content::SaveFile, terminal))
        return usage_error;
    driver::Compilation compilation =
        driver::compile_file(command.scene.file, compile_options(command.scene));
    Exit exit = report(compilation, command.scene, terminal);
    if (exit != done) return exit;
    if (overwrites(compilation, command.out, terminal)) return usage_error;
    Diagnostics diagnostics;
    std::string yaml = save::export_yaml(compilation.scene, diagnostics);
    print_diagnostics(diagnostics, compilation.sources, terminal);
    return diagnostics.has_errors() ? scene_error : write_result(command.out, yaml, terminal);
}

} // namespace fathom::cli
