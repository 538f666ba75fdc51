// How the pages are set: prose within 100 columns, so that they can be read in a terminal and
// compared line by line.
#include "repository.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace fathom::style;

namespace {

constexpr std::size_t widest = 100;

// Code points, not bytes.
std::size_t columns(const std::string &line) {
    return static_cast<std::size_t>(
        std::ranges::count_if(line, [](char c) { return (c & 0xC0) != 0x80; }));
}

bool is_page(const std::string &path) {
    return path == "README.md" || path == "CONTRIBUTING.md" ||
           (path.starts_with("docs/") && path.ends_with(".md"));
}

// Whether a line could be broken: at a space that is not in its indentation, nor in code.
bool breakable(const std::string &text) {
    bool in_code = false;
    for (std::size_t i = text.find_first_not_of(' '); i < text.size(); ++i) {
        if (text[i] == '`') in_code = !in_code;
        if (text[i] == ' ' && !in_code) return true;
    }
    return false;
}

// Tables and images cannot be broken.
std::vector<int> long_lines(const std::string &path, const std::vector<std::string> &lines) {
    std::vector<int> found;
    for (const ProseLine &line : prose_of(path, lines)) {
        const std::size_t begin = line.text.find_first_not_of(' ');
        if (begin == line.text.npos || line.text[begin] == '|' ||
            line.text.compare(begin, 2, "![") == 0)
            continue;
        if (columns(line.text) > widest && breakable(line.text)) found.push_back(line.line);
    }
    return found;
}

} // namespace

TEST_CASE("prose on the pages stays within 100 columns") {
    std::size_t pages = 0;
    for (const std::string &path : files_below(FATHOM_SOURCE_DIR)) {
        if (!is_page(path)) continue;
        ++pages;
        for (const int line :
             long_lines(path, lines_of(std::filesystem::path(FATHOM_SOURCE_DIR) / path)))
            FAIL_CHECK(path << ":" << line << " has more than 100 columns");
    }
    CHECK(pages > 50);
}

TEST_CASE("what counts as a long line") {
    const std::string words = "two " + std::string(97, 'x');
    CHECK(long_lines("a.md", {"", words}) == std::vector{2});
    CHECK(long_lines("a.md", {"  " + words}) == std::vector{1});
    CHECK(long_lines("a.md", {words.substr(1)}).empty());
    CHECK(long_lines("a.md", {"```", words, "```", "| " + words, "![" + words}).empty());
    CHECK(long_lines("a.md", {"  `" + words + "`:"}).empty());
    std::string accents;
    for (int i = 0; i < 98; ++i) accents += "ä";
    CHECK(long_lines("a.md", {"x " + accents}).empty());
    CHECK(long_lines("a.md", {"xx " + accents}) == std::vector{1});
}
