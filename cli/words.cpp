// See words.h.
#include "cli/words.h"

#include "base/text.h"

#include <cmath>
#include <fmt/format.h>
#include <optional>
#include <string_view>

namespace fathom::cli {

std::string read_pair(const std::string &word, int &first, int &second) {
    std::size_t x = word.find('x');
    std::optional<double> w =
        x == word.npos ? std::nullopt : parse_number(std::string_view(word).substr(0, x));
    std::optional<double> h =
        x == word.npos ? std::nullopt : parse_number(std::string_view(word).substr(x + 1));
    auto good = [](std::optional<double> n) {
        return n && *n >= 1 && *n <= 16384 && *n == static_cast<int>(*n);
    };
    if (!good(w) || !good(h))
        return fmt::format("a size is WIDTHxHEIGHT, each 1 to 16384, as 1280x720, not `{}`", word);
    first = static_cast<int>(*w);
    second = static_cast<int>(*h);
    return "";
}

std::string read_point(const std::string &word, std::array<double, 3> &point) {
    std::string_view rest = word;
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t comma = i < 2 ? rest.find(',') : rest.size();
        std::optional<double> number =
            comma == rest.npos ? std::nullopt : parse_number(rest.substr(0, comma));
        if (!number || !std::isfinite(*number))
            return fmt::format("a point is X,Y,Z, as 0,1.5,-2, not `{}`", word);
        point[i] = *number;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    return "";
}

std::string read_box(const std::string &word, std::array<std::array<double, 3>, 2> &box) {
    std::size_t half = 0; // the third comma
    for (int k = 0; k < 3 && half != word.npos; ++k) half = word.find(',', half + (k > 0));
    const bool good = half != word.npos && read_point(word.substr(0, half), box[0]).empty() &&
                      read_point(word.substr(half + 1), box[1]).empty();
    for (std::size_t i = 0; good && i < 3; ++i)
        if (!(box[0][i] < box[1][i]))
            return fmt::format("the box {} is empty: its least corner comes first", word);
    return good ? ""
                : fmt::format("a box is X,Y,Z,X,Y,Z, its least corner first, as -1,-1,0,1,1,2, "
                              "not `{}`",
                              word);
}

std::string read_frames(const std::string &word, std::pair<int, int> &frames) {
    std::size_t dots = word.find("..");
    bool inclusive = dots != word.npos && word.compare(dots, 3, "..=") == 0;
    auto whole = [&](std::string_view text) -> std::optional<int> {
        std::optional<double> n = parse_number(text);
        if (!n || *n < 0 || *n > 1e6 || *n != static_cast<int>(*n)) return std::nullopt;
        return static_cast<int>(*n);
    };
    std::optional<int> first, last;
    if (dots != word.npos) {
        first = whole(std::string_view(word).substr(0, dots));
        last = whole(std::string_view(word).substr(dots + (inclusive ? 3 : 2)));
    }
    if (!first || !last || *first >= *last + (inclusive ? 1 : 0))
        return fmt::format("frames are A..B (B left out) or A..=B, as 0..48, not `{}`", word);
    frames = {*first, *last + (inclusive ? 1 : 0)};
    return "";
}

std::string read_override(const std::string &word, std::vector<typecheck::Override> &overrides) {
    std::size_t equals = word.find('=');
    if (equals == word.npos || equals == 0)
        return fmt::format("a param is set as -D name=value, not `{}`", word);
    overrides.push_back({word.substr(0, equals), word.substr(equals + 1)});
    return "";
}

} // namespace fathom::cli
