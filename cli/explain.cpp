// fathom explain: a diagnostic's page; without a code the list of all.
#include "base/suggest.h"
#include "cli/terminal.h"
#include "driver/pages.h"

#include <fmt/format.h>

namespace fathom::cli {

Exit run(const ExplainCommand &command, Terminal &terminal) {
    terminal.page();
    if (command.code.empty()) {
        for (Code code : all_codes())
            terminal.put(fmt::format("{:<22} {}\n", code_name(code), code_summary(code)));
        return done;
    }
    for (auto [file, text] : driver::diagnostic_pages()) {
        if (file != command.code + ".md") continue;
        terminal.put(text);
        return done;
    }
    std::vector<std::string> names;
    for (Code code : all_codes()) names.emplace_back(code_name(code));
    std::string near = nearest_name(command.code, names);
    terminal.say(fmt::format("fathom: there is no code `{}`{}", command.code,
                             near.empty() ? "; `fathom explain` lists them"
                                          : fmt::format("; did you mean `{}`?", near)));
    return usage_error;
}

} // namespace fathom::cli
