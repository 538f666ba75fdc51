// The tree, built from below while the grammar reads: each method is what one rule of the grammar
// means, and bears its name. Reports what only the tree shows. Knows no PEGTL.
#pragma once

#include "lang/ast.h"
#include "lang/token.h"

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

// Names that other languages have for what is spelled otherwise here: `True`, `None`; `math`.
bool is_type_word(std::string_view word); // of any language
bool is_foreign_value(std::string_view name);
bool is_foreign_module(std::string_view name);

// A string with values in it, as `f"r = {r}"` and `${r}` of JavaScript, as a sum; empty where it
// holds none, or what is not plain. `opening` is what stands before a value.
std::string joined_string(std::string_view quoted, std::string_view opening);

// A text as it can stand in a message: of one line and not long, else `…`; and in backticks.
std::string brief(std::string_view text);
std::string in_code(std::string_view text);

template <std::size_t N>
bool is_one_of(std::string_view word, const std::array<std::string_view, N> &words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

inline constexpr std::string_view changes_nothing =
    "a function changes none of its arguments: it returns what is new, several numbers as a "
    "vector, "
    "`fn f(p: vec3) = vec2(d, id)`, whose parts are `f(p).x` and `f(p).y`";

// Half of a value that stands in a text; a shape of OpenSCAD that has two dimensions.
std::string half_of(std::string_view value);
bool is_flat_shape(std::string_view name);

// Thrown by Builder::fail, caught around each statement: reading goes on behind it. Never leaves
// parse().
struct Abandon {};

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

// Removes the last element and returns it.
template <class T> T take_back(std::vector<T> &stack) {
    assert(!stack.empty());
    T top = std::move(stack.back());
    stack.pop_back();
    return top;
}

// Builds one Ast from the actions of the grammar.
class Builder {
  public:
    using Index = std::uint32_t; // of a token

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
    bool ends_statement(Index at) const;
    Index junk(const Mark &mark, Index first, Index at);
    bool foreign_statement(Index first); // true: reported, and to be abandoned
    Index abandon(const Mark &mark, Index first);

    // Types.
    void type_name(Index at);
    void type_number(Index at);
    void type_bound_end(Index at);
    void type_list(Index first, Index last);
    void type_function_open() { type_marks_.push_back(types_.size()); }
    void type_function(Index first, Index last);
    void some_type();
    void no_type() { maybe_types_.emplace_back(); }

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
    bool is_declared(const std::string &name);
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
    struct Statement {
        Stmt stmt;
        std::uint32_t height;
    };

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
    Span span(const Item &item) const { return {id_, item.begin, item.end}; }
    Identifier identifier(Index at) { return {std::string(text(at)), span(at), word(text(at))}; }
    std::uint32_t word(std::string_view text); // of a part of the source

    Diagnostic &foreign(Span where, std::string message) {
        return diagnostics_.add(Code::ForeignSyntax, where, std::move(message));
    }

    ExprId add(ExprKind kind, Span span, std::uint32_t height);
    void push(ExprKind kind, Span span, std::uint32_t height);
    Item pop_item();
    std::optional<Item> pop_maybe_item();
    Identifier pop_name();
    std::optional<TypeExpr> pop_maybe_type();
    BlockId pop_block();
    FunctionId pop_function(std::optional<Identifier> name, std::optional<TypeExpr> result,
                            Span whole);
    std::uint32_t height(ExprId id) const { return expr_heights_[id.index]; }
    std::uint32_t height(BlockId id) const { return block_heights_[id.index]; }
    void reduce_above(int precedence);
    void reduce_top();
    void report_chain(const Op &first, Index second);
    BlockId value_block(const Item &item);
    BlockId add_block(std::size_t first_stmt, Span span);
    void add_stmt(StmtKind kind, Span span, std::uint32_t height);
    std::string doc_above(Index at) const;
    bool is_target(ExprId id) const;
    bool names_function(ExprId id);
    Index statement_end(Index first) const;
    void drop(const Mark &mark);
    bool has_body(Index name) const;
    void replace_bad_statement(Index first);

    // Answers made for the forms of other languages (foreign.cpp); true where they reported.
    bool foreign_failure(Wanted wanted, Index at); // by rule (foreign_failures.cpp)
    bool foreign_operand(Wanted wanted, Index at);
    bool foreign_list(Index at);
    bool foreign_group(Index at, bool list);
    bool is_body_of_lambda(Index open, Index at) const;
    bool foreign_binding(Index at);
    bool foreign_name(Index at);
    std::vector<Edit> names_of_let(Index let);
    bool foreign_count(Index at);
    bool foreign_in(Index at);
    void changed_parameter(Index word, Index type);
    void note_changed(Index open, Diagnostic &d) const;
    bool foreign_function_body(Index at);
    bool foreign_instead(Index at, std::string message, const std::string &replacement);
    bool foreign_loop(Index at);
    bool foreign_head(Index first);
    Edit without_statement(Index first) const;
    void foreign_param(Index first, Index name);
    bool foreign_stream(Index first, Index name);
    void foreign_unbound(Index first, Index name, std::string_view type);
    bool range_of_param(Index comma);
    void foreign_name_parts(Index left, Index right);
    bool is_used_after(Index name) const;
    bool arguments_by_space(Index first);
    void foreign_curried(Index first, Index name, Index past);
    std::string shape_of_field(Index name) const;
    bool names_vector(std::string_view name) const;
    void foreign_function(Index first, Index name, bool has_type);
    bool is_assigned_after(Index name) const;
    bool foreign_body(Index at);
    bool goes_on_with_else(Index end) const;
    bool colon_range(Index at);
    void foreign_then(Index at);
    bool foreign_lambda(Index at);
    bool separated_unit(Index at);
    std::string parameters_text(Index open) const;
    bool foreign_junk(Index first, Index at);
    bool junk_by_sign(Index first, Index at);
    bool remark(Index first, Index at);
    bool where_clause(Index first, Index at);
    void destructuring(Index first, Index from, Index past, Index assign);
    bool shape_behind_call(Index first, Index at);
    Index body_below(Index at) const;
    bool foreign_import(Index at);
    bool foreign_slice(Index at);
    // Transforms of OpenSCAD (foreign_transforms.cpp).
    std::string value_text(Index from, Index to) const;
    std::string degrees_text(Index from, Index to) const;
    std::string transform_text(Index name, bool flat) const;
    std::string cut_of_revolution(Index name) const;
    std::string_view lost_of_transform(Index name) const;
    // Solids of OpenSCAD (foreign_solids.cpp).
    struct Solid {
        std::string text;            // as it is written here
        std::string_view told, lost; // how theirs differs, and what ours has not
        bool is_centered = false;
    };
    Solid solid_of(Index name, bool certain) const;
    bool of_openscad(Index first);
    bool is_openscad() const;
    bool foreign_solid(Index first);
    struct ModuleBody {
        bool takes_shapes = false, has_many = false;
    };
    ModuleBody module_body(Index open) const;
    void module_head(Index first, Index after, std::string &head) const;
    bool foreign_minkowski(Index first);
    bool foreign_modifier(Index at);
    void forget_arguments(Index open) const;
    std::string lisp_value(Index &at) const;
    std::string lisp_part(Index at, Index end) const;
    std::string lisp_form(Index open) const;
    std::string lisp_thread(Index open) const;
    std::string lisp_function(Index open) const;
    bool lisp_arrow(Index at);
    bool lisp_binding(Index open);
    bool lisp_call(Index at);
    bool lisp_let(Index open);
    bool asks_for_type(Index at);
    bool list_spread(Index at);
    bool counted_block(Index first, Index at);
    bool range_in_parentheses(Index at);
    bool foreign_for_words(Index at);
    bool python_import(Index first);
    bool of_other_program(Index first);
    bool joined_by_space(Index at, bool list);
    bool call_of_row(Index open);
    bool pipe_edits(Index sign, std::vector<Edit> &edits) const;
    std::string nested_loops(Index open, Index at) const;
    std::string scad_heads(Index name, Index close) const;
    bool nothing_compared(Index at);
    bool applied_without_dot(Index at);
    void enumeration(Index first);
    std::vector<Edit> further_names(Index first, Index from);

    // Calls by a space (foreign_spaced.cpp); `apart` becomes true where there is one.
    std::string spaced_row(Index first, Index past, bool &apart) const;
    std::string spaced_atom(Index &at, Index past, bool &apart) const;
    std::string spaced_call(Index &at, Index past, bool &apart) const;
    std::string spaced_value(Index first, Index past, bool &apart) const;
    bool foreign_parameter(Index at);
    bool sentence(Index first, Index past);
    bool word_of_sentence(Index at);
    bool parted_by_semicolon(Index at, Index open);
    bool spaced_statement(Index at);
    bool holds_comma(Index open) const;

    // Whether all words may be looked at for one report: not where there are many reports.
    bool may_look_far() const {
        constexpr std::size_t most_reports = 100;
        return diagnostics_.items().size() < most_reports;
    }
    bool bars_of_amount(Index at);
    bool keyword_as_name(Index at);
    bool tried_block(Index first);
    bool loop_of_tuple(Index open, Diagnostic &d);
    bool head_of_loop(Index at);
    std::string loop_of_parts(Index open, std::string list, std::string &lets) const;
    std::unordered_set<Index> renamed_; // keywords that an edit makes names of

    // Records of theirs (foreign_records.cpp).
    bool foreign_struct(Index first);
    bool named_record(Index brace);
    bool called_record(Index made);
    bool parameters_in_braces(Index brace);

    // Operators of theirs, and what is missing beside one (foreign_operators.cpp).
    bool touch(Index first, Index second) const; // with nothing between
    bool foreign_word_operator(Index at);
    bool foreign_comparison(Index at);
    bool foreign_scope(Index colon);
    bool foreign_percent(Index at);
    bool is_amount_of_vector(Index bar) const;
    bool set_of_points(Index brace);
    bool missing_operand(Index at);
    bool runs_on(Index name, std::uint32_t end);
    bool wanted_at_start(Index at) const;
    bool foreign_product(Index at);
    bool juxtaposed_arguments(Index at);

    // Statements of theirs, each of its own kind (foreign_statements.cpp).
    bool mistyped_keyword(Index first);
    bool setting_assigned(std::string_view name, Span target, Span value);
    bool print_stream(Index first);
    bool block_until_end(Index at);
    void loop_over_pairs(Index at);
    bool label_of_param(Index at);
    bool words_of_range(Index first, Index at);

    // Words and blocks of theirs (foreign_words.cpp).
    void declare_poison(Index name);
    void withdraw_quotes(Index first);
    bool may_be_declared(std::string_view name);
    bool indented_body(Index colon, std::vector<Edit> &edits);
    void foreign_colon(Index at);
    void foreign_choice(Index start, Index at);
    Index value_start(Index first, Index at) const;
    void foreign_pipe(Index at);
    bool foreign_concat(Index at);
    bool foreign_record(Index brace);
    bool curv_slider(Index first);
    bool curv_block(Index first);
    std::string slider_text(Index name, Index &value) const;
    bool juxtaposed_calls(Index first, Index at);
    void settle_foreign_names();

    // Answers to all else (failures.cpp).
    bool already_reported(Wanted wanted, Index at) const;
    void generic_failure(Wanted wanted, Index at);
    std::vector<Edit> call_of_list(Index open) const;
    Index enclosing(Index at) const;
    std::string describe(Index at) const;

    const Source &source_;
    SourceId id_;
    const Tokens &tokens_;
    const Token past_;
    Diagnostics &diagnostics_;
    Ast ast_;
    std::unordered_map<std::string_view, std::uint32_t> words_; // into ast_.words

    std::vector<Item> items_;
    std::vector<Op> ops_;
    std::vector<Frame> frames_;
    std::vector<std::optional<Identifier>> names_;
    std::vector<TypeExpr> types_;
    std::vector<std::optional<TypeExpr>> maybe_types_;
    std::vector<std::size_t> type_marks_;
    std::vector<Argument> arguments_;
    std::vector<std::size_t> argument_marks_;
    std::vector<Parameter> parameters_;
    std::vector<std::optional<Item>> maybe_items_;
    std::vector<Head> heads_;
    std::vector<IfBranch> branches_;
    std::vector<std::size_t> branch_marks_;
    std::vector<Statement> stmts_;
    std::vector<std::size_t> stmt_marks_;
    std::vector<BlockId> blocks_;
    std::vector<Index> remembered_;
    std::vector<std::uint32_t> expr_heights_, block_heights_;
    std::size_t depth_ = 0;
    bool in_function_ = false;
    bool body_missing_ = false;         // of an `if` that was just abandoned: an `else` may follow
    bool expression_body_ = false;      // of the function whose body was just read
    std::uint32_t last_too_tall_ = ~0u; // where the chain began that was reported
    std::vector<Span> loose_breaks_;    // of `break`s, those that no loop that was read holds
    std::vector<Index> lost_;           // names that it would have declared, beside its first
    Index let_until_ = 0;               // the `in` of a Curv `let` whose names were told
    std::uint32_t bound_at_ = ~0u;      // where the last new name without a `let` stands
    Index failed_ = 0;                  // where the statement that is being abandoned broke

    // Names that other languages have, to be reported unless the file declares them.
    struct ForeignName {
        ExprId expr; // the name, or the member that it qualifies
        Span span;
    };
    std::vector<ForeignName> foreign_names_;
    std::vector<std::string_view> declared_;
    std::unordered_set<std::string_view> known_names_; // the first known_ of them
    std::size_t known_ = 0;
    std::optional<std::unordered_set<std::string_view>>
        all_declared_; // made when it is first needed
    bool has_import_ = false;
};

} // namespace fathom::lang
