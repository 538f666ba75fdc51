// Words that begin like a number and are none: why, and what was meant where that is plain.
#include "lang/lexer.h"

#include "base/text.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 17> lengths = {"mm", "cm",  "dm",   "m",  "km",    "um",
                                                      "nm", "in",  "inch", "ft", "px",    "pt",
                                                      "em", "rem", "vh",   "vw", "inches"};
// Of types, in Rust, C, Java and GLSL.
constexpr std::array<std::string_view, 19> suffixes = {
    "f32", "f64", "i8",    "i16",   "i32", "i64", "u8", "u16", "u32", "u64",
    "lf",  "LF",  "usize", "isize", "L",   "UL",  "ul", "LL",  "ull"};
constexpr std::array<std::string_view, 5> seconds = {"s", "sec", "secs", "second", "seconds"};

template <std::size_t N>
bool holds(const std::array<std::string_view, N> &words, std::string_view word) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

} // namespace

bool is_length_unit(std::string_view word) { return holds(lengths, word); }

bool is_degree_word(std::string_view word) {
    return word == "\xC2\xB0" || word == "\xC2\xBA" || word == "\xCB\x9A" || word == "degrees" ||
           word == "degree" || word == "Deg" || word == "DEG";
}

std::size_t number_length(std::string_view word) {
    std::size_t i = 0;
    const auto digits = [&] {
        const std::size_t start = i;
        while (i < word.size() && is_digit(word[i])) ++i;
        return i > start;
    };
    digits();
    if (i + 1 < word.size() && word[i] == '.' && is_digit(word[i + 1])) ++i, digits();
    if (i < word.size() && (word[i] == 'e' || word[i] == 'E')) {
        const std::size_t mantissa = i++;
        if (i < word.size() && (word[i] == '+' || word[i] == '-')) ++i;
        if (!digits()) i = mantissa;
    }
    return i;
}

// `named`: what stands behind the digits is a name of the text.
BadNumber explain_bad_number(std::string_view word, bool named) {
    const std::string whole(word);
    if (word[0] == '.')
        return {"a number does not begin with a point", "write the zero before the point",
                "0" + whole};
    const std::size_t length = number_length(word);
    const std::string number(word.substr(0, length));
    const std::string_view rest = word.substr(length);
    const std::string code = "`" + std::string(rest) + "`";
    if (rest == ".")
        return {"a number does not end with a point",
                "leave the point away, or write a digit after it",
                number.find('.') == std::string::npos ? number + ".0" : number};
    if (rest == "f" || rest == "F" || rest == ".f" || rest == "u" || rest == "U")
        return {"a number has no suffix " + code, "leave it away", number};
    std::string_view suffix = rest;
    while (suffix.starts_with('_')) suffix.remove_prefix(1);
    if (!named && holds(suffixes, suffix))
        return {"a number has no suffix " + code, "leave it away", number};
    if ((rest[0] == 'x' || rest[0] == 'X') && number == "0" && rest.size() > 1 &&
        std::all_of(rest.begin() + 1, rest.end(), is_hex) && rest.size() < 9) {
        std::uint64_t value = 0;
        for (const char c : rest.substr(1)) value = value << 4 | hex_value(c);
        if (rest.size() == 7) { // as a colour has
            const std::string color = "#" + std::string(rest.substr(1));
            return {"numbers are written in decimal, and colours with a `#`",
                    "write `" + color + "`", color};
        }
        return {"numbers are written in decimal", "write the value", fmt::to_string(value)};
    }
    if (rest[0] == '_' &&
        std::all_of(rest.begin(), rest.end(), [](char c) { return is_digit(c) || c == '_'; })) {
        std::string digits = whole;
        std::erase(digits, '_');
        return {"the digits of a number stand together", "leave the underscores away", digits};
    }
    if (rest == "e" || rest == "E") return {"an exponent needs digits after the `e`", "", ""};
    if (is_degree_word(rest))
        return {"the unit of degrees is `deg`", "write `deg`", number + "deg"};
    if (rest == "radians" || rest == "radian")
        return {"the unit of radians is `rad`", "write `rad`", number + "rad"};
    if (rest == "turns") return {"the unit of turns is `turn`", "write `turn`", number + "turn"};
    if (!named && is_length_unit(rest))
        return {"a length has no unit: all of a scene are in the same", "leave " + code + " away",
                number};
    if (!named && holds(seconds, rest))
        return {"a time has no unit: it is in seconds", "leave " + code + " away", number};
    if (const auto value = parse_number(number); !named && rest == "ms" && value) {
        const std::string in_seconds = format_shortest(*value / 1000);
        return {"a time has no unit: it is in seconds", "write `" + in_seconds + "`", in_seconds};
    }
    return {"a name cannot follow a number directly", "to multiply, write `*`",
            number + " * " + std::string(rest)};
}

} // namespace fathom::lang
