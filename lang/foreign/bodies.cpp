// Bodies that stand in no braces: by indentation behind a `:`, behind `=>`, `then` or `do`, behind
// `let(…)`, or directly behind their header.
#include "lang/foreign/foreign.h"

#include <algorithm>

namespace fathom::lang {

bool ForeignSyntax::begins_body(Index at) const {
    return is_one_of(kind(at), {Tok::Colon, Tok::FatArrow});
}

// The body behind a header's `:`, on the line or on deeper lines below it: what it takes to put it
// in braces, and where reading goes on. False where there is none.
bool ForeignSyntax::indented_body(Index colon, std::vector<Edit> &edits) {
    const auto indent_of = [&](Index i) {
        const std::string_view all = source_.text;
        const std::size_t line = all.rfind('\n', token(i).begin);
        const std::size_t begin = line == std::string_view::npos ? 0 : line + 1;
        return std::min(all.find_first_not_of(" \t", begin), all.size()) - begin;
    };
    const bool sign = begins_body(colon),
               word = kind(colon) == Tok::Else; // or the line's end
    const std::size_t margin = indent_of(sign || word ? colon : colon - 1);
    const std::size_t count = tokens_.tokens.size();
    Index last = colon;
    bool below = false;
    for (Index i = colon + 1; i < count; ++i) {
        const Token &t = token(i);
        if (t.begin == t.end) continue; // a line's end
        if (is_one_of(t.kind, {Tok::BraceClose, Tok::Close, Tok::ListClose})) break;
        if (t.first_on_line) {
            if (indent_of(i) <= margin) break;
            below = true;
        }
        if (!below && is_one_of(t.kind, {Tok::Comma, Tok::Else})) break;
        last = i = std::max(i, match(i));
    }
    if (last == colon) return false;
    const std::uint32_t end = token(last).end;
    const bool spaced =
        sign && token(colon).begin > 0 && source_.text[token(colon).begin - 1] == ' ';
    const std::uint32_t header = token(word ? colon : colon - 1).end;
    edits.push_back({sign ? span(colon) : Span{id_, header, header}, spaced ? "{" : " {"});
    edits.push_back(
        {{id_, end, end}, below ? "\n" + std::string(margin, ' ') + "}" : std::string(" }")});
    failed_ = last;
    return true;
}

// `if a: …`, `for x in l: …`, `for x in l => …`, at the sign; the `else:` behind it too.
void ForeignSyntax::foreign_colon(Index at) {
    constexpr std::string_view below = ", which begin on the line of its header";
    std::vector<Edit> edits;
    bool whole = indented_body(at, edits);
    for (Index i = failed_ + 1; whole && i < tokens_.tokens.size();) {
        while (kind(i) == Tok::End && i + 1 < tokens_.tokens.size()) ++i;
        const bool other = kind(i) == Tok::Else;
        if (!other && !(kind(i) == Tok::Name && text(i) == "elif")) break;
        if (!other) edits.push_back({span(i), "else if"});
        Index colon = i + 1;
        while (!ends_statement(colon) && !begins_body(colon)) ++colon;
        if (other && token(i + 1).first_on_line) colon = i;
        whole = (begins_body(colon) || kind(at) == Tok::End) && indented_body(colon, edits);
        i = failed_ + 1;
    }
    Diagnostic &d =
        foreign(span(at), "a body stands in braces" +
                              std::string(kind(at) == Tok::End ? below : std::string_view()));
    d.help("write `{ … }`", whole ? std::move(edits) : std::vector<Edit>{});
}

// `if a then b else c`, `for i in 0..3 do b`.
void ForeignSyntax::foreign_then(Index at) {
    if (kind(at + 1) == Tok::End && block_until_end(at)) return;
    Diagnostic &d = foreign(span(at), "a body stands in braces");
    const auto is_end = [&](Index i) { return kind(i) == Tok::Name && text(i) == "end"; };
    const auto end_of = [&](Index i) { // of the branch that begins there
        while (!ends_statement(i) && kind(i) != Tok::Else && kind(i) != Tok::Close &&
               kind(i) != Tok::ListClose && kind(i) != Tok::Comma && !is_end(i))
            i = match(i) > i ? match(i) + 1 : i + 1;
        return i;
    };
    const auto before = [&](Index i) { return Span{id_, token(i).begin, token(i).begin}; };
    const auto behind = [&](Index i) { return Span{id_, token(i - 1).end, token(i - 1).end}; };
    const auto close = [&](Index i) {
        if (is_end(i)) failed_ = i;
        return is_end(i) ? Edit{span(i), "}"} : Edit{behind(i), " }"};
    };
    const Index first = at + 1, end = end_of(first);
    if (end == first || kind(first) == Tok::Body) {
        d.help("write `{ … }`");
        return;
    }
    std::string told = "`{ " + std::string(text(token(first).begin, token(end - 1).end)) + " }";
    std::vector<Edit> edits{{span(at), "{"}, close(end)};
    const Index other = end + 1;
    if (kind(end) == Tok::Else && kind(other) != Tok::If && kind(other) != Tok::Body) {
        if (const Index last = end_of(other); last > other) {
            told += " else { " + std::string(text(token(other).begin, token(last - 1).end)) + " }";
            edits.push_back({before(other), "{ "});
            edits.push_back(close(last));
        }
    }
    d.help("write " + told + "`", std::move(edits));
}

// Whether an `else` follows the statement that ends there.
bool ForeignSyntax::goes_on_with_else(Index end) const {
    while (kind(end) == Tok::End && end < tokens_.tokens.size()) ++end;
    return kind(end) == Tok::Else;
}

// `for i in 0:5 { … }`, at the colon.
bool ForeignSyntax::colon_range(Index at) {
    Index first = at;
    while (first > 0 && !is_one_of(kind(first), {Tok::For, Tok::If, Tok::While, Tok::End})) --first;
    Index end = at + 1;
    while (!ends_statement(end) && kind(end) != Tok::Body) ++end;
    if (kind(first) != Tok::For || kind(end) != Tok::Body) return false;
    return foreign_instead(at, "a range is written with `..`, or `..=` with its end", "..=");
}

// A header without its `{`: `if a = b {`, `if x:`, `if (c) return 1`.
bool ForeignSyntax::foreign_body(Index at) {
    // `for x in xs => …` was read as one of a lambda
    for (Index i = at; i-- > 0 && kind(i) != Tok::End;)
        if (kind(i) == Tok::For && kind(i + 1) == Tok::Name && kind(i + 2) == Tok::In &&
            kind(i + 3) == Tok::LambdaName && kind(i + 4) == Tok::FatArrow && i + 4 < at)
            return foreign_body(i + 4);
    const Tok found = kind(at);
    body_missing_ = true;
    if (found == Tok::End && text(at) == ";" && kind(at + 1) == Tok::StrayBrace) { // `if a; { … }`
        failed_ = match(at + 1);
        foreign(span(at), "a body begins directly behind its header")
            .help("leave the `;` away", {{span(at), ""}});
        return true;
    }
    if (at < tokens_.tokens.size() && found == Tok::End) {
        foreign_colon(at);
        return true;
    }
    if (head_of_loop(at) || foreign_word_operator(at) || foreign_comparison(at)) return true;
    if (found == Tok::Colon && (foreign_scope(at) || colon_range(at))) return true;
    if (found == Tok::Assign) {
        foreign(span(at), "a comparison is written `==`").help("write `==`", {{span(at), "=="}});
        return true;
    }
    if (found == Tok::FatArrow && kind(at + 1) == Tok::Body) { // `for x in 0..3 => { … }`
        failed_ = match(at + 1);
        foreign(span(at), "a body begins directly behind its header")
            .help("leave the `=>` away", {{{id_, token(at).begin, token(at + 1).begin}, ""}});
        return true;
    }
    if (begins_body(at)) {
        foreign_colon(at);
        return true;
    }
    if (found == Tok::Name && (text(at) == "then" || text(at) == "do")) {
        foreign_then(at);
        return true;
    }
    const bool nested = is_one_of(found, {Tok::For, Tok::While, Tok::If}); // `if a for …`
    if (!nested && !is_one_of(found, {Tok::Return, Tok::Break, Tok::Name, Tok::Number}))
        return false;
    Index end = at;
    while (!ends_statement(end) && kind(end) != Tok::Else)
        end = match(end) > end ? match(end) + 1 : end + 1;
    if (nested && is_one_of(Tok::Else, {kind(end), kind(end + 1)})) return false; // whose is it?
    std::string told = "{ " + std::string(text(token(at).begin, token(end - 1).end)) + " }";
    std::vector<Edit> edits{{{id_, token(at).begin, token(at).begin}, "{ "},
                            {{id_, token(end - 1).end, token(end - 1).end}, " }"}};
    // `; else b`
    Index other = end;
    while (kind(other) == Tok::End && other < tokens_.tokens.size() && text(other) == ";") ++other;
    if (kind(other) == Tok::Else && kind(other + 1) != Tok::If && kind(other + 1) != Tok::Body) {
        const Index begin = other + 1;
        Index last = begin;
        while (!ends_statement(last)) last = match(last) > last ? match(last) + 1 : last + 1;
        if (other > end) edits.push_back({span(end, other - 1), ""});
        if (last > begin) {
            edits.push_back({{id_, token(begin).begin, token(begin).begin}, "{ "});
            edits.push_back({{id_, token(last - 1).end, token(last - 1).end}, " }"});
            told += " else { " + std::string(text(token(begin).begin, token(last - 1).end)) + " }";
            failed_ = last - 1;
        }
    }
    foreign(span(at), "a body stands in braces").help("write `" + told + "`", std::move(edits));
    return true;
}

// OpenSCAD's `function f(x) = let(a = 2*x, b = a) a + b;`, at its `let`: a body of statements.
bool ForeignSyntax::let_of_value(Index at) {
    const Index close = match(at + 1), assign = at - 1;
    if (kind(at) != Tok::Let || kind(at + 1) != Tok::Open || close <= at + 1 || at < 4 ||
        kind(assign) != Tok::Assign || kind(assign - 1) != Tok::Close)
        return false;
    Index head = assign - 1;
    while (head > 0 && !token(head).first_on_line && kind(head) != Tok::End) --head;
    const Index end = statement_end(at);
    if (kind(head) != Tok::Fn || end <= close + 1) return false;
    std::vector<Edit> edits{{{id_, token(assign).begin, token(at + 1).end}, "{ let "}};
    for (Index i = at + 2; i<close; i = match(i)> i ? match(i) + 1 : i + 1)
        if (kind(i) == Tok::Comma) edits.push_back({span(i), "; let"});
    edits.push_back({span(close), ";"});
    edits.push_back({{id_, token(end - 1).end, token(end - 1).end}, " }"});
    failed_ = end - 1;
    foreign(span(at), "names are bound by a `let` each, before what uses them")
        .help("write `{ let a = …; value }`", std::move(edits));
    return true;
}

} // namespace fathom::lang
