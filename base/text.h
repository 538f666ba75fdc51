// Numbers to and from text without a locale, and small text helpers that several folders need.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace fathom {

std::string format_shortest(double value); // shortest form that reads back equal: "0.1", "1e+30"
std::string format_shortest(float value);
std::optional<double> parse_number(std::string_view text); // the whole text, or nothing
std::string json_string(std::string_view text);            // quoted and escaped; bad UTF-8 replaced

} // namespace fathom
