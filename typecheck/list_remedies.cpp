// Methods of lists that other languages have, and the loops and folds that do the same here.
#include "typecheck/remedies.h"

#include <algorithm>
#include <array>

namespace fathom::typecheck {

namespace {

constexpr std::size_t most_exprs = 20'000, most_blocks = 5'000;

// The block that holds the expression as a statement; nothing: it is part of another.
std::optional<lang::BlockId> block_of(const File &ast, Span place) {
    if (ast.blocks.size() > most_blocks) return std::nullopt;
    for (std::size_t i = 0; i < ast.blocks.size(); ++i) {
        const lang::BlockId id{static_cast<std::uint32_t>(i)};
        for (const lang::Stmt &s : ast.blocks[id].stmts)
            if (const auto *e = std::get_if<lang::ExprStmt>(&s.kind);
                e && ast.exprs[e->value].span == place)
                return id;
    }
    return std::nullopt;
}

bool is_push(std::string_view name) {
    return name == "push" || name == "append" || name == "push_back" || name == "add";
}

bool is_empty_list(const File &ast, lang::ExprId id) {
    const auto *list = std::get_if<lang::List>(&ast.exprs[id].kind);
    return list && list->items.empty();
}

// `let l = []`, then `for … { l.push(x) }`: `let l = [for … { x }]`.
std::vector<Edit> pushes_as_list(const File &ast, std::string_view list, Span pushed, Span place) {
    const auto inner = block_of(ast, place);
    if (!inner) return {};
    for (std::size_t i = 0; i < ast.blocks.size(); ++i) {
        const auto &stmts = ast.blocks[lang::BlockId{static_cast<std::uint32_t>(i)}].stmts;
        const lang::Stmt *bound = nullptr;
        for (const lang::Stmt &s : stmts) {
            const auto *let = std::get_if<lang::Let>(&s.kind);
            const auto *var = std::get_if<lang::Var>(&s.kind);
            if ((let && let->name.text == list && is_empty_list(ast, let->value)) ||
                (var && var->name.text == list && is_empty_list(ast, var->value)))
                bound = &s;
            const auto *loop = std::get_if<lang::For>(&s.kind);
            if (!loop || !bound || loop->body != *inner) continue;
            const Span at = s.span;
            return {{bound->span, ""},
                    {{at.source, at.begin, at.begin}, "let " + std::string(list) + " = ["},
                    {{at.source, place.begin, pushed.begin}, ""},
                    {{at.source, pushed.end, place.end}, ""},
                    {{at.source, at.end, at.end}, "]"}};
        }
    }
    return {};
}

// How often something is added to the list.
std::size_t pushes_to(const File &ast, std::string_view list) {
    return static_cast<std::size_t>(std::ranges::count_if(ast.exprs, [&](const lang::Expr &e) {
        const auto *m = std::get_if<lang::Member>(&e.kind);
        const auto *of = m ? std::get_if<lang::Name>(&ast.exprs[m->object].kind) : nullptr;
        return of && of->text == list && is_push(m->name.text);
    }));
}

// `l.forEach(x => s)`: `for x in l { s }`.
std::vector<Edit> loop_of_function(const Interpreter &ev, const File &ast, Span object,
                                   lang::ExprId argument, Span place) {
    const auto *lambda = std::get_if<lang::Lambda>(&ast.exprs[argument].kind);
    if (!lambda || !block_of(ast, place)) return {};
    const lang::Function &f = ast.functions[lambda->function];
    const auto &stmts = ast.blocks[f.body].stmts;
    if (f.parameters.size() != 1 || stmts.empty()) return {};
    const Span block = ast.blocks[f.body].span;
    const bool braces = !f.body_is_expression && text(ev.sources, block).starts_with('{');
    const Span body = braces ? block : stmts.front().span;
    const std::string name(f.parameters[0].name.text);
    return {{{place.source, place.begin, place.begin}, "for " + name + " in "},
            {{place.source, object.end, body.begin}, braces ? " " : " { "},
            {{place.source, body.end, place.end}, braces ? "" : " }"}};
}

} // namespace

std::vector<Edit> edits_of_list_method(const Interpreter &ev, const File &ast,
                                       const lang::Member &member, const lang::Call &call,
                                       Span place) {
    if (ev.quiet > 0 || is_library_place(ev, place) || ast.exprs.size() > most_exprs) return {};
    const std::string name(member.name.text);
    const Span object = ast.exprs[member.object].span;
    if (name == "sum" && call.arguments.empty())
        return {{{place.source, place.begin, place.begin}, "fold("},
                {{place.source, object.end, place.end}, ", 0, (a, b) => a + b)"}};
    if (call.arguments.size() != 1 || call.arguments[0].name) return {};
    const lang::ExprId argument = call.arguments[0].value;
    if (name == "forEach" || name == "for_each")
        return loop_of_function(ev, ast, object, argument, place);
    const auto *list = std::get_if<lang::Name>(&ast.exprs[member.object].kind);
    if (!is_push(name) || !list || pushes_to(ast, list->text) != 1) return {};
    return pushes_as_list(ast, list->text, ast.exprs[argument].span, place);
}

} // namespace fathom::typecheck
