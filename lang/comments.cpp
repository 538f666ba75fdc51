// Comments, which are kept for the formatter; those that their writer did not mean as one; and what a
// `#` begins, which is a colour here.
#include "lang/lexer.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::lang {

// `2`, `3)`: hardly a remark.
static bool is_number_alone(std::string_view text) {
    const std::size_t first = text.find_first_not_of(' ');
    if (first == text.npos || !is_digit(text[first])) return false;
    return text.find_first_not_of("0123456789.)], ", first) == text.npos;
}

void Lexer::line_comment(std::uint32_t begin, std::uint32_t end) {
    if (end > begin && source_.text[end - 1] == '\r') --end;
    words_.comments.push_back({begin, end, true});
    turned_text(begin, end);
    // Python's `a //= 2`: a comment would swallow it in silence.
    const std::string_view text = slice(begin, end);
    const bool after_name = !fresh_line_ && words_.tokens.back().kind == Tok::Name;
    if (after_name && text.starts_with("//= ") && text.size() > 4)
        report(Code::ForeignSyntax, begin, begin + 3, "`//` begins a comment")
            .help("whole division is `a = div(a, b)`");
    const bool after_value =
        !fresh_line_ && is_one_of(words_.tokens.back().kind, {Tok::Name, Tok::Number});
    if (after_value && is_number_alone(text.substr(2))) { // Python's `7 // 2`
        Diagnostic d{Code::ForeignSyntax,
                     Severity::Warning,
                     "`//` begins a comment",
                     {span(begin, begin + 2), {}},
                     {},
                     {},
                     {}};
        d.help("if a whole quotient is meant, write `div(a, b)`");
        diagnostics_.add(std::move(d));
    }
}

void Lexer::block_comment(std::uint32_t begin, std::uint32_t end) {
    words_.comments.push_back({begin, end, false});
    turned_text(begin, end);
    if (slice(begin, end).find('\n') != std::string_view::npos) fresh_line_ = true;
}

void Lexer::unclosed_comment(std::uint32_t begin, std::uint32_t end) {
    words_.comments.push_back({begin, end, false});
    report(Code::UnclosedBracket, begin, begin + 2, "this comment is never closed")
        .help("close it with `*/`; comments do not nest");
}

std::uint32_t Lexer::hash(std::uint32_t begin, std::uint32_t end) {
    const std::string_view digits = slice(begin + 1, end);
    const bool all_hex = std::all_of(digits.begin(), digits.end(), is_hex);
    if (all_hex && (digits.size() == 3 || digits.size() == 6 || digits.size() == 8)) {
        add(Tok::Color, begin, end);
        return end;
    }
    if (digits.empty() && !fresh_line_ && lisp_vector(end)) {
        if (!told_before(begin, end, {{span(begin, end), ""}}))
            report(Code::BadCharacter, begin, end, "a vector is written `[x, y, z]`")
                .help("leave the `#` away", {{span(begin, end), ""}});
        return end;
    }
    // `# remark` of Python, and `#version`, `#include`: the rest of the line is theirs.
    if (digits.empty() || (fresh_line_ && !all_hex)) {
        const auto line_end = static_cast<std::uint32_t>(
            std::min(source_.text.find('\n', begin), source_.text.size()));
        if (end < source_.text.size() && source_.text[end] == '(') { // OpenSCAD's modifier
            report(Code::ForeignSyntax, begin, begin + 1, "there are no modifiers of shapes")
                .help("leave it away", {{span(begin, begin + 1), ""}});
            return begin + 1;
        }
        if (digits == "define")
            if (const std::uint32_t head_end = define(begin, end); head_end > 0) return head_end;
        if (digits.empty())
            report(Code::ForeignSyntax, begin, begin + 1, "a comment begins with `//`")
                .help("write `//`", {{span(begin, begin + 1), "//"}});
        else
            directive(begin, end, line_end);
        return line_end;
    }
    add(Tok::Bad, begin, end);
    Diagnostic &d =
        report(Code::BadColor, begin, end, "a colour takes 3, 6 or 8 hex digits after the `#`");
    if (all_hex)
        d.note(fmt::format("here are {}", digits.size()));
    else
        d.note("hex digits are 0 to 9 and a to f");
    d.help("write it as `#f80` or `#ff8800`");
    return end;
}

} // namespace fathom::lang
