// Comments, which are kept for the formatter; and those that their writer did not mean as one.
#include "lang/lexer.h"

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

} // namespace fathom::lang
