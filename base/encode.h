// Text from outside (file names, -D, strings and labels of scenes, the words of drivers), encoded
// for the place that it is written to: one function a place. None of it can end, or begin, anything
// there. Bytes that are not UTF-8 become U+FFFD everywhere.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace fathom {

// Does nothing but stand there: no control character, no line end, no turn of the reading
// direction.
bool is_printable(std::uint32_t code_point);

// One line of a terminal or of a window, also of its title: line ends and tabs are blanks, what is
// not printable is U+FFFD.
std::string for_terminal(std::string_view text);

// A part of one line of a comment, of GLSL or of the language, `//` as well as `/* */`: as on a
// terminal, without backslashes (which continue a line at its end) and without `*/`.
std::string for_comment(std::string_view text);

// Text and attribute values of HTML.
std::string for_html(std::string_view text);

// A JSON string, with its quotes. What is not printable is escaped, so that it may be shown.
std::string for_json(std::string_view text);

// A string of JavaScript, with its quotes, within an HTML script element. It holds no `<`, so no
// `</script` and no `<!--`.
std::string for_script(std::string_view text);

// A YAML scalar in single quotes, or in double quotes where something has to be escaped.
std::string for_yaml(std::string_view text);

} // namespace fathom
