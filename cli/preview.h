// A picture as it comes, in a terminal that can show it: two pixels a character, the upper half
// block in 24-bit colour over its background. Only where COLORTERM says truecolor or 24bit and the
// locale is of UTF-8; on standard error, like the progress bar, and wiped like it.
#pragma once

#include <cstdint>
#include <span>
#include <string>

namespace fathom::cli {

// Size of a preview, in characters.
struct PreviewSize {
    int columns = 0, rows = 0; // of characters; 0: the terminal cannot
};
// As large as a picture of these sides may be in the terminal, half of its lines at most.
PreviewSize preview_size(int width, int height);

// The picture's mean colours as lines of characters; rgba from the top left, what is not drawn yet
// has no alpha.
std::string preview_lines(std::span<const std::uint8_t> rgba, int width, int height,
                          PreviewSize size);

} // namespace fathom::cli
