// Signs of mathematics and typography, as `x²`, `√x`, `‖p‖`, `f ∘ g`, `i ∈ 0..5`, and what is drawn alone
// in OpenSCAD: what each is here.
#include "lang/lexer.h"

#include "base/text.h"

#include <algorithm>

namespace fathom::lang {

namespace {

constexpr std::string_view no_sign_of_ours = "this sign is not one of the language's";
constexpr std::string_view root = "√", composed = "∘";

// Signs that stand for a few of ours.
struct Written {
    std::string_view theirs, ours;
};
constexpr Written written_out[] = {{"²", "^2"},   {"³", "^3"},   {"⁴", "^4"},  {"⁵", "^5"},
                                   {"⁶", "^6"},   {"∞", "inf"},  {"½", "0.5"}, {"¼", "0.25"},
                                   {"¾", "0.75"}, {"∅", "empty"}};

// Signs that stand before a value and behind it, and the call that they are.
struct Pair {
    std::string_view open, close, call, message;
};
constexpr std::string_view of_length = "a vector's length is written `length(v)`";
constexpr Pair pairs[] = {{"‖", "‖", "length", of_length},
                          {"∥", "∥", "length", of_length},
                          {"⌊", "⌋", "floor", "the next whole number below is written `floor(x)`"},
                          {"⌈", "⌉", "ceil", "the next whole number above is written `ceil(x)`"}};

std::string coded(std::string_view text) { return "`" + std::string(text) + "`"; }

std::uint32_t offset(std::size_t place) { return static_cast<std::uint32_t>(place); }

// Where the word that begins at `place` ends.
std::size_t word_end(std::string_view all, std::size_t place) {
    while (place < all.size() && is_word_char(all[place])) ++place;
    return place;
}

} // namespace

// Whether this sign or name was told at an earlier place, which then gets the edits for this one,
// too; without any, those that put what was put there.
bool ForeignWords::told_before(std::uint32_t begin, std::uint32_t end,
                               const std::vector<Edit> &edits) {
    constexpr std::size_t most_uses = 40;
    const auto [told, fresh] =
        told_names_.try_emplace(slice(begin, end), ToldName{span(begin, end)});
    if (fresh) return false;
    if (++told->second.uses > most_uses) return true;
    Diagnostic *first = diagnostics_.find(Code::BadCharacter, told->second.first);
    if (!first || !first->fix || first->fix->edits.empty()) return true;
    std::vector<Edit> &all = first->fix->edits;
    if (edits.empty())
        all.push_back({span(begin, end), std::string(all[0].replacement)});
    else
        all.insert(all.end(), edits.begin(), edits.end());
    return true;
}

// Signs that typography, other keyboards and mathematics put in the place of ours.
bool ForeignWords::strange_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t c) {
    struct Twin {
        std::uint32_t code_point;
        Tok kind;
        std::string_view ours;
    };
    static constexpr Twin twins[] = {
        {0x2212, Tok::Minus, "-"},      {0x2013, Tok::Minus, "-"},
        {0x2014, Tok::Minus, "-"},      {0x2216, Tok::Minus, "-"},
        {0x00D7, Tok::Star, "*"},       {0x22C5, Tok::Star, "*"},
        {0x00B7, Tok::Star, "*"},       {0x2217, Tok::Star, "*"},
        {0x2219, Tok::Star, "*"},       {0x00F7, Tok::Slash, "/"},
        {0x2264, Tok::LessEqual, "<="}, {0x2265, Tok::GreaterEqual, ">="},
        {0x2A7D, Tok::LessEqual, "<="}, {0x2A7E, Tok::GreaterEqual, ">="},
        {0x2260, Tok::NotEqual, "!="},  {0x2192, Tok::Arrow, "->"},
        {0x21D2, Tok::FatArrow, "=>"},  {0x21A6, Tok::FatArrow, "=>"},
        {0x2208, Tok::In, "in"},        {0x2227, Tok::And, "and"},
        {0x2228, Tok::Or, "or"},        {0x00AC, Tok::Not, "not"},
        {0x2200, Tok::For, "for"},      {0x222A, Tok::Bar, "|"},
        {0x2229, Tok::Amp, "&"},        {0x27E8, Tok::ListOpen, "["},
        {0x27E9, Tok::ListClose, "]"},  {0xFF08, Tok::Open, "("},
        {0xFF09, Tok::Close, ")"},      {0xFF0C, Tok::Comma, ","},
        {0x2026, Tok::DotDot, ".."},    {0xFF1B, Tok::End, ";"},
        {0xFF1A, Tok::Colon, ":"},      {0xFF1D, Tok::Assign, "="},
        {0x2254, Tok::Assign, "="},     {0xFF0B, Tok::Plus, "+"}};
    const auto *const twin = std::ranges::find(twins, c, &Twin::code_point);
    if (twin == std::end(twins)) return false;
    add(twin->kind, begin, end);
    const bool product = twin->kind == Tok::Star;
    if (product && product_of_rows(begin, end, c == 0xD7)) return true;
    const std::string ours = set_apart(begin, end, twin->ours); // `i∈0..5`
    if (told_before(begin, end, {{span(begin, end), ours}})) return true;
    Diagnostic &d = report(Code::BadCharacter, begin, end, std::string(no_sign_of_ours));
    if (product)
        d.note(c == 0xD7 ? "of vectors it is `cross(a, b)`" : "of vectors it is `dot(a, b)`");
    d.help("write " + coded(twin->ours), {{span(begin, end), ours}});
    return true;
}

// `[1, 0, 0] × [0, 1, 0]`, `u · [1, 0, 0]`: the sign is that of numbers too, and so only of what
// stands in brackets it is known which product is meant.
bool ForeignWords::product_of_rows(std::uint32_t begin, std::uint32_t end, bool cross) {
    const std::string_view all = source_.text;
    const std::size_t left = begin == 0 ? all.npos : all.find_last_not_of(" \t", begin - 1);
    const std::size_t right = all.find_first_not_of(" \t", end);
    if (left == all.npos || right == all.npos) return false;
    const std::size_t open = all[left] == ']' ? all.rfind('[', left) : all.npos;
    const std::size_t close = all[right] == '[' ? all.find(']', right) : all.npos;
    if (open == all.npos && close == all.npos) return false;
    std::vector<Edit> edits;
    if (open != all.npos && close != all.npos)
        edits = {{span(offset(open), offset(open)), cross ? "cross(" : "dot("},
                 {span(offset(left + 1), offset(right)), ", "},
                 {span(offset(close + 1), offset(close + 1)), ")"}};
    report(Code::BadCharacter, begin, end, std::string(no_sign_of_ours))
        .help(cross ? "a product of vectors is `cross(a, b)`"
                    : "a product of vectors is `dot(a, b)`",
              std::move(edits));
    return true;
}

// `√(x + 1)`, `√2`, `√p.x`: the call.
void ForeignWords::root_sign(std::uint32_t begin, std::uint32_t end) {
    const std::string_view all = source_.text;
    std::vector<Edit> edits{{span(begin, end), "sqrt"}};
    if (end >= all.size() || all[end] != '(') {
        std::size_t past = word_end(all, end);
        while (past > end && past + 1 < all.size() && all[past] == '.' &&
               is_word_char(all[past + 1]))
            past = word_end(all, past + 1);
        if (past == end || (past < all.size() && all[past] == '('))
            edits.clear(); // `√ f(x)`: how far it reaches is not known
        else
            edits = {{span(begin, end), "sqrt("}, {span(offset(past), offset(past)), ")"}};
    }
    if (!edits.empty() && told_before(begin, end, edits)) return;
    report(Code::BadCharacter, begin, end, "a root is written `sqrt(x)`")
        .help("write `sqrt( … )`", std::move(edits));
}

// `‖p‖`, `⌊x⌋`, at either of the two signs. True where it is one of them.
bool ForeignWords::paired_sign(std::uint32_t begin, std::uint32_t end) {
    const std::string_view all = source_.text, sign = slice(begin, end);
    const auto *const pair = std::ranges::find_if(
        pairs, [&](const Pair &p) { return p.open == sign || p.close == sign; });
    if (pair == std::end(pairs)) return false;
    if (pair_ends_.contains(begin)) return true; // told at the first
    constexpr std::size_t farthest = 400;        // bytes
    const std::string_view near = all.substr(end, farthest);
    const std::size_t line = end + std::min(near.find('\n'), near.size());
    std::size_t close = all.npos;
    for (std::size_t depth = 0, at = end; pair->open == sign && at < line; ++at) {
        if (all.substr(at).starts_with(pair->close) && depth-- == 0) {
            close = at;
            break;
        }
        if (all.substr(at).starts_with(pair->open)) ++depth; // `⌊⌊x⌋ / 2⌋`
    }
    std::vector<Edit> edits;
    if (close != all.npos && close < line && close > end) {
        pair_ends_.insert(offset(close));
        edits = {{span(begin, end), std::string(pair->call) + "("},
                 {span(offset(close), offset(close + pair->close.size())), ")"}};
        if (told_before(begin, end, edits)) return true;
    }
    report(Code::BadCharacter, begin, end, std::string(pair->message))
        .help("write `" + std::string(pair->call) + "( … )`", std::move(edits));
    return true;
}

// `f ∘ g`, which applies g first.
void ForeignWords::composition_sign(std::uint32_t begin, std::uint32_t end) {
    const std::string_view all = source_.text;
    Diagnostic &d =
        report(Code::BadCharacter, begin, end, "there is no sign for one function after another");
    const std::size_t right = std::min(all.find_first_not_of(' ', end), all.size());
    const std::size_t past = word_end(all, right);
    const std::size_t next = std::min(all.find_first_not_of(' ', past), all.size());
    const bool ends =
        next == all.size() || std::string_view("\r\n;,)").find(all[next]) != std::string_view::npos;
    const Token *left = words_.tokens.empty() ? nullptr : &words_.tokens.back();
    const Tok before =
        words_.tokens.size() < 2 ? Tok::End : words_.tokens[words_.tokens.size() - 2].kind;
    if (!left || left->kind != Tok::Name || past == right || is_digit(all[right]) || !ends ||
        !is_one_of(before, {Tok::Assign, Tok::Open, Tok::Comma, Tok::Colon})) {
        d.help("write `x => f(g(x))`");
        return;
    }
    const std::string written = "x => " + std::string(slice(left->begin, left->end)) + "(" +
                                std::string(slice(offset(right), offset(past))) + "(x))";
    d.help("write " + coded(written), {{span(left->begin, offset(past)), written}});
}

// `Σ_{i=1}^{3} x_i`, `∏_i f(i)`, at the first sign: where the line ends, which is left unread; 0
// where it is none.
std::uint32_t ForeignWords::sum_sign(std::uint32_t begin) {
    const std::string_view all = source_.text, rest = all.substr(begin);
    const bool sum = rest.starts_with("Σ") || rest.starts_with("∑");
    const bool product = rest.starts_with("Π") || rest.starts_with("∏");
    if (!sum && !product) return 0;
    const std::size_t sign = rest.starts_with("Σ") || rest.starts_with("Π") ? 2 : 3;
    const bool indexed = rest.substr(sign).starts_with("_") || rest.substr(sign).starts_with("ᵢ");
    if (!indexed && sign == 2) return 0; // a name of Greek letters
    const std::size_t line = std::min(all.find('\n', begin), all.size());
    const std::uint32_t end = begin + offset(sign);
    add(Tok::Bad, begin, end);
    report(Code::BadCharacter, begin, end,
           sum ? "a sum over a range is written with a loop"
               : "a product over a range is written with a loop")
        .help(
            sum ? "write `fn sum_of(n) { var s = 0; for i in 1..=n { s = s + i^2 }; return s }`"
                : "write `fn product_of(n) { var s = 1; for i in 1..=n { s = s * i }; return s }`");
    return offset(line);
}

// `!cube(1);` of OpenSCAD, at the sign.
void ForeignWords::shown_alone(std::uint32_t begin, std::uint32_t end) {
    const std::string_view all = source_.text;
    Diagnostic &d =
        report(Code::ForeignSyntax, begin, end, "what is drawn alone stands in `only(…)`");
    const bool moved = !words_.tokens.empty() && words_.tokens.back().kind == Tok::Close;
    std::size_t past =
        std::min(all.find_first_not_of("_0123456789abcdefghijklmnopqrstuvwxyz", end), all.size());
    constexpr std::size_t farthest = 400; // bytes
    const std::size_t limit = std::min(all.size(), end + farthest);
    for (std::size_t depth = 0; past < limit && all[past] != '\n'; ++past) {
        if (all[past] == '(') ++depth;
        if (depth == 0 || (all[past] == ')' && --depth == 0)) break;
    }
    const std::size_t next = std::min(all.find_first_not_of(' ', past + 1), all.size());
    const bool whole = past < all.size() && all[past] == ')' &&
                       (next == all.size() || all[next] == ';' || all[next] == '\n');
    if (whole && !moved) {
        const auto close = static_cast<std::uint32_t>(past + 1);
        d.help("write `only( … )`", {{span(begin, end), "only("}, {span(close, close), ")"}});
    } else
        d.help("leave it away, and give the shape to `only(s)`", {{span(begin, end), ""}});
}

// True where that is one of these, which is then told.
bool ForeignWords::sign_of_mathematics(std::uint32_t begin, std::uint32_t end) {
    const std::string_view text = slice(begin, end);
    if (const auto *const known = std::ranges::find(written_out, text, &Written::theirs);
        known != std::end(written_out)) {
        const bool mixed = known->ours[0] == '0' && begin > 0 && is_digit(source_.text[begin - 1]);
        const std::string ours(known->ours.substr(mixed ? 1 : 0)); // `2½`
        if (!told_before(begin, end, {{span(begin, end), ours}}))
            report(Code::BadCharacter, begin, end, std::string(no_sign_of_ours))
                .help("write " + coded(mixed ? "2" + ours : ours), {{span(begin, end), ours}});
    } else if (text == root)
        root_sign(begin, end);
    else if (text == composed)
        composition_sign(begin, end);
    else if (!paired_sign(begin, end))
        return false;
    add(Tok::Bad, begin, end);
    return true;
}

// `$fn = 64;`, and `, $fn = 64` among arguments: all of it. Nothing where no `=` follows.
std::optional<Span> ForeignWords::assignment_from(std::uint32_t begin, std::uint32_t end) const {
    const std::string_view all = source_.text;
    const std::size_t sign = std::min(all.find_first_not_of(' ', end), all.size());
    if (sign == all.size() || all[sign] != '=') return std::nullopt;
    std::size_t last = std::min(all.find_first_of(";\n,)", sign), all.size()), first = begin;
    const char behind = last < all.size() ? all[last] : '\n';
    const std::size_t before = begin > 0 ? all.find_last_not_of(' ', begin - 1) : all.npos;
    const bool after_comma = before != all.npos && all[before] == ',';
    if ((behind == ',' || behind == ')') && after_comma)
        first = before;
    else if (behind == ';' || behind == ',')
        last = std::min(all.find_first_not_of(' ', last + 1), all.size());
    return span(static_cast<std::uint32_t>(first), static_cast<std::uint32_t>(last));
}

ForeignWords::Faces ForeignWords::faces_of(Span assignment) const {
    const std::string_view all = source_.text, name = "$fn";
    const std::string_view whole = all.substr(assignment.begin, assignment.end - assignment.begin);
    const std::size_t sign = whole.find('=');
    std::string_view number = whole.substr(std::min(sign, whole.size() - 1) + 1);
    number.remove_prefix(std::min(number.find_first_not_of(' '), number.size()));
    number = number.substr(0, number.find_first_not_of("0123456789"));
    const auto faces =
        whole.find(name) == whole.npos || sign == whole.npos ? std::nullopt : parse_number(number);
    if (!faces || *faces > 8 || *faces < 3) return Faces::None;
    int depth = 0;
    constexpr std::size_t farthest = 1000;
    for (std::size_t i = assignment.begin, n = 0; i-- > 0 && n < farthest; ++n) {
        depth += all[i] == ')' ? 1 : all[i] == '(' ? -1 : 0;
        if (depth >= 0) continue;
        const std::string_view before = all.substr(0, i);
        if (before.ends_with("cylinder") || before.ends_with("circle")) return Faces::OfSolid;
        constexpr std::array<std::string_view, 3> round = {"sphere", "rotate_extrude", "torus"};
        const bool smooth = std::ranges::any_of(
            round, [&](std::string_view solid) { return before.ends_with(solid); });
        return smooth || before.empty() || !is_word_char(before.back()) ? Faces::None
                                                                        : Faces::HandedOn;
    }
    return Faces::HandedOn; // for all that follows
}

} // namespace fathom::lang
