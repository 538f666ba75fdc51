// What the readers of words and of the tree share with the answers to other languages
// (foreign/foreign.h): the text, its words, and how far reading has come. Internal to lang.
#pragma once

#include "lang/ast.h"
#include "lang/token.h"

#include <algorithm>
#include <array>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace fathom::lang {

// What the grammar wanted at a place where it cannot go on.
enum class Wanted {
    Expression,
    Statement,
    CloseParen,
    CloseList,
    CloseBrace,
    Name,
    ParameterName,
    OpenParen,
    AssignSign,
    Type,
    TypeEnd,
    TypeNumber,
    TypeArrow,
    FunctionBody,
    Block,
    In,
    Arrow,
    MemberName,
    ImportPath,
    TernaryColon,
    StatementEnd
};

// A text as it can stand in a message: of one line and not long, else `…`; and in backticks.
std::string brief(std::string_view text);
std::string in_code(std::string_view text);
// "write `…`" of what an edit writes, which is shown with it where it is long.
std::string to_write(std::string_view text);

template <std::size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N> &words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

// The text, while its words are read (lexer.h).
class WordReading {
  protected:
    WordReading(const Source &source, SourceId id, Diagnostics &diagnostics)
        : source_(source), id_(id), diagnostics_(diagnostics) {}

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

    const Source &source_;
    SourceId id_;
    Diagnostics &diagnostics_;
    Words words_;
    bool fresh_line_ = true;
};

// The words, while the tree is built of them (builder.h).
class TokenReading {
  public:
    using Index = std::uint32_t; // of a token

  protected:
    TokenReading(const Source &source, SourceId id, const Tokens &tokens, Diagnostics &diagnostics);

    // A token, and behind the last a statement's end: who looks ahead need not ask whether there is
    // anything.
    const Token &token(Index at) const {
        return at < tokens_.tokens.size() ? tokens_.tokens[at] : past_;
    }
    Tok kind(Index at) const { return token(at).kind; }
    // Of a bracket the index of its partner, of all else its own.
    Index match(Index at) const { return at < tokens_.match.size() ? tokens_.match[at] : at; }
    std::string_view text(Index at) const { return text_of(source_, token(at)); }
    std::string_view text(std::uint32_t begin, std::uint32_t end) const {
        return std::string_view(source_.text).substr(begin, end - begin);
    }
    Span span(Index at) const { return {id_, token(at).begin, token(at).end}; }
    Span span(Index first, Index last) const { return {id_, token(first).begin, token(last).end}; }
    Diagnostic &foreign(Span where, std::string message) {
        return diagnostics_.add(Code::ForeignSyntax, where, std::move(message));
    }

    bool ends_statement(Index at) const;
    Index statement_end(Index first) const;
    Index enclosing(Index at) const;
    bool is_declared(std::string_view name);
    std::uint32_t word(std::string_view text); // of a part of the source

    const Source &source_;
    SourceId id_;
    const Tokens &tokens_;
    const Token past_;
    Diagnostics &diagnostics_;
    Ast ast_;
    std::unordered_map<std::string_view, std::uint32_t> words_; // into ast_.words
    std::vector<std::string_view> declared_;                    // names, so far
    bool in_function_ = false;
    bool body_missing_ = false; // of an `if` that was just abandoned: an `else` may follow
    std::vector<Index> lost_;   // names that the statement would have declared, beside its first
    Index failed_ = 0;          // where the statement that is being abandoned broke

  private:
    std::unordered_set<std::string_view> known_names_; // the first known_ of those declared
    std::size_t known_ = 0;
};

} // namespace fathom::lang
