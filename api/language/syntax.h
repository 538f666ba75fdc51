// A text's words and tree as the compiler's parser gives them, also where a part cannot be read, and
// what lies at a place of them. Knows nothing of types.
#pragma once

#include "base/source.h"
#include "lang/ast.h"
#include "lang/token.h"

#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::language {

struct Syntax {
    Sources sources;
    SourceId source;
    lang::Ast ast;
    lang::Words words; // with the comments
    bool whole = true; // all of it could be read
    std::string_view text() const { return sources[source].text; }
};
Syntax read_syntax(std::string text);
int line_of(const Syntax &syntax, std::size_t offset); // from 1

// The expressions directly inside an expression or a statement, and the blocks and functions.
struct Inside {
    std::vector<lang::ExprId> exprs;
    std::vector<lang::BlockId> blocks;
    std::vector<lang::FunctionId> functions;
};
Inside inside(const lang::Expr &expr);
Inside inside(const lang::Stmt &stmt);

// What holds a stretch of the text, from the file down to the smallest expression.
struct Step {
    const lang::Block *block = nullptr;       // with `stmt`, which lies in it
    const lang::Stmt *stmt = nullptr;         // or one of the following
    const lang::Function *function = nullptr; // a lambda, or what `fn` declares
    lang::ExprId expr;
    Span span(const lang::Ast &ast) const;
};
std::vector<Step> path_to(const lang::Ast &ast, std::uint32_t begin, std::uint32_t end);

// The call in whose parentheses a byte lies, read from the words alone, so that it is found in a
// half-typed text too.
struct OpenCall {
    std::string name; // what is called
    std::size_t name_begin = 0;
    bool method = false;            // a dot stands before it
    std::size_t argument = 0;       // arguments begun before the byte, less one
    std::string argument_name;      // of the one that the byte lies in; empty where it has none
    std::vector<std::string> named; // all that are named
};
std::optional<OpenCall> call_around(const Syntax &syntax, std::size_t offset);

// The name (letters, digits, `_`) that a byte lies in or at the end of; empty where there is none.
struct Word {
    std::size_t begin = 0, end = 0;
    bool method = false; // a dot stands before it
};
Word word_at(std::string_view text, std::size_t offset);

// Whether a byte lies in a comment or a string.
bool in_comment_or_string(const Syntax &syntax, std::size_t offset);

} // namespace fathom::language
