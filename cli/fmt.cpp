// fathom fmt: the one style. Writes only what changes; a file with a syntax error is left alone.
#include "cli/diff.h"
#include "cli/outputs.h"
#include "lang/format.h"
#include "lang/parse.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

Exit format_file(const std::string &file, const FmtCommand &command, Terminal &terminal) {
    bool standard_input = file == "-";
    std::string error;
    std::optional<std::string> text =
        standard_input ? driver::read_standard_input(driver::max_source_bytes, error)
                       : driver::read_file(file, driver::max_source_bytes, error);
    if (!text) {
        terminal.say(fmt::format("fathom: cannot read `{}`: {}", file, error));
        return device_error;
    }
    Sources sources;
    Diagnostics diagnostics;
    SourceId source = sources.add(standard_input ? "<stdin>" : file, *text);
    lang::Ast ast = lang::parse(sources, source, diagnostics);
    if (diagnostics.has_errors()) {
        print_diagnostics(diagnostics, sources, terminal);
        return scene_error;
    }
    std::string formatted = lang::format(sources, ast);
    if (command.check || command.diff) {
        if (formatted == *text) return done;
        terminal.put(command.check ? file + "\n" : unified_diff(file, *text, formatted));
        return scene_error;
    }
    if (standard_input) {
        terminal.put(formatted);
        return done;
    }
    return formatted == *text ? done : write_result(file, formatted, terminal);
}

} // namespace

Exit run(const FmtCommand &command, Terminal &terminal) {
    Exit worst = done;
    for (const std::string &file : command.files)
        worst = std::max(worst, format_file(file, command, terminal));
    return worst;
}

} // namespace fathom::cli
