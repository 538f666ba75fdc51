// Words of the command line: each function reads one into its place, or says what it wanted; an
// empty answer is a good word.
#pragma once

#include "cli/command.h"

#include <array>
#include <string>
#include <utility>
#include <vector>

namespace fathom::cli {

std::string read_pair(const std::string &word, int &first, int &second); // 1280x720: 1 to 16384
std::string read_point(const std::string &word, std::array<double, 3> &point); // 0,1.5,-2: finite
// -1,-1,0,1,1,2: the least corner of a box, then the greatest.
std::string read_box(const std::string &word, std::array<std::array<double, 3>, 2> &box);
// 0..48 and 0..=47: the first, and one past the last.
std::string read_frames(const std::string &word, std::pair<int, int> &frames);
// name=value, of `-D`; the value is an expression of the language, which is not read here.
std::string read_override(const std::string &word, std::vector<typecheck::Override> &overrides);

} // namespace fathom::cli
