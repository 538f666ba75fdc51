// One golden case: a legal program, then from the first line `//====` on its expectations, a
// section a stage. Knows how sections are written and computed; not where cases lie.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace golden {

struct Section {
    std::string stage;     // "diagnostics", "ast", …
    std::string arguments; // what stands behind the stage's name: the points of `eval`
    std::string text;      // as expected, without the `// ` of its lines
};

struct Case {
    std::string file;    // its name alone
    std::string folder;  // where its imports start
    std::string program; // what stands above the sections
    std::vector<Section> sections;
    std::string error; // why the file is no case, or empty
};

Case read_case(const std::string &path);

// The program after all fixes that its diagnostics propose, made one after the other as a person
// would; and the diagnostics that remain. `stuck` names a fix that changes nothing.
struct Fixed {
    std::string program, left, stuck;
};

struct Outcome {
    std::vector<Section> actual; // the same sections, as the program is now
    bool has_errors = false;
    std::vector<std::string> codes; // of all its diagnostics
    Fixed fixed;
};
Outcome run_case(const Case &golden);

std::string write_case(const Case &golden, const std::vector<Section> &sections); // the file's text

// The first difference, in a few lines.
std::string difference(std::string_view expected, std::string_view actual);

} // namespace golden
