// Numbers to and from text without a locale, and the small text helpers that several folders need.
// Knows nothing of sources or diagnostics.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace fathom {

std::string format_shortest(double value); // shortest form that reads back equal: "0.1", "1e+30"
// The same for a float: the fewest digits that read back as it.
std::string format_shortest(float value);
std::optional<double> parse_number(std::string_view text); // the whole text, or nothing

// The code point that begins at `offset` (which must lie inside the text). What is not UTF-8 is one
// U+FFFD a byte, with `valid` false, so that reading always moves on.
struct CodePoint {
    std::uint32_t value = 0;
    std::uint32_t length = 1; // bytes
    bool valid = true;
};
CodePoint decode_utf8(std::string_view text, std::size_t offset);
void append_utf8(std::string &out, std::uint32_t code_point);

// Columns that a code point takes on a terminal: 0 (combining), 1 or 2 (East Asian wide, emoji).
int display_width(std::uint32_t code_point);

// The text, or as much of its begin as fits into so many bytes without a part of a code point.
std::string_view cut(std::string_view text, std::size_t bytes);
// The same with `…` behind it where something is left out, in no more than so many bytes.
std::string shortened(std::string_view text, std::size_t bytes);
// A name of the user's as a message quotes it: its first 80 code points, `…` for what follows.
std::string short_name(std::string_view name);

} // namespace fathom
