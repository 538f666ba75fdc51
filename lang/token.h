// The words of a text, before any grammar: one byte of kind each, so that the grammar is an
// ordinary grammar over a string of kinds. Internal to lang. Knows nothing of the tree.
#pragma once

#include "base/diagnostic.h"
#include "base/source.h"

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::lang {

// Signs of one character are their own kind; `;` also stands for a line end that ends a statement.
enum class Tok : char {
    End = ';',
    Open = '(',
    Close = ')',
    ListOpen = '[',
    ListClose = ']',
    BraceClose = '}',
    Comma = ',',
    Colon = ':',
    Dot = '.',
    Assign = '=',
    Bar = '|',
    Amp = '&',
    Less = '<',
    Greater = '>',
    Plus = '+',
    Minus = '-',
    Star = '*',
    Slash = '/',
    Percent = '%',
    Caret = '^',
    Question = '?',
    // What layout makes of brackets: first on its line, a lambda's parameters, and the three
    // braces.
    FreshOpen = 'P',
    FreshListOpen = 'B',
    LambdaOpen = 'L',
    Body = '{',
    Trailing = 'T',
    StrayBrace = 'S',
    Arrow = 'a',
    FatArrow = 'f',
    DotDot = 'r',
    DotDotEqual = 'R',
    EqualEqual = 'e',
    NotEqual = 'n',
    LessEqual = 'l',
    GreaterEqual = 'g',
    PlusAssign = '1',
    MinusAssign = '2',
    StarAssign = '3',
    SlashAssign = '4',
    PlusPlus = '5',
    MinusMinus = '6',
    OtherAssign = '7',
    Name = 'N',
    LambdaName = 'M',
    Number = '0',
    String = '"',
    Color = '#',
    Bad = '!',
    Let = 'A',
    Var = 'V',
    Fn = 'F',
    Param = 'D',
    Import = 'I',
    For = 'O',
    In = 'i',
    If = 'C',
    Else = 'E',
    While = 'W',
    Limit = 'm',
    Break = 'K',
    Return = 'U',
    And = 'd',
    Or = 'o',
    Not = 't',
    True = 'y',
    False = 'z',
    As = 's',
};

inline bool is_one_of(Tok kind, std::initializer_list<Tok> some) {
    return std::find(some.begin(), some.end(), kind) != some.end();
}

inline bool ends_operand(Tok kind) {
    return is_one_of(kind, {Tok::Name, Tok::Number, Tok::String, Tok::Color, Tok::True, Tok::False,
                            Tok::Close, Tok::ListClose});
}

// A word: its kind and its place.
struct Token {
    Tok kind = Tok::End;
    bool first_on_line = false;
    std::uint32_t begin = 0, end = 0; // bytes
};

// The place of a comment in the text.
struct Comment {
    std::uint32_t begin = 0, end = 0; // without the line end
    bool is_line = false;             // `// …`, `/// …`
};

// The words as written (brackets not yet told apart), comments beside them.
struct Words {
    std::vector<Token> tokens;
    std::vector<Comment> comments;
};

// The words with their statement ends and balanced brackets, ready for the grammar.
struct Tokens {
    std::vector<Token> tokens;
    std::string kinds;                // the tokens' kinds, one byte each
    std::vector<std::uint32_t> match; // of a bracket: the index of its partner; else its own index
};

Words read_words(const Source &source, SourceId id, Diagnostics &diagnostics); // in parse.cpp
// Settles where statements end, and reports what cannot be a word.
Tokens lay_out(const Source &source, SourceId id, const Words &words, Diagnostics &diagnostics);

// What stands between words of a line and says nothing (parse.cpp's `blank`).
constexpr std::string_view blanks = " \t\r\f\v";
inline std::string_view without_end(std::string_view line) {
    return line.substr(0, line.find_last_not_of(blanks) + 1);
}

inline std::string_view text_of(const Source &source, const Token &token) {
    return std::string_view(source.text).substr(token.begin, token.end - token.begin);
}

} // namespace fathom::lang
