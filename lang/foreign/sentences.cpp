// Lines of plain words: a remark, a scene as `make a red sphere with radius 2`, and a call whose arguments are
// parted by spaces, as `sphere radius=2 color=blue`.
#include "lang/foreign/foreign.h"

#include <array>

namespace fathom::lang {

// What holds a sentence together, and is no value's name where the file has none such.
bool ForeignSyntax::word_of_sentence(Index at) {
    constexpr std::array<std::string_view, 14> holding = {"a",    "an",     "the",  "with", "of",
                                                          "on",   "at",     "to",   "by",   "from",
                                                          "into", "please", "that", "it"};
    return kind(at) == Tok::Name && is_one_of(text(at), holding) && !may_be_declared(text(at));
}

// Words in a row, behind the first of them one such as holds sentences together: the whole
// statement.
bool ForeignSyntax::sentence(Index first, Index past) {
    const bool whole = first == 0 || is_one_of(kind(first - 1), {Tok::End, Tok::Body, Tok::Trailing,
                                                                 Tok::BraceClose});
    if (!whole || text(first) == "case") return false;
    Index words = 0;
    bool holds = false;
    for (Index i = first; i<past; i = match(i)> i ? match(i) + 1 : i + 1) {
        if (is_one_of(kind(i), {Tok::Number, Tok::Comma, Tok::And, Tok::In})) continue;
        if (match(i) > i) { // `sphere(1) on top of the box`, `a ball at (1, 2, 3)`
            if (kind(i) == Tok::Trailing) return false;
            continue;
        }
        if (kind(i) != Tok::Name || is_one_of(kind(i + 1), {Tok::Assign, Tok::Colon})) return false;
        const bool call = match(i + 1) > i + 1 && touch(i, i + 1);
        words += call ? 0 : 1;
        holds = holds || (i > first && !call && word_of_sentence(i));
    }
    if (words < 3 || !holds) return false;
    failed_ = past;
    foreign(span(first, past - 1), "a scene is not told in sentences")
        .help("each shape is a call, and what is done to it stands behind a `.`: "
              "`sphere(2).paint(red).translate(y: 1)`");
    return true;
}

// A line of words, as `-- a remark`, `; a remark`: no statement.
bool ForeignSyntax::remark(Index first, Index at) {
    Index words = first;
    while (kind(words) == Tok::Minus) ++words;
    const Index begin = words;
    while (is_one_of(kind(words), {Tok::Name, Tok::In, Tok::And, Tok::Or, Tok::Not, Tok::For}))
        ++words;
    if (at >= 3 && kind(at - 1) == Tok::Name && kind(at - 2) == Tok::Minus &&
        kind(at - 3) == Tok::Minus && touch(at - 3, at - 2) && kind(at) == Tok::Name &&
        at - 3 > first) { // `sphere(1) -- a remark`
        foreign(span(at - 3, at - 2), "a comment begins with `//`")
            .help("write `//`", {{span(at - 3, at - 2), "//"}});
        return true;
    }
    const bool dashes = begin == first + 2 && touch(first, first + 1);
    const Index count = words - begin;
    const bool lisp = first > 0 && kind(first - 1) == Tok::End && text(first - 1) == ";" &&
                      !token(first).first_on_line;
    if (!ends_statement(words) || at > words || at < begin || count < (dashes ? 2u : 3u) ||
        (begin > first && !dashes) || kind(begin) != Tok::Name)
        return false;
    Index known = begin + 1; // `union a b`
    while (known < words && is_declared(std::string(text(known)))) ++known;
    const bool alone = first == 0 && words + 1 >= tokens_.tokens.size(); // the scene itself
    if (known == words || (alone && sentence(first, words))) return known < words;
    const Span sign = dashes ? span(first, first + 1)
                      : lisp ? span(first - 1)
                             : Span{id_, token(first).begin, token(first).begin};
    foreign(span(lisp ? first - 1 : first, words - 1), "a comment begins with `//`")
        .help("write `//`", {{sign, dashes || lisp ? "//" : "// "}});
    return true;
}

// `sphere radius=2 color=blue`, as a command has its arguments, at the shape: each `=` touches what
// it stands between, or there are several.
bool ForeignSyntax::arguments_by_space(Index first) {
    std::string arguments;
    Index at = first + 1;
    int count = 0;
    bool touching = true, used = false;
    while (kind(at) == Tok::Name && kind(at + 1) == Tok::Assign) {
        const Index value = at + 2;
        touching = touching && touch(at, at + 1) && touch(at + 1, value);
        Index end = value;
        bool row = false; // `size=1,2,3`
        while (!ends_statement(end) &&
               !(end > value && kind(end) == Tok::Name && kind(end + 1) == Tok::Assign)) {
            used = used || (kind(end) == Tok::Name && text(end) == text(at));
            row = row || (kind(end) == Tok::Comma && !ends_statement(end + 1) &&
                          kind(end + 2) != Tok::Assign);
            end = match(end) > end ? match(end) + 1 : end + 1;
        }
        if (end == value) return false;
        const Index last = kind(end - 1) == Tok::Comma ? end - 2 : end - 1;
        const std::string given(text(token(value).begin, token(last).end));
        arguments += (count++ > 0 ? ", " : "") + std::string(text(at)) + ": " +
                     (row ? "[" + given + "]" : given);
        at = end;
    }
    const bool function = count == 1 && (!touching || used || is_used_after(first)); // `f x=2*x`
    if (count == 0 || !ends_statement(at) || function) return false;
    const std::string written = std::string(text(first)) + "(" + arguments + ")";
    failed_ = at;
    foreign(span(first, first + 1), "a call's arguments stand in parentheses, named with `:`")
        .help(to_write(written), {{span(first, at - 1), written}});
    return true;
}

// Python's `*`, `/`, `*shapes` and `**options`, JavaScript's `...shapes`, where a parameter's name
// should stand.
bool ForeignSyntax::foreign_parameter(Index at) {
    const bool rest = kind(at) == Tok::DotDot && text(at) == "...";
    if (!rest && !is_one_of(kind(at), {Tok::Star, Tok::Slash, Tok::Caret})) return false;
    if (is_one_of(kind(at + 1), {Tok::Comma, Tok::Close})) {
        const bool last = kind(at + 1) == Tok::Close;
        const std::uint32_t begin = last && kind(at - 1) == Tok::Comma ? token(at - 1).begin
                                                                       : token(at).begin,
                            end = last ? token(at).end : token(at + 2).begin;
        foreign(span(at), "each argument may be given by its name, or by its place")
            .help("leave " + in_code(text(at)) + " away", {{{id_, begin, end}, ""}});
        return true;
    }
    if (kind(at + 1) != Tok::Name) return false;
    if (kind(at) == Tok::Caret) diagnostics_.withdraw(Code::ForeignSyntax, span(at)); // no power
    foreign(span(at, at + 1), "a function is given as many arguments as it has parameters")
        .help("take a list: leave " + in_code(text(at)) +
                  " away, and give what it is given in `[ … ]`",
              {{span(at), ""}});
    return true;
}

// `translate(x; 2)`, `max(a; b)`, at the `;`: a slip of the shift key, or other languages' comma.
bool ForeignSyntax::parted_by_semicolon(Index at, Index open) {
    constexpr std::array<std::string_view, 10> values = {"pi",  "tau", "inf", "time", "p",
                                                         "pos", "red", "X",   "Y",    "Z"};
    const bool named = kind(at - 1) == Tok::Name && kind(open - 1) == Tok::Name &&
                       is_one_of(kind(at - 2), {Tok::Open, Tok::Comma}) &&
                       !is_one_of(text(at - 1), values) && !may_be_declared(text(at - 1));
    if (named) return foreign_instead(at, "an argument is named with `:`", ":");
    return foreign_instead(at, "arguments are parted by commas", ",");
}

} // namespace fathom::lang
