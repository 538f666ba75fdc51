// Calls by a space, as Curv, Bauble and Haskell write them: `sphere 1 >> move [1, 0, 0]`,
// `cube 2 | rotate y 45`, `blend (sin time) (cube 2, sphere 2)`. A whole value of such calls is read
// and written as ours, so that one edit puts all of it right.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 24> piped = {
    "translate", "rotate", "scale",  "mirror", "paint",   "offset",   "shell",   "twist",
    "repeat",    "move",   "color",  "bend",   "reflect", "displace", "colour",  "shade",
    "tint",      "tile",   "expand", "round",  "hollow",  "taper",    "extrude", "revolve"};

// Words that stand between two values, or around one, and are no arguments.
constexpr std::array<std::string_view, 14> no_arguments = {
    "then", "do",  "where", "of",   "to",         "until", "is",
    "mod",  "xor", "union", "step", "instanceof", "times", "end"};

bool is_sign(Tok kind) {
    return is_one_of(kind, {Tok::Plus, Tok::Minus, Tok::Star, Tok::Slash, Tok::Percent, Tok::Caret,
                            Tok::Amp, Tok::Bar, Tok::DotDot, Tok::DotDotEqual});
}

bool opens_group(Tok kind) { return kind == Tok::Open || kind == Tok::FreshOpen; }
bool opens_row(Tok kind) { return kind == Tok::ListOpen || kind == Tok::FreshListOpen; }

} // namespace

// Whether a comma stands between a bracket and its partner.
bool ForeignSyntax::holds_comma(Index open) const {
    for (Index i = open + 1; i<match(open); i = match(i)> i ? match(i) + 1 : i + 1)
        if (kind(i) == Tok::Comma) return true;
    return false;
}

// What stands between brackets, parted by commas, or by spaces where there are none.
std::string ForeignSyntax::spaced_row(Index first, Index past, bool &apart) const {
    std::string row;
    bool commas = false, signs = false;
    for (Index i = first; i<past; i = match(i)> i ? match(i) + 1 : i + 1) {
        commas = commas || kind(i) == Tok::Comma;
        signs = signs || (i > first && is_sign(kind(i)) && !touch(i, i + 1));
    }
    for (Index begin = first; begin < past;) {
        Index end = begin;
        if (commas) {
            while (end < past && kind(end) != Tok::Comma)
                end = match(end) > end ? match(end) + 1 : end + 1;
            std::string label;
            if (kind(begin) == Tok::Name && kind(begin + 1) == Tok::Colon) {
                label = std::string(text(begin)) + ": ";
                begin += 2;
            }
            const std::string value = spaced_value(begin, end, apart);
            if (value.empty()) return {};
            row += (row.empty() ? "" : ", ") + label + value;
            begin = end + 1;
            continue;
        }
        if (kind(first) == Tok::Name && kind(first + 1) == Tok::Colon) {
            const std::string value = spaced_value(first + 2, past, apart);
            return value.empty() ? value : std::string(text(first)) + ": " + value;
        }
        const bool numbers =
            is_one_of(kind(first), {Tok::Number, Tok::Minus}) || opens_row(kind(first));
        if (!numbers || signs || !opens_row(kind(first - 1)))
            return spaced_value(first, past, apart);
        const std::string value = spaced_atom(end, past, apart); // `[1 0 0]`
        if (value.empty()) return {};
        if (!row.empty()) apart = true;
        row += (row.empty() ? "" : ", ") + value;
        begin = end;
    }
    return row;
}

// One value without arguments behind it, and past it; empty: it is none.
std::string ForeignSyntax::spaced_atom(Index &at, Index past, bool &apart) const {
    if (at >= past) return {};
    const Tok found = kind(at);
    if (found == Tok::Minus && kind(at + 1) == Tok::Number && touch(at, at + 1)) {
        at += 2;
        return "-" + std::string(text(at - 1));
    }
    if (is_one_of(found, {Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False}))
        return std::string(text(at++));
    const Index close = match(at);
    if (opens_group(found) || opens_row(found)) {
        if (close <= at || close >= past) return {};
        const std::string row = spaced_row(at + 1, close, apart);
        at = close + 1;
        if (row.empty()) return {};
        return opens_row(found) ? "[" + row + "]" : "(" + row + ")";
    }
    if (found != Tok::Name || is_one_of(text(at), no_arguments)) return {};
    std::string out(text(at++));
    while (at < past && touch(at - 1, at)) { // its own call, index or part
        if (kind(at) == Tok::Dot && kind(at + 1) == Tok::Name) {
            out += "." + std::string(text(at + 1));
            at += 2;
            continue;
        }
        if (!opens_group(kind(at)) && !opens_row(kind(at)) && kind(at) != Tok::Trailing) break;
        const Index end = match(at);
        if (end <= at || end >= past) return {};
        const bool applied = kind(at + 1) == Tok::Name && at + 2 < end && !is_sign(kind(at + 2)) &&
                             kind(at + 2) != Tok::Dot;                         // `union[sphere 1]`
        const bool list = opens_row(kind(at)) && (holds_comma(at) || applied); // `move[1, 0, 0]`
        const bool call = !opens_row(kind(at));
        std::string row = spaced_row(at + 1, end, apart);
        if (row.empty() && end > at + 1) return {};
        if (kind(at) == Tok::Trailing || list) apart = true;
        if (list) row = "[" + row + "]";
        out += call || list ? "(" + row + ")" : "[" + row + "]";
        at = end + 1;
    }
    return out;
}

// A name with what stands behind it, as a call.
std::string ForeignSyntax::spaced_call(Index &at, Index past, bool &apart) const {
    const Index first = at;
    std::string out = spaced_atom(at, past, apart);
    if (out.empty() || kind(first) != Tok::Name || kind(at - 1) != Tok::Name) return out;
    std::string arguments;
    bool any = false;
    while (at < past && !token(at).first_on_line) {
        const Tok next = kind(at);
        const bool record = next == Tok::Trailing && kind(at + 2) == Tok::Colon;
        const bool value = is_one_of(next, {Tok::Number, Tok::String, Tok::Color, Tok::Name,
                                            Tok::True, Tok::False}) ||
                           opens_group(next) || opens_row(next) || record ||
                           (next == Tok::Minus && touch(at, at + 1) && !touch(at - 1, at) &&
                            kind(at + 1) == Tok::Number);
        if (!value || (next == Tok::Name && is_one_of(text(at), no_arguments))) break;
        std::string given;
        if (record) {
            given = spaced_row(at + 1, match(at), apart);
            at = match(at) + 1;
        } else {
            const bool grouped = opens_group(next);
            if (any && next == Tok::Name && opens_group(kind(at + 1)) && touch(at, at + 1))
                return {}; // `color red sphere(1)`, of another order
            given = spaced_atom(at, past, apart);
            if (grouped && given.size() > 2) given = given.substr(1, given.size() - 2);
        }
        if (given.empty()) return {};
        arguments += (any ? ", " : "") + given;
        any = true;
    }
    if (!any) return out;
    apart = true;
    return out + "(" + arguments + ")";
}

// A value in which calls, pipes and operators follow each other; empty where it holds anything else.
std::string ForeignSyntax::spaced_value(Index first, Index past, bool &apart) const {
    Index at = first;
    std::string out = spaced_call(at, past, apart);
    while (!out.empty() && at < past) {
        const bool arrow = is_one_of(kind(at), {Tok::Greater, Tok::Bar}) &&
                           kind(at + 1) == Tok::Greater && touch(at, at + 1);
        const bool bar =
            kind(at) == Tok::Bar && kind(at + 1) == Tok::Name && is_one_of(text(at + 1), piped);
        if (arrow || bar) {
            at += arrow ? 2 : 1;
            std::string call = kind(at) == Tok::Name ? spaced_call(at, past, apart) : std::string();
            if (call.empty()) return {};
            if (!call.ends_with(')')) call += "()";
            if (arrow) apart = true;
            bool operators = false; // those before bind looser than a dot
            int depth = 0;
            for (std::size_t i = 0; i < out.size(); ++i) {
                depth += out[i] == '(' || out[i] == '['   ? 1
                         : out[i] == ')' || out[i] == ']' ? -1
                                                          : 0;
                operators = operators || (depth == 0 && i > 0 && out[i] == ' ');
            }
            out = (operators ? "(" + out + ")" : out) + "." + call;
            continue;
        }
        if (!is_sign(kind(at)) || at + 1 >= past) return {};
        const bool range = is_one_of(kind(at), {Tok::DotDot, Tok::DotDotEqual});
        const std::string sign(text(at++));
        const std::string next = spaced_call(at, past, apart);
        if (next.empty()) return {};
        out += range ? sign + next : " " + sign + " " + next;
    }
    return out;
}

// `let s = sphere 1 >> move [1, 0, 0]`, at any of its words: the whole value of the statement.
// `a b` of names that stand for values, not for functions.
bool ForeignSyntax::values_side_by_side(Index first, Index past) {
    if (past != first + 2 || kind(first + 1) != Tok::Name || !may_look_far()) return false;
    bool is_value[] = {false, false};
    for (Index i = 0; i < first; ++i) {
        if (!is_one_of(kind(i), {Tok::Let, Tok::Var}) || kind(i + 2) != Tok::Assign) continue;
        const bool function = is_one_of(kind(i + 3), {Tok::LambdaOpen, Tok::LambdaName});
        for (Index k : {Index{0}, Index{1}})
            if (text(i + 1) == text(first + k)) is_value[k] = !function;
    }
    if (!is_value[0] || !is_value[1]) return false;
    const std::string a(text(first)), b(text(first + 1));
    failed_ = past;
    foreign(span(first, first + 1), "an operator is missing between two values")
        .help("shapes are united by `a | b`, cut by `a - b`, and `a & b` is what both have in "
              "common: write " +
                  in_code(a + " | " + b),
              {{{id_, token(first).end, token(first + 1).begin}, " | "}});
    return true;
}

bool ForeignSyntax::spaced_statement(Index at) {
    constexpr Index longest = 300; // words
    Index first = at;
    for (Index steps = 0; first > 0 && steps < longest; ++steps) {
        const Index before = first - 1;
        const bool stops = is_one_of(kind(before), {Tok::End, Tok::Body, Tok::Assign, Tok::Return,
                                                    Tok::BraceClose, Tok::In, Tok::FatArrow});
        if (stops && match(before) >= before) break;
        first = match(before) < before ? match(before) : before;
    }
    const Index past = statement_end(first);
    if (kind(first) != Tok::Name || at >= past || past > first + longest) return false;
    bool apart = false;
    if (values_side_by_side(first, past)) return true;
    if (sentence(first, past)) return true;
    const std::string value = spaced_value(first, past, apart);
    if (value.empty() || !apart) return false;
    failed_ = past;
    const Index shown = kind(at - 1) == Tok::Name ? at - 1 : at;
    Diagnostic &d = foreign(span(shown, at), "a call's arguments stand in parentheses, and what is "
                                             "done to a shape behind a `.`");
    constexpr std::array<std::string_view, 3> round_shapes{"sphere(", "circle(", "ellipsoid("};
    if (std::ranges::any_of(round_shapes,
                            [&](auto shape) { return value.find(shape) != value.npos; }))
        d.note("Curv gives a ball by its diameter; here it is given by its radius");
    d.help(to_write(value), {{span(first, past - 1), value}});
    return true;
}

} // namespace fathom::lang
