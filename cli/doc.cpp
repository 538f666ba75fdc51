// fathom doc: the library's entry of a name, as its doc comment says it; without a name the list of
// all.
#include "base/suggest.h"
#include "cli/terminal.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

std::string first_line(std::string_view doc) { return std::string(doc.substr(0, doc.find('\n'))); }

} // namespace

Exit run(const DocCommand &command, Terminal &terminal) {
    std::vector<typecheck::LibraryEntry> entries =
        typecheck::library_entries(driver::standard_library());
    std::vector<std::string> names;
    bool found = false;
    for (const typecheck::LibraryEntry &entry : entries) {
        const std::string module = entry.module.empty() ? "" : entry.module + ".";
        const std::string name = module + entry.name;
        if (command.name.empty()) {
            terminal.put(fmt::format("{:<28} {}\n", name, first_line(entry.doc)));
        } else if (name == command.name || entry.name == command.name) {
            terminal.put(fmt::format("{}{}{}\n\n{}\n", found ? "\n" : "", module, entry.signature,
                                     entry.doc));
            found = true;
        }
        names.push_back(name);
    }
    if (command.name.empty() || found) return done;
    std::string near = nearest_name(command.name, names);
    terminal.say(fmt::format("fathom: the library has no `{}`{}", command.name,
                             near.empty() ? "; `fathom doc` lists its names"
                                          : fmt::format("; did you mean `{}`?", near)));
    return usage_error;
}

} // namespace fathom::cli
