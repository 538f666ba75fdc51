// GLSL's `void fold(inout vec2 p, float a) { p = … }`, called as `fold(q.xz, 1.0);`: a function that
// gives the new `p`, and calls that assign it. What is `out` is no argument then.
#include "lang/foreign/foreign.h"
#include "lang/vocabulary.h"

namespace fathom::lang {

namespace {

constexpr std::size_t longest_text = 20'000; // tokens: each such function looks through all calls

} // namespace

std::string_view zero_of(std::string_view type) {
    constexpr std::pair<std::string_view, std::string_view> zeros[] = {
        {"int", "0"},        {"bool", "false"},   {"vec2", "vec2(0)"},
        {"vec3", "vec3(0)"}, {"vec4", "vec4(0)"}, {"color", "black"},
        {"shape", "empty"},  {"string", "\"\""},  {"float", "0.0"}};
    for (const auto &[name, zero] : zeros)
        if (name == type) return zero;
    return {};
}

// The parameter that is changed, where there is one: its place in the row, and its name.
std::optional<ForeignSyntax::Changed> ForeignSyntax::changed_by(Index open) const {
    std::optional<Changed> out;
    const Index close = match(open);
    std::size_t place = 0;
    for (Index i = open + 1; i < close; ++i) {
        if (match(i) > i) i = match(i);
        if (kind(i) == Tok::Comma) ++place;
        if (text(i) != "inout" && text(i) != "out") continue;
        if (out || kind(i + 1) != Tok::Name || kind(i + 2) != Tok::Name) return std::nullopt;
        out = Changed{place, i + 1, i + 2, text(i) == "out"};
    }
    return out;
}

// The edits that make it return what it changes, in its body, which begins at a brace, and in all of
// its calls; none where a call stands within an expression. Then its head says what it gives.
std::vector<Edit> ForeignSyntax::returned_instead(Index name, Index body, std::string &head) const {
    const auto by = changed_by(name + 1);
    const Index end = match(body);
    if (!by || tokens_.tokens.size() > longest_text || end <= body) return {};
    const std::string ours(text(by->name)), type(our_type(text(by->type)));
    const std::string_view zero = zero_of(type);
    if (by->is_fresh && (text(name - 1) != "void" || zero.empty())) return {};
    const auto insert = [&](std::uint32_t at, std::string what) {
        return Edit{{id_, at, at}, std::move(what)};
    };
    const std::string first = by->is_fresh ? std::string(zero) : ours;
    std::vector<Edit> edits{insert(token(body).end, " var " + ours + " = " + first + ";")};
    for (Index i = body + 1; i < end; ++i) {
        if (kind(i) != Tok::Return) continue;
        const Index past = statement_end(i);
        edits.push_back({{id_, token(i).end, token(past - 1).end}, " " + ours});
        i = past;
    }
    if (text(name - 1) == "void") edits.push_back(insert(token(end).begin, ours + " "));
    for (Index i = 0; i < tokens_.tokens.size(); ++i) {
        if (i == name || kind(i) != Tok::Name || text(i) != text(name) || kind(i + 1) != Tok::Open)
            continue;
        const Index close = match(i + 1);
        const bool begins =
            i == 0 || kind(i - 1) == Tok::End || text(i - 1) == "{" || text(i - 1) == "}";
        if (!begins || close <= i + 1 || text(close + 1) != ";") return {};
        Index from = i + 2;
        for (std::size_t k = 0; k < by->place && from < close; ++from) {
            if (match(from) > from) from = match(from);
            k += kind(from) == Tok::Comma;
        }
        Index to = from; // a name, or parts of one
        while (to < close && is_one_of(kind(to), {Tok::Name, Tok::Dot})) ++to;
        if (to == from || !is_one_of(kind(to), {Tok::Comma, Tok::Close})) return {};
        const std::string place(text(token(from).begin, token(to - 1).end));
        edits.push_back(insert(token(i).begin, place + " = "));
        if (!by->is_fresh) continue;
        const bool alone = from == i + 2 && to == close, leads = from == i + 2 && !alone;
        const std::uint32_t begin = token(leads || alone ? from : from - 1).begin;
        edits.push_back({{id_, begin, leads ? token(to + 1).begin : token(to - 1).end}, ""});
    }
    head.resize(head.rfind(')') + 1);
    if (by->is_fresh) {
        const std::string written = ours + ": " + type;
        std::size_t at = head.find("(" + written) + 1, length = written.size();
        if (at > 0)
            length += head.compare(at + length, 2, ", ") == 0 ? 2 : 0;
        else
            at = head.find(", " + written), length += 2;
        if (at == std::string::npos) return {};
        head.erase(at, length);
    }
    head += " -> " + type;
    return edits;
}

// For GLSL's `void f(inout vec2 p, out float d)`, whose parameters begin at a `(`.
void ForeignSyntax::note_changed(Index open, Diagnostic &d) const {
    bool changes = false;
    for (Index i = open + 1; i < match(open); ++i)
        changes = changes || ((text(i) == "out" || text(i) == "inout") &&
                              is_one_of(kind(i - 1), {Tok::Open, Tok::Comma}));
    if (changes) d.note(std::string(changes_nothing));
}

} // namespace fathom::lang
