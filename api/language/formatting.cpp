// The one form of `fathom fmt` as edits. The formatter keeps all words and comments and changes what
// is between them, so an edit replaces the space between two; of a range, those within it.
#include "api/language/features.h"

#include <algorithm>

namespace fathom::language {
namespace {

struct Piece {
    std::size_t begin, end;
};

// Words and comments by place, without what the formatter puts and takes: `;` and the comma before
// a bracket that closes.
std::vector<Piece> pieces_of(const Syntax &syntax) {
    std::vector<Piece> pieces;
    const std::string_view text = syntax.text();
    const std::vector<lang::Token> &tokens = syntax.words.tokens;
    const auto sign = [&](std::size_t i) {
        return i < tokens.size() ? text[tokens[i].begin] : ' ';
    };
    for (std::size_t i = 0; i < tokens.size(); ++i) {
        if (sign(i) == ';') continue;
        if (sign(i) == ',' && (sign(i + 1) == ')' || sign(i + 1) == ']')) continue;
        pieces.push_back({tokens[i].begin, tokens[i].end});
    }
    for (const lang::Comment &comment : syntax.words.comments)
        pieces.push_back({comment.begin, comment.end});
    std::ranges::sort(pieces, {}, &Piece::begin);
    return pieces;
}

// Edits of the stretch [from, to) that give the formatted text there; none where the text cannot be
// read.
std::vector<v1::TextEdit> edits_within(const Reading &read, std::size_t from, std::size_t to) {
    std::vector<v1::TextEdit> edits;
    const std::string old(read.syntax.text());
    const std::optional<std::string> formatted = v1::format_text(old);
    if (!formatted || *formatted == old) return edits;
    const auto replace = [&](std::size_t begin, std::size_t end, std::string_view with) {
        if (std::string_view(old).substr(begin, end - begin) == with) return;
        edits.push_back({{begin, end}, std::string(with)});
    };
    const Syntax after = read_syntax(*formatted);
    const std::vector<Piece> was = pieces_of(read.syntax), is = pieces_of(after);
    const auto same = [&](const Piece &a, const Piece &b) {
        return std::string_view(old).substr(a.begin, a.end - a.begin) ==
               std::string_view(*formatted).substr(b.begin, b.end - b.begin);
    };
    if (!std::ranges::equal(was, is, same)) { // a comment that was laid out anew
        if (from == 0 && to >= old.size()) replace(0, old.size(), *formatted);
        return edits;
    }
    std::size_t old_at = 0, new_at = 0;
    for (std::size_t i = 0; i <= was.size(); ++i) {
        const std::size_t old_end = i < was.size() ? was[i].begin : old.size(),
                          new_end = i < is.size() ? is[i].begin : formatted->size();
        if (from <= old_at && old_end <= to)
            replace(old_at, old_end, std::string_view(*formatted).substr(new_at, new_end - new_at));
        if (i == was.size()) break;
        old_at = was[i].end;
        new_at = is[i].end;
    }
    return edits;
}

} // namespace

// Whole lines: those that the stretch touches.
std::vector<v1::TextEdit> format(Document &document, v1::Stretch within) {
    const Reading &read = reading(document);
    const std::string_view text = read.syntax.text();
    const auto begin_of_line = [&](std::size_t at) {
        const std::size_t before = at > 0 ? text.rfind('\n', at - 1) : text.npos;
        return before == text.npos ? 0 : before + 1;
    };
    const std::size_t from = begin_of_line(within.begin);
    std::size_t to = within.end;
    if (begin_of_line(to) != to || from == to) {
        const std::size_t end = text.find('\n', to);
        to = end == text.npos ? text.size() : end + 1;
    }
    return edits_within(read, from > 0 ? from - 1 : 0, to);
}

std::vector<v1::TextEdit> format_typed(Document &document, std::size_t offset, char typed) {
    const Reading &read = reading(document);
    const std::string_view text = read.syntax.text();
    const std::size_t at =
        std::min(text.find_last_not_of(" \t\r\n", offset ? offset - 1 : 0), text.size());
    if (at == text.size()) return {};
    std::size_t from = at;
    const lang::Block &root = read.syntax.ast.blocks[read.syntax.ast.root];
    for (const lang::Stmt &stmt : root.stmts)
        if (stmt.span.begin <= at && at < stmt.span.end) from = stmt.span.begin;
    if (from == at) return {};
    // the line that is being typed stays as it is
    return edits_within(read, from, typed == '}' ? offset : at + 1);
}

} // namespace fathom::language
