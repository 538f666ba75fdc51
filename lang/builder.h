// The tree, built from below while the grammar reads: each method is what one rule of the grammar
// means, and bears its name. Reports what only the tree shows. Knows no PEGTL.
#pragma once

#include "lang/foreign/foreign.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace fathom::lang {

// Thrown by Builder::fail, caught around each statement: reading goes on behind it. Never leaves
// parse().
struct Abandon {};

// Removes the last element and returns it.
template <class T> T take_back(std::vector<T> &stack) {
    assert(!stack.empty());
    T top = std::move(stack.back());
    stack.pop_back();
    return top;
}

// Builds one Ast from the actions of the grammar.
class Builder : ForeignSyntax {
  public:
    using ForeignSyntax::foreign_statement;
    using TokenReading::ends_statement, TokenReading::Index;

    Builder(const Source &source, SourceId id, const Tokens &tokens, Diagnostics &diagnostics);
    Ast finish();

    // Reports and abandons the statement.
    [[noreturn]] void fail(Wanted wanted, Index at);
    void deeper(Index at); // the depth of the grammar's own recursion
    void shallower() { --depth_; }

    // Statements end at a line end, at a `}`, or with the file. Where one does not, or was
    // abandoned, what it left on the stacks is dropped; the result is the token to go on at.
    struct Mark {
        std::size_t items, ops, frames, names, types, maybe_types, type_marks, arguments,
            argument_marks;
        std::size_t parameters, maybe_items, heads, branches, branch_marks, stmts, stmt_marks,
            blocks, remembered;
        std::size_t depth;
        bool in_function;
    };
    Mark mark() const;
    Index junk(const Mark &mark, Index first, Index at);
    Index abandon(const Mark &mark, Index first);

    // Types.
    void type_name(Index at);
    void type_number(Index at);
    void type_bound_end(Index at);
    void type_list(Index first, Index last);
    void type_function_open() { type_marks_.push_back(types_.size()); }
    void type_function(Index first, Index last);
    void some_type();
    void no_type() { maybe_types_.push_back(nullptr); }

    // Operands.
    void number(Index at);
    void string(Index at);
    void color(Index at);
    void yes(Index at);
    void no(Index at);
    void name(Index at);
    void poison(Index at);
    void parenthesized(Index first, Index last);
    void list_open() { frames_.push_back({items_.size(), ops_.size()}); }
    void comprehension();
    void list(Index first, Index last);

    // Functions. A head begins at `fn`, or at a lambda's parameters.
    void declared_name(Index at);
    void some_value(); // an operand that may be left away
    void no_value() { maybe_items_.emplace_back(); }
    void parameter();
    void function_open(Index at);
    void declaration_open(Index at);
    void lambda_name(Index at);
    void function_head(Index next);
    void block_body() { expression_body_ = false; }
    void value_body();
    void lambda(Index first, Index last);
    void function(Index first, Index last);

    void if_open() { branch_marks_.push_back(branches_.size()); }
    void if_branch();
    void otherwise();
    void choice(Index first, Index last);

    // Postfix forms, of the operand on top.
    void call_open() { argument_marks_.push_back(arguments_.size()); }
    void argument_name(Index at);
    void no_name() { names_.emplace_back(); }
    void argument();
    void call(Index first, Index last);
    void index(Index first, Index last);
    void member(Index at);
    void trailing(Index first, Index last);
    void step(Index at);

    // Rows of operands and operators.
    void expression_open(Index at);
    void row_end();
    void prefix(Index at);
    void binary(Index at);
    void remember(Index at) { remembered_.push_back(at); }
    void ternary();

    // Statements.
    void let(Index first, Index last);
    void var(Index first, Index last);
    void param_label(Index at);
    void param(Index first, Index last);
    void import(Index first, Index last);
    void for_loop(Index first, Index last);
    void while_loop(Index first, Index last);
    void break_loop(Index at);
    void catch_breaks(Index first);
    void return_value(Index first, Index last);
    void assignment();
    void plain_value();
    void block_open() { stmt_marks_.push_back(stmts_.size()); }
    void block_close(Index first, Index last);

  private:
    struct Item { // an operand with its extent, parentheses included
        ExprId id;
        std::uint32_t begin = 0, end = 0;
    };
    struct Op {
        bool is_prefix = false;
        UnaryOp unary{};
        BinaryOp binary{};
        bool is_range = false, inclusive = false;
        int precedence = 0;
        Index at = 0;
    };
    struct Frame {
        std::size_t items, ops;
    };
    struct Head {
        std::size_t parameters;
        Index first;
        bool outer_in_function;
        Span span;
    };

    using TokenReading::span;
    Span span(const Item &item) const { return {id_, item.begin, item.end}; }
    Identifier identifier(Index at) {
        const std::uint32_t name = word(text(at));
        return {ast_.words[name], span(at), name};
    }

    ExprId add(ExprKind kind, Span span, std::uint32_t height);
    void push(ExprKind kind, Span span, std::uint32_t height);
    Item pop_item();
    std::optional<Item> pop_maybe_item();
    Identifier pop_name();
    const TypeExpr *pop_maybe_type();
    BlockId pop_block();
    FunctionId pop_function(std::optional<Identifier> name, const TypeExpr *result, Span whole);
    std::uint32_t height(ExprId id) const { return expr_heights_[id.index]; }
    std::uint32_t height(BlockId id) const { return block_heights_[id.index]; }
    void reduce_above(int precedence);
    void reduce_top();
    void report_chain(const Op &first, Index second);
    BlockId value_block(const Item &item);
    BlockId add_block(std::size_t first_stmt, Span span);
    void declare_poison(Index name);
    void add_stmt(StmtKind kind, Span span, std::uint32_t height);
    std::string_view doc_above(Index at);
    bool is_target(ExprId id) const;
    bool names_function(ExprId id);
    void drop(const Mark &mark);
    bool has_body(Index name) const;
    void replace_bad_statement(Index first);

    // Answers to all else (failures.cpp).
    bool already_reported(Wanted wanted, Index at) const;
    void generic_failure(Wanted wanted, Index at);
    std::vector<Edit> call_of_list(Index open) const;
    std::string describe(Index at) const;

    std::vector<Item> items_;
    std::vector<Op> ops_;
    std::vector<Frame> frames_;
    std::vector<std::optional<Identifier>> names_;
    std::vector<TypeExpr> types_;
    std::vector<const TypeExpr *> maybe_types_;
    std::vector<std::size_t> type_marks_;
    std::vector<Argument> arguments_;
    std::vector<std::size_t> argument_marks_;
    std::vector<Parameter> parameters_;
    std::vector<std::optional<Item>> maybe_items_;
    std::vector<Head> heads_;
    std::vector<IfBranch> branches_;
    std::vector<std::size_t> branch_marks_;
    std::vector<Stmt> stmts_;
    std::vector<std::size_t> stmt_marks_;
    std::vector<BlockId> blocks_;
    std::vector<Index> remembered_;
    std::vector<std::uint32_t> expr_heights_, stmt_heights_, block_heights_;
    std::size_t depth_ = 0;
    bool expression_body_ = false;      // of the function whose body was just read
    std::uint32_t last_too_tall_ = ~0u; // where the chain began that was reported
    std::vector<Span> loose_breaks_;    // of `break`s, those that no loop that was read holds
    std::uint32_t bound_at_ = ~0u;      // where the last new name without a `let` stands
};

} // namespace fathom::lang
