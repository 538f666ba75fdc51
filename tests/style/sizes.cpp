// How long files and functions may be. What is longer says why: `Long: …` in the first lines of a
// file, or in the comment above a function.
#include "repository.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <string_view>

using namespace fathom::style;

namespace {

constexpr std::size_t longest_file = 500, longest_function = 120;

bool gives_reason(const std::string &line) {
    const std::size_t at = line.find("// ");
    return at != line.npos && line.find("Long: ", at) != line.npos;
}

struct Long {
    std::size_t line = 0, length = 0; // the line of its head, from 1; how many lines it has
    friend bool operator==(const Long &, const Long &) = default;
};

std::size_t indentation(const std::string &line) {
    return std::min(line.find_first_not_of(' '), line.size());
}

// Whether text at the beginning of a head opens something else than a function.
bool opens_other(std::string_view head) {
    constexpr std::array words{"namespace", "struct", "class",  "enum", "union", "if",
                               "for",       "while",  "switch", "do",   "else",  "case",
                               "return",    "extern", "}",      "try",  "//",    "#"};
    return std::ranges::any_of(words, [&](std::string_view word) {
        if (!head.starts_with(word)) return false;
        const char next = head.size() > word.size() ? head[word.size()] : ' ';
        return !std::isalnum(static_cast<unsigned char>(next)) && next != '_';
    });
}

// The functions that have more lines than `limit` and give no reason. Reads clang-format's layout:
// a function's last line is a brace at the indentation of its head's first line, which is that of
// the file or of one class.
std::vector<Long> long_functions(const std::vector<std::string> &lines, std::size_t limit) {
    std::vector<Long> found;
    for (std::size_t i = 0; i < lines.size(); ++i) {
        if (!lines[i].ends_with('{')) continue;
        std::size_t head = i;
        while (head > 0 && !lines[head - 1].empty() &&
               std::string_view(";{}:,").find(lines[head - 1].back()) == std::string_view::npos &&
               lines[head - 1].find("//") == std::string::npos && lines[head - 1][0] != '#')
            --head;
        // A head that is broken within its parameters goes on above.
        while (head > 0 && !lines[head - 1].empty() && lines[head - 1].back() == ',' &&
               lines[head - 1].find("//") == std::string::npos)
            --head;
        const std::size_t depth = indentation(lines[head]);
        const std::string_view text = std::string_view(lines[head]).substr(depth);
        const std::size_t open = text.find('('), assign = text.find(" = ");
        const bool lambda =
            lines[i].find("](") != std::string::npos || text.starts_with("std::visit");
        if (depth > 4 || lambda || opens_other(text) || open == text.npos || assign < open)
            continue;
        std::size_t last = i + 1;
        while (last < lines.size() &&
               !(indentation(lines[last]) == depth && lines[last][depth] == '}'))
            ++last;
        if (last - head + 1 <= limit) continue;
        bool reason = false;
        for (std::size_t k = head; k > 0 && lines[k - 1].find("//") == depth; --k)
            reason |= gives_reason(lines[k - 1]);
        if (!reason) found.push_back({head + 1, last - head + 1});
    }
    return found;
}

bool is_code(const std::string &path) { return path.ends_with(".cpp") || path.ends_with(".h"); }

} // namespace

TEST_CASE("a file of more than 500 lines, or a function of more than 120, says why") {
    std::size_t files = 0;
    for (const std::string &path : files_below(FATHOM_SOURCE_DIR)) {
        if (!is_code(path)) continue;
        if (path.starts_with("proof/")) continue; // its rules are being divided
        ++files;
        const std::vector<std::string> lines =
            lines_of(std::filesystem::path(FATHOM_SOURCE_DIR) / path);
        const auto head =
            lines.begin() + static_cast<std::ptrdiff_t>(std::min<std::size_t>(lines.size(), 10));
        if (lines.size() > longest_file && std::none_of(lines.begin(), head, gives_reason))
            FAIL_CHECK(path << " has " << lines.size() << " lines: divide it, or say why");
        for (const Long &function : long_functions(lines, longest_function))
            FAIL_CHECK(path << ":" << function.line << ": a function of " << function.length
                            << " lines: divide it, or say why");
    }
    CHECK(files > 300);
}

TEST_CASE("what counts as a long function") {
    using Lines = std::vector<std::string>;
    CHECK(long_functions({"int f() {", "    a;", "    b;", "}"}, 3) == std::vector<Long>{{1, 4}});
    CHECK(long_functions({"int f() {", "    a;", "    b;", "}"}, 4).empty());
    CHECK(long_functions({"struct S {", "    int f(int a,", "          int b) const {",
                          "        a;", "    }", "};"},
                         3) == std::vector<Long>{{2, 4}});
    CHECK(long_functions({"// Long: a case for each op.", "int f() {", "    a;", "}"}, 2).empty());
    CHECK(long_functions({"// It is long.", "int f() {", "    a;", "}"}, 2).size() == 1);
    for (const char *other : {"struct S {", "namespace a {", "const int a[] = {", "} else {"})
        CHECK(long_functions({other, "    a;", "    b;", "}"}, 2).empty());
    CHECK(long_functions(Lines{"void f() {", "    for (;;) {", "        a;", "    }", "}"}, 4)
              .size() == 1);
}
