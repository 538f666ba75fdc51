// See words.h.
#include "cli/words.h"

#include "base/single.h"
#include "base/text.h"

#include <algorithm>
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
        return n && *n >= 1 && *n <= 65536 && *n == static_cast<int>(*n);
    };
    if (!good(w) || !good(h))
        return fmt::format("a size is WIDTHxHEIGHT, each 1 to 65536, as 1280x720, not `{}`", word);
    first = static_cast<int>(*w);
    second = static_cast<int>(*h);
    return "";
}

std::optional<double> read_coordinate(std::string_view word) {
    const std::optional<double> number = parse_number(word);
    return number && std::abs(*number) <= longest ? number : std::nullopt;
}

std::string read_point(const std::string &word, std::array<double, 3> &point) {
    std::string_view rest = word;
    for (std::size_t i = 0; i < 3; ++i) {
        std::size_t comma = i < 2 ? rest.find(',') : rest.size();
        std::optional<double> number =
            comma == rest.npos ? std::nullopt : read_coordinate(rest.substr(0, comma));
        if (!number)
            return fmt::format("a point is X,Y,Z, as 0,1.5,-2, none beyond 1e18, not `{}`", word);
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

namespace {

std::optional<int> whole_number(std::string_view text, double most) {
    const std::optional<double> n = parse_number(text);
    if (!n || !(*n >= 0 && *n <= most) || *n != std::floor(*n)) return std::nullopt;
    return static_cast<int>(*n);
}

// `A..B`, which leaves B out, and `A..=B`, which takes it in: both words, and whether it does.
struct Range {
    std::string_view first, last;
    bool inclusive = false;
};
std::optional<Range> range_of(std::string_view word) {
    const std::size_t dots = word.find("..");
    if (dots == word.npos) return std::nullopt;
    const bool inclusive = word.substr(dots).starts_with("..=");
    return Range{word.substr(0, dots), word.substr(dots + (inclusive ? 3 : 2)), inclusive};
}

constexpr int last_frame = 1'000'000;

// Adds one part of a list of frames. Whether it is one.
bool add_frames(std::string_view part, std::vector<int> &numbers) {
    const std::optional<Range> range = range_of(part);
    if (!range) {
        const std::optional<int> one = whole_number(part, last_frame);
        if (one) numbers.push_back(*one);
        return one.has_value();
    }
    const std::size_t colon = range->last.find(':');
    const std::optional<int> first = whole_number(range->first, last_frame),
                             last = whole_number(range->last.substr(0, colon), last_frame),
                             step = colon == range->last.npos
                                        ? std::optional(1)
                                        : whole_number(range->last.substr(colon + 1), last_frame);
    if (!first || !last || !step || *step < 1) return false;
    const int end = *last + (range->inclusive ? 1 : 0);
    for (int frame = *first; frame < end; frame += *step) numbers.push_back(frame);
    return *first < end;
}

} // namespace

std::string read_frames(const std::string &word, FrameList &frames) {
    frames = {word, {}};
    std::string_view rest = word;
    bool good = true;
    for (bool more = true; more && good;) {
        const std::size_t comma = rest.find(',');
        good = add_frames(rest.substr(0, comma), frames.numbers);
        // More numbers than there are have one twice, which is told below.
        more = comma != rest.npos && frames.numbers.size() <= last_frame + 1;
        if (more) rest.remove_prefix(comma + 1);
    }
    if (!good)
        return fmt::format(
            "frames are A..B (B left out), A..=B, with a step as 0..=240:2, a number, "
            "or a list of these as 0..48,60, none above {}, not `{}`",
            last_frame, word);
    std::ranges::sort(frames.numbers);
    const auto twice = std::ranges::adjacent_find(frames.numbers);
    if (twice != frames.numbers.end())
        return fmt::format("frame {} is there twice in `{}`", *twice, word);
    return "";
}

std::string read_sweep(const std::string &word, std::vector<Sweep> &sweeps) {
    const std::size_t equals = word.find('=');
    const std::optional<Range> range =
        equals == word.npos ? std::nullopt : range_of(std::string_view(word).substr(equals + 1));
    const std::optional<double> from = range ? parse_number(range->first) : std::nullopt,
                                to = range ? parse_number(range->last) : std::nullopt;
    if (!from || !to || equals == 0 || !std::isfinite(*from) || !std::isfinite(*to))
        return fmt::format(
            "a sweep is NAME=A..B (B left out) or NAME=A..=B, as height=1..=2.5, not "
            "`{}`",
            word);
    sweeps.push_back({word.substr(0, equals), *from, *to, range->inclusive});
    return "";
}

std::string read_section(const std::string &word, std::optional<v1::Section> &section) {
    const std::size_t dots = word.find("..");
    const std::size_t axis = word.empty() ? word.npos : std::string_view("xyz").find(word[0]);
    v1::Section read;
    bool good = axis != word.npos && word.size() > 4 && word[1] == '=' && dots != word.npos;
    const auto end = [&](std::string_view text, double &height) {
        if (text.empty()) return;
        const std::optional<double> number = read_coordinate(text);
        good = good && number;
        height = number.value_or(0);
    };
    if (good) {
        read.axis = static_cast<int>(axis);
        end(std::string_view(word).substr(2, dots - 2), read.from);
        end(std::string_view(word).substr(dots + 2), read.to);
    }
    if (!good || !(read.from < read.to))
        return fmt::format(
            "a section is AXIS=A..B: z=..0.5 keeps what lies below 0.5, z=0.5.. what "
            "lies above, x=-1..1 what lies between, not `{}`",
            word);
    section = read;
    return "";
}

std::string word_of_section(const v1::Section &section) {
    const auto end = [](double height) {
        return std::isfinite(height) ? format_shortest(height) : std::string();
    };
    return fmt::format("{}={}..{}", "xyz"[section.axis], end(section.from), end(section.to));
}

std::string read_samples(const std::string &word, RenderCommand &command) {
    constexpr int most = 256;
    const std::optional<Range> range = range_of(word);
    const std::optional<int> first = range ? whole_number(range->first, most) : std::optional(0),
                             last =
                                 whole_number(range ? range->last : std::string_view(word), most);
    const int count = first && last ? *last + (range && range->inclusive ? 1 : 0) - *first : 0;
    if (count < 1 || *first + count > most)
        return fmt::format(
            "samples are a number from 1 to {0}, or a range of them up to {0} as 4..8, "
            "not `{1}`",
            most, word);
    command.first_sample = *first;
    command.samples = count;
    command.part_of_samples = range.has_value();
    return "";
}

std::string read_tile(const std::string &word, std::optional<std::pair<int, int>> &tile) {
    const std::size_t slash = word.find('/');
    const std::string_view text = word;
    const std::optional<int> i = slash == word.npos ? std::nullopt
                                                    : whole_number(text.substr(0, slash), 65536),
                             n = slash == word.npos ? std::nullopt
                                                    : whole_number(text.substr(slash + 1), 65536);
    if (!i || !n || *i >= *n)
        return fmt::format("a tile is I/N with I from 0 to N - 1, as 0/4, not `{}`", word);
    tile = {*i, *n};
    return "";
}

std::string read_region(const std::string &word, std::optional<std::array<int, 4>> &region) {
    std::array<int, 4> numbers{};
    std::string_view rest = word;
    for (std::size_t i = 0; i < 4; ++i) {
        const std::size_t comma = i < 3 ? rest.find(',') : rest.size();
        const std::optional<int> number =
            comma == rest.npos ? std::nullopt : whole_number(rest.substr(0, comma), 65536);
        if (!number || (i >= 2 && *number < 1))
            return fmt::format("a region is X,Y,WIDTH,HEIGHT in pixels, as 0,100,640,20, not `{}`",
                               word);
        numbers[i] = *number;
        rest.remove_prefix(std::min(comma + 1, rest.size()));
    }
    region = numbers;
    return "";
}

std::string read_override(const std::string &word, std::vector<Definition> &overrides) {
    std::size_t equals = word.find('=');
    if (equals == word.npos || equals == 0)
        return fmt::format("a param is set as -D name=value, not `{}`", word);
    overrides.push_back({word.substr(0, equals), word.substr(equals + 1)});
    return "";
}

std::string read_heights(const std::string &word, std::vector<double> &heights) {
    constexpr std::size_t most = 100'000;
    const std::string wrong = fmt::format(
        "wants heights, as 1.5, 0..10:0.2 or 0..=10:0.2, or a list of them by commas, not `{}`",
        word);
    const auto good = [](std::optional<double> n) { return n && fits_single(*n); };
    for (std::string_view rest = word; !rest.empty();) {
        const std::string_view part = rest.substr(0, rest.find(','));
        rest.remove_prefix(std::min(part.size() + 1, rest.size()));
        const std::optional<Range> range = range_of(part);
        if (!range) {
            const std::optional<double> one = parse_number(part);
            if (!good(one)) return wrong;
            heights.push_back(*one);
            continue;
        }
        const std::size_t colon = range->last.find(':');
        if (colon == range->last.npos)
            return fmt::format("wants a step: {}:0.2, if a slice is to lie every 0.2", part);
        const std::optional<double> from = parse_number(range->first),
                                    to = parse_number(range->last.substr(0, colon)),
                                    step = parse_number(range->last.substr(colon + 1));
        if (!good(from) || !good(to) || !good(step) || !(*step > 0) || !(*from <= *to))
            return wrong;
        // A number of steps that is whole but for rounding is taken for whole.
        const double steps = (*to - *from) / *step, whole = std::round(steps);
        const bool even = std::fabs(steps - whole) < 1e-6;
        const double count = even ? whole + (range->inclusive ? 1 : 0) : std::floor(steps) + 1;
        if (!(static_cast<double>(heights.size()) + count <= most))
            return fmt::format("wants at most {} heights", most);
        for (double k = 0; k < count; ++k) heights.push_back(*from + k * *step);
    }
    if (heights.empty() || word.back() == ',') return wrong;
    return heights.size() > most ? fmt::format("wants at most {} heights", most) : "";
}

} // namespace fathom::cli
