// What mathematics writes of numbers, vectors and sets: `|x| - 1`, `{(x, y, z) : x^2 < 1}`,
// `x^2 + y^2 + z^2 = 1`.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>

namespace fathom::lang {

static constexpr std::array<std::string_view, 3> coordinates = {"x", "y", "z"};

// `|p|`, `|p - [1, 0, 0]|`, `|p.xz|`, at the first bar: whether a vector stands there as a whole.
bool ForeignSyntax::is_amount_of_vector(Index bar) const {
    constexpr std::array<std::string_view, 4> points = {"p", "pos", "v", "point"};
    for (Index i = bar + 1; !ends_statement(i) && kind(i) != Tok::Bar;
         i = match(i) > i ? match(i) + 1 : i + 1) {
        if (is_one_of(kind(i), {Tok::ListOpen, Tok::FreshListOpen}))
            return kind(i - 1) != Tok::Name;
        if (kind(i) != Tok::Name) continue;
        if (kind(i - 1) == Tok::Dot) {
            if (text(i).size() > 1 && text(i).find_first_not_of("xyz") == std::string_view::npos)
                return true;
            continue;
        }
        const bool whole = !is_one_of(kind(i + 1), {Tok::Dot, Tok::Open, Tok::ListOpen});
        if (whole && is_one_of(text(i), points)) return true;
    }
    return false;
}

// `|x| - 1`, at the first bar, where no value stands before it: all bars of the statement.
bool ForeignSyntax::bars_of_amount(Index at) {
    if (kind(at) != Tok::Bar || at == 0 || ends_operand(kind(at - 1))) return false;
    std::vector<Edit> edits;
    std::vector<std::size_t> open; // bars, each by the brackets around it
    std::size_t depth = 0;
    bool closed = false; // whether the word before was a bar that closes
    for (Index i = at; !ends_statement(i); ++i) {
        if (match(i) > i) ++depth;
        if (match(i) < i && depth-- == 0) break;
        const bool bar = kind(i) == Tok::Bar, closes = bar && (closed || ends_operand(kind(i - 1)));
        closed = closes;
        if (!bar) continue;
        if (closes && (open.empty() || open.back() != depth)) return false; // a union
        if (closes)
            open.pop_back();
        else
            open.push_back(depth);
        edits.push_back({span(i), closes ? ")" : is_amount_of_vector(i) ? "length(" : "abs("});
    }
    if (edits.empty() || !open.empty()) return false;
    std::string proposal = "write `" + edits[0].replacement + " … )`";
    for (const Edit &edit : edits)
        if (edit.replacement != ")" && edit.replacement != edits[0].replacement)
            proposal = "write `abs( … )` and `length( … )`";
    foreign(span(at), "an amount is written `abs(x)`, of a vector `length(v)`")
        .help(std::move(proposal), std::move(edits));
    return true;
}

// `{(x, y, z) : x^2 + y^2 < 1}`, `{p | length(p) < 1}`, at the brace.
bool ForeignSyntax::set_of_points(Index brace) {
    const Index close = match(brace);
    if (close <= brace + 2) return false;
    const bool row = is_one_of(kind(brace + 1), {Tok::Open, Tok::FreshOpen});
    const Index sign = row ? match(brace + 1) + 1 : brace + 2;
    const bool names = row || kind(brace + 1) == Tok::Name;
    if (!names || sign >= close || !is_one_of(kind(sign), {Tok::Colon, Tok::Bar, Tok::In}))
        return false;
    bool compares = false;
    for (Index i = sign + 1; i<close; i = match(i)> i ? match(i) + 1 : i + 1)
        compares = compares || is_one_of(kind(i), {Tok::Less, Tok::LessEqual, Tok::Greater,
                                                   Tok::GreaterEqual, Tok::Assign});
    if (!compares) return false;
    for (Index i = brace + 1; i < close; ++i) // one cause, one report
        diagnostics_.withdraw(Code::BadCharacter, span(i));
    failed_ = close;
    foreign(span(brace, sign), "a shape is no set of points, but a function that is below 0 inside")
        .help("write `implicit(p => length(p) - 1)` for all points nearer than 1");
    return true;
}

// `x^2 + y^2 + z^2 = 1`, `z < sin(x)`, `x^2 + y^2 - 1`: a statement of coordinates that are declared nowhere.
bool ForeignSyntax::equation(Span statement) {
    const auto begins =
        std::ranges::lower_bound(tokens_.tokens, statement.begin, {}, &Token::begin);
    const auto first = static_cast<Index>(begins - tokens_.tokens.begin());
    Index past = first, sign = 0;
    bool reads_last = false; // coordinates: behind the sign, or where there is none
    int depth = 0;
    constexpr std::size_t most_edits = 200;
    std::vector<Edit> edits;
    for (; token(past).begin < statement.end && past < tokens_.tokens.size(); ++past) {
        const Tok k = kind(past);
        if (is_one_of(
                k, {Tok::And, Tok::Or, Tok::Not, Tok::Bar, Tok::Amp, Tok::FatArrow, Tok::NotEqual}))
            return false;
        depth += match(past) > past ? 1 : match(past) < past ? -1 : 0;
        if (depth == 0 && is_one_of(k, {Tok::Assign, Tok::EqualEqual, Tok::Less, Tok::LessEqual,
                                        Tok::Greater, Tok::GreaterEqual})) {
            if (sign > 0) return false;
            sign = past, reads_last = false;
        }
        const bool coordinate = k == Tok::Name && is_one_of(text(past), coordinates) &&
                                (past == 0 || kind(past - 1) != Tok::Dot) &&
                                !is_one_of(kind(past + 1), {Tok::Open, Tok::Colon}) &&
                                !may_be_declared(text(past));
        if (!coordinate) continue;
        reads_last = true;
        if (edits.size() == most_edits) return false;
        edits.push_back({{id_, token(past).begin, token(past).begin}, "p."});
    }
    const bool binds = sign == first + 1 && kind(sign) == Tok::Assign; // `z = 3` declares a name
    if (edits.empty() || (binds && !reads_last)) return false;
    std::string head = "implicit(p => ", tail = ", within: ball(3))";
    if (sign > 0) {
        if (is_one_of(kind(sign), {Tok::Greater, Tok::GreaterEqual}))
            head += "-(", tail = ")" + tail;
        const bool zero = sign + 2 == past && text(sign + 1) == "0";
        const bool sum = sign + 2 < past;
        if (sum) tail = ")" + tail;
        if (zero)
            edits.push_back({{id_, token(sign - 1).end, statement.end}, tail});
        else
            edits.push_back({{id_, token(sign).begin, token(sign + 1).begin}, sum ? "- (" : "- "});
        if (zero) tail.clear();
    }
    if (edits[0].span.begin == statement.begin)
        edits[0].replacement = head + edits[0].replacement;
    else
        edits.push_back({{id_, statement.begin, statement.begin}, head});
    if (!tail.empty()) edits.push_back({{id_, statement.end, statement.end}, tail});
    std::ranges::sort(edits, {}, [](const Edit &edit) { return edit.span.begin; });
    foreign(statement, sign > 0 ? "an equation is no shape by itself"
                                : "a formula of coordinates is no shape by itself")
        .help("a solid is where a function of the point is below 0, and is looked for as far as "
              "`within` says",
              std::move(edits));
    return true;
}

} // namespace fathom::lang
