// References that lead nowhere: a page or a file that does not exist, a section that the page does
// not have, a link or an anchor. Read in every page, and in the comments of every source file.
#include "repository.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cctype>

using namespace fathom::style;

namespace {

// The repository as far as references can lead: its files, and the headings of its pages.
struct Library {
    std::set<std::string> files, folders;
    std::map<std::string, Headings> pages;
};

Library read_library(const std::filesystem::path &root) {
    Library library;
    library.files = files_below(root);
    for (const std::string &file : library.files) {
        for (std::size_t at = file.find('/'); at != file.npos; at = file.find('/', at + 1))
            library.folders.insert(file.substr(0, at));
        if (file.ends_with(".md")) library.pages[file] = headings_of(lines_of(root / file));
    }
    return library;
}

std::string folder_of(const std::string &file) {
    return std::filesystem::path(file).parent_path().generic_string();
}

std::string joined(const std::string &folder, const std::string &path) {
    return (std::filesystem::path(folder) / path).lexically_normal().generic_string();
}

// A file that is named: by its path from the root or from where it is named, or by the end of its
// path. "" if there is none.
std::string resolve(const Library &library, const std::string &folder, const std::string &name) {
    for (const std::string &path : {joined("", name), joined(folder, name)})
        if (library.files.contains(path)) return path;
    for (const std::string &file : library.files)
        if (file.ends_with("/" + name)) return file;
    return "";
}

// CODE.md, of which there are many.
bool is_placeholder(const std::string &name) {
    const std::string stem = std::filesystem::path(name).stem().string();
    return std::ranges::none_of(stem, [](unsigned char c) { return std::islower(c); });
}

// Extensions of files that are the project's own wherever they are named.
bool is_source(const std::string &name) {
    const std::string extension = std::filesystem::path(name).extension().string();
    return std::set<std::string>{".md", ".h", ".cpp", ".def", ".glsl", ".cmake", ".py"}.contains(
        extension);
}

// A path below a folder of the repository: to a file, to a folder, or to a pair `NAME.h`,
// `NAME.cpp`.
bool leads_into(const Library &library, const std::string &name) {
    const std::size_t slash = name.find('/');
    return slash != name.npos && library.folders.contains(name.substr(0, slash));
}

bool exists(const Library &library, const std::string &folder, std::string name) {
    while (name.ends_with("/")) name.pop_back();
    return !resolve(library, folder, name).empty() || library.folders.contains(name) ||
           library.files.contains(name + ".h") || library.files.contains(name + ".cpp");
}

// The prose of a file as one text, with what stands in the way of a search taken out.
struct Running {
    std::string text;
    std::vector<std::pair<std::size_t, int>> begins; // where each line begins

    int line(std::size_t at) const {
        auto next = std::ranges::upper_bound(begins, at, {}, &std::pair<std::size_t, int>::first);
        return next == begins.begin() ? 0 : std::prev(next)->second;
    }
};

Running running(const std::string &path, const std::vector<std::string> &lines) {
    Running all;
    for (const ProseLine &line : prose_of(path, lines)) {
        all.begins.push_back({all.text.size(), line.line});
        const std::size_t begin = line.text.find_first_not_of(" \t");
        if (begin != line.text.npos) all.text += line.text.substr(begin);
        all.text += ' ';
    }
    return all;
}

bool in_path(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' || c == '-' || c == '.' ||
           c == '/';
}

// The section numbers that follow a page's name: "9", "2 and 11", "1 to 8" in
// "page.md, 1 to 8".
std::vector<std::string> sections_after(const std::string &text, std::size_t at) {
    std::vector<std::string> sections;
    if (at < text.size() && text[at] == '`') ++at;
    for (std::string_view join : {", ", " and ", " to "}) {
        if (text.compare(at, join.size(), join) != 0) continue;
        std::size_t end = at + join.size();
        while (end < text.size() &&
               (std::isdigit(static_cast<unsigned char>(text[end])) || text[end] == '.'))
            ++end;
        std::string number = text.substr(at + join.size(), end - at - join.size());
        while (number.ends_with(".")) number.pop_back();
        if (number.empty() || !std::isdigit(static_cast<unsigned char>(number[0]))) continue;
        if (join != ", " && sections.empty()) continue;
        sections.push_back(number);
        at = end;
    }
    return sections;
}

// "(page.md, the rule of x)": a section that is named, and not numbered, cannot be looked for.
bool cites_by_name(const std::string &text, std::size_t at) {
    const std::size_t open = text.rfind('(', at), close = text.rfind(')', at);
    const bool enclosed = open != text.npos && (close == text.npos || close < open);
    return enclosed && text.compare(at, 2, ", ") == 0 &&
           std::isalpha(static_cast<unsigned char>(text[at + 2]));
}

// The anchor that follows a page's name in a comment, "" without one. On pages links are checked.
std::string anchor_after(const std::string &text, std::size_t at) {
    if (at >= text.size() || text[at] != '#') return "";
    std::size_t end = at + 1;
    while (end < text.size() && in_path(text[end]) && text[end] != '.') ++end;
    return text.substr(at + 1, end - at - 1);
}

struct Dead {
    int line = 0;
    std::string what;
};

void check_mentions(const Library &library, const std::string &file, const Running &prose,
                    std::vector<Dead> &dead) {
    const std::string &text = prose.text;
    for (std::size_t begin = 0; begin < text.size(); ++begin) {
        if (!in_path(text[begin])) continue;
        std::size_t end = begin;
        while (end < text.size() && in_path(text[end])) ++end;
        const bool open = end < text.size() && (text[end] == '*' || text[end] == '{');
        const bool pattern = begin > 0 && (text[begin - 1] == '*' || text[begin - 1] == '$' ||
                                           text[begin - 1] == ':' || text[begin - 1] == '~');
        std::string name = text.substr(begin, end - begin);
        const std::size_t after = begin = end;
        while (name.ends_with(".")) name.pop_back();
        if (name.starts_with("./")) name.erase(0, 2);
        if (pattern || open || name.starts_with("/") || is_placeholder(name)) continue;
        if (!is_source(name) && !leads_into(library, name)) continue;
        const std::string anchor = file.ends_with(".md") ? "" : anchor_after(text, after);
        const std::string page = resolve(library, folder_of(file), name);
        if (!exists(library, folder_of(file), name))
            dead.push_back({prose.line(after - 1), "there is no " + name});
        else if (!anchor.empty() &&
                 !(library.pages.contains(page) && library.pages.at(page).anchors.contains(anchor)))
            dead.push_back({prose.line(after - 1), page + " has no anchor #" + anchor});
        else if (library.pages.contains(page) && cites_by_name(text, after))
            dead.push_back({prose.line(after - 1), "cite a section of " + page + " by its number"});
        else if (library.pages.contains(page))
            for (const std::string &section : sections_after(text, after))
                if (!library.pages.at(page).numbers.contains(section))
                    dead.push_back({prose.line(after - 1), page + " has no section " + section});
    }
}

void check_decisions(const Library &library, const Running &prose, std::vector<Dead> &dead) {
    const std::string word = "decision 0";
    for (std::size_t at = prose.text.find(word); at != prose.text.npos;
         at = prose.text.find(word, at + 1)) {
        const std::string number = prose.text.substr(at + word.size() - 1, 4);
        const bool known = std::ranges::any_of(library.files, [&](const std::string &file) {
            return file.starts_with("docs/decisions/" + number + "-");
        });
        if (!known) dead.push_back({prose.line(at), "there is no decision " + number});
    }
}

void check_links(const Library &library, const std::string &file, const Running &prose,
                 std::vector<Dead> &dead) {
    const std::string &text = prose.text;
    for (std::size_t at = text.find("]("); at != text.npos; at = text.find("](", at + 1)) {
        const std::string target = text.substr(at + 2, text.find(')', at) - at - 2);
        if (std::ranges::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(at), '`') %
                2 ==
            1)
            continue; // in code
        if (target.find("://") != target.npos || target.starts_with("mailto:")) continue;
        const std::size_t hash = std::min(target.find('#'), target.size());
        std::string path = hash == 0 ? file : joined(folder_of(file), target.substr(0, hash));
        while (path.ends_with("/")) path.pop_back();
        const std::string anchor = hash < target.size() ? target.substr(hash + 1) : "";
        if (!library.files.contains(path) && !library.folders.contains(path))
            dead.push_back({prose.line(at), "a link leads to " + path + ", which is not there"});
        else if (!anchor.empty() && (!library.pages.contains(path) ||
                                     !library.pages.at(path).anchors.contains(anchor)))
            dead.push_back({prose.line(at), path + " has no anchor #" + anchor});
    }
}

std::vector<Dead> dead_references(const Library &library, const std::string &file,
                                  const std::vector<std::string> &lines) {
    const Running prose = running(file, lines);
    std::vector<Dead> dead;
    check_mentions(library, file, prose, dead);
    check_decisions(library, prose, dead);
    if (file.ends_with(".md")) check_links(library, file, prose, dead);
    return dead;
}

bool is_text(const std::string &file) {
    const std::filesystem::path path(file);
    return std::set<std::string>{".md",  ".h",  ".cpp",   ".def", ".glsl",
                                 ".sdf", ".in", ".cmake", ".py",  ".sh"}
               .contains(path.extension().string()) ||
           path.filename() == "CMakeLists.txt" || !path.has_extension();
}

} // namespace

TEST_CASE("every reference in code and pages leads somewhere") {
    const std::filesystem::path root = FATHOM_SOURCE_DIR;
    const Library library = read_library(root);
    std::size_t read = 0;
    for (const std::string &file : library.files) {
        if (!is_text(file) || file == "tests/style/references.cpp") continue;
        ++read;
        for (const Dead &dead : dead_references(library, file, lines_of(root / file)))
            FAIL_CHECK(file << ":" << dead.line << ": " << dead.what);
    }
    CHECK(read > 500);
}

TEST_CASE("references that lead nowhere are found") {
    Library library;
    library.files = {"docs/rules.md", "docs/decisions/0001-one.md", "ir/shading.h", "ir/cost.cpp"};
    library.folders = {"docs", "docs/decisions", "ir"};
    library.pages["docs/rules.md"] =
        headings_of({"# Rules", "## 1. First", "### 1.1 Part", "## 2. Next", "```", "## 3. No"});
    const auto dead = [&](const std::string &file, const std::vector<std::string> &lines) {
        std::vector<std::string> said;
        for (const Dead &one : dead_references(library, file, lines))
            said.push_back(std::to_string(one.line) + ": " + one.what);
        return said;
    };
    using Said = std::vector<std::string>;
    SECTION("in comments") {
        CHECK(dead("ir/a.cpp", {"int a; // rules.md, 1 and 2, shading.h and `ir/cost`"}).empty());
        CHECK(dead("ir/a.cpp", {"call(\"none.md // none.h\");", "#include \"none.h\""}).empty());
        CHECK(dead("ir/a.cpp", {"", "// See none.md."}) == Said{"2: there is no none.md"});
        CHECK(dead("ir/a.cpp", {"case '\"': // none.h"}) == Said{"1: there is no none.h"});
        CHECK(dead("ir/a.cpp", {"// docs/rules.md#2-next."}).empty());
        CHECK(dead("ir/a.cpp", {"// docs/rules.md#2-nxt."}) ==
              Said{"1: docs/rules.md has no anchor #2-nxt"});
        CHECK(dead("ir/a.glsl", {"$# As none.h"}) == Said{"1: there is no none.h"});
        CHECK(dead("ir/CMakeLists.txt", {"x(\"#a\") # none.h"}) == Said{"1: there is no none.h"});
        CHECK(dead("ir/a.cpp", {"// looks.h's steps"}) == Said{"1: there is no looks.h"});
        CHECK(dead("ir/a.cpp", {"// as ir/none does"}) == Said{"1: there is no ir/none"});
        CHECK(dead("ir/a.cpp", {"// (rules.md,", "// 4)"}) ==
              Said{"1: docs/rules.md has no section 4"});
        CHECK(dead("ir/a.cpp", {"// rules.md, 1.1 to 3."}) ==
              Said{"1: docs/rules.md has no section 3"});
        CHECK(dead("ir/a.cpp", {"// (rules.md,", "// first)"}) ==
              Said{"1: cite a section of docs/rules.md by its number"});
        CHECK(dead("ir/a.cpp", {"// (decision 0001), (decision 0002)"}) ==
              Said{"1: there is no decision 0002"});
    }
    SECTION("on pages") {
        CHECK(dead("docs/a.md", {"[x](rules.md#11-part), [y](../ir/shading.h), [z](https://a.b/c)",
                                 "```", "[x](none)", "```", "`[x](none)`, `CODE.md`, `ir/*.md`"})
                  .empty());
        CHECK(dead("docs/a.md", {"", "[x](rules.md#3-no)"}) ==
              Said{"2: docs/rules.md has no anchor #3-no"});
        CHECK(dead("docs/a.md", {"![x](none.png)"}) ==
              Said{"1: a link leads to docs/none.png, which is not there"});
        CHECK(dead("docs/a.md", {"`ir/none.cpp`"}) == Said{"1: there is no ir/none.cpp"});
        CHECK(dead("docs/a.md", {"rules.md, 7"}) == Said{"1: docs/rules.md has no section 7"});
    }
}
