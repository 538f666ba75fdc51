// fathom doc: the library's entry of a name, as its doc comment says it; without a name the list of
// all by groups, or of those that hold the words that are searched for. With --json the whole
// vocabulary, which the grammars of editors are made from.
#include "base/suggest.h"
#include "cli/terminal.h"

#include <fathom/reference.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

using v1::LibraryEntry;

std::string first_line(std::string_view doc) { return std::string(doc.substr(0, doc.find('\n'))); }

std::string whole_name(const LibraryEntry &entry) {
    return (entry.module.empty() ? "" : entry.module + ".") + entry.name;
}

std::string lower(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

bool holds(const LibraryEntry &entry, const std::vector<std::string> &words) {
    const std::string text = lower(whole_name(entry) + "\n" + entry.doc);
    return std::ranges::all_of(
        words, [&](const std::string &word) { return text.find(lower(word)) != text.npos; });
}

// An entry's group is the file of the library that defines it.
std::string group_of(const LibraryEntry &entry) {
    const std::string group = std::filesystem::path(entry.file).stem().string();
    return group.empty() ? "built in" : group;
}

bool list(const std::vector<LibraryEntry> &entries, const std::vector<std::string> &words,
          Terminal &terminal) {
    std::string group, last;
    for (const LibraryEntry &entry : entries) {
        if (!holds(entry, words)) continue;
        if (group != group_of(entry)) {
            terminal.put((group.empty() ? "" : "\n") + group_of(entry) + ":\n");
            group = group_of(entry);
        }
        if (whole_name(entry) == last) continue; // another form of the same
        last = whole_name(entry);
        terminal.put(fmt::format("  {:<26} {}\n", last, first_line(entry.doc)));
    }
    return !group.empty();
}

using Json = nlohmann::ordered_json;

Json constants() {
    Json all = Json::array();
    for (const v1::LibraryConstant &constant : v1::library_constants()) {
        Json entry{{"name", constant.name}, {"type", constant.type}};
        if (constant.rgb) entry["color"] = fmt::format("#{:06x}", *constant.rgb);
        all.push_back(std::move(entry));
    }
    return all;
}

// Of one name, or of all where it is empty; false where there is none.
bool put_json(const std::vector<LibraryEntry> &entries, const std::string &name,
              Terminal &terminal) {
    Json functions = Json::array(), whole = Json::object();
    for (const LibraryEntry &entry : entries)
        if (name.empty() || name == entry.name || name == whole_name(entry))
            functions.push_back({{"name", entry.name},
                                 {"module", entry.module},
                                 {"signature", entry.signature},
                                 {"doc", entry.doc}});
    if (name.empty()) {
        const v1::Vocabulary words = v1::vocabulary();
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
    const std::vector<LibraryEntry> entries = v1::library_entries();
    if (command.json && put_json(entries, command.name, terminal)) return done;
    terminal.page();
    if (command.name.empty()) {
        if (list(entries, command.search, terminal)) return done;
        terminal.say("fathom: no entry of the library holds these words; `fathom doc` lists all");
        return usage_error;
    }
    std::vector<std::string> names;
    bool found = false;
    for (const LibraryEntry &entry : entries) {
        const std::string name = whole_name(entry);
        names.push_back(name);
        if (name != command.name && entry.name != command.name) continue;
        const std::string module = entry.module.empty() ? "" : entry.module + ".";
        terminal.put(
            fmt::format("{}{}{}\n\n{}\n", found ? "\n" : "", module, entry.signature, entry.doc));
        found = true;
    }
    if (found) return done;
    const std::string near = nearest_name(command.name, names);
    terminal.say(fmt::format(
        "fathom: the library has no `{}`; {}`fathom doc` lists its names, "
        "`fathom doc --search {}` looks in their texts",
        command.name, near.empty() ? "" : fmt::format("did you mean `{}`? ", near), command.name));
    return usage_error;
}

} // namespace fathom::cli
