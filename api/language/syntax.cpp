#include "api/language/syntax.h"

#include "base/diagnostic.h"
#include "lang/parse.h"

#include <algorithm>
#include <cctype>

namespace fathom::language {

using lang::Tok;

Syntax read_syntax(std::string text) {
    Syntax syntax;
    syntax.source = syntax.sources.add("", std::move(text));
    Diagnostics diagnostics;
    syntax.ast =
        lang::parse(syntax.sources, syntax.source, diagnostics, lang::usual_words, &syntax.words);
    syntax.whole = !diagnostics.has_errors();
    return syntax;
}

int line_of(const Syntax &syntax, std::size_t offset) {
    return position(syntax.sources[syntax.source], static_cast<std::uint32_t>(offset)).line;
}

Inside inside(const lang::Expr &expr) {
    Inside in;
    const auto visit = [&in](const auto &kind) {
        using Kind = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<Kind, lang::List>)
            in.exprs = kind.items;
        else if constexpr (std::is_same_v<Kind, lang::Comprehension>)
            in.blocks = {kind.body};
        else if constexpr (std::is_same_v<Kind, lang::Range>)
            in.exprs = {kind.first, kind.last};
        else if constexpr (std::is_same_v<Kind, lang::Unary>)
            in.exprs = {kind.operand};
        else if constexpr (std::is_same_v<Kind, lang::Binary>)
            for (const lang::Operand &operand : kind.operands) in.exprs.push_back(operand.value);
        else if constexpr (std::is_same_v<Kind, lang::Call>) {
            in.exprs = {kind.callee};
            for (const lang::Argument &argument : kind.arguments)
                in.exprs.push_back(argument.value);
            if (kind.trailing) in.blocks = {*kind.trailing};
        } else if constexpr (std::is_same_v<Kind, lang::Index>)
            in.exprs = {kind.object, kind.index};
        else if constexpr (std::is_same_v<Kind, lang::Member>)
            in.exprs = {kind.object};
        else if constexpr (std::is_same_v<Kind, lang::Lambda>)
            in.functions = {kind.function};
        else if constexpr (std::is_same_v<Kind, lang::If>) {
            for (const lang::IfBranch &branch : kind.branches) {
                in.exprs.push_back(branch.condition);
                in.blocks.push_back(branch.body);
            }
            if (kind.otherwise) in.blocks.push_back(*kind.otherwise);
        } else if constexpr (std::is_same_v<Kind, lang::BlockExpr>)
            in.blocks = {kind.block};
    };
    std::visit(visit, expr.kind);
    return in;
}

Inside inside(const lang::Stmt &stmt) {
    Inside in;
    const auto visit = [&in](const auto &kind) {
        using Kind = std::decay_t<decltype(kind)>;
        if constexpr (std::is_same_v<Kind, lang::ExprStmt> || std::is_same_v<Kind, lang::Let> ||
                      std::is_same_v<Kind, lang::Var>)
            in.exprs = {kind.value};
        else if constexpr (std::is_same_v<Kind, lang::Assign>)
            in.exprs = {kind.target, kind.value};
        else if constexpr (std::is_same_v<Kind, lang::FunctionDecl>)
            in.functions = {kind.function};
        else if constexpr (std::is_same_v<Kind, lang::Param>) {
            in.exprs = {kind.value};
            if (kind.low) in.exprs.push_back(*kind.low);
            if (kind.high) in.exprs.push_back(*kind.high);
        } else if constexpr (std::is_same_v<Kind, lang::For>) {
            in.exprs = {kind.sequence};
            in.blocks = {kind.body};
        } else if constexpr (std::is_same_v<Kind, lang::While>) {
            in.exprs = {kind.condition};
            if (kind.limit) in.exprs.push_back(*kind.limit);
            in.blocks = {kind.body};
        } else if constexpr (std::is_same_v<Kind, lang::Return>) {
            if (kind.value) in.exprs = {*kind.value};
        }
    };
    std::visit(visit, stmt.kind);
    return in;
}

Span Step::span(const lang::Ast &ast) const {
    if (expr) return ast.exprs[expr].span;
    return function ? function->span : stmt->span;
}

namespace {

// Goes down the tree towards a stretch. Poisoned places have no parts.
struct Descent {
    const lang::Ast &ast;
    std::uint32_t begin, end;
    std::vector<Step> steps;

    bool holds(Span span) const { return span.begin <= begin && end <= span.end; }

    bool block(lang::BlockId id) {
        const lang::Block &block = ast.blocks[id];
        for (const lang::Stmt &stmt : block.stmts) {
            if (!holds(stmt.span)) continue;
            steps.push_back({&block, &stmt, nullptr, {}});
            into(inside(stmt));
            return true;
        }
        return false;
    }
    bool function(lang::FunctionId id) {
        const lang::Function &function = ast.functions[id];
        if (!holds(function.span)) return false;
        steps.push_back({nullptr, nullptr, &function, {}});
        for (const lang::Parameter &parameter : function.parameters)
            if (parameter.default_value && expr(*parameter.default_value)) return true;
        block(function.body);
        return true;
    }
    bool expr(lang::ExprId id) {
        if (!holds(ast.exprs[id].span)) return false;
        steps.push_back({nullptr, nullptr, nullptr, id});
        into(inside(ast.exprs[id]));
        return true;
    }
    bool into(const Inside &in) {
        return std::ranges::any_of(in.exprs, [&](lang::ExprId id) { return expr(id); }) ||
               std::ranges::any_of(in.blocks, [&](lang::BlockId id) { return block(id); }) ||
               std::ranges::any_of(in.functions, [&](lang::FunctionId id) { return function(id); });
    }
};

} // namespace

std::vector<Step> path_to(const lang::Ast &ast, std::uint32_t begin, std::uint32_t end) {
    Descent descent{ast, begin, end, {}};
    descent.block(ast.root);
    return std::move(descent.steps);
}

std::optional<OpenCall> call_around(const Syntax &syntax, std::size_t offset) {
    const std::vector<lang::Token> &tokens = syntax.words.tokens;
    const auto text = [&](const lang::Token &token) {
        return syntax.text().substr(token.begin, token.end - token.begin);
    };
    // Brackets that are open at the byte, innermost last, each with where its arguments begin.
    struct Open {
        std::size_t token;
        std::vector<std::size_t> begins;
    };
    std::vector<Open> open;
    for (std::size_t i = 0; i < tokens.size() && tokens[i].begin < offset; ++i) {
        const std::string_view sign = text(tokens[i]);
        if (sign == "(" || sign == "[" || sign == "{")
            open.push_back({i, {i + 1}});
        else if (sign == ")" || sign == "]" || sign == "}") {
            if (!open.empty()) open.pop_back();
        } else if (sign == "," && !open.empty())
            open.back().begins.push_back(i + 1);
    }
    while (!open.empty() && text(tokens[open.back().token]) == "[") open.pop_back();
    if (open.empty() || text(tokens[open.back().token]) != "(") return std::nullopt;
    const Open &last = open.back();
    if (last.token == 0 || tokens[last.token - 1].kind != Tok::Name) return std::nullopt;
    if (last.token > 1 && tokens[last.token - 2].kind == Tok::Fn) return std::nullopt;
    OpenCall call;
    const lang::Token &name = tokens[last.token - 1];
    call.name = text(name);
    call.name_begin = name.begin;
    call.method = last.token > 1 && tokens[last.token - 2].kind == Tok::Dot;
    call.argument = last.begins.size() - 1;
    for (std::size_t begin : last.begins) {
        if (begin + 1 >= tokens.size() || tokens[begin].kind != Tok::Name ||
            tokens[begin + 1].kind != Tok::Colon)
            continue;
        call.named.emplace_back(text(tokens[begin]));
        if (begin == last.begins.back() && tokens[begin].end < offset)
            call.argument_name = call.named.back();
    }
    return call;
}

namespace {

bool in_name(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '_' ||
           static_cast<unsigned char>(c) >= 0x80;
}

} // namespace

Word word_at(std::string_view text, std::size_t offset) {
    Word word{std::min(offset, text.size()), std::min(offset, text.size())};
    while (word.begin > 0 && in_name(text[word.begin - 1])) --word.begin;
    while (word.end < text.size() && in_name(text[word.end])) ++word.end;
    word.method = word.begin > 0 && text[word.begin - 1] == '.';
    return word;
}

bool in_comment_or_string(const Syntax &syntax, std::size_t offset) {
    for (const lang::Comment &comment : syntax.words.comments)
        if (comment.begin < offset && offset < comment.end + (comment.is_line ? 1u : 0u))
            return true;
    for (const lang::Token &token : syntax.words.tokens)
        if (token.kind == Tok::String && token.begin < offset && offset < token.end) return true;
    return false;
}

} // namespace fathom::language
