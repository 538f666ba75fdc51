#include "base/encode.h"

#include "base/text.h"

#include <fmt/format.h>

namespace fathom {

namespace {

constexpr std::uint32_t replacement = 0xFFFD;

template <class Take> void each_code_point(std::string_view text, Take take) {
    for (std::size_t i = 0; i < text.size();) {
        const CodePoint c = decode_utf8(text, i);
        take(c.value);
        i += c.length;
    }
}

// On one line.
std::uint32_t shown(std::uint32_t c) {
    if (c == '\t' || c == '\n') return ' ';
    return is_printable(c) ? c : replacement;
}

// The YAML characters that may stand in quotes as they are (YAML 1.1, 5.1): not the byte order
// mark, no noncharacters of the basic plane.
bool plain_in_yaml(std::uint32_t c) {
    return is_printable(c) && c != 0xFEFF && c != 0xFFFE && c != 0xFFFF;
}

std::string escaped_in_yaml(std::uint32_t c) {
    switch (c) {
    case '"': return "\\\"";
    case '\\': return "\\\\";
    case '\n': return "\\n";
    default: return c < 0x100 ? fmt::format("\\x{:02X}", c) : fmt::format("\\u{:04X}", c);
    }
}

} // namespace

// C0, DEL, C1; line separators; the marks, embeddings and isolates that turn the reading direction.
bool is_printable(std::uint32_t c) {
    return !(c < 0x20 || (c >= 0x7F && c < 0xA0) || c == 0x061C || c == 0x200E || c == 0x200F ||
             (c >= 0x2028 && c <= 0x202E) || (c >= 0x2066 && c <= 0x2069));
}

std::string for_terminal(std::string_view text) {
    std::string out;
    out.reserve(text.size());
    each_code_point(text, [&](std::uint32_t c) { append_utf8(out, shown(c)); });
    return out;
}

std::string for_comment(std::string_view text) {
    std::string out;
    each_code_point(text, [&](std::uint32_t c) {
        const bool ends = c == '\\' || (c == '/' && out.ends_with('*'));
        append_utf8(out, ends ? replacement : shown(c));
    });
    return out;
}

std::string for_html(std::string_view text) {
    std::string out;
    each_code_point(text, [&](std::uint32_t c) {
        switch (c) {
        case '<': out += "&lt;"; break;
        case '>': out += "&gt;"; break;
        case '&': out += "&amp;"; break;
        case '"': out += "&quot;"; break;
        case '\'': out += "&#39;"; break;
        default: append_utf8(out, shown(c));
        }
    });
    return out;
}

std::string for_json(std::string_view text) {
    std::string out = "\"";
    each_code_point(text, [&](std::uint32_t c) {
        switch (c) {
        case '"': out += "\\\""; break;
        case '\\': out += "\\\\"; break;
        case '\n': out += "\\n"; break;
        case '\r': out += "\\r"; break;
        case '\t': out += "\\t"; break;
        default:
            if (is_printable(c))
                append_utf8(out, c);
            else // all of them lie in the basic plane
                out += fmt::format("\\u{:04x}", c);
        }
    });
    return out + '"';
}

std::string for_script(std::string_view text) {
    std::string out;
    for (const char c : for_json(text)) {
        if (c == '<')
            out += "\\u003c";
        else
            out += c;
    }
    return out;
}

std::string for_yaml(std::string_view text) {
    bool plain = true;
    each_code_point(text, [&](std::uint32_t c) { plain = plain && plain_in_yaml(c); });
    std::string out(1, plain ? '\'' : '"');
    each_code_point(text, [&](std::uint32_t c) {
        if (plain && c == '\'')
            out += "''"; // the only escape of single quotes
        else if (plain || (plain_in_yaml(c) && c != '"' && c != '\\'))
            append_utf8(out, c);
        else
            out += escaped_in_yaml(c);
    });
    return out + (plain ? '\'' : '"');
}

} // namespace fathom
