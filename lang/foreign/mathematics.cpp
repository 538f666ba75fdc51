// What mathematics writes of numbers, vectors and sets: `|x| - 1`, `{(x, y, z) : x^2 < 1}`,
// `x^2 + y^2 + z^2 = 1`.
#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>
#include <utility>

namespace fathom::lang {

namespace {

constexpr std::array<std::string_view, 3> coordinates = {"x", "y", "z"};
constexpr std::initializer_list<Tok> comparisons = {
    Tok::Assign, Tok::EqualEqual, Tok::Less, Tok::LessEqual, Tok::Greater, Tok::GreaterEqual};

} // namespace

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
    if (kind(at) != Tok::Bar || (at > 0 && ends_operand(kind(at - 1)))) return false;
    std::vector<Edit> edits;
    std::vector<std::size_t> open; // bars, each by the brackets around it
    std::size_t depth = 0;
    bool closed = false; // whether the word before was a bar that closes
    for (Index i = at; !ends_statement(i); ++i) {
        if (match(i) > i) ++depth;
        if (match(i) < i && depth-- == 0) break;
        const bool bar = kind(i) == Tok::Bar,
                   closes = bar && i > at && (closed || ends_operand(kind(i - 1)));
        closed = closes;
        if (!bar) continue;
        const bool unites = closes && is_one_of(kind(i + 1), {Tok::Name, Tok::Number, Tok::Open,
                                                              Tok::ListOpen}); // `| a | b`
        if (closes && (open.empty() || open.back() != depth || unites)) return false;
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

// The edits that make parts of a point of the coordinates in [first, past) that are declared nowhere; empty
// where there are none, or hundreds, or where names may be bound within.
std::vector<Edit> ForeignSyntax::parts_of_point(Index first, Index past) {
    constexpr std::size_t most_edits = 200;
    std::vector<Edit> edits;
    for (Index i = first; i < past; ++i) {
        if (is_one_of(kind(i), {Tok::FatArrow, Tok::For, Tok::Let, Tok::Var})) return {};
        const bool coordinate = kind(i) == Tok::Name && is_one_of(text(i), coordinates) &&
                                (i == 0 || kind(i - 1) != Tok::Dot) &&
                                !is_one_of(kind(i + 1), {Tok::Open, Tok::Colon}) &&
                                !may_be_declared(text(i));
        if (coordinate) edits.push_back({{id_, token(i).begin, token(i).begin}, "p."});
        if (edits.size() > most_edits) return {};
    }
    return edits;
}

// The edits that make a shape of an equation, an inequality or a formula in [first, past); empty: it is none.
std::vector<Edit> ForeignSyntax::shape_of_equation(Index first, Index past) {
    Index sign = 0;
    for (Index i = first; i<past; i = match(i)> i ? match(i) + 1 : i + 1) {
        if (is_one_of(kind(i), {Tok::Not, Tok::Bar, Tok::Amp, Tok::FatArrow, Tok::NotEqual}))
            return {};
        if (!is_one_of(kind(i), comparisons)) continue;
        if (sign > 0) return {};
        sign = i;
    }
    std::vector<Edit> edits = parts_of_point(first, past);
    const bool binds = sign == first + 1 && kind(sign) == Tok::Assign; // `z = 3` declares a name
    if (edits.empty() || (binds && edits.back().span.begin < token(sign).begin)) return {};
    const std::uint32_t begin = token(first).begin, end = token(past - 1).end;
    std::string head = "implicit(p => ", tail = ", within: ball(3))";
    if (sign > 0) {
        if (is_one_of(kind(sign), {Tok::Greater, Tok::GreaterEqual}))
            head += "-(", tail = ")" + tail;
        const bool zero = sign + 2 == past && text(sign + 1) == "0";
        const bool sum = sign + 2 < past;
        if (sum) tail = ")" + tail;
        if (zero)
            edits.push_back({{id_, token(sign - 1).end, end}, std::exchange(tail, "")});
        else
            edits.push_back({{id_, token(sign).begin, token(sign + 1).begin}, sum ? "- (" : "- "});
    }
    if (edits[0].span.begin == begin)
        edits[0].replacement = head + edits[0].replacement;
    else
        edits.push_back({{id_, begin, begin}, head});
    if (!tail.empty()) edits.push_back({{id_, end, end}, tail});
    return edits;
}

void ForeignSyntax::tell_equation(Span where, bool compares, std::vector<Edit> edits) {
    std::ranges::sort(edits, {}, [](const Edit &edit) { return edit.span.begin; });
    foreign(where, compares ? "an equation is no shape by itself"
                            : "a formula of coordinates is no shape by itself")
        .help("a solid is where a function of the point is below 0, and is looked for as far as "
              "`within` says",
              std::move(edits));
}

// `x^2 + y^2 + z^2 = 1`, `z < sin(x) and z > 0`, `x^2 + y^2 - 1`: a statement.
bool ForeignSyntax::equation(Span statement) {
    const auto begins =
        std::ranges::lower_bound(tokens_.tokens, statement.begin, {}, &Token::begin);
    const auto from = static_cast<Index>(begins - tokens_.tokens.begin());
    Tok joined = Tok::End; // what joins several
    bool compares = false;
    std::vector<Edit> edits;
    for (Index first = from, i = from;; i = match(i) > i ? match(i) + 1 : i + 1) {
        const bool ends = i >= tokens_.tokens.size() || token(i).begin >= statement.end;
        const bool joins = !ends && is_one_of(kind(i), {Tok::And, Tok::Or});
        compares = compares || is_one_of(kind(i), comparisons);
        if (!ends && !joins) continue;
        if (joins && joined != Tok::End && joined != kind(i)) return false;
        const std::vector<Edit> shape = shape_of_equation(first, i);
        if (shape.empty()) return false;
        edits.insert(edits.end(), shape.begin(), shape.end());
        if (ends) break;
        joined = kind(i), first = i + 1;
        edits.push_back({span(i), joined == Tok::And ? "&" : "|"});
    }
    tell_equation(statement, compares, std::move(edits));
    return true;
}

// `let f = x^2 + y^2 - 1`, `let ball = x^2 + y^2 + z^2 < 1`, at the `let`: the value ends before `end`.
bool ForeignSyntax::formula_bound(Index let, std::uint32_t end) {
    const Index value = let + 3;
    if (kind(let + 2) != Tok::Assign || is_one_of(text(let + 1), coordinates)) return false;
    Index past = value;
    bool compares = false;
    for (; past < tokens_.tokens.size() && token(past).begin < end; ++past) {
        if (is_one_of(kind(past), {Tok::Bar, Tok::Amp, Tok::FatArrow, Tok::And, Tok::Or}))
            return false;
        compares = compares || is_one_of(kind(past), comparisons);
    }
    std::vector<Edit> edits =
        compares ? shape_of_equation(value, past) : parts_of_point(value, past);
    if (edits.empty()) return false;
    if (compares) {
        tell_equation(span(value, past - 1), true, std::move(edits));
        return true;
    }
    const std::string name(text(let + 1));
    edits.insert(edits.begin(), {span(let, let + 1), "fn " + name + "(p)"});
    foreign(span(let, past - 1), "coordinates are those of a point, which a function is given")
        .help(to_write("fn " + name + "(p) = …"), std::move(edits));
    return true;
}

} // namespace fathom::lang
