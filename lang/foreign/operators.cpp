// Answers to operators that other languages have: words, comparisons that are spelled otherwise,
// percents, scopes, and values that are missing beside an operator.
#include "base/text.h"
#include "lang/foreign/foreign.h"
#include "lang/lexer.h"

#include <algorithm>

namespace fathom::lang {

namespace {

struct WordOperator {
    std::string_view word, ours, message;
};

constexpr WordOperator word_operators[] = {
    {"is", "==", "equality is written `==`"},
    {"eq", "==", "equality is written `==`"},
    {"equals", "==", "equality is written `==`"},
    {"ne", "!=", "inequality is written `!=`"},
    {"isnt", "!=", "inequality is written `!=`"},
    {"AND", "and", "the logical and is written small"},
    {"And", "and", "the logical and is written small"},
    {"OR", "or", "the logical or is written small"},
    {"Or", "or", "the logical or is written small"},
    {"xor", "!=", "of two bools, one is true where they differ"},
    {"mod", "%", "the rest of a division is written `%`"},
    {"MOD", "%", "the rest of a division is written `%`"},
    {"union", "|", "between shapes, the union is written `|`"},
    {"intersection", "&", "between shapes, the intersection is written `&`"},
    {"intersect", "&", "between shapes, the intersection is written `&`"},
    {"difference", "-", "between shapes, the difference is written `-`"},
    {"minus", "-", "a difference is written `-`"},
    {"plus", "+", "a sum is written `+`"},
    {"times", "*", "a product is written `*`"},
    {"per", "*", "what grows with the time is a product: `90deg * time`"},
    {"to", "..=", "a range is written `..=`, or `..` without its end"},
    {"until", "..", "a range is written `..`, or `..=` with its end"}};

bool is_binary(Tok kind) {
    return is_one_of(kind, {Tok::Bar, Tok::Amp, Tok::Or, Tok::And, Tok::EqualEqual, Tok::NotEqual,
                            Tok::Less, Tok::LessEqual, Tok::Greater, Tok::GreaterEqual, Tok::DotDot,
                            Tok::DotDotEqual, Tok::Plus, Tok::Minus, Tok::Star, Tok::Slash,
                            Tok::Percent, Tok::Caret});
}

} // namespace

bool ForeignSyntax::touch(Index first, Index second) const {
    return token(first).end == token(second).begin && second < tokens_.tokens.size();
}

// `a is b`, `a AND b`, `0 to 5`: a word between two operands.
bool ForeignSyntax::foreign_word_operator(Index at) {
    if (kind(at) != Tok::Name || token(at).first_on_line || at == 0 ||
        !ends_operand(kind(at - 1)) || is_declared(std::string(text(at))))
        return false;
    if (nothing_compared(at)) return true;
    if (text(at) == "instanceof" && kind(at + 1) == Tok::Name) {
        foreign(span(at), "every name has one type, which nobody asks for")
            .help("leave the question away");
        return true;
    }
    const auto *row = std::ranges::find(word_operators, text(at), &WordOperator::word);
    if (row == std::end(word_operators)) return false;
    const bool negated = row->ours == "==" && kind(at + 1) == Tok::Not;
    const Tok next = kind(negated ? at + 2 : at + 1);
    const bool operand =
        ends_operand(next)
            ? next != Tok::Close && next != Tok::ListClose
            : is_one_of(next, {Tok::Open, Tok::ListOpen, Tok::Minus, Tok::If, Tok::Not});
    if (!operand) return false;
    const Span place = negated ? span(at, at + 1) : span(at);
    const std::string ours(negated ? "!=" : row->ours);
    foreign(place, negated ? "inequality is written `!=`" : std::string(row->message))
        .help(to_write(ours), {{place, ours}});
    return true;
}

// `s is not None`: every name has a value.
bool ForeignSyntax::nothing_compared(Index at) {
    if (text(at) != "is") return false;
    const bool negated = kind(at + 1) == Tok::Not;
    const Index nothing = negated ? at + 2 : at + 1;
    if (kind(nothing) != Tok::Name || !is_foreign_value(text(nothing)) || text(nothing)[0] == 'T' ||
        text(nothing)[0] == 'F')
        return false;
    const bool whole = kind(at - 1) == Tok::Name && at > 1 &&
                       is_one_of(kind(at - 2), {Tok::If, Tok::While, Tok::And, Tok::Or, Tok::Open,
                                                Tok::Assign, Tok::Return, Tok::Not});
    const std::string_view value = negated ? "true" : "false";
    Diagnostic &d = foreign(span(at, nothing),
                            "there is no " + in_code(text(nothing)) + ": every name has a value");
    if (whole)
        d.help("the condition is always " + in_code(value),
               {{span(at - 1, nothing), std::string(value)}});
    else
        d.help("leave the condition away");
    return true;
}

// `n =< 3`, `n =! 3`, `n /= 3`, `n in [1, 2]`, where no assignment and no loop can stand.
bool ForeignSyntax::foreign_comparison(Index at) {
    const Tok found = kind(at);
    const auto say = [&](Index last, const std::string &ours) {
        foreign(span(at, last), "this comparison is written " + in_code(ours))
            .help(to_write(ours), {{span(at, last), ours}});
        return true;
    };
    if (at == 0 || !ends_operand(kind(at - 1))) return false;
    if (found == Tok::Assign && kind(at + 1) == Tok::Less && touch(at, at + 1))
        return say(at + 1, "<=");
    if (found == Tok::Assign && kind(at + 1) == Tok::Not && text(at + 1) == "!" &&
        touch(at, at + 1)) {
        diagnostics_.withdraw(Code::ForeignSyntax, span(at + 1));
        return say(at + 1, "!=");
    }
    if (found == Tok::SlashAssign) return say(at, "!=");
    if (found != Tok::In) return false;
    const Index open = at + 1, close = match(open);
    Diagnostic &d = foreign(span(at), "there is no operator `in`");
    std::string written;
    bool plain = kind(at - 1) == Tok::Name && kind(at - 2) != Tok::Dot && close > open;
    for (Index i = open + 1; plain && i < close; i += 2) {
        plain = is_one_of(kind(i), {Tok::Number, Tok::Name, Tok::String}) &&
                is_one_of(kind(i + 1), {Tok::Comma, Tok::ListClose});
        written += (i > open + 1 ? " or " : "") + std::string(text(at - 1)) +
                   " == " + std::string(text(i));
    }
    const bool whole = is_one_of(kind(at - 2), {Tok::If, Tok::While, Tok::Open, Tok::Assign});
    if (plain && whole && !written.empty())
        d.help(to_write(written), {{span(at - 1, close), written}});
    else
        d.help("compare with each: `n == 1 or n == 2`");
    return true;
}

// `std::sqrt(2)`, `parts::arch()`, at the first colon.
bool ForeignSyntax::foreign_scope(Index colon) {
    if (colon == 0 || kind(colon) != Tok::Colon || kind(colon + 1) != Tok::Colon ||
        !touch(colon, colon + 1) || kind(colon - 1) != Tok::Name)
        return false;
    const std::string_view module = text(colon - 1);
    if (is_foreign_module(module) || module == "std") {
        foreign(span(colon - 1, colon + 1), "the mathematical functions need no module")
            .help(to_write(text(colon + 2)), {{span(colon - 1, colon + 1), ""}});
        return true;
    }
    for (Index i = 0; may_look_far() && i + 1 < colon;
         ++i) { // `Kind::Ball`, of an enumeration above
        if (kind(i) != Tok::Name || text(i) != "enum" || text(i + 1) != module) continue;
        foreign(span(colon - 1, colon + 1), "the names of an enumeration are names of their own")
            .help("leave " + in_code(std::string(module) + "::") + " away",
                  {{span(colon - 1, colon + 1), ""}});
        return true;
    }
    foreign(span(colon, colon + 1), "what is in a module stands behind a `.`")
        .help("write `.`", {{span(colon, colon + 1), "."}});
    return true;
}

// `50%`, where no operand follows.
bool ForeignSyntax::foreign_percent(Index at) {
    if (at < 2 || kind(at - 1) != Tok::Percent || kind(at - 2) != Tok::Number ||
        !touch(at - 2, at - 1))
        return false;
    const auto value = parse_number(text(at - 2));
    if (!value) return false;
    const std::string share = format_shortest(*value / 100);
    foreign(span(at - 2, at - 1), "a share is a number, of which 1 is the whole")
        .help(to_write(share), {{span(at - 2, at - 1), share}});
    return true;
}

// `let in = 2`: the name with a `_` behind it, in all places.
bool ForeignSyntax::keyword_as_name(Index at) {
    constexpr std::size_t most_edits = 20;
    const bool declares =
        at > 0 && is_one_of(kind(at - 1), {Tok::Let, Tok::Var, Tok::Fn, Tok::Param});
    const bool keyword =
        is_one_of(kind(at), {Tok::Let, Tok::Var, Tok::Fn, Tok::Param, Tok::Import, Tok::For,
                             Tok::In, Tok::If, Tok::Else, Tok::While, Tok::Limit, Tok::Break,
                             Tok::Return, Tok::And, Tok::Or, Tok::Not, Tok::As});
    if (!declares || !keyword || !is_one_of(kind(at + 1), {Tok::Assign, Tok::Open, Tok::Colon}))
        return false;
    const std::string name = std::string(text(at)) + "_";
    std::vector<Edit> edits{{span(at), name}};
    for (Index i = at + 1;
         may_look_far() && i + 1 < tokens_.tokens.size() && edits.size() < most_edits; ++i) {
        const bool value =
            is_one_of(kind(i - 1), {Tok::Open, Tok::ListOpen, Tok::Comma, Tok::Plus, Tok::Minus,
                                    Tok::Star, Tok::Slash, Tok::Assign, Tok::Colon, Tok::DotDot});
        if (kind(i) != kind(at) || !value || is_one_of(kind(i + 1), {Tok::Name, Tok::Body}))
            continue;
        edits.push_back({span(i), name});
        renamed_.insert(i);
    }
    failed_ = at + 1;
    diagnostics_
        .add(Code::SyntaxError, span(at),
             in_code(text(at)) + " is a word of the language, "
                                 "and no name")
        .help(to_write(name), std::move(edits));
    return true;
}

// Where an operand is missing: what that says about the signs before it.
bool ForeignSyntax::missing_operand(Index at) {
    const Tok found = kind(at);
    const Index before = at > 0 ? at - 1 : 0;
    const Tok sign = kind(before);
    if (foreign_percent(at)) return true;
    if (found == Tok::Colon && sign == Tok::Colon && foreign_scope(before)) return true;
    const Index around = enclosing(at);
    const bool argument = kind(around) == Tok::Open && around > 0 && touch(around - 1, around) &&
                          kind(around - 1) == Tok::Name;
    if (found == Tok::Assign && sign == Tok::Colon && touch(before, at) && !argument) {
        foreign(span(before, at), "a value stands behind `=`")
            .help("write `=`", {{span(before, at), "="}});
        return true;
    }
    if (found == Tok::Assign && sign == Tok::Colon && touch(before, at)) {
        foreign(span(before, at), "an argument is named with `:`")
            .help("write `:`", {{span(before, at), ":"}});
        return true;
    }
    if (found == Tok::Less && sign == Tok::Less && touch(before, at)) {
        foreign(span(before, at), "there are no operators on bits").help("`a << b` is `a * 2 ^ b`");
        return true;
    }
    if (found == Tok::Comma && is_one_of(sign, {Tok::Comma, Tok::Open, Tok::ListOpen})) {
        diagnostics_.add(Code::SyntaxError, span(at), "a value is missing before this comma")
            .help("leave the comma away, or write the value", {{span(at), ""}});
        return true;
    }
    if (sign == Tok::Comma && is_one_of(found, {Tok::End, Tok::BraceClose})) return false;
    const bool behind = is_binary(sign) ||
                        is_one_of(sign, {Tok::Assign, Tok::Not, Tok::PlusAssign, Tok::MinusAssign,
                                         Tok::StarAssign, Tok::SlashAssign, Tok::FatArrow});
    const bool nothing =
        at >= tokens_.tokens.size() || is_binary(found) ||
        is_one_of(found, {Tok::End, Tok::Close, Tok::ListClose, Tok::BraceClose, Tok::Comma});
    if (at == 0 || !nothing || (!behind && !is_binary(found))) return false;
    if (!behind && wanted_at_start(at)) return false;
    const bool ahead = is_binary(found); // that sign wants one before it
    const Index shown = ahead ? at : before;
    const bool shapes = is_one_of(kind(shown), {Tok::Bar, Tok::Amp});
    Diagnostic &d =
        diagnostics_.add(Code::SyntaxError, span(shown),
                         (shapes ? "a shape is missing " : "a value is missing ") +
                             std::string(ahead ? "before " : "behind ") + in_code(text(shown)));
    if (is_binary(kind(shown)) && !(ahead && behind)) {
        const std::uint32_t from = !ahead && shown > 0 ? token(shown - 1).end : token(shown).begin;
        d.help("write it, or leave " + in_code(text(shown)) + " away",
               {{{id_, from, token(shown).end}, ""}});
    }
    return true;
}

// `let r = 50%`, and on the next line what uses that name, which has no value yet: a percent.
bool ForeignSyntax::runs_on(Index name, std::uint32_t end) {
    const auto column = [&](Index i) {
        const std::size_t line = std::string_view(source_.text).rfind('\n', token(i).begin);
        return token(i).begin - (line == std::string_view::npos ? 0 : line + 1);
    };
    if (kind(name) != Tok::Name) return false;
    Index below = 0; // where the statement goes on, no further in than it begins
    for (Index i = name + 1; i < tokens_.tokens.size() && token(i).begin < end; ++i) {
        if (below == 0 && match(i) > i) {
            if (token(match(i)).end > end) return false;
            i = match(i); // a line within brackets goes on
            continue;
        }
        const bool fresh = token(i).first_on_line && is_binary(kind(i - 1));
        if (below == 0 && fresh && column(i) <= column(name - 1)) below = i;
        if (is_one_of(kind(i), {Tok::LambdaName, Tok::LambdaOpen, Tok::For}) && below > 0)
            return false;
        if (below == 0 || kind(i) != Tok::Name || text(i) != text(name)) continue;
        if (std::ranges::count(declared_, text(name)) > 1) return false; // an outer one is meant
        return foreign_percent(below);
    }
    return false;
}

// Whether a statement should begin there.
bool ForeignSyntax::wanted_at_start(Index at) const {
    return at == 0 ||
           is_one_of(kind(at - 1), {Tok::End, Tok::Body, Tok::Trailing, Tok::BraceClose});
}

// `2 x`: two values with nothing between them, the first a number.
bool ForeignSyntax::foreign_product(Index at) {
    if (at == 0 || kind(at - 1) != Tok::Number || kind(at) != Tok::Name || token(at).first_on_line)
        return false;
    if (text(at) == "step" && is_one_of(kind(at + 1), {Tok::Number, Tok::Name})) return false;
    const std::string product = std::string(text(at - 1)) + " * " + std::string(text(at));
    diagnostics_.add(Code::SyntaxError, span(at - 1, at), "a product is written with `*`")
        .help(to_write(product), {{{id_, token(at - 1).end, token(at).begin}, " * "}});
    return true;
}

// `let s = sphere 1`, `x = add 1 2`, at the first argument.
bool ForeignSyntax::juxtaposed_arguments(Index at) {
    const auto is_atom = [&](Index i) {
        return is_one_of(kind(i), {Tok::Number, Tok::String, Tok::Color}) ||
               (kind(i) == Tok::Name && !token(i).first_on_line);
    };
    if (at == 0 || kind(at - 1) != Tok::Name || !is_atom(at)) return false;
    if (at > 1 && is_one_of(kind(at - 2), {Tok::Name, Tok::Let, Tok::Var, Tok::Fn, Tok::Param}))
        return false;
    Index past = at;
    if (kind(at) == Tok::Name && kind(at + 1) == Tok::Colon) { // `.translate x: 2`
        while (!ends_statement(past)) past = match(past) > past ? match(past) + 1 : past + 1;
        failed_ = past;
        foreign(span(at - 1, at), "a call's arguments stand in parentheses")
            .help(to_write(std::string(text(at - 1)) + "(" +
                           std::string(text(token(at).begin, token(past - 1).end)) + ")"),
                  {{{id_, token(at - 1).end, token(at).begin}, "("},
                   {{id_, token(past - 1).end, token(past - 1).end}, ")"}});
        return true;
    }
    std::string call = std::string(text(at - 1)) + "(";
    std::vector<Edit> edits{{{id_, token(at - 1).end, token(at).begin}, "("}};
    while (is_atom(past)) {
        if (past > at) edits.push_back({{id_, token(past - 1).end, token(past).begin}, ", "});
        call += (past > at ? ", " : "") + std::string(text(past));
        ++past;
    }
    const bool names_alone = kind(at) == Tok::Name && past > at + 1;
    if (names_alone || (kind(past) == Tok::Open && kind(past - 1) == Tok::Name)) return false;
    edits.push_back({{id_, token(past - 1).end, token(past - 1).end}, ")"});
    foreign(span(at - 1, past - 1), "a call's arguments stand in parentheses")
        .help(to_write(call + ")"), std::move(edits));
    return true;
}

} // namespace fathom::lang
