// The files of the repository as text, for tests that read them: all of them, what a file says in
// prose, and the headings of a page. Knows nothing of what the code does.
#pragma once

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fathom::style {

// Every file below a folder, by its path from there. Hidden folders and build trees are left out.
std::set<std::string> files_below(const std::filesystem::path &root);

std::vector<std::string> lines_of(const std::filesystem::path &file);

// One line of prose: of a page what stands outside of code blocks, of a source file a comment
// without its signs.
struct ProseLine {
    std::string text;
    int line = 0;
};
std::vector<ProseLine> prose_of(const std::string &path, const std::vector<std::string> &lines);

// What can be cited of a page: the numbers before its headings ("9", "5.1"), and the anchors that
// GitHub gives them ("line-ends", of a second heading of that name "line-ends-1").
struct Headings {
    std::set<std::string> numbers, anchors;
};
Headings headings_of(const std::vector<std::string> &page);

} // namespace fathom::style
