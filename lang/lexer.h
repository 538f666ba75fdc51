// What the word grammar (parse.cpp) does with each word that it finds: kinds, and reports of words
// that the language does not have. Knows nothing of statements.
#pragma once

#include "lang/token.h"

namespace fathom::lang {

// Collects the words of a text.
class Lexer {
  public:
    Lexer(const Source &source, SourceId id, Diagnostics &diagnostics)
        : source_(source), id_(id), diagnostics_(diagnostics) {}

    void line_end() { fresh_line_ = true; }
    void line_comment(std::uint32_t begin, std::uint32_t end);
    void block_comment(std::uint32_t begin, std::uint32_t end);
    void unclosed_comment(std::uint32_t begin, std::uint32_t end);
    void word(std::uint32_t begin, std::uint32_t end);
    void number(std::uint32_t begin, std::uint32_t end);
    void string(std::uint32_t begin, std::uint32_t end);
    void unclosed_string(std::uint32_t begin, std::uint32_t end);
    void quoted(std::uint32_t begin, std::uint32_t end);        // 'text'
    std::uint32_t hash(std::uint32_t begin, std::uint32_t end); // the end of what was understood
    std::uint32_t defined_name(std::uint32_t from) const;
    std::uint32_t define(std::uint32_t begin, std::uint32_t end, std::uint32_t name_end);
    void sign(std::uint32_t begin, std::uint32_t end);
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
    std::optional<Span> assignment_from(std::uint32_t begin, std::uint32_t end) const;
    bool strange_sign(std::uint32_t begin, std::uint32_t end, std::uint32_t code_point);

    const Source &source_;
    SourceId id_;
    Diagnostics &diagnostics_;
    Words words_;
    bool fresh_line_ = true;
};

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
