// Which lines of an edited text are those of the text before. Works on text alone.
#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

namespace fathom::viewer {

// For each line of `before`, counted from 1 (so [0] is nothing's), its line in `after`, 0 where it
// has gone. Lines are the same where they hold the same words, in the order of the longest common
// subsequence; lines that were edited where they stood, as many as before, are paired too.
std::vector<std::uint32_t> lines_after(std::string_view before, std::string_view after);

} // namespace fathom::viewer
