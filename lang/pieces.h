// What the formatter lays out: words and comments in the order of the text. Internal to lang. Knows
// nothing of where lines should break.
#pragma once

#include "lang/token.h"

namespace fathom::lang {

// A word or a comment, and whether it begins a line.
struct Piece {
    Tok kind = Tok::End;
    bool is_comment = false, is_line_comment = false;
    bool starts_statement = false;
    bool is_prefix = false;     // a `-` with one operand
    bool is_call = false;       // a `(` or `[` that applies to what stands before it
    bool in_type = false;       // the `<`, number and `>` of `shape<1>`
    bool breaks = false;        // begins a line
    bool blank_above = false;   // with an empty line above it
    bool inline_block = false;  // a `{` whose block stands on its line
    std::uint32_t newlines = 0; // in the source, before it
    std::size_t match = 0;      // of a bracket
    std::string_view text;
};

inline bool is_block_open(Tok kind) { return kind == Tok::Body || kind == Tok::Trailing; }
inline bool is_group_open(Tok kind) {
    return kind == Tok::Open || kind == Tok::FreshOpen || kind == Tok::LambdaOpen ||
           kind == Tok::ListOpen || kind == Tok::FreshListOpen;
}
inline bool is_open(Tok kind) { return is_block_open(kind) || is_group_open(kind); }
inline bool is_close(Tok kind) {
    return kind == Tok::Close || kind == Tok::ListClose || kind == Tok::BraceClose;
}

// The words and comments of a text in order.
std::vector<Piece> read_pieces(const Source &source, const Tokens &tokens,
                               const std::vector<Comment> &comments);

} // namespace fathom::lang
