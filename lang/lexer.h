// What the word grammar (parse.cpp) does with each word that it finds: kinds, and reports of words
// that the language does not have. Knows nothing of statements.
#pragma once

#include "lang/token.h"

#include <algorithm>
#include <unordered_map>
#include <unordered_set>

namespace fathom::lang {

// Collects the words of a text.
class Lexer {
  public:
    Lexer(const Source &source, SourceId id, Diagnostics &diagnostics)
        : source_(source), id_(id), diagnostics_(diagnostics),
          beyond_ascii_(std::any_of(source.text.begin(), source.text.end(),
                                    [](char c) { return (c & 0x80) != 0; })) {}

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
    bool lisp_vector(std::uint32_t begin) const;
    std::uint32_t define(std::uint32_t begin, std::uint32_t end);
    void directive(std::uint32_t begin, std::uint32_t end, std::uint32_t line_end);
    void sign(std::uint32_t begin, std::uint32_t end);
    void shown_alone(std::uint32_t begin, std::uint32_t end);
    void turned_text(std::uint32_t begin, std::uint32_t end);
    bool invisible_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t sign);
    void strange(std::uint32_t begin, std::uint32_t end); // bytes that begin no word

    std::size_t count() const { return words_.tokens.size(); }
    Words take() { return std::move(words_); }

  private:
    void add(Tok kind, std::uint32_t begin, std::uint32_t end);
    Span span(std::uint32_t begin, std::uint32_t end) const { return {id_, begin, end}; }
    std::string_view slice(std::uint32_t begin, std::uint32_t end) const {
        return std::string_view(source_.text).substr(begin, end - begin);
    }
    Diagnostic &report(Code code, std::uint32_t begin, std::uint32_t end, std::string message) {
        return diagnostics_.add(code, span(begin, end), std::move(message));
    }
    Diagnostic &foreign(std::uint32_t begin, std::uint32_t end, std::string message,
                        std::string replacement);
    std::string set_apart(std::uint32_t begin, std::uint32_t end, std::string_view ours) const;
    std::optional<Span> assignment_from(std::uint32_t begin, std::uint32_t end) const;
    bool makes_prism(Span assignment) const;
    std::uint32_t name_with_letters(std::uint32_t begin);
    bool strange_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t code_point);
    // Signs of mathematics (strange_signs.cpp).
    bool told_before(std::uint32_t begin, std::uint32_t end, const std::vector<Edit> &edits);
    bool sign_of_mathematics(std::uint32_t begin, std::uint32_t end);
    void root_sign(std::uint32_t begin, std::uint32_t end);
    bool paired_sign(std::uint32_t begin, std::uint32_t end);
    std::uint32_t sum_sign(std::uint32_t begin);
    void composition_sign(std::uint32_t begin, std::uint32_t end);

    const Source &source_;
    SourceId id_;
    Diagnostics &diagnostics_;
    Words words_;
    bool is_named(std::string_view number) const;
    bool product_of_rows(std::uint32_t begin, std::uint32_t end, bool cross);

    bool fresh_line_ = true;
    const bool beyond_ascii_; // the text has other letters somewhere
    struct ToldName {
        Span first;
        std::size_t uses = 0;
    };
    // Names with letters that no name has, and signs.
    std::unordered_map<std::string_view, ToldName> told_names_;
    std::unordered_set<std::uint32_t> pair_ends_; // signs that close the `‖` before them
    std::uint32_t open_choices_ = 0;              // `#if`s whose `#endif` is yet to come
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

// A word that begins like a number and is none (bad_numbers.cpp).
struct BadNumber {
    std::string message, help, replacement;
};
std::size_t number_length(std::string_view word); // of the digits that it begins with
BadNumber explain_bad_number(std::string_view word, bool named);
bool is_length_unit(std::string_view word); // `mm`, `in`: elsewhere
bool is_degree_word(std::string_view word);

// The value of a number word, its unit applied; nothing where the word is no number of the
// language.
struct NumberWord {
    double value = 0;
    bool is_int = false;
    std::string_view digits, unit;
};
std::optional<NumberWord> read_number(std::string_view word);
std::string read_string(std::string_view quoted); // escapes resolved
void read_color(std::string_view word, double (&rgba)[4]);

} // namespace fathom::lang
