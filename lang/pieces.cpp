// Words and comments, merged by place. Statement ends and commas before a closing bracket are left
// out: the formatter writes its own.
#include "lang/pieces.h"

#include <algorithm>

namespace fathom::lang {

std::vector<Piece> read_pieces(const Source &source, const Tokens &tokens,
                               const std::vector<Comment> &comments) {
    const std::string_view text = source.text;
    std::vector<Piece> pieces;
    std::vector<std::size_t> place(tokens.tokens.size()); // of each token among the pieces
    std::uint32_t done = 0;
    std::size_t next_comment = 0;
    bool statement = true;
    const auto put = [&](std::uint32_t begin, std::uint32_t end) -> Piece & {
        Piece piece;
        const std::string_view gap = text.substr(done, begin - done);
        piece.newlines = static_cast<std::uint32_t>(std::count(gap.begin(), gap.end(), '\n'));
        piece.text = text.substr(begin, end - begin);
        done = end;
        pieces.push_back(piece);
        return pieces.back();
    };
    const auto put_comments_before = [&](std::uint32_t begin) {
        for (; next_comment < comments.size() && comments[next_comment].begin < begin;
             ++next_comment) {
            const Comment &comment = comments[next_comment];
            Piece &piece = put(comment.begin, comment.end);
            piece.is_comment = true;
            piece.is_line_comment = comment.is_line;
            if (comment.is_line) piece.text = without_end(piece.text);
        }
    };
    for (std::size_t i = 0; i < tokens.tokens.size(); ++i) {
        const Token &token = tokens.tokens[i];
        if (token.kind == Tok::End) {
            statement = true;
            continue;
        }
        // No comma stands before a closing bracket.
        const bool last =
            i + 1 < tokens.tokens.size() && (tokens.tokens[i + 1].kind == Tok::Close ||
                                             tokens.tokens[i + 1].kind == Tok::ListClose);
        if (token.kind == Tok::Comma && last) continue;
        put_comments_before(token.begin);
        place[i] = pieces.size();
        Piece &piece = put(token.begin, token.end);
        piece.kind = token.kind;
        piece.starts_statement = statement && token.kind != Tok::BraceClose;
        piece.match = place[i];
        if (tokens.match[i] < i) {
            piece.match = place[tokens.match[i]];
            pieces[piece.match].match = place[i];
        }
        statement = is_block_open(token.kind);
    }
    put_comments_before(static_cast<std::uint32_t>(text.size()));
    return pieces;
}

} // namespace fathom::lang
