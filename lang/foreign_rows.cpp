// Answers to rows of values as Curv, Python and JavaScript write them: lists behind a function's name,
// pipes, comprehensions, strings that hold values, calls without their dot.
#include "lang/builder.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 14> changes_of_shapes = {
    "translate", "rotate", "scale", "mirror", "paint", "offset",  "shell",
    "twist",     "repeat", "move",  "color",  "bend",  "reflect", "displace"};

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

// `a = 1, b = 2, c = 3`, from the first value on: what binds each of the others.
std::vector<Edit> Builder::further_names(Index first, Index from) {
    std::vector<Edit> edits;
    for (Index i = from; !ends_statement(i); i = match(i) > i ? match(i) + 1 : i + 1) {
        if (kind(i) != Tok::Comma || kind(i + 1) != Tok::Name || i < first) continue;
        lost_.push_back(i + 1);
        if (kind(i + 2) != Tok::Assign) continue;
        edits.push_back({span(i), in_function_ && is_assigned_after(i + 1) ? "; var" : "; let"});
    }
    return edits;
}

// Curv's `union [sphere 1, box 2]`, at the bracket, which stands apart from the name.
bool Builder::call_of_row(Index open) {
    if (open == 0 || kind(open) != Tok::ListOpen || kind(open - 1) != Tok::Name ||
        touch(open - 1, open) || is_one_of(kind(open - 2), {Tok::Let, Tok::Var, Tok::Dot}))
        return false;
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
        .help("write " + in_code(std::string(text(open - 1)) + "([ … ])"), std::move(edits));
    return true;
}

// From the first sign of a pipe on: each as a call behind a dot. False where one of them is no call.
bool Builder::pipe_edits(Index sign, std::vector<Edit> &edits) const {
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
std::string Builder::nested_loops(Index open, Index at) const {
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
bool Builder::applied_without_dot(Index at) {
    const Index name = kind(at) == Tok::Comma ? at + 1 : at;
    if (at == 0 || kind(name) != Tok::Name || kind(name + 1) != Tok::Open ||
        kind(at - 1) != Tok::Close || token(name).first_on_line ||
        !is_one_of(text(name), changes_of_shapes))
        return false;
    const std::string call = "." + std::string(text(name)) + "(…)";
    foreign(span(at), "a function is applied by a dot")
        .help("write " + in_code(call), {{{id_, token(at - 1).end, token(name).begin}, "."}});
    return true;
}

} // namespace fathom::lang
