// Answers to rows of values as Curv, Python and JavaScript write them: lists behind a function's name,
// pipes, comprehensions, strings that hold values, calls without their dot.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 14> changes_of_shapes = {
    "translate", "rotate", "scale", "mirror", "paint", "offset",  "shell",
    "twist",     "repeat", "move",  "color",  "bend",  "reflect", "displace"};

bool spreads(std::string_view word) { return word == "*" || word == "..." || word == "each"; }

} // namespace

std::string joined_string(std::string_view quoted, std::string_view opening) {
    const std::string_view inside = quoted.substr(1, quoted.size() - 2);
    std::string sum;
    std::size_t at = 0;
    bool any = false;
    const auto add = [&](const std::string &part) { sum += (sum.empty() ? "" : " + ") + part; };
    while (at <= inside.size()) {
        const std::size_t open = std::min(inside.find(opening, at), inside.size());
        const std::string_view words = inside.substr(at, open - at);
        if (words.find_first_of("{}\"\\") != words.npos) return {};
        if (!words.empty() || sum.empty()) add("\"" + std::string(words) + "\"");
        if (open == inside.size()) break;
        const std::size_t value = open + opening.size(), close = inside.find('}', value);
        if (close == inside.npos) return {};
        std::string_view held = inside.substr(value, close - value);
        if (const std::size_t format = held.find(':');
            format != held.npos && held.find_first_of("([?") == held.npos)
            held = held.substr(0, format); // `{x:.2f}`
        if (held.empty() || held.find_first_of("{\"'\n=") != held.npos) return {};
        const bool plain = held.find_first_of("+-*/<>|& ") == held.npos;
        add(plain ? std::string(held) : "(" + std::string(held) + ")");
        any = true;
        at = close + 1;
        if (at == inside.size()) break;
    }
    return any ? sum : std::string();
}

// A list in which lists are spread or loops stand beside entries, as `concat(a, [3], [for …])`; empty
// where an entry is missing.
std::string ForeignSyntax::joined_list(Index open) const {
    const Index close = match(open);
    std::vector<std::string> lists;
    bool row = false; // the last one is of single values
    for (Index first = open + 1, i = first; i <= close; i = match(i) > i ? match(i) + 1 : i + 1) {
        if (i < close && kind(i) != Tok::Comma) continue;
        const bool spread = spreads(text(first)), whole = spread || kind(first) == Tok::For;
        const Index begin = spread ? first + 1 : first;
        if (begin >= i) return {};
        const std::string part(text(token(begin).begin, token(i - 1).end));
        if (whole)
            lists.push_back(spread ? part : "[" + part + "]");
        else if (row)
            lists.back().insert(lists.back().size() - 1, ", " + part);
        else
            lists.push_back("[" + part + "]");
        row = !whole;
        first = i + 1;
    }
    std::string joined = lists[0];
    for (std::size_t k = 1; k < lists.size(); ++k) joined += ", " + lists[k];
    return lists.size() > 1 ? "concat(" + joined + ")" : joined;
}

// `[*a, 3]`, `[...a, 3]`, `[each a, 3]`, at the sign.
bool ForeignSyntax::list_spread(Index at) {
    const Index open = enclosing(at), close = match(open);
    if (!spreads(text(at)) || !is_one_of(kind(open), {Tok::ListOpen, Tok::FreshListOpen}) ||
        (at != open + 1 && kind(at - 1) != Tok::Comma))
        return false;
    const std::string joined = joined_list(open);
    if (joined.empty()) return false;
    failed_ = close;
    foreign(span(at), "a list is not spread out: lists are joined by `concat`")
        .help(to_write(joined), {{span(open, close), joined}});
    return true;
}

// numpy's `p[:, 0]`, at the colon: a part of the point.
bool ForeignSyntax::column_of_rows(Index at) {
    const Index open = at - 1, close = at + 3;
    if (at == 0 || kind(at) != Tok::Colon || kind(open) != Tok::ListOpen || match(open) != close ||
        kind(at + 1) != Tok::Comma || kind(at + 2) != Tok::Number)
        return false;
    constexpr std::string_view parts = "xyz";
    const std::size_t which = std::string_view("012").find(text(at + 2));
    if (which >= parts.size()) return false;
    failed_ = close;
    foreign(span(open, close), "a field is given one point, not rows of them")
        .help(to_write(std::string(".") + parts[which]),
              {{span(open, close), std::string(".") + parts[which]}});
    return true;
}

// `[for i in 0..3 { i }, 7]`, at the comma, and `[7, for i in 0..3 { i }]`, at the loop.
bool ForeignSyntax::loop_among_entries(Index at) {
    const Index open = enclosing(at), close = match(open);
    const bool begun =
        kind(at) == Tok::For ? kind(at - 1) == Tok::Comma : kind(open + 1) == Tok::For;
    if (!begun || !is_one_of(kind(open), {Tok::ListOpen, Tok::FreshListOpen}) || close <= at)
        return false;
    const bool last = at + 1 == close; // `[for i in 0..3 { i }, ]`
    const std::string joined = last ? std::string() : joined_list(open);
    if (joined.empty() && !last) return false;
    failed_ = close;
    Diagnostic &d =
        diagnostics_.add(Code::SyntaxError, span(at), "a list is made by one loop, or of entries");
    if (last)
        d.help("leave the `,` away", {{span(at), ""}});
    else
        d.help("lists are joined by `concat(a, b)`", {{span(open, close), joined}});
    return true;
}

// `enum Kind { BALL, CUBE }`: each is a number.
void ForeignSyntax::enumeration(Index first) {
    std::string written;
    Index open = first + 1;
    while (kind(open) == Tok::Name) lost_.push_back(open++);
    const Index close = match(open);
    bool plain = close > open && close < open + 100;
    int number = 0;
    for (Index i = open + 1; i < close; i += 2) {
        plain =
            plain && kind(i) == Tok::Name && is_one_of(kind(i + 1), {Tok::Comma, Tok::BraceClose});
        if (kind(i) == Tok::Name) lost_.push_back(i);
        written += (number > 0 ? "; let " : "let ") + std::string(text(i)) + " = " +
                   std::to_string(number);
        ++number;
    }
    foreign(span(first), "there are no enumerations")
        .help(plain ? "write " + in_code(written) : "give each number a name of its own with `let`",
              plain && number > 0 ? std::vector<Edit>{{span(first, close), written}}
                                  : std::vector<Edit>{});
}

// Curv's `r :: slider[0, 2] = 1` as a `param`, and its last word; empty where it is none.
std::string ForeignSyntax::slider_text(Index name, Index &value) const {
    const Index open = name + 4, close = match(open);
    value = close + 2;
    const bool plain = kind(name) == Tok::Name && kind(name + 1) == Tok::Colon &&
                       kind(name + 2) == Tok::Colon && kind(open) == Tok::ListOpen &&
                       close == open + 4 && kind(open + 2) == Tok::Comma &&
                       kind(close + 1) == Tok::Assign && kind(value) == Tok::Number;
    if (!plain) return {};
    return "param " + std::string(text(name)) + " = " + std::string(text(value)) + " in " +
           std::string(text(open + 1)) + ".." + std::string(text(open + 3));
}

// Curv's `parametric r :: slider[0, 2] = 1`, also with its names on lines of their own before `in`.
bool ForeignSyntax::curv_slider(Index first) {
    const bool below = kind(first + 1) == Tok::End && text(first + 1) != ";";
    std::vector<Edit> edits;
    if (below) edits.push_back({span(first), ""});
    std::string told;
    Index i = below ? first + 2 : first + 1;
    for (Index value = 0; kind(i) == Tok::Name;) {
        const std::string written = slider_text(i, value);
        if (written.empty()) return false;
        if (told.empty()) told = written;
        edits.push_back({span(below ? i : first, value), written});
        lost_.push_back(i);
        failed_ = value;
        i = value + 1;
        if (!below) break;
        while (kind(i) == Tok::End && i < tokens_.tokens.size()) ++i;
    }
    if (told.empty()) return false;
    if (below && kind(i) == Tok::In) {
        edits.push_back({span(i), ""});
        failed_ = i;
    }
    foreign(span(first), "a parameter is declared with `param`")
        .help(to_write(told), std::move(edits));
    return true;
}

// Curv's `parametric` and `do`, alone on their lines.
bool ForeignSyntax::curv_block(Index first) {
    if (kind(first + 1) != Tok::End || text(first + 1) == ";" || first + 1 >= tokens_.tokens.size())
        return false;
    if (text(first) == "parametric" && kind(first + 3) == Tok::Colon) return curv_slider(first);
    const bool local = kind(first + 2) == Tok::Name && text(first + 2) == "local";
    if (text(first) != "do" || !local || may_be_declared("do")) return false;
    failed_ = first;
    foreign(span(first), "statements follow each other, without `do`")
        .help("leave it away", {{span(first), ""}});
    return true;
}

// `a = 1, b = 2, c = 3`, from the first value on: what binds each of the others.
std::vector<Edit> ForeignSyntax::further_names(Index first, Index from) {
    std::vector<Edit> edits;
    for (Index i = from; !ends_statement(i); i = match(i) > i ? match(i) + 1 : i + 1) {
        if (kind(i) != Tok::Comma || kind(i + 1) != Tok::Name || i < first) continue;
        lost_.push_back(i + 1);
        if (kind(i + 2) != Tok::Assign) continue;
        const bool changes = in_function_ && is_assigned_after(i + 1);
        edits.push_back(
            {span(i), std::string(changes ? "; var" : "; let") + (touch(i, i + 1) ? " " : "")});
    }
    return edits;
}

// Curv's `union [sphere 1, box 2]`, at the bracket, which stands apart from the name.
bool ForeignSyntax::call_of_row(Index open) {
    if (open == 0 || kind(open) != Tok::ListOpen || kind(open - 1) != Tok::Name ||
        touch(open - 1, open) || is_one_of(kind(open - 2), {Tok::Let, Tok::Var, Tok::Dot}))
        return false;
    if (spaced_statement(open)) return true;
    const Index close = match(open);
    const auto next = [&](Index i) { return match(i) > i ? match(i) + 1 : i + 1; };
    std::vector<Edit> edits{{{id_, token(open - 1).end, token(open).begin}, "("}};
    bool commas = kind(open + 1) == Tok::For;
    for (Index first = open + 1, i = first; i <= close; i = next(i)) {
        if (i < close && kind(i) != Tok::Comma) continue;
        commas = commas || i < close;
        const bool pair = i == first + 2 && kind(first) == Tok::Name &&
                          is_one_of(kind(first + 1), {Tok::Number, Tok::Name});
        if (pair) { // `sphere 1`
            edits.push_back({{id_, token(first).end, token(first + 1).begin}, "("});
            edits.push_back({{id_, token(first + 1).end, token(first + 1).end}, ")"});
        }
        first = i + 1;
    }
    if (!commas) return false;
    edits.push_back({{id_, token(close).end, token(close).end}, ")"});
    foreign(span(open - 1, open), "a call's arguments stand in parentheses")
        .help(to_write(std::string(text(open - 1)) + "([ … ])"), std::move(edits));
    return true;
}

// From the first sign of a pipe on: each as a call behind a dot. False where one of them is no call.
bool ForeignSyntax::pipe_edits(Index sign, std::vector<Edit> &edits) const {
    while (true) {
        const bool pipe = (kind(sign) == Tok::Greater || kind(sign) == Tok::Bar) &&
                          kind(sign + 1) == Tok::Greater && touch(sign, sign + 1);
        if (!pipe) return true;
        const Index name = sign + 2, open = name + 1;
        if (kind(name) != Tok::Name) return false;
        edits.push_back({{id_, token(sign - 1).end, token(name).begin}, "."});
        const Tok argument = kind(open);
        Index past = name + 1;
        if (argument == Tok::Open || argument == Tok::Trailing) {
            const bool record = argument == Tok::Trailing && kind(open + 2) == Tok::Colon;
            if (record) { // `rotate {angle: 1}`
                edits.push_back({{id_, token(name).end, token(open).end}, "("});
                edits.push_back({span(match(open)), ")"});
            } else if (argument == Tok::Open && !touch(name, open))
                edits.push_back({{id_, token(name).end, token(open).begin}, ""});
            past = match(open) + 1;
        } else if (is_one_of(argument, {Tok::Number, Tok::Name, Tok::ListOpen, Tok::Color})) {
            past = match(open) + 1;
            edits.push_back({{id_, token(name).end, token(open).begin}, "("});
            edits.push_back({{id_, token(past - 1).end, token(past - 1).end}, ")"});
        } else
            return false;
        sign = past;
    }
}

// `[x for a in l for b in m if c]` with its loops before what they give; `at` is the first `for`.
// Empty where the item has a choice of its own behind it.
std::string ForeignSyntax::nested_loops(Index open, Index at) const {
    const Index close = match(open);
    std::string head, tail = " }]";
    bool plain = true;
    for (Index first = at, i = at; i <= close; i = match(i) > i ? match(i) + 1 : i + 1) {
        plain = plain && kind(i) != Tok::Else;
        const bool begins = i > first && is_one_of(kind(i), {Tok::For, Tok::If});
        if (i < close && !begins) continue;
        head +=
            (head.empty() ? "" : " { ") + std::string(text(token(first).begin, token(i - 1).end));
        if (first > at) tail = " }" + tail;
        first = i;
    }
    const std::string item(text(token(open + 1).begin, token(at - 1).end));
    return plain ? "[" + head + " { " + item + tail : std::string();
}

// `sphere(1) translate(x: 1)`, `sphere(1), translate(x: 1)`, at the word or the comma.
bool ForeignSyntax::applied_without_dot(Index at) {
    const Index name = kind(at) == Tok::Comma ? at + 1 : at;
    if (at == 0 || kind(name) != Tok::Name || kind(name + 1) != Tok::Open ||
        !(kind(at - 1) == Tok::Close ||
          (kind(at - 1) == Tok::Name && is_declared(std::string(text(at - 1))))) ||
        token(name).first_on_line || !is_one_of(text(name), changes_of_shapes))
        return false;
    const std::string call = "." + std::string(text(name)) + "(…)";
    foreign(span(at), "a function is applied by a dot")
        .help(to_write(call), {{{id_, token(at - 1).end, token(name).begin}, "."}});
    return true;
}

} // namespace fathom::lang
