// Source texts: where lines begin, and lines and columns of byte offsets.
#include "base/source.h"

#include "base/text.h"

#include <algorithm>
#include <cassert>
#include <iterator>

namespace fathom {

Span join(Span a, Span b) {
    assert(a.source == b.source);
    return {a.source, std::min(a.begin, b.begin), std::max(a.end, b.end)};
}

namespace {

constexpr std::uint32_t between_milestones = 256; // bytes, and up to three more

std::vector<Milestone> milestones_of(const Source &source) {
    std::vector<Milestone> milestones;
    for (std::size_t line = 0; line < source.line_starts.size(); ++line) {
        const std::size_t begin = source.line_starts[line];
        const std::size_t end = line + 1 < source.line_starts.size() ? source.line_starts[line + 1]
                                                                     : source.text.size();
        if (end - begin <= between_milestones) continue;
        std::size_t last = begin;
        std::uint32_t column = 1;
        for (std::size_t at = begin; at < end; ++column) {
            if (at - last >= between_milestones) {
                milestones.push_back({static_cast<std::uint32_t>(at), column});
                last = at;
            }
            at += decode_utf8(source.text, at).length;
        }
    }
    return milestones;
}

} // namespace

SourceId Sources::add(std::string name, std::string text, SourceId made_from) {
    Source source{std::move(name), std::move(text), {0}, made_from, {}};
    for (std::size_t i = source.text.find('\n'); i != std::string::npos;
         i = source.text.find('\n', i + 1))
        source.line_starts.push_back(static_cast<std::uint32_t>(i + 1));
    source.milestones = milestones_of(source);
    return sources_.add(std::move(source));
}

Position position(const Source &source, std::uint32_t offset) {
    offset = std::min(offset, static_cast<std::uint32_t>(source.text.size()));
    const auto &starts = source.line_starts;
    const auto after = std::upper_bound(starts.begin(), starts.end(), offset);
    const auto line = static_cast<std::uint32_t>(after - starts.begin()); // counts from 1
    Milestone from{starts[line - 1], 1};
    const auto next = std::upper_bound(
        source.milestones.begin(), source.milestones.end(), offset,
        [](std::uint32_t at, const Milestone &milestone) { return at < milestone.offset; });
    if (next != source.milestones.begin() && std::prev(next)->offset > from.offset)
        from = *std::prev(next);
    for (std::uint32_t i = from.offset; i < offset; ++from.column) {
        i += decode_utf8(source.text, i).length;
        if (i > offset) break; // an offset inside a code point belongs to it
    }
    return {line, from.column};
}

std::string_view line_text(const Source &source, std::uint32_t line) {
    if (line == 0 || line > source.line_starts.size()) return {};
    const std::string_view whole = source.text;
    const std::uint32_t begin = source.line_starts[line - 1];
    std::size_t end =
        line < source.line_starts.size() ? source.line_starts[line] - 1 : whole.size();
    if (end > begin && whole[end - 1] == '\r') --end;
    return whole.substr(begin, end - begin);
}

std::string_view text(const Sources &sources, Span span) {
    if (!span.source) return {};
    const std::string_view whole = sources[span.source].text;
    const std::size_t begin = std::min<std::size_t>(span.begin, whole.size());
    const std::size_t end = std::clamp<std::size_t>(span.end, begin, whole.size());
    return whole.substr(begin, end - begin);
}

} // namespace fathom
