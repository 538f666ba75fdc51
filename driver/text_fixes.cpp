#include "driver/text_fixes.h"

#include <optional>
#include <regex>
#include <string>
#include <string_view>

namespace fathom::driver {
namespace {

using Match = std::match_results<std::string_view::const_iterator>;

Span part(Span of, std::size_t begin, std::size_t end) {
    return {of.source, static_cast<std::uint32_t>(begin), static_cast<std::uint32_t>(end)};
}

// The radii of the text's ellipsoid, from `k1 = length(p / (r * r))` before its distance.
std::string radii_before(std::string_view text, const std::string &k1) {
    const std::regex squared(
        "\\b" + k1 +
        R"(\s*(?::\s*float\s*)?=\s*length\(\s*\w+\s*/\s*\(\s*(\w+)\s*\*\s*\1\s*\)\s*\))");
    std::string radii;
    for (std::regex_iterator at(text.begin(), text.end(), squared), none = decltype(at){};
         at != none; ++at)
        radii = (*at)[1].str();
    return radii;
}

std::vector<Edit> ellipsoid_edits(std::string_view text, Span place) {
    static const std::regex distance(
        R"((\w+)\s*\*\s*\(\s*(\w+)\s*-\s*1(?:\.0*)?\s*\)\s*/\s*(\w+))");
    constexpr std::size_t longest = 200, near = 1000; // so much is looked at, whatever is written
    const std::string_view written = text.substr(place.begin, place.end - place.begin);
    Match found;
    if (written.size() > longest ||
        !std::regex_match(written.begin(), written.end(), found, distance) || found[1] != found[2])
        return {};
    const std::size_t begin = place.begin > near ? place.begin - near : 0;
    const std::string radii = radii_before(text.substr(begin, place.begin - begin), found[3].str());
    if (radii.empty()) return {};
    const std::string k0 = found[1].str();
    return {{part(place, place.begin, place.begin), "if " + k0 + " < 1 { (" + k0 + " - 1) * min(" +
                                                        radii + ".x, min(" + radii + ".y, " +
                                                        radii + ".z)) } else { "},
            {part(place, place.end, place.end), " }"}};
}

// The stretch, with its line where nothing else stands there.
Span with_line(std::string_view text, Span stretch) {
    std::size_t begin = stretch.begin, end = stretch.end;
    while (begin > 0 && (text[begin - 1] == ' ' || text[begin - 1] == '\t')) --begin;
    while (end < text.size() && (text[end] == ' ' || text[end] == '\t')) ++end;
    const bool alone =
        (begin == 0 || text[begin - 1] == '\n') && (end < text.size() && text[end] == '\n');
    return alone ? part(stretch, begin, end + 1) : stretch;
}

// `if c { … }` without its head and its braces, where no `else` follows; `place` is the condition.
std::vector<Edit> without_if(std::string_view text, Span place) {
    std::size_t head = text.substr(0, place.begin).find_last_not_of(" (\n");
    if (head == std::string_view::npos || head == 0 || text.substr(head - 1, 2) != "if") return {};
    --head;
    const std::size_t open = text.find('{', place.end);
    if (open == std::string_view::npos ||
        text.substr(place.end, open - place.end).find_first_not_of(" )\n") !=
            std::string_view::npos)
        return {};
    std::size_t close = open;
    for (int depth = 0; close < text.size(); ++close) {
        depth += text[close] == '{' ? 1 : text[close] == '}' ? -1 : 0;
        if (depth == 0) break;
    }
    if (close == text.size()) return {};
    const std::size_t behind = text.find_first_not_of(" \n", close + 1);
    if (behind != std::string_view::npos && text.substr(behind, 4) == "else") return {};
    return {{with_line(text, part(place, head, open + 1)), ""},
            {with_line(text, part(place, close, close + 1)), ""}};
}

std::vector<Edit> region_edits(std::string_view text, const Diagnostic &d) {
    const Span place = d.related.empty() ? d.primary.span : d.related.back().span;
    const std::string_view written = text.substr(place.begin, place.end - place.begin);
    constexpr std::string_view endless = "everywhere";
    const std::size_t at = written.rfind("within: everywhere");
    if (at == std::string_view::npos || !written.starts_with("implicit(")) return {};
    const std::size_t begin = place.begin + at + std::string_view("within: ").size();
    return {{part(place, begin, begin + endless.size()), "ball(3)"}};
}

// `implicit(DE, within: everywhere)` with `estimate: 1`: distances to fractals have names of their own.
std::vector<Edit> estimate_edits(std::string_view text, const Diagnostic &d) {
    static const std::regex shape(R"(implicit\((\w+), within: (everywhere|ball\([\w.]+\))\))");
    static const std::regex estimates(
        R"(de|distance_?estimat\w*|\w*(bulb|mandel|julia|fractal)\w*)", std::regex::icase);
    constexpr std::uint32_t longest = 200;
    const Span place = d.related.empty() ? d.primary.span : d.related.back().span;
    if (place.end - place.begin > longest) return {};
    const std::string written(text.substr(place.begin, place.end - place.begin));
    std::smatch found;
    if (!std::regex_match(written, found, shape) || !std::regex_match(found[1].str(), estimates))
        return {};
    const std::string region = found[2].str() == "everywhere" ? "ball(3)" : found[2].str();
    const std::size_t at = place.begin + static_cast<std::size_t>(found.position(2));
    return {{part(place, at, at + static_cast<std::size_t>(found.length(2))),
             region + ", estimate: 1"}};
}

} // namespace

void add_text_fixes(const Sources &sources, Diagnostics &diagnostics) {
    for (const Diagnostic &told : std::vector(diagnostics.items())) {
        const bool of_proof = told.code == Code::FieldSingular || told.code == Code::FieldJump ||
                              told.code == Code::LipschitzUnbounded;
        if (!of_proof || !told.fix || !told.fix->edits.empty() || !told.primary.span.source)
            continue;
        const std::string_view text = sources[told.primary.span.source].text;
        const std::string_view way = told.fix->message;
        std::vector<Edit> edits = estimate_edits(text, told);
        const bool estimates = !edits.empty();
        if (estimates)
            diagnostics.find(told.code, told.primary.span)->fix->message =
                "state a fractal's estimate of the distance as one, `estimate: 1`, which is not "
                "tested, or a bound with `lipschitz:`, which is";
        else if (way.starts_with("give its inside apart"))
            edits = ellipsoid_edits(text, told.primary.span);
        else if (way.starts_with("leave the `if` out"))
            edits = without_if(text, told.primary.span);
        else if (way.starts_with("give it a region") &&
                 told.message.find("grows steeper") != std::string::npos)
            edits = region_edits(text, told);
        if (!edits.empty())
            diagnostics.find(told.code, told.primary.span)->fix->edits = std::move(edits);
    }
}

} // namespace fathom::driver
