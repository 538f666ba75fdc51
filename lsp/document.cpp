#include "lsp/document.h"

#include <algorithm>
#include <cctype>
#include <iterator>

namespace fathom::lsp {
namespace {

// Bytes of the UTF-8 character that begins at `at`, at least 1, within the text.
std::size_t length_at(std::string_view text, std::size_t at) {
    const auto byte = static_cast<unsigned char>(text[at]);
    const std::size_t length = byte >= 0xf0 ? 4 : byte >= 0xe0 ? 3 : byte >= 0xc0 ? 2 : 1;
    return std::min(length, text.size() - at);
}

int units(std::size_t length) { return length == 4 ? 2 : 1; } // of UTF-16

} // namespace

std::size_t offset_at(std::string_view text, Position position) {
    std::size_t at = 0;
    for (int line = 0; line < position.line; ++line) {
        const std::size_t end = text.find('\n', at);
        if (end == text.npos) return text.size();
        at = end + 1;
    }
    for (int unit = 0; unit < position.character && at < text.size() && text[at] != '\n';) {
        const std::size_t length = length_at(text, at);
        unit += units(length);
        at += length;
    }
    return at;
}

Lines lines_of(std::string_view text) {
    constexpr std::size_t between_milestones = 256;
    Lines lines{text};
    for (std::size_t begin = 0;;) {
        const std::size_t end = std::min(text.find('\n', begin), text.size());
        std::size_t last = begin;
        int character = 0;
        for (std::size_t at = begin; end - begin > between_milestones && at < end;) {
            if (at - last >= between_milestones) {
                lines.milestones.push_back({at, character});
                last = at;
            }
            const std::size_t length = length_at(text, at);
            character += units(length);
            at += length;
        }
        if (end == text.size()) return lines;
        begin = end + 1;
        lines.begins.push_back(begin);
    }
}

Position position_at(const Lines &lines, std::size_t offset) {
    offset = std::min(offset, lines.text.size());
    const auto next = std::ranges::upper_bound(lines.begins, offset);
    Milestone from{*std::prev(next), 0};
    const auto further = std::ranges::upper_bound(lines.milestones, offset, {}, &Milestone::offset);
    if (further != lines.milestones.begin() && std::prev(further)->offset > from.offset)
        from = *std::prev(further);
    while (from.offset < offset) {
        const std::size_t length = length_at(lines.text, from.offset);
        from.character += units(length);
        from.offset += length;
    }
    return {static_cast<int>(next - lines.begins.begin()) - 1, from.character};
}

Range range_of(const Lines &lines, std::size_t begin, std::size_t end) {
    return {position_at(lines, begin), position_at(lines, end)};
}

Range range_of(const fathom::v1::Place &place) {
    return {{std::max(place.line - 1, 0), std::max(place.column - 1, 0)},
            {std::max(place.end_line - 1, 0), std::max(place.end_column - 1, 0)}};
}

std::string uri_of(const std::string &path) {
    constexpr std::string_view digits = "0123456789ABCDEF", plain = "-._~/";
    std::string uri = "file://";
    for (char c : path) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x80 && (std::isalnum(byte) || plain.find(c) != plain.npos)) {
            uri += c;
        } else {
            uri += '%';
            uri += digits[byte >> 4];
            uri += digits[byte & 15];
        }
    }
    return uri;
}

std::string path_of(std::string_view uri) {
    constexpr std::string_view scheme = "file://";
    if (!uri.starts_with(scheme)) return "";
    uri.remove_prefix(scheme.size());
    uri.remove_prefix(std::min(uri.find('/'), uri.size())); // a host's name
    const auto digit = [](char c) {
        return c >= '0' && c <= '9'   ? c - '0'
               : c >= 'a' && c <= 'f' ? c - 'a' + 10
               : c >= 'A' && c <= 'F' ? c - 'A' + 10
                                      : -1;
    };
    std::string path;
    for (std::size_t i = 0; i < uri.size(); ++i) {
        if (uri[i] == '%' && i + 2 < uri.size() && digit(uri[i + 1]) >= 0 &&
            digit(uri[i + 2]) >= 0) {
            path += static_cast<char>(digit(uri[i + 1]) * 16 + digit(uri[i + 2]));
            i += 2;
        } else {
            path += uri[i];
        }
    }
    return path;
}

} // namespace fathom::lsp
