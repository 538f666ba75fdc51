// Building the tree: statements and blocks, and what becomes of a statement that cannot be read.
#include "lang/builder.h"

#include "lang/lexer.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace fathom::lang {

// -- blocks --------------------------------------------------------------------------------------

void Builder::add_stmt(StmtKind kind, Span span, std::uint32_t height) {
    stmts_.push_back({std::move(kind), span});
    stmt_heights_.push_back(height);
}

BlockId Builder::add_block(std::size_t first_stmt, Span span) {
    Block block;
    block.span = span;
    std::uint32_t tallest = 0;
    for (std::size_t i = first_stmt; i < stmts_.size(); ++i)
        tallest = std::max(tallest, stmt_heights_[i]);
    stmt_heights_.resize(first_stmt);
    const auto first = stmts_.begin() + static_cast<std::ptrdiff_t>(first_stmt);
    const auto inner = std::make_move_iterator(first),
               outer = std::make_move_iterator(stmts_.begin());
    constexpr std::size_t many = 1000; // of which there is no room for a copy
    if (stmts_.size() > many && first_stmt < stmts_.size() / 2) {
        std::vector<Stmt> around(outer, inner);
        stmts_.erase(stmts_.begin(), first);
        block.stmts = std::exchange(stmts_, std::move(around));
    } else {
        block.stmts.assign(inner, std::make_move_iterator(stmts_.end()));
        stmts_.erase(first, stmts_.end());
    }
    block_heights_.push_back(1 + tallest);
    return ast_.blocks.add(std::move(block));
}

BlockId Builder::value_block(const Item &item) {
    const std::size_t mark = stmts_.size();
    add_stmt(ExprStmt{item.id}, span(item), height(item.id));
    return add_block(mark, span(item));
}

void Builder::block_close(Index first, Index last) {
    blocks_.push_back(add_block(take_back(stmt_marks_), span(first, last)));
}

// -- statements ----------------------------------------------------------------------------------

// The `///` lines directly above the line of a token, without slashes.
std::string_view Builder::doc_above(Index at) {
    const std::string_view all = source_.text;
    const auto line_start = [&](std::size_t offset) {
        const std::size_t end = offset == 0 ? std::string_view::npos : all.rfind('\n', offset - 1);
        return end == std::string_view::npos ? 0 : end + 1;
    };
    // what begins with what a formatted text leaves away still begins its line
    const auto nothing_in = [&](std::size_t first, std::size_t end) {
        if (first == 0 && all.starts_with("\xEF\xBB\xBF")) first = std::min<std::size_t>(3, end);
        const std::string_view left = all.substr(first, end - first);
        return first + std::min(left.find_first_not_of(" \t\r\f\v;"), left.size());
    };
    // not from the line's start on: a line may be long, and hold many declarations
    std::size_t begin = token(at).begin;
    while (begin > 0 &&
           std::string_view(" \t\r\f\v;").find(all[begin - 1]) != std::string_view::npos)
        --begin;
    if (begin == 3 && all.starts_with("\xEF\xBB\xBF")) begin = 0;
    if (begin > 0 && all[begin - 1] != '\n') return {};
    std::vector<std::string_view> lines;
    while (begin > 0) {
        const std::size_t above = line_start(begin - 1);
        std::string_view line = all.substr(above, begin - 1 - above);
        line.remove_prefix(nothing_in(above, begin - 1) - above);
        if (!line.starts_with("///") || line.starts_with("////")) break;
        line.remove_prefix(line.starts_with("/// ") ? 4 : 3);
        lines.push_back(without_end(line));
        begin = above;
    }
    std::string doc;
    for (auto line = lines.rbegin(); line != lines.rend(); ++line) {
        if (line != lines.rbegin()) doc += '\n';
        doc += *line;
    }
    return doc.empty() ? std::string_view() : ast_.others.add(std::move(doc));
}

void Builder::let(Index first, Index) {
    Item value = pop_item();
    if (runs_on(first + 1, value.end)) value.id = add(Poison{}, span(value), 1);
    if (!in_function_ && std::holds_alternative<Binary>(ast_.exprs[value.id].kind) &&
        formula_bound(first, value.end))
        value.id = add(Poison{}, span(value), 1);
    const TypeExpr *type = pop_maybe_type();
    add_stmt(Let{pop_name(), type, value.id, doc_above(first)},
             {id_, token(first).begin, value.end}, height(value.id));
}

void Builder::var(Index first, Index) {
    const Item value = pop_item();
    const TypeExpr *type = pop_maybe_type();
    add_stmt(Var{pop_name(), type, value.id}, {id_, token(first).begin, value.end},
             height(value.id));
}

void Builder::function(Index first, Index last) {
    shallower();
    const TypeExpr *result = pop_maybe_type();
    const std::uint32_t body_height = height(blocks_.back());
    const FunctionId function = pop_function(pop_name(), result, span(first, last));
    ast_.functions[function].doc = doc_above(first);
    add_stmt(FunctionDecl{function}, span(first, last), 1 + body_height);
}

void Builder::param_label(Index at) {
    names_.emplace_back(Identifier{ast_.others.add(read_string(text(at))), span(at)});
}

void Builder::param(Index first, Index last) {
    Param param;
    if (const std::optional<Identifier> label = take_back(names_)) param.label = label->text;
    const std::optional<Item> range = pop_maybe_item();
    const Item value = pop_item();
    param.type = pop_maybe_type();
    param.name = pop_name();
    param.value = value.id;
    std::uint32_t tallest = height(value.id);
    if (range) {
        const Expr &expr = ast_.exprs[range->id];
        if (const Range *ends = std::get_if<Range>(&expr.kind)) {
            param.low = ends->first;
            param.high = ends->last;
            tallest = std::max(tallest, height(range->id));
        } else if (const List *list = std::get_if<List>(&expr.kind);
                   list && list->items.size() == 2) { // `[0, 2]`
            param.low = list->items[0];
            param.high = list->items[1];
            tallest = std::max(tallest, height(range->id));
            const auto written = [&](ExprId id) {
                return std::string(text(ast_.exprs[id].span.begin, ast_.exprs[id].span.end));
            };
            const std::string ends = written(*param.low) + ".." + written(*param.high);
            if (!std::holds_alternative<String>(ast_.exprs[*param.low].kind)) // told by its type
                foreign(span(*range), "a parameter's range is written `low..high`")
                    .help(to_write(ends), {{span(*range), ends}});
        } else if (!std::holds_alternative<Poison>(expr.kind)) {
            diagnostics_
                .add(Code::SyntaxError, span(*range), "a parameter's range is written `low..high`")
                .note("both ends are included");
        }
    }
    add_stmt(std::move(param), span(first, last), tallest);
}

void Builder::import(Index first, Index last) {
    Import import;
    import.as = take_back(names_);
    import.path = ast_.others.add(read_string(text(first + 1)));
    import.path_span = span(first + 1);
    add_stmt(std::move(import), span(first, last), 1);
}

void Builder::for_loop(Index first, Index last) {
    shallower();
    const BlockId body = pop_block();
    const Item sequence = pop_item();
    add_stmt(For{pop_name(), sequence.id, body}, span(first, last),
             1 + std::max(height(sequence.id), height(body)));
    catch_breaks(first);
}

void Builder::while_loop(Index first, Index last) {
    shallower();
    const BlockId body = pop_block();
    const std::optional<Item> limit = pop_maybe_item();
    const Item condition = pop_item();
    While loop{condition.id, {}, body};
    std::uint32_t tallest = std::max(height(condition.id), height(body));
    if (limit) {
        loop.limit = limit->id;
        tallest = std::max(tallest, height(limit->id));
    }
    add_stmt(loop, span(first, last), 1 + tallest);
    catch_breaks(first);
}

void Builder::break_loop(Index at) {
    add_stmt(Break{}, span(at), 1);
    loose_breaks_.push_back(span(at));
}

// Those in the loop that begins at `first` leave it.
void Builder::catch_breaks(Index first) {
    std::erase_if(loose_breaks_, [&](const Span &s) { return s.begin >= token(first).begin; });
}

void Builder::return_value(Index first, Index last) {
    const std::optional<Item> value = pop_maybe_item();
    Return statement;
    if (value) statement.value = value->id;
    add_stmt(statement, span(first, last), value ? height(value->id) : 1);
}

void Builder::plain_value() {
    const Item item = pop_item();
    if (!in_function_ && std::holds_alternative<Binary>(ast_.exprs[item.id].kind) &&
        equation(span(item))) {
        add_stmt(Bad{}, span(item), 1);
        return;
    }
    add_stmt(ExprStmt{item.id}, span(item), height(item.id));
}

// A name, or members and indices of one.
bool Builder::is_target(ExprId id) const {
    for (;;) {
        const ExprKind &kind = ast_.exprs[id].kind;
        if (const Member *member = std::get_if<Member>(&kind))
            id = member->object;
        else if (const lang::Index *index = std::get_if<lang::Index>(&kind))
            id = index->object;
        else
            return std::holds_alternative<Name>(kind) || std::holds_alternative<Poison>(kind);
    }
}

// A call of a name that is not declared, whose arguments are names: `f(x)`.
bool Builder::names_function(ExprId id) {
    const lang::Call *head = std::get_if<lang::Call>(&ast_.exprs[id].kind);
    if (!head || head->trailing || head->arguments.empty()) return false;
    const lang::Name *called = std::get_if<lang::Name>(&ast_.exprs[head->callee].kind);
    return called && !is_declared(called->text) &&
           std::ranges::all_of(head->arguments, [&](const Argument &a) {
               return !a.name && std::holds_alternative<lang::Name>(ast_.exprs[a.value].kind);
           });
}

void Builder::assignment() {
    const Index at = take_back(remembered_);
    const Item value = pop_item();
    const Item target = pop_item();
    const Span whole{id_, target.begin, value.end};
    const std::uint32_t tall = std::max(height(target.id), height(value.id));
    const Name *name = std::get_if<Name>(&ast_.exprs[target.id].kind);
    if (!in_function_ && kind(at) == Tok::Assign && !names_function(target.id) && equation(whole)) {
        add_stmt(Bad{}, whole, 1);
        return;
    }
    if (!in_function_ && name && kind(at) == Tok::Assign && !is_declared(name->text)) {
        if (setting_assigned(name->text, span(target), span(value))) {
            add_stmt(Bad{}, whole, 1);
            return;
        }
        if (at >= let_until_) // else told at the `let` that is for all of them
            foreign(span(target), "a new name is bound with `let`")
                .help("write `let " + std::string(name->text) + " = …`",
                      {{{id_, target.begin, target.begin}, "let "}});
        bound_at_ = target.begin;
        Identifier bound{name->text, span(target), name->word};
        declared_.push_back(text(target.begin, target.end));
        add_stmt(Let{std::move(bound), {}, value.id, {}}, whole, tall);
        return;
    }
    if (kind(at) == Tok::Assign && names_function(target.id)) { // `f(x) = …`
        foreign(span(target), "a function is declared with `fn`")
            .help(to_write("fn " + std::string(text(target.begin, target.end)) + " = …"),
                  {{{id_, target.begin, target.begin}, "fn "}});
        const lang::Call &head = std::get<lang::Call>(ast_.exprs[target.id].kind);
        const lang::Name &called = std::get<lang::Name>(ast_.exprs[head.callee].kind);
        Identifier bound{called.text, ast_.exprs[head.callee].span, called.word};
        declared_.push_back(text(bound.span.begin, bound.span.end));
        add_stmt(Let{std::move(bound), {}, add(Poison{}, whole, 1), {}}, whole, 1);
        return;
    }
    if (!is_target(target.id)) {
        Diagnostic &d =
            diagnostics_.add(Code::NotAssignable, span(target), "this cannot be assigned to");
        d.note("a target is a `var`, or a component of one");
        if (std::holds_alternative<Member>(ast_.exprs[target.id].kind))
            d.help("nothing that is made changes: give the call other arguments");
        else if (std::holds_alternative<List>(ast_.exprs[target.id].kind))
            d.help("each name is bound by a `let` of its own: `let a2 = b; let b2 = a`");
        else if (kind(at) == Tok::Assign)
            d.help("a comparison is written `==`", {{span(at), "=="}});
        add_stmt(Bad{}, whole, 1);
        return;
    }
    std::optional<BinaryOp> op;
    if (kind(at) == Tok::PlusAssign) op = BinaryOp::Add;
    if (kind(at) == Tok::MinusAssign) op = BinaryOp::Sub;
    if (kind(at) == Tok::StarAssign) op = BinaryOp::Mul;
    if (kind(at) == Tok::SlashAssign) op = BinaryOp::Div;
    add_stmt(Assign{target.id, op, value.id}, whole, tall);
}

// -- statements that cannot be read --------------------------------------------------------------

Builder::Mark Builder::mark() const {
    return {items_.size(),
            ops_.size(),
            frames_.size(),
            names_.size(),
            types_.size(),
            maybe_types_.size(),
            type_marks_.size(),
            arguments_.size(),
            argument_marks_.size(),
            parameters_.size(),
            maybe_items_.size(),
            heads_.size(),
            branches_.size(),
            branch_marks_.size(),
            stmts_.size(),
            stmt_marks_.size(),
            blocks_.size(),
            remembered_.size(),
            depth_,
            in_function_};
}

void Builder::drop(const Mark &mark) {
    const auto cut = [](auto &stack, std::size_t size) {
        stack.erase(stack.begin() + static_cast<std::ptrdiff_t>(size), stack.end());
    };
    cut(items_, mark.items);
    cut(ops_, mark.ops);
    cut(frames_, mark.frames);
    cut(names_, mark.names);
    cut(types_, mark.types);
    cut(maybe_types_, mark.maybe_types);
    cut(type_marks_, mark.type_marks);
    cut(arguments_, mark.arguments);
    cut(argument_marks_, mark.argument_marks);
    cut(parameters_, mark.parameters);
    cut(maybe_items_, mark.maybe_items);
    cut(heads_, mark.heads);
    cut(branches_, mark.branches);
    cut(branch_marks_, mark.branch_marks);
    cut(stmts_, mark.stmts);
    cut(stmt_heights_, mark.stmts);
    cut(stmt_marks_, mark.stmt_marks);
    cut(blocks_, mark.blocks);
    cut(remembered_, mark.remembered);
    depth_ = mark.depth;
    in_function_ = mark.in_function;
}

// A statement that is not in the tree still declares the name, so that its uses are no new errors.
void Builder::declare_poison(Index name) {
    declared_.push_back(text(name));
    add_stmt(Let{identifier(name), {}, add(Poison{}, span(name), 1), {}}, span(name), 1);
}

// What stands for the statement in the tree. Its name stays declared, so that its uses are no new
// errors.
// Whether what stands behind the parentheses after a name makes it a declaration.
bool Builder::has_body(Index name) const {
    Index body = match(name + 1) + 1;
    if (kind(body) == Tok::End && text(body) != ";") ++body; // perhaps on the line below
    return text(name - 1) != "with" &&
           is_one_of(kind(body), {Tok::Body, Tok::Trailing, Tok::StrayBrace, Tok::Colon,
                                  Tok::Assign, Tok::Arrow});
}

void Builder::replace_bad_statement(Index first) {
    const std::vector<Index> lost = std::exchange(lost_, {});
    for (const Index name : lost) declare_poison(name);
    const Index end = statement_end(first);
    const Span whole = span(first, end > first ? end - 1 : first);
    Index name = first;
    if (is_one_of(kind(first), {Tok::Let, Tok::Var, Tok::Fn, Tok::Param})) name = first + 1;
    if (kind(first) == Tok::Name) // `x = …`, `const float x = …`, `def f(…)`
        while (kind(name + 1) == Tok::Name) ++name;
    const Tok behind = kind(name + 1);
    const bool declares = kind(first) != Tok::Name || behind == Tok::Assign ||
                          (name > first && behind == Tok::Open && has_body(name) &&
                           text(name - 1) != "default"); // JavaScript's export
    const bool head = kind(first) == Tok::Name && name == first && behind == Tok::Open &&
                      kind(match(name + 1) + 1) == Tok::Assign; // `f(x) = …`
    if (head && !is_declared(std::string(text(name)))) {
        declare_poison(name);
        return;
    }
    const auto is_lost = [&](Index i) { return text(i) == text(name); };
    if (std::ranges::any_of(lost, is_lost)) {
        add_stmt(Bad{}, whole, 1);
        return;
    }
    if (kind(first) == Tok::Name && name == first && declares && kind(name) == Tok::Name &&
        (bound_at_ == token(first).begin || !is_declared(std::string(text(name))))) {
        declare_poison(name);
        return;
    }
    if (name == first || kind(name) != Tok::Name || !declares) {
        add_stmt(Bad{}, whole, 1);
        return;
    }
    declared_.push_back(text(name));
    add_stmt(Let{identifier(name), {}, add(Poison{}, span(name), 1), {}}, whole, 1);
}

Builder::Index Builder::abandon(const Mark &mark, Index first) {
    drop(mark);
    replace_bad_statement(first);
    return statement_end(first);
}

Builder::Index Builder::junk(const Mark &mark, Index first, Index at) {
    failed_ = at;
    if (!already_reported(Wanted::StatementEnd, at) && !foreign_junk(first, at))
        generic_failure(Wanted::StatementEnd, at);
    return abandon(mark, first);
}

Ast Builder::finish() {
    settle_foreign_names();
    for (const Span &place : loose_breaks_)
        diagnostics_.add(Code::WrongPlace, place, "`break` stands in a loop")
            .help("leave it away, or end a function by `return`");
    const auto size = static_cast<std::uint32_t>(source_.text.size());
    ast_.root = add_block(0, {id_, 0, size});
    return std::move(ast_);
}

} // namespace fathom::lang
