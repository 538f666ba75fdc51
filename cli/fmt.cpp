// fathom fmt: the one style. Writes only what changes; a file with a syntax error is left alone.
#include "cli/diff.h"
#include "cli/outputs.h"

#include <fathom/files.h>
#include <fathom/scene.h>

#include <algorithm>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

constexpr std::size_t max_source_bytes = Limits{}.source * mebibyte;

Exit format_file(const std::string &file, const FmtCommand &command, Terminal &terminal) {
    bool standard_input = file == "-";
    std::string error;
    std::optional<std::string> text = standard_input
                                          ? v1::read_standard_input(max_source_bytes, error)
                                          : v1::read_file(file, max_source_bytes, error);
    if (!text) {
        terminal.say(fmt::format("fathom: cannot read `{}`: {}", file, error));
        return device_error;
    }
    const v1::Formatted result = v1::format_text(standard_input ? "<stdin>" : file, *text);
    if (!result.text) {
        print_diagnostics(result.diagnostics, result.dropped, result.texts, terminal);
        return scene_error;
    }
    const std::string &formatted = *result.text;
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
