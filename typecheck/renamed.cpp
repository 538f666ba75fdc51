// A name of a scene that is given another value, as in languages whose names are variables: each
// value gets a name of its own.
#include "typecheck/remedies.h"

#include <fmt/format.h>

#include <algorithm>
#include <set>

namespace fathom::typecheck {

namespace {

// The name that an assignment changes as a whole; null where it changes a part of it.
const lang::Name *assigned(const File &ast, const lang::Stmt &s) {
    const auto *a = std::get_if<lang::Assign>(&s.kind);
    return a ? std::get_if<lang::Name>(&ast.exprs[a->target].kind) : nullptr;
}

// Whether the file declares the name again behind a place, or assigns to it in a block.
bool is_entangled(const File &ast, std::string_view name, std::uint32_t from) {
    const auto &stmts = ast.blocks[ast.root].stmts;
    const auto at_top = [&](const lang::Stmt &s) {
        return !stmts.empty() && &s >= stmts.data() && &s < stmts.data() + stmts.size();
    };
    for (const lang::Function &f : ast.functions)
        for (const lang::Parameter &p : f.parameters)
            if (p.name.text == name && p.name.span.begin > from) return true;
    for (const lang::Block &b : ast.blocks)
        for (const lang::Stmt &s : b.stmts) {
            if (s.span.begin < from) continue;
            const lang::Name *changed = assigned(ast, s);
            if (changed && changed->text == name && !at_top(s)) return true;
            const auto *a = std::get_if<lang::Assign>(&s.kind);
            if (a && !changed && at_top(s)) return true; // of a part of something
            const auto *l = std::get_if<lang::Let>(&s.kind);
            const auto *v = std::get_if<lang::Var>(&s.kind);
            const auto *loop = std::get_if<lang::For>(&s.kind);
            if ((l && l->name.text == name) || (v && v->name.text == name) ||
                (loop && loop->variable.text == name))
                return true;
        }
    return false;
}

std::string_view sign_of(lang::BinaryOp op) {
    return op == lang::BinaryOp::Add   ? "+"
           : op == lang::BinaryOp::Sub ? "-"
           : op == lang::BinaryOp::Mul ? "*"
                                       : "/";
}

} // namespace

std::vector<Edit> renamed_from(const Interpreter &ev, const File &ast, const lang::Assign &node,
                               std::string_view name, std::string &fresh) {
    constexpr std::size_t most_edits = 60, most_exprs = 100'000;
    const Span target = ast.exprs[node.target].span;
    const auto &stmts = ast.blocks[ast.root].stmts;
    const auto first = std::ranges::find_if(stmts, [&](const lang::Stmt &s) {
        const auto *a = std::get_if<lang::Assign>(&s.kind);
        return a && a->target == node.target;
    });
    if (first == stmts.end() || ast.exprs.size() > most_exprs ||
        is_entangled(ast, name, target.begin))
        return {};
    const auto is_taken = [&](const std::string &other) {
        return ev.sources[target.source].text.find(other) != std::string::npos;
    };
    int number = 1;
    const auto next_name = [&] {
        std::string next;
        do next = fmt::format("{}{}", name, ++number);
        while (is_taken(next));
        return next;
    };
    // where each name begins to hold, and the value that is its own
    struct Version {
        std::string name;
        std::uint32_t from;
    };
    std::vector<Version> versions{{std::string(name), 0}};
    std::vector<Edit> edits;
    for (auto s = first; s != stmts.end(); ++s) {
        const lang::Name *changed = assigned(ast, *s);
        if (!changed || changed->text != name) continue;
        const lang::Assign &a = std::get<lang::Assign>(s->kind);
        const Span value = ast.exprs[a.value].span, place = ast.exprs[a.target].span;
        const std::string next = next_name();
        if (fresh.empty()) fresh = next;
        if (!a.op)
            edits.push_back({place, "let " + next});
        else {
            const bool grouped = operand_source(ev, value) != source_text(ev, value);
            edits.push_back({{place.source, place.begin, value.begin},
                             fmt::format("let {} = {} {} {}", next, versions.back().name,
                                         sign_of(*a.op), grouped ? "(" : "")});
            if (grouped) edits.push_back({{value.source, value.end, value.end}, ")"});
        }
        versions.push_back({next, s->span.end});
    }
    for (const lang::Expr &e : ast.exprs) {
        const auto *used = std::get_if<lang::Name>(&e.kind);
        if (!used || used->text != name || e.span.begin < target.end) continue;
        const bool is_target = std::ranges::any_of(
            edits, [&](const Edit &edit) { return edit.span.begin == e.span.begin; });
        if (is_target) continue;
        const auto version =
            std::ranges::find_if(versions.rbegin(), versions.rend(),
                                 [&](const Version &v) { return v.from <= e.span.begin; });
        if (version->name != name) edits.push_back({e.span, version->name});
    }
    if (edits.size() > most_edits) edits.clear();
    return edits;
}

bool help_with_hidden(Interpreter &ev, Diagnostic &d, std::string_view name, Span callee) {
    if (name.empty() || !callee.source) return false;
    const File *file = nullptr;
    for (const File &one : ev.files)
        if (one.source == callee.source) file = &one;
    constexpr std::size_t most_reports = 100; // the whole file is looked at for each
    if (!file || ev.diagnostics.items().size() > most_reports) return false;
    const Symbol place = intern(ev, std::string(name));
    if (!is_builtin(place) && !ev.prelude_items.contains(place) &&
        !slot_in_module(ev, ev.prelude_frame, place))
        return false;
    // The declaration at the top, and each use that is no call, is named otherwise.
    const std::string other = std::string(name) + "_value";
    std::vector<Edit> edits;
    for (const lang::Stmt &s : file->blocks[file->root].stmts) {
        const lang::Identifier *declared = nullptr;
        if (const auto *let = std::get_if<lang::Let>(&s.kind)) declared = &let->name;
        if (const auto *param = std::get_if<lang::Param>(&s.kind)) declared = &param->name;
        if (declared && declared->text == name) edits.push_back({declared->span, other});
        if (declared && declared->text == other) return false;
    }
    if (edits.size() != 1) return false;
    std::set<std::uint32_t> called;
    for (const lang::Expr &e : file->exprs)
        if (const auto *call = std::get_if<lang::Call>(&e.kind)) called.insert(call->callee.index);
    for (std::uint32_t i = 0; i < file->exprs.size(); ++i) {
        const lang::Expr &e = file->exprs[lang::ExprId{i}];
        const auto *use = std::get_if<lang::Name>(&e.kind);
        if (use && use->text == name && !called.contains(i)) edits.push_back({e.span, other});
    }
    for (const lang::Function &f : file->functions) // an inner name of the same spelling
        for (const lang::Parameter &p : f.parameters)
            if (p.name.text == name) return false;
    for (const lang::Block &b : file->blocks)
        for (const lang::Stmt &s : b.stmts)
            if (const auto *let = std::get_if<lang::Let>(&s.kind);
                let && let->name.text == name && let->name.span.begin != edits[0].span.begin)
                return false;
    d.help(
        fmt::format("the name hides the library's function: give the value another, `{}`", other),
        std::move(edits));
    return true;
}

OwnValue own_value(Interpreter &ev, const File &ast, std::string_view name) {
    if (ev.quiet > 0) return {};
    for (const lang::Stmt &s : ast.blocks[ast.root].stmts) {
        const auto *let = std::get_if<lang::Let>(&s.kind);
        if (!let || let->name.text != name) continue;
        const auto *made = std::get_if<lang::Call>(&ast.exprs[let->value].kind);
        const auto *callee =
            made ? std::get_if<lang::Name>(&ast.exprs[made->callee].kind) : nullptr;
        const bool look = std::holds_alternative<lang::Color>(ast.exprs[let->value].kind) ||
                          (callee && (callee->text == "material" || callee->text == "rgb"));
        if (look)
            return {fmt::format("a shape is given a colour or a material by `.paint({})`", name),
                    fmt::format(".paint({})", name)};
    }
    return {};
}

void report_needless_range(Interpreter &ev, const File &ast, const lang::Param &param) {
    const Span last = ast.exprs[param.value].span, high = ast.exprs[*param.high].span;
    report(ev, Code::BadArgument, param.name.span, "a bool or a color has no range")
        .help("leave the range away", {{{last.source, last.end, high.end}, ""}});
}

// `translate(1, 2, 3)`; and `repeat(2, 3, 4)`, whose third number stands where a function may.
bool is_vector_by_numbers(std::span<const Formal> formals, std::size_t i, std::size_t numbers) {
    if (numbers < 2) return false;
    return formals[i].is_place ||
           (numbers == formals[i].vector_size && i + numbers <= formals.size() &&
            formals[i + numbers - 1].takes_function);
}

} // namespace fathom::typecheck
