// fathom doc: the library's entry of a name, as its doc comment says it; without a name the list of
// all. With --json the whole vocabulary, which the grammars of editors are made from.
#include "base/suggest.h"
#include "cli/terminal.h"
#include "lang/vocabulary.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

std::string first_line(std::string_view doc) { return std::string(doc.substr(0, doc.find('\n'))); }

using Json = nlohmann::ordered_json;

Json constants() {
    Json all = Json::array();
    for (const typecheck::LibraryConstant &constant : typecheck::library_constants()) {
        Json entry{{"name", constant.name}, {"type", constant.type}};
        if (constant.rgb) entry["color"] = fmt::format("#{:06x}", *constant.rgb);
        all.push_back(std::move(entry));
    }
    return all;
}

// Of one name, or of all where it is empty; false where there is none.
bool put_json(const std::vector<typecheck::LibraryEntry> &entries, const std::string &name,
              Terminal &terminal) {
    Json functions = Json::array(), whole = Json::object();
    for (const typecheck::LibraryEntry &entry : entries)
        if (name.empty() || name == entry.name || name == entry.module + "." + entry.name)
            functions.push_back({{"name", entry.name},
                                 {"module", entry.module},
                                 {"signature", entry.signature},
                                 {"doc", entry.doc}});
    if (name.empty()) {
        const lang::Vocabulary words = lang::vocabulary();
        whole = {{"keywords", words.keywords}, {"keywords_in_place", words.keywords_in_place},
                 {"types", words.types},       {"units", words.units},
                 {"signs", words.signs},       {"constants", constants()}};
    } else if (functions.empty())
        return false;
    whole["functions"] = std::move(functions);
    terminal.put(whole.dump(2) + "\n");
    return true;
}

} // namespace

Exit run(const DocCommand &command, Terminal &terminal) {
    std::vector<typecheck::LibraryEntry> entries =
        typecheck::library_entries(driver::standard_library());
    std::vector<std::string> names;
    bool found = command.json && put_json(entries, command.name, terminal);
    if (found) return done;
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
