#include "viewer/slots.h"

#include "base/text.h"

#include <algorithm>
#include <fmt/format.h>
#include <string_view>

namespace fathom::viewer {
namespace {

constexpr std::size_t maximum = 512; // GL 3.3 grants a fragment shader 1024 uniform floats

struct Range {
    std::size_t begin = 0, end = 0;
};

bool digit(char c) { return c >= '0' && c <= '9'; }
bool part_of_name(char c) {
    return digit(c) || c == '_' || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}

// The float literals of a GLSL text: digits with a point or an exponent, outside of comments and
// names.
std::vector<Range> literals_of(std::string_view text) {
    std::vector<Range> found;
    for (std::size_t at = 0; at < text.size();) {
        if (text.substr(at, 2) == "//") {
            at = std::min(text.find('\n', at), text.size());
        } else if (part_of_name(text[at]) && !digit(text[at])) {
            while (at < text.size() && part_of_name(text[at])) ++at;
        } else if (digit(text[at])) {
            const std::size_t begin = at;
            bool is_float = false;
            while (at < text.size() && digit(text[at])) ++at;
            if (at < text.size() && text[at] == '.') {
                is_float = true;
                for (++at; at < text.size() && digit(text[at]);) ++at;
            }
            if (at < text.size() && text[at] == 'e') {
                is_float = true;
                ++at;
                if (at < text.size() && (text[at] == '-' || text[at] == '+')) ++at;
                while (at < text.size() && digit(text[at])) ++at;
            }
            while (at < text.size() && part_of_name(text[at])) ++at; // 1u
            if (is_float) found.push_back({begin, at});
        } else {
            ++at;
        }
    }
    return found;
}

std::string_view part(std::string_view text, Range range) {
    return text.substr(range.begin, range.end - range.begin);
}

// Which literals differ; nothing where anything else does.
std::optional<std::vector<std::size_t>> differing(std::string_view a,
                                                  const std::vector<Range> &in_a,
                                                  std::string_view b,
                                                  const std::vector<Range> &in_b) {
    if (in_a.size() != in_b.size()) return std::nullopt;
    std::vector<std::size_t> result;
    Range before_a{0, 0}, before_b{0, 0};
    for (std::size_t i = 0; i <= in_a.size(); ++i) {
        const bool last = i == in_a.size();
        before_a.end = last ? a.size() : in_a[i].begin;
        before_b.end = last ? b.size() : in_b[i].begin;
        if (part(a, before_a) != part(b, before_b)) return std::nullopt;
        if (last) break;
        if (part(a, in_a[i]) != part(b, in_b[i])) result.push_back(i);
        before_a.begin = in_a[i].end;
        before_b.begin = in_b[i].end;
    }
    return result;
}

} // namespace

std::optional<std::vector<float>> values_in(const Slots &slots, const std::string &fresh) {
    const std::vector<Range> old_literals = literals_of(slots.text), literals = literals_of(fresh);
    const auto changed = differing(slots.text, old_literals, fresh, literals);
    if (!changed) return std::nullopt;
    if (!std::includes(slots.edited.begin(), slots.edited.end(), changed->begin(), changed->end()))
        return std::nullopt;
    std::vector<float> values;
    for (std::size_t i : slots.edited)
        values.push_back(static_cast<float>(parse_number(part(fresh, literals[i])).value_or(0)));
    return values;
}

std::optional<Slots> widened(const Slots &slots, const std::string &fresh) {
    const auto changed = differing(slots.text, literals_of(slots.text), fresh, literals_of(fresh));
    if (!changed) return std::nullopt;
    Slots result{fresh, {}};
    std::set_union(slots.edited.begin(), slots.edited.end(), changed->begin(), changed->end(),
                   std::back_inserter(result.edited));
    if (result.edited.size() > maximum) return std::nullopt;
    return result;
}

// A constant that holds a slot is a constant no more: its `const` goes. GLSL lets other globals
// begin with any value.
std::string text_with_slots(const Slots &slots) {
    if (slots.edited.empty()) return slots.text;
    constexpr std::string_view constant = "const ";
    const std::string_view text = slots.text;
    const std::vector<Range> literals = literals_of(text);
    std::string result;
    std::size_t copied = 0;
    const auto copy = [&](std::size_t end) {
        result += text.substr(copied, end - copied);
        copied = end;
    };
    const std::size_t second_line = text.find('\n') + 1; // after #version
    copy(second_line);
    result += fmt::format("uniform float fathom_edited[{}];\n", slots.edited.size());
    for (std::size_t k = 0; k < slots.edited.size(); ++k) {
        const Range literal = literals[slots.edited[k]];
        copy(literal.begin);
        const std::size_t statement = result.find_last_of(";{}"),
                          from = statement == result.npos ? 0 : statement;
        const std::size_t word = result.find(constant, from);
        if (word != result.npos && (word == 0 || !part_of_name(result[word - 1])))
            result.erase(word, constant.size());
        result += fmt::format("fathom_edited[{}]", k);
        copied = literal.end;
    }
    copy(text.size());
    return result;
}

} // namespace fathom::viewer
