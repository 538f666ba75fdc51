// `switch`, `do … while` and records without a value, as C and its kin have them.
#include "lang/foreign/foreign.h"
#include "lang/lexer.h"

namespace fathom::lang {

bool ForeignSyntax::c_statement(Index first) {
    return (text(first) == "struct" && foreign_struct(first)) ||
           (text(first) == "switch" && switch_choice(first)) ||
           (text(first) == "do" && do_loop(first));
}

// `switch (x) { case 1: a; break; case 2: case 3: b; break; default: c; }`, where no case runs on into
// the next one.
bool ForeignSyntax::switch_choice(Index first) {
    const Index close_value = match(first + 1), open = close_value + 1, close = match(open);
    if (kind(first + 1) != Tok::Open || close_value <= first + 1 || close <= open) return false;
    const std::string value(text(token(first + 2).begin, token(close_value - 1).end));
    const auto is_label = [&](Index i) {
        return kind(i) == Tok::Name && (text(i) == "case" || text(i) == "default");
    };
    const auto next = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    std::string written;
    for (Index i = open + 1; i < close;) {
        while (i < close && kind(i) == Tok::End) ++i;
        if (i == close) break;
        std::string test;
        bool is_default = false;
        for (; is_label(i); ++i) {
            const Index from = i + 1;
            is_default = is_default || text(i) == "default";
            while (i < close && kind(i) != Tok::Colon) ++i;
            if (i == close) return false;
            if (i > from)
                test += (test.empty() ? "" : " or ") + value +
                        " == " + std::string(text(token(from).begin, token(i - 1).end));
            while (kind(i + 1) == Tok::End && i + 1 < close) ++i;
        }
        if (test.empty() && !is_default) return false;
        Index behind = i;
        while (behind < close && !is_label(behind)) behind = next(behind);
        while (behind > i && kind(behind - 1) == Tok::End) --behind;
        const bool block = match(i) > i && match(i) + 1 == behind; // `case 1: { … }`
        const Index begin = block ? i + 1 : i, past = block ? match(i) : behind;
        Index last = begin; // where its last statement begins
        bool leaves = false;
        for (Index k = begin; k < past; k = next(k)) {
            if (leaves && kind(k) != Tok::End && kind(last) == Tok::Break) return false;
            if (kind(k) == Tok::Break || kind(k) == Tok::Return) leaves = true, last = k;
        }
        while (behind < close && kind(behind) == Tok::End) ++behind;
        if (behind < close && (!leaves || is_default)) return false;
        Index end = leaves && kind(last) == Tok::Break ? last : past;
        while (end > begin && kind(end - 1) == Tok::End) --end;
        const std::string body =
            end > begin ? std::string(text(token(begin).begin, token(end - 1).end)) + " " : "";
        written += (written.empty() ? "" : " else ") +
                   (is_default ? std::string() : "if " + test + " ") + "{ " + body + "}";
        i = behind;
    }
    if (written.empty() || !written.starts_with("if ")) return false;
    failed_ = close;
    foreign(span(first), "a choice is written with `if`")
        .help("write `if a { … } else if b { … } else { … }`", {{span(first, close), written}});
    return true;
}

// `do { … } while (c);`: a loop that its condition ends from the second turn on.
bool ForeignSyntax::do_loop(Index first) {
    const Index open = first + 1, close = match(open), at = close + 1;
    if (close <= open || kind(at) != Tok::While || kind(at + 1) != Tok::Open ||
        match(at + 1) <= at + 1)
        return false;
    const std::string test(text(token(at + 1).begin, token(match(at + 1)).end));
    failed_ = match(at + 1);
    foreign(span(first), "a loop begins with its condition, and has a limit")
        .help("write `while again limit 100 { …; again = condition }`",
              {{span(first, open), "var again = true\nwhile again limit 100 {"},
               {span(close, match(at + 1)), "again = " + test + " }"}});
    return true;
}

// `Hit h;` of a record that the text makes by a function: one of zeros; else empty.
std::string ForeignSyntax::zero_record(std::string_view type) const {
    for (Index i = 0; i + 2 < tokens_.tokens.size() && may_look_far(); ++i) {
        if (kind(i) != Tok::Fn || text(i + 1) != type || kind(i + 2) != Tok::Open) continue;
        std::string zeros;
        for (Index k = i + 3; k < match(i + 2); ++k)
            if (kind(k) == Tok::Name) zeros += zeros.empty() ? "0.0" : ", 0.0";
        return zeros.empty() ? zeros : std::string(type) + "(" + zeros + ")";
    }
    return {};
}

} // namespace fathom::lang
