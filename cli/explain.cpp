// fathom explain: a diagnostic's page; without a code the list of all.
#include "base/suggest.h"
#include "cli/terminal.h"

#include <fathom/reference.h>

#include <fmt/format.h>

namespace fathom::cli {

Exit run(const ExplainCommand &command, Terminal &terminal) {
    terminal.page();
    std::vector<std::string> names;
    for (const v1::DiagnosticCode &code : v1::diagnostic_codes()) {
        if (command.code.empty()) terminal.put(fmt::format("{:<22} {}\n", code.name, code.summary));
        if (command.code == code.name) {
            terminal.put(code.page);
            return done;
        }
        names.push_back(code.name);
    }
    if (command.code.empty()) return done;
    std::string near = nearest_name(command.code, names);
    terminal.say(fmt::format("fathom: there is no code `{}`{}", command.code,
                             near.empty() ? "; `fathom explain` lists them"
                                          : fmt::format("; did you mean `{}`?", near)));
    return usage_error;
}

} // namespace fathom::cli
