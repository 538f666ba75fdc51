// `switch` and `do … while` of C and its kin, the lines of its preprocessor that choose, and
// OpenSCAD's `let(…)` before a value.
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

// At `#if`: the edits that leave its lines away, and what they leave out, where that is known by a
// number or by whether the text defines a name.
std::vector<Edit> ForeignWords::chosen_lines(std::uint32_t begin) const {
    if (!may_look_far()) return {};
    const std::string_view all = source_.text;
    const auto line_end = [&](std::size_t at) { return std::min(all.find('\n', at), all.size()); };
    const auto word_at = [&](std::size_t at) { // `# if`, too
        std::size_t from = all.find_first_not_of(" \t", at + 1), past = from;
        while (past < all.size() && is_word_char(all[past])) ++past;
        return all.substr(std::min(from, all.size()), past - from);
    };
    const auto argument = [&](std::size_t at) {
        const std::string_view line = all.substr(at, line_end(at) - at);
        const std::size_t from = line.find(word_at(at)) + word_at(at).size();
        const std::size_t first = line.find_first_not_of(" \t", from);
        return first == std::string_view::npos
                   ? std::string_view()
                   : line.substr(first, line.find_first_of(" \t\r/", first) - first);
    };
    const std::string name(argument(begin));
    const std::string_view word = word_at(begin);
    bool holds = false;
    if (word == "if" && (name == "0" || name == "1"))
        holds = name == "1";
    else if ((word == "ifdef" || word == "ifndef") && !name.empty())
        holds = (all.substr(0, begin).find("#define " + name) != std::string_view::npos ||
                 all.substr(0, begin).find("let " + name + " ") != std::string_view::npos) ==
                (word == "ifdef");
    else
        return {};
    std::size_t other = 0;
    int depth = 1;
    for (std::size_t at = line_end(begin); at < all.size(); at = line_end(at + 1)) {
        const std::size_t first = all.find_first_not_of(" \t", at + 1);
        if (first == std::string_view::npos || all[first] != '#') continue;
        const std::string_view what = word_at(first);
        if (what == "if" || what == "ifdef" || what == "ifndef") ++depth;
        if (what == "elif" && depth == 1) return {};
        if (what == "else" && depth == 1) other = first;
        if (what != "endif" || --depth > 0) continue;
        const auto cut = [&](std::size_t from, std::size_t to) {
            return Edit{span(static_cast<std::uint32_t>(from), static_cast<std::uint32_t>(to)), ""};
        };
        const std::size_t past = line_end(first);
        if (holds) return {cut(begin, line_end(begin)), cut(other > 0 ? other : first, past)};
        if (other == 0) return {cut(begin, past)};
        return {cut(begin, line_end(other)), cut(first, past)};
    }
    return {};
}

} // namespace fathom::lang
