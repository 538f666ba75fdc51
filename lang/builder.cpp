// Building the tree: operands, expressions and functions. Statements are in builder_statements.cpp.
#include "lang/builder.h"

#include "lang/lexer.h"

#include <algorithm>
#include <cassert>
#include <map>
#include <utility>

namespace fathom::lang {

namespace {

// Brackets, functions and types may nest so deep; the grammar's own recursion is bounded by it.
constexpr std::size_t deepest_nesting = 256;
// Levels of the tree, which all that walk it may descend: nesting with several operators to a
// level, and chains of calls.
constexpr std::uint32_t tallest_tree = 1024;

} // namespace

Builder::Builder(const Source &source, SourceId id, const Tokens &tokens, Diagnostics &diagnostics)
    : ForeignSyntax(source, id, tokens, diagnostics) {
    ast_.source = id;
    // An expression has a word of its own, so that no room is made twice. What is not used stays the system's.
    ast_.exprs.reserve(tokens.tokens.size());
    expr_heights_.reserve(tokens.tokens.size());
    stmt_marks_.push_back(0); // the file is a block
}

void Builder::deeper(Index at) {
    if (++depth_ <= deepest_nesting + 1) return; // a statement is no nesting
    diagnostics_.add(Code::TooDeep, span(at), "the text nests deeper than 256 levels here")
        .help("give the inner parts names with `let`");
    failed_ = at;
    throw Abandon{};
}

// -- stacks --------------------------------------------------------------------------------------

ExprId Builder::add(ExprKind kind, Span span, std::uint32_t height) {
    if (height > tallest_tree) {
        if (span.begin != last_too_tall_)
            diagnostics_
                .add(Code::TooDeep, {span.source, span.end, span.end},
                     "this expression is a chain or nest of more than 1000 parts")
                .help("give its parts names with `let`");
        last_too_tall_ = span.begin;
        kind = Poison{};
        height = 0;
    }
    expr_heights_.push_back(height);
    return ast_.exprs.add({std::move(kind), span, false});
}

void Builder::push(ExprKind kind, Span span, std::uint32_t height) {
    items_.push_back({add(std::move(kind), span, height), span.begin, span.end});
}

Builder::Item Builder::pop_item() { return take_back(items_); }
std::optional<Builder::Item> Builder::pop_maybe_item() { return take_back(maybe_items_); }
const TypeExpr *Builder::pop_maybe_type() { return take_back(maybe_types_); }
BlockId Builder::pop_block() { return take_back(blocks_); }

Identifier Builder::pop_name() { return *take_back(names_); }

void Builder::some_value() { maybe_items_.emplace_back(pop_item()); }

// -- types ---------------------------------------------------------------------------------------

static const std::map<std::string_view, TypeName> &table_of_types() {
    static const std::map<std::string_view, TypeName> names = {
        {"float", TypeName::Float},     {"int", TypeName::Int},
        {"bool", TypeName::Bool},       {"string", TypeName::String},
        {"vec2", TypeName::Vec2},       {"vec3", TypeName::Vec3},
        {"vec4", TypeName::Vec4},       {"mat2", TypeName::Mat2},
        {"mat3", TypeName::Mat3},       {"mat4", TypeName::Mat4},
        {"color", TypeName::Color},     {"shape", TypeName::Shape},
        {"shape2", TypeName::Shape2},   {"material", TypeName::Material},
        {"light", TypeName::Light},     {"region", TypeName::Region},
        {"_shape", TypeName::AnyShape}, {"_field", TypeName::AnyField},
        {"_any", TypeName::Any},        {"angle", TypeName::Float},
        {"angles", TypeName::Vec3}};
    return names;
}

TypeName type_named(std::string_view text) {
    const auto it = table_of_types().find(text);
    return it == table_of_types().end() ? TypeName::Unknown : it->second;
}

std::vector<std::string_view> type_names() {
    std::vector<std::string_view> all;
    for (const auto &[name, type] : table_of_types()) all.push_back(name);
    return all;
}

void Builder::type_name(Index at) {
    TypeExpr type;
    type.span = span(at);
    type.name = ast_.others.add(std::string(text(at)));
    type.named = type_named(type.name);
    type.in_radians = type.name == "angle" || type.name == "angles";
    types_.push_back(std::move(type));
}

void Builder::type_number(Index at) {
    const std::optional<NumberWord> number = read_number(text(at));
    if (number) types_.back().lipschitz = number->value;
}

void Builder::type_bound_end(Index at) { types_.back().span = join(types_.back().span, span(at)); }

void Builder::type_list(Index first, Index last) {
    TypeExpr list;
    list.kind = TypeExpr::Kind::List;
    list.span = span(first, last);
    list.items.push_back(take_back(types_));
    types_.push_back(std::move(list));
}

void Builder::type_function(Index first, Index last) {
    const auto items = types_.begin() + static_cast<std::ptrdiff_t>(take_back(type_marks_));
    TypeExpr function;
    function.kind = TypeExpr::Kind::Function;
    function.span = span(first, last);
    function.items.assign(std::make_move_iterator(items), std::make_move_iterator(types_.end()));
    types_.erase(items, types_.end());
    types_.push_back(std::move(function));
}

void Builder::some_type() { maybe_types_.push_back(&ast_.types.emplace_back(take_back(types_))); }

// -- operands ------------------------------------------------------------------------------------

void Builder::number(Index at) {
    const std::optional<NumberWord> number = read_number(text(at));
    assert(number);
    push(Number{number->value, number->is_int, number->unit}, span(at), 1);
}

void Builder::string(Index at) {
    push(String{ast_.others.add(read_string(text(at)))}, span(at), 1);
}

void Builder::color(Index at) {
    Color color;
    read_color(text(at), color.rgba);
    push(color, span(at), 1);
}

void Builder::yes(Index at) { push(Bool{true}, span(at), 1); }
void Builder::no(Index at) { push(Bool{false}, span(at), 1); }
void Builder::poison(Index at) { push(Poison{}, span(at), 1); }

void Builder::name(Index at) {
    const std::uint32_t name = word(text(at));
    push(Name{ast_.words[name], name}, span(at), 1);
    if (is_foreign_value(text(at))) foreign_names_.push_back({items_.back().id, span(at)});
}

void Builder::parenthesized(Index first, Index last) {
    Item &item = items_.back();
    ast_.exprs[item.id].parenthesized = true;
    item.begin = token(first).begin;
    item.end = token(last).end;
}

void Builder::comprehension() {
    const BlockId body = add_block(take_back(stmt_marks_), {});
    const Span inside = ast_.blocks[body].stmts.front().span;
    ast_.blocks[body].span = inside;
    push(Comprehension{body}, inside, 1 + height(body));
}

void Builder::list(Index first, Index last) {
    const Frame frame = take_back(frames_);
    const std::size_t count = items_.size() - frame.items;
    const Span whole = span(first, last);
    if (count == 1) {
        // A lone `for` or `if` in brackets contributes.
        const Item item = items_.back();
        const Expr &only = ast_.exprs[item.id];
        if (kind(first + 1) == Tok::For) {
            ast_.exprs[item.id].span = whole;
            items_.back() = {item.id, whole.begin, whole.end};
            return;
        }
        if (std::holds_alternative<If>(only.kind) && !only.parenthesized) {
            items_.pop_back();
            const std::size_t mark = stmts_.size();
            add_stmt(ExprStmt{item.id}, span(item), height(item.id));
            const BlockId body = add_block(mark, span(item));
            push(Comprehension{body}, whole, 1 + height(body));
            return;
        }
    }
    List list;
    std::uint32_t tallest = 0;
    list.items.reserve(count);
    for (std::size_t i = frame.items; i < items_.size(); ++i) {
        list.items.push_back(items_[i].id);
        tallest = std::max(tallest, height(items_[i].id));
    }
    items_.resize(frame.items);
    push(std::move(list), whole, 1 + tallest);
}

// -- functions -----------------------------------------------------------------------------------

void Builder::declared_name(Index at) {
    names_.emplace_back(identifier(at));
    declared_.push_back(text(at));
}

void Builder::parameter() {
    const std::optional<Item> value = pop_maybe_item();
    const TypeExpr *type = pop_maybe_type();
    parameters_.push_back({pop_name(), type, {}});
    if (value) parameters_.back().default_value = value->id;
}

void Builder::function_open(Index at) {
    heads_.push_back({parameters_.size(), at, in_function_, span(at)});
}

void Builder::declaration_open(Index at) {
    deeper(at);
    function_open(at);
}

void Builder::lambda_name(Index at) {
    function_open(at);
    declared_.push_back(text(at));
    parameters_.push_back({identifier(at), {}, {}});
}

void Builder::function_head(Index next) {
    heads_.back().span = span(heads_.back().first, next - 1);
    in_function_ = true;
}

void Builder::value_body() {
    blocks_.push_back(value_block(pop_item()));
    expression_body_ = true;
}

FunctionId Builder::pop_function(std::optional<Identifier> name, const TypeExpr *result,
                                 Span whole) {
    const Head head = take_back(heads_);
    in_function_ = head.outer_in_function;
    Function function;
    function.name = std::move(name);
    const auto parameters = parameters_.begin() + static_cast<std::ptrdiff_t>(head.parameters);
    function.parameters.assign(std::make_move_iterator(parameters),
                               std::make_move_iterator(parameters_.end()));
    parameters_.erase(parameters, parameters_.end());
    function.result = result;
    function.body = pop_block();
    function.span = whole;
    function.head = head.span;
    function.body_is_expression = expression_body_;
    return ast_.functions.add(std::move(function));
}

void Builder::lambda(Index first, Index last) {
    const std::uint32_t body_height = height(blocks_.back());
    const FunctionId function = pop_function({}, {}, span(first, last));
    push(Lambda{function}, span(first, last), 1 + body_height);
}

// -- choice --------------------------------------------------------------------------------------

void Builder::if_branch() {
    const BlockId body = pop_block();
    branches_.push_back({pop_item().id, body});
}

void Builder::otherwise() { branches_.push_back({ExprId{}, pop_block()}); }

void Builder::choice(Index first, Index last) {
    const auto begin = branches_.begin() + static_cast<std::ptrdiff_t>(take_back(branch_marks_));
    If choice;
    std::uint32_t tallest = 0;
    for (auto branch = begin; branch != branches_.end(); ++branch) {
        tallest = std::max(tallest, height(branch->body));
        if (branch->condition) tallest = std::max(tallest, height(branch->condition));
        if (!branch->condition)
            choice.otherwise = branch->body;
        else
            choice.branches.push_back(*branch);
    }
    branches_.erase(begin, branches_.end());
    push(std::move(choice), span(first, last), 1 + tallest);
}

// -- postfix forms -------------------------------------------------------------------------------

void Builder::argument_name(Index at) {
    names_.emplace_back(identifier(at));
    if (kind(at + 1) != Tok::Assign) return;
    // all of one call are one mistake
    const Index open = enclosing(at), close = match(open);
    std::vector<Edit> edits;
    for (Index i = open + 1; i<close; i = match(i)> i ? match(i) + 1 : i + 1) {
        const bool begins = kind(i - 1) == Tok::Comma || i == open + 1;
        if (!begins || kind(i) != Tok::Name || kind(i + 1) != Tok::Assign) continue;
        if (i < at) return;
        const bool spaced = token(i + 1).end < token(i + 2).begin;
        edits.push_back({{id_, token(i).end, token(i + 1).end}, spaced ? ":" : ": "});
    }
    foreign(span(at + 1), "an argument is named with `:`")
        .help("write `" + std::string(text(at)) + ": …`", std::move(edits));
}

void Builder::argument() { arguments_.push_back({take_back(names_), pop_item().id}); }

void Builder::call(Index, Index last) {
    const auto arguments =
        arguments_.begin() + static_cast<std::ptrdiff_t>(take_back(argument_marks_));
    const Item callee = pop_item();
    Call call;
    call.callee = callee.id;
    call.arguments.assign(std::make_move_iterator(arguments),
                          std::make_move_iterator(arguments_.end()));
    arguments_.erase(arguments, arguments_.end());
    std::uint32_t tallest = height(callee.id);
    for (const Argument &argument : call.arguments)
        tallest = std::max(tallest, height(argument.value));
    push(std::move(call), {id_, callee.begin, token(last).end}, 1 + tallest);
}

void Builder::index(Index, Index last) {
    const Item index = pop_item();
    const Item object = pop_item();
    push(lang::Index{object.id, index.id}, {id_, object.begin, token(last).end},
         1 + std::max(height(object.id), height(index.id)));
}

void Builder::member(Index at) {
    const Item object = pop_item();
    push(Member{object.id, identifier(at)}, {id_, object.begin, token(at).end},
         1 + height(object.id));
    const Expr &qualifier = ast_.exprs[object.id];
    const Name *name = std::get_if<Name>(&qualifier.kind);
    if (name && !qualifier.parenthesized && is_foreign_module(name->text))
        foreign_names_.push_back({items_.back().id, qualifier.span});
}

void Builder::trailing(Index first, Index last) {
    const BlockId block = pop_block();
    const Item callee = pop_item();
    const std::uint32_t tall = 1 + std::max(height(callee.id), height(block));
    const Span whole{id_, callee.begin, token(last).end};
    Expr &expr = ast_.exprs[callee.id];
    Call *call = std::get_if<Call>(&expr.kind);
    if (!call || expr.parenthesized || call->trailing) {
        push(Call{{}, callee.id, block, false}, whole, tall);
        return;
    }
    if (const Name *name = std::get_if<Name>(&ast_.exprs[call->callee].kind);
        name && !call->arguments.empty() && is_foreign_transform(name->text) &&
        !may_be_declared(name->text)) {
        const Index open = match(first - 1);
        const Span head{id_, token(open - 1).begin, token(first - 1).end};
        std::string chain = transform_text(open - 1, false); // none of `render(…) { … }`
        if (!chain.empty()) chain.insert(0, ".");
        Diagnostic &d = foreign(head, "a transform stands behind the shape that it moves");
        if (const auto lost = lost_of_transform(open - 1); !lost.empty()) d.note(std::string(lost));
        d.help("write " + ("`union { … }" + chain + "`"),
               {{head, "union"}, {{id_, whole.end, whole.end}, chain}});
        push(Poison{}, whole, tall);
        return;
    }
    if (call->arguments.empty()) {
        const Index open = match(first - 1);
        const std::string name = brief(text(expr.span.begin, token(open).begin));
        foreign(span(open, first - 1), "a block stands directly behind the function's name")
            .help("write `" + name + " { … }`", {{span(open, first - 1), ""}});
        call->has_parentheses = false;
    }
    call->trailing = block;
    Expr merged = std::move(expr);
    push(std::move(merged.kind), whole, tall);
}

void Builder::step(Index at) {
    const Item item = pop_item();
    const bool up = kind(at) == Tok::PlusPlus;
    if (up && foreign_concat(at)) {
        failed_ = at;
        throw Abandon{};
    }
    const std::string name = brief(text(item.begin, item.end));
    if (!is_target(item.id)) {
        foreign(span(at), up ? "there is no `++`" : "there is no `--`")
            .help("lists are joined by `concat(a, b)`");
        return push(Poison{}, {id_, item.begin, token(at).end}, 1);
    }
    if (!in_function_ && enclosing(at) == 0) {
        foreign(span(at), up ? "there is no `++`" : "there is no `--`")
            .help("a scene's names keep their value: give the new one a name of its own, `let " +
                  name + "2 = " + name + (up ? " + 1`" : " - 1`"));
        return push(Poison{}, {id_, item.begin, token(at).end}, 1);
    }
    foreign(span(at), up ? "there is no `++`" : "there is no `--`")
        .help("write `" + name + (up ? " += 1`" : " -= 1`"), {{span(at), up ? " += 1" : " -= 1"}});
    push(Poison{}, {id_, item.begin, token(at).end}, 1);
}

} // namespace fathom::lang
