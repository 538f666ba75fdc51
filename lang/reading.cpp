// Words and tokens while they are read; see reading.h.
#include "lang/reading.h"

#include "base/text.h"
#include "lang/lexer.h"

namespace fathom::lang {

void WordReading::add(Tok kind, std::uint32_t begin, std::uint32_t end) {
    words_.tokens.push_back({kind, fresh_line_, begin, end});
    fresh_line_ = false;
}

// A word that takes the place of a sign, with spaces where it would run into another: `a&&b`.
std::string WordReading::set_apart(std::uint32_t begin, std::uint32_t end,
                                   std::string_view ours) const {
    const std::string_view all = source_.text;
    std::string out(ours);
    if (out.empty() || !is_word_char(out[0])) return out;
    if (begin > 0 && is_word_char(all[begin - 1])) out.insert(0, " ");
    if (end < all.size() && (is_word_char(all[end]) || all[end] == '(')) out += " ";
    return out;
}

Diagnostic &WordReading::foreign(std::uint32_t begin, std::uint32_t end, std::string message,
                                 std::string replacement) {
    std::string_view shown = replacement;
    if (shown.ends_with(' ')) shown.remove_suffix(1);
    std::string help = "write `" + std::string(shown) + "`";
    return report(Code::ForeignSyntax, begin, end, std::move(message))
        .help(std::move(help), {{span(begin, end), std::move(replacement)}});
}

static Token behind(const std::vector<Token> &tokens) {
    const std::uint32_t end = tokens.empty() ? 0 : tokens.back().end;
    return {Tok::End, false, end, end};
}

TokenReading::TokenReading(const Source &source, SourceId id, const Tokens &tokens,
                           Diagnostics &diagnostics)
    : source_(source), id_(id), tokens_(tokens), past_(behind(tokens.tokens)),
      diagnostics_(diagnostics) {}

std::uint32_t TokenReading::word(std::string_view text) {
    const auto [it, added] =
        words_.try_emplace(text, static_cast<std::uint32_t>(ast_.words.size()));
    if (added) ast_.words.add(std::string(text));
    return it->second;
}

bool TokenReading::ends_statement(Index at) const {
    return at >= tokens_.tokens.size() || kind(at) == Tok::End || kind(at) == Tok::BraceClose;
}

static bool opens(Tok kind) {
    return is_one_of(kind, {Tok::Open, Tok::FreshOpen, Tok::LambdaOpen, Tok::ListOpen,
                            Tok::FreshListOpen, Tok::Body, Tok::Trailing, Tok::StrayBrace});
}

// Past the place where the statement broke, at the line end or `}` that ends it.
TokenReading::Index TokenReading::statement_end(Index first) const {
    Index i = first;
    while (i < tokens_.tokens.size()) {
        if (opens(kind(i))) {
            i = match(i) + 1;
        } else if (kind(i) == Tok::BraceClose && match(i) < first) {
            return i; // of the block around it, which no statement leaves
        } else if (i >= failed_ && (kind(i) == Tok::BraceClose ||
                                    (kind(i) == Tok::End && kind(i + 1) != Tok::Else))) {
            return i;
        } else {
            ++i;
        }
    }
    return i;
}

// The bracket around a token, or 0.
TokenReading::Index TokenReading::enclosing(Index at) const {
    for (Index i = at; i-- > 0;) {
        const Index partner = match(i);
        if (partner < i)
            i = partner;
        else if (partner > i)
            return i;
    }
    return 0;
}

// Whether a name was declared above, anywhere: then an assignment means to change it.
bool TokenReading::is_declared(std::string_view name) {
    for (; known_ < declared_.size(); ++known_) known_names_.insert(declared_[known_]);
    return known_names_.count(name) > 0;
}

std::string brief(std::string_view text) {
    constexpr std::size_t longest = 80;
    return text.size() > longest || text.find('\n') != std::string_view::npos ? "…"
                                                                              : std::string(text);
}

std::string in_code(std::string_view text) { return "`" + brief(text) + "`"; }

std::string to_write(std::string_view text) {
    const std::string code = in_code(text);
    return code == "`…`" ? "write it so" : "write " + code;
}

} // namespace fathom::lang
