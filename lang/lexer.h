// What the word grammar (parse.cpp) does with each word that it finds: kinds, and reports of words
// that the language does not have. Knows nothing of statements.
#pragma once

#include "lang/foreign/foreign.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace fathom::lang {

// Collects the words of a text.
class Lexer : ForeignWords {
  public:
    Lexer(const Source &source, SourceId id, Diagnostics &diagnostics)
        : ForeignWords(source, id, diagnostics) {}

    void line_end() { fresh_line_ = true; }
    void line_comment(std::uint32_t begin, std::uint32_t end);
    void block_comment(std::uint32_t begin, std::uint32_t end);
    void unclosed_comment(std::uint32_t begin, std::uint32_t end);
    void word(std::uint32_t begin, std::uint32_t end);
    void number(std::uint32_t begin, std::uint32_t end);
    void string(std::uint32_t begin, std::uint32_t end);
    void unclosed_string(std::uint32_t begin, std::uint32_t end);
    std::uint32_t by_hand(std::uint32_t begin);
    std::uint32_t smart_string(std::uint32_t begin);
    void quoted(std::uint32_t begin, std::uint32_t end);        // 'text'
    std::uint32_t hash(std::uint32_t begin, std::uint32_t end); // the end of what was understood
    void sign(std::uint32_t begin, std::uint32_t end);
    void strange(std::uint32_t begin, std::uint32_t end); // bytes that begin no word

    std::size_t count() const { return words_.tokens.size(); }
    Words take() { return std::move(words_); }

  private:
    bool is_named(std::string_view number) const;
};

inline bool is_digit(char c) { return c >= '0' && c <= '9'; }
inline bool is_word_char(char c) {
    return c == '_' || is_digit(c) || (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z');
}
inline bool is_hex(char c) {
    return is_digit(c) || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F');
}
inline unsigned hex_value(char c) {
    return static_cast<unsigned>(is_digit(c) ? c - '0' : (c | 0x20) - 'a' + 10);
}

bool is_keyword_text(std::string_view word);

// The value of a number word, its unit applied; nothing where the word is no number of the
// language.
struct NumberWord {
    double value = 0;
    bool is_int = false;
    std::string_view digits; // of the word
    std::string_view unit;   // "", "deg", "rad" or "turn", of no text
};
std::optional<NumberWord> read_number(std::string_view word);
std::string read_string(std::string_view quoted); // escapes resolved
void read_color(std::string_view word, double (&rgba)[4]);

} // namespace fathom::lang
