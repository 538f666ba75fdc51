// Near names: what did the user mean by a name that does not exist.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace fathom {

// Damerau-Levenshtein distance (optimal string alignment), compared without regard to case.
std::size_t edit_distance(std::string_view a, std::string_view b);

// The nearest of `names` within a third of the word's length (at least 1); else, of a word of three
// letters or more, the shortest name that it begins; else an empty string.
std::string nearest_name(std::string_view word, const std::vector<std::string> &names);
std::string shortest_begun_by(std::string_view word, const std::vector<std::string> &names);

} // namespace fathom
