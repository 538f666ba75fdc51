#include "api/language/refactor.h"

#include "base/text.h"
#include "lang/vocabulary.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <set>

namespace fathom::language {
namespace {

std::string slice(const Syntax &syntax, Span span) {
    return std::string(syntax.text().substr(span.begin, span.end - span.begin));
}

// A name that nothing of the text is called, and no word of the language.
std::string free_name(const Names &names, const std::string &wanted) {
    std::set<std::string, std::less<>> taken;
    for (const Declaration &declared : names.declarations) taken.insert(declared.name);
    for (const Use &use : names.uses) taken.insert(use.name);
    for (int i = 1;; ++i) {
        const std::string name = i == 1 ? wanted : fmt::format("{}{}", wanted, i);
        if (!taken.contains(name)) return name;
    }
}

// The selected expression and the way to it; nothing where the selection is no whole expression.
struct Selected {
    lang::ExprId expr;
    std::vector<Step> path; // ends with the expression
};
std::optional<Selected> selected(const Syntax &syntax, std::size_t begin, std::size_t end) {
    const std::string_view text = syntax.text();
    const auto blank = [&](std::size_t at) { return text[at] == ' ' || text[at] == '\n'; };
    while (begin < end && blank(begin)) ++begin;
    while (end > begin && blank(end - 1)) --end;
    if (begin == end) return std::nullopt;
    const auto from = static_cast<std::uint32_t>(begin), to = static_cast<std::uint32_t>(end);
    std::vector<Step> path = path_to(syntax.ast, from, to);
    // parentheses are no part of what they hold
    if (path.empty() || !path.back().expr) {
        if (text[begin] != '(' || text[end - 1] != ')') return std::nullopt;
    }
    if (!path.empty() && path.back().expr) {
        const Span span = path.back().span(syntax.ast);
        if (span.begin == from && span.end == to) {
            // of `(a)` and `a` alike the outermost that has the same place
            return Selected{path.back().expr, std::move(path)};
        }
    }
    if (text[begin] == '(' && text[end - 1] == ')') return selected(syntax, begin + 1, end - 1);
    return std::nullopt;
}

bool within(Span inner, Span outer) { return outer.begin <= inner.begin && inner.end <= outer.end; }

// What an expression's parent makes of it: a place where a name cannot stand for it.
bool is_callee_or_target(const Syntax &syntax, const Selected &what) {
    const lang::Ast &ast = syntax.ast;
    if (what.path.size() < 2) return false;
    const Step &parent = what.path[what.path.size() - 2];
    if (parent.expr) {
        const auto *call = std::get_if<lang::Call>(&ast.exprs[parent.expr].kind);
        return call && call->callee == what.expr;
    }
    if (!parent.stmt) return false;
    const auto *assign = std::get_if<lang::Assign>(&parent.stmt->kind);
    return assign && within(ast.exprs[what.expr].span, ast.exprs[assign->target].span);
}

// Whether something inside leaves a block or a function that lies outside.
bool leaves(const lang::Ast &ast, lang::ExprId expr) {
    bool found = false;
    const std::function<void(const Inside &)> walk = [&](const Inside &in) {
        for (lang::ExprId id : in.exprs) walk(inside(ast.exprs[id]));
        for (lang::BlockId id : in.blocks)
            for (const lang::Stmt &stmt : ast.blocks[id].stmts) {
                found |= std::holds_alternative<lang::Return>(stmt.kind) ||
                         std::holds_alternative<lang::Break>(stmt.kind) ||
                         std::holds_alternative<lang::Assign>(stmt.kind);
                walk(inside(stmt));
            }
    };
    walk(inside(ast.exprs[expr]));
    return found;
}

bool is_module(const Syntax &syntax, const Names &names, lang::ExprId expr) {
    if (!std::holds_alternative<lang::Name>(syntax.ast.exprs[expr].kind)) return false;
    const Use *use = names.use_at(syntax.ast.exprs[expr].span.begin);
    return use && use->declaration &&
           names.declarations[*use->declaration].by == DeclaredBy::Import;
}

// The declarations outside of a stretch that it uses, each once, in the order of their uses.
std::vector<std::size_t> used_in(const Names &names, Span span) {
    std::vector<std::size_t> used;
    for (const Use &use : names.uses)
        if (use.declaration && use.as != UsedAs::Argument && within(use.at, span) &&
            !within(names.declarations[*use.declaration].at, span) &&
            std::ranges::find(used, *use.declaration) == used.end())
            used.push_back(*use.declaration);
    return used;
}

// Where a statement begins a line, the blanks before it; nothing where it shares its line.
std::optional<std::string> indentation(std::string_view text, std::size_t begin) {
    const std::size_t line = text.rfind('\n', begin ? begin - 1 : 0);
    const std::size_t from = begin == 0 || line == text.npos ? 0 : line + 1;
    const std::string_view before = text.substr(from, begin - from);
    if (before.find_first_not_of(" \t") != before.npos) return std::nullopt;
    return std::string(before);
}

TextEdit statement_before(const Syntax &syntax, std::size_t at, const std::string &statement) {
    const auto indent = indentation(syntax.text(), at);
    return {{at, at}, indent ? statement + "\n" + *indent : statement + "; "};
}

// The byte before a top-level statement and the `///` lines above it.
std::size_t above(const Syntax &syntax, const lang::Stmt &stmt) {
    std::size_t at = stmt.span.begin;
    const std::string_view text = syntax.text();
    for (std::size_t i = syntax.words.comments.size(); i-- > 0;) {
        const lang::Comment &comment = syntax.words.comments[i];
        if (comment.end > at || !comment.is_line) continue;
        const std::string_view between = text.substr(comment.end, at - comment.end);
        if (between.find_first_not_of(" \t\r\n") != between.npos ||
            std::ranges::count(between, '\n') != 1 || !indentation(text, comment.begin))
            break;
        at = comment.begin;
    }
    return at;
}

bool refused(const Syntax &syntax, const Names &names, const Selected &what) {
    return is_callee_or_target(syntax, what) || is_module(syntax, names, what.expr) ||
           leaves(syntax.ast, what.expr) ||
           std::holds_alternative<lang::BlockExpr>(syntax.ast.exprs[what.expr].kind);
}

// A name behind the keyword of a value, which is no name without it.
std::string in_place(const Syntax &syntax, Span at, const std::string &name) {
    const std::string_view text = syntax.text();
    const bool touches =
        at.end < text.size() && (std::isalnum(text[at.end]) || text[at.end] == '_');
    return touches ? name + " " : name;
}

} // namespace

std::string edited(std::string_view text, std::vector<TextEdit> edits) {
    std::ranges::stable_sort(edits, {}, [](const TextEdit &edit) { return edit.at.begin; });
    std::string out;
    std::size_t at = 0;
    for (const TextEdit &edit : edits) {
        out += text.substr(at, edit.at.begin - at);
        out += edit.text;
        at = edit.at.end;
    }
    return out += text.substr(at);
}

std::optional<CodeAction> extract_let(const Syntax &syntax, const Names &names, std::size_t begin,
                                      std::size_t end) {
    const auto what = selected(syntax, begin, end);
    if (!what || refused(syntax, names, *what)) return std::nullopt;
    const Span span = syntax.ast.exprs[what->expr].span;
    // the nearest statement of a block with braces, or of the file
    std::size_t at = what->path.size();
    const lang::Stmt *stmt = nullptr;
    while (at-- > 0 && !stmt) {
        const Step &step = what->path[at];
        if (!step.stmt) continue;
        if (std::holds_alternative<lang::While>(step.stmt->kind)) return std::nullopt;
        const Step *owner = at > 0 ? &what->path[at - 1] : nullptr;
        if (owner && owner->function && owner->function->body_is_expression) continue;
        stmt = step.stmt;
    }
    if (!stmt) return std::nullopt;
    // what is declared between the statement's begin and the value has no place before it
    for (std::size_t used : used_in(names, span))
        if (within(names.declarations[used].at, stmt->span)) return std::nullopt;
    const std::string name = free_name(names, "value");
    CodeAction out{"Extract into a `let`", CodeAction::Kind::Extract, {}, {}};
    out.edits.push_back(statement_before(syntax, stmt->span.begin,
                                         fmt::format("let {} = {}", name, slice(syntax, span))));
    out.edits.push_back({{span.begin, span.end}, in_place(syntax, span, name)});
    return out;
}

std::optional<CodeAction> extract_function(const Syntax &syntax, const Names &names,
                                           std::size_t begin, std::size_t end) {
    const auto what = selected(syntax, begin, end);
    if (!what || refused(syntax, names, *what) || !what->path.front().stmt) return std::nullopt;
    const Span span = syntax.ast.exprs[what->expr].span;
    const lang::Stmt &stmt = *what->path.front().stmt;
    std::string parameters;
    for (std::size_t used : used_in(names, span)) {
        const Declaration &declared = names.declarations[used];
        if (!declared.top_level) parameters += (parameters.empty() ? "" : ", ") + declared.name;
        // a name of the file that stands below is not there yet where the value stands above
    }
    const std::string name = free_name(names, "part");
    CodeAction out{"Extract into a function", CodeAction::Kind::Extract, {}, {}};
    const std::size_t at = above(syntax, stmt);
    const auto indent = indentation(syntax.text(), at);
    const std::string text = fmt::format("fn {}({}) = {}", name, parameters, slice(syntax, span));
    out.edits.push_back({{at, at}, text + (indent ? "\n\n" + *indent : "; ")});
    out.edits.push_back({{span.begin, span.end}, fmt::format("{}({})", name, parameters)});
    return out;
}

std::optional<CodeAction> extract_param(const Syntax &syntax, const Names &names, std::size_t begin,
                                        std::size_t end) {
    auto path = path_to(syntax.ast, static_cast<std::uint32_t>(begin),
                        static_cast<std::uint32_t>(std::max(begin, end)));
    if (path.empty() || !path.back().expr || !path.front().stmt) return std::nullopt;
    const lang::Expr &literal = syntax.ast.exprs[path.back().expr];
    const lang::Stmt &stmt = *path.front().stmt;
    if (std::holds_alternative<lang::Param>(stmt.kind)) return std::nullopt;
    std::string range, text = slice(syntax, literal.span), wanted = "amount";
    if (const auto *number = std::get_if<lang::Number>(&literal.kind)) {
        const std::string unit(number->unit);
        const std::string digits = text.substr(0, text.size() - unit.size());
        const double value = parse_number(digits).value_or(0);
        if (number->is_int && value == 0) return std::nullopt; // what it counts is not known
        if (value == 0)
            range = " in -1..1";
        else if (number->is_int && std::fmod(value, 2) == 0)
            range = fmt::format(" in {}..{}", value / 2, value * 2);
        else if (number->is_int)
            range = fmt::format(" in {}..{}", std::ceil(value / 2), value * 2);
        else
            range = fmt::format(" in {:.6g}{}..{:.6g}{}", value / 2, unit, value * 2, unit);
    } else if (std::holds_alternative<lang::Color>(literal.kind))
        wanted = "tint";
    else if (std::holds_alternative<lang::Bool>(literal.kind))
        wanted = "enabled";
    else
        return std::nullopt;
    const std::string name = free_name(names, wanted);
    const std::size_t at = above(syntax, stmt);
    const auto indent = indentation(syntax.text(), at);
    CodeAction out{"Make a `param` of it", CodeAction::Kind::Extract, {}, {}};
    out.edits.push_back(
        {{at, at},
         fmt::format("param {} = {}{}{}", name, text, range, indent ? "\n" + *indent : "; ")});
    out.edits.push_back(
        {{literal.span.begin, literal.span.end}, in_place(syntax, literal.span, name)});
    return out;
}

namespace {

// Whether a value needs parentheses where a name stood.
bool stands_alone(const lang::Ast &ast, lang::ExprId value) {
    const lang::ExprKind &kind = ast.exprs[value].kind;
    return std::holds_alternative<lang::Name>(kind) || std::holds_alternative<lang::Number>(kind) ||
           std::holds_alternative<lang::String>(kind) || std::holds_alternative<lang::Bool>(kind) ||
           std::holds_alternative<lang::Color>(kind) || std::holds_alternative<lang::List>(kind) ||
           std::holds_alternative<lang::Comprehension>(kind) ||
           std::holds_alternative<lang::Index>(kind) ||
           std::holds_alternative<lang::Member>(kind) ||
           (std::holds_alternative<lang::Call>(kind) && !std::get<lang::Call>(kind).trailing);
}

// A declaration's whole statement with its line and its `///` lines, where it has them for itself.
TextEdit without(const Syntax &syntax, const lang::Stmt &stmt) {
    const std::string_view text = syntax.text();
    std::size_t begin = above(syntax, stmt), end = stmt.span.end;
    while (end < text.size() && (text[end] == ' ' || text[end] == '\t' || text[end] == '\r')) ++end;
    if (end < text.size() && text[end] == ';') {
        ++end;
        while (end < text.size() && text[end] == ' ') ++end;
        return {{begin, end}, ""};
    }
    const auto indent = indentation(text, begin);
    if (indent && end < text.size() && text[end] == '\n')
        return {{begin - indent->size(), end + 1}, ""};
    return {{stmt.span.begin, stmt.span.end}, ""};
}

} // namespace

std::optional<CodeAction> inline_let(const Syntax &syntax, const Names &names, std::size_t at) {
    const auto meant = names.meant_at(at);
    if (!meant) return std::nullopt;
    const Declaration &declared = names.declarations[*meant];
    if (declared.by != DeclaredBy::Let || leaves(syntax.ast, declared.value)) return std::nullopt;
    const auto path = path_to(syntax.ast, declared.at.begin, declared.at.end);
    const lang::Stmt *stmt = nullptr;
    for (const Step &step : path)
        if (step.stmt && step.stmt->span == declared.statement) stmt = step.stmt;
    const auto *let = stmt ? std::get_if<lang::Let>(&stmt->kind) : nullptr;
    if (!let || let->type) return std::nullopt; // a type converts
    const Span value = syntax.ast.exprs[declared.value].span;
    const std::vector<std::size_t> used = used_in(names, value);
    for (std::size_t other : used)
        if (names.declarations[other].by == DeclaredBy::Var) return std::nullopt;
    std::string text = slice(syntax, value);
    if (text.find("//") != text.npos) return std::nullopt; // a comment would swallow what follows
    if (!stands_alone(syntax.ast, declared.value)) text = "(" + text + ")";
    CodeAction out{fmt::format("Inline `{}`", declared.name), CodeAction::Kind::Inline, {}, {}};
    out.edits.push_back(without(syntax, *stmt));
    std::size_t count = 0;
    for (const Use &use : names.uses) {
        if (use.declaration != *meant) continue;
        if (use.doubtful || use.as == UsedAs::Method || use.as == UsedAs::Argument)
            return std::nullopt;
        ++count;
        out.edits.push_back(
            {{use.at.begin, use.at.end},
             use.as == UsedAs::Callee && text[0] != '(' &&
                     !std::holds_alternative<lang::Name>(syntax.ast.exprs[declared.value].kind)
                 ? "(" + text + ")"
                 : text});
    }
    if (count == 0) return std::nullopt;
    // each name of the value has to mean the same where it comes to stand
    const std::string after = edited(syntax.text(), out.edits);
    const Syntax now = read_syntax(after);
    const Names then = names_of(now.ast);
    std::multiset<std::string> expected, got;
    const auto name_of = [](const Names &of, const Use &use) {
        return use.declaration
                   ? fmt::format("{}@{}", use.name,
                                 std::ranges::count_if(
                                     of.declarations.begin(),
                                     of.declarations.begin() +
                                         static_cast<std::ptrdiff_t>(*use.declaration),
                                     [&](const Declaration &d) { return d.name == use.name; }))
                   : use.name;
    };
    for (const Use &use : names.uses) {
        if (use.declaration == *meant) continue;
        const std::size_t times = within(use.at, value) ? count : 1;
        for (std::size_t i = 0; i < times; ++i) expected.insert(name_of(names, use));
    }
    for (const Use &use : then.uses) got.insert(name_of(then, use));
    const bool declares = std::ranges::any_of(
        names.declarations, [&](const Declaration &d) { return within(d.at, value); });
    if (!now.whole || (!declares && expected != got)) return std::nullopt;
    return out;
}

std::vector<CodeAction> convert_units(const Syntax &syntax, std::size_t at) {
    std::vector<CodeAction> all;
    const auto byte = static_cast<std::uint32_t>(at);
    const auto path = path_to(syntax.ast, byte, byte);
    if (path.empty() || !path.back().expr) return all;
    const lang::Expr &e = syntax.ast.exprs[path.back().expr];
    const auto *number = std::get_if<lang::Number>(&e.kind);
    if (!number || number->unit.empty()) return all;
    const std::pair<const char *, double> units[] = {
        {"deg", std::numbers::pi / 180}, {"turn", 2 * std::numbers::pi}, {"rad", 1}};
    for (const auto &[unit, size] : units) {
        if (number->unit == unit) continue;
        std::string digits;
        for (int precision = 1; precision <= 17; ++precision) { // the fewest that are equal
            digits = fmt::format("{:.{}g}", number->value / size, precision);
            const double read = parse_number(digits).value_or(0);
            if (static_cast<float>(read * size) == static_cast<float>(number->value)) break;
        }
        if (digits.find('e') != digits.npos) continue; // nobody writes an angle so
        all.push_back({fmt::format("Write as `{}{}`", digits, unit),
                       CodeAction::Kind::Rewrite,
                       {},
                       {{{e.span.begin, e.span.end}, digits + unit}}});
    }
    return all;
}

std::optional<CodeAction> name_argument(const Syntax &syntax, const Names &names, std::size_t at,
                                        const ParameterName &parameter) {
    const lang::Ast &ast = syntax.ast;
    const auto byte = static_cast<std::uint32_t>(at);
    const auto path = path_to(ast, byte, byte);
    for (std::size_t i = path.size(); i-- > 0;) {
        if (!path[i].expr) continue;
        const auto *call = std::get_if<lang::Call>(&ast.exprs[path[i].expr].kind);
        if (!call) continue;
        std::size_t chosen = 0;
        while (chosen < call->arguments.size() &&
               !(ast.exprs[call->arguments[chosen].value].span.begin <= at &&
                 at <= ast.exprs[call->arguments[chosen].value].span.end))
            ++chosen;
        if (chosen == call->arguments.size()) continue;
        if (call->arguments[chosen].name || call->trailing) return std::nullopt;
        const lang::Expr &callee = ast.exprs[call->callee];
        const auto *member = std::get_if<lang::Member>(&callee.kind);
        const Span name = member ? member->name.span : callee.span;
        const auto use = std::ranges::find(names.uses, name, &Use::at);
        if (use == names.uses.end()) return std::nullopt;
        const std::size_t first = member && !use->module ? 1 : 0;
        CodeAction out{"Name this argument", CodeAction::Kind::Rewrite, {}, {}};
        for (std::size_t k = chosen; k < call->arguments.size(); ++k) {
            if (call->arguments[k].name) continue; // those behind it have names, too
            const std::string called = parameter(*use, first + k, first + call->arguments.size());
            if (called.empty()) return std::nullopt;
            const lang::Expr &value = ast.exprs[call->arguments[k].value];
            std::size_t begin = value.span.begin;
            while (value.parenthesized && begin > 0 && syntax.text()[begin] != '(') --begin;
            out.edits.push_back({{begin, begin}, called + ": "});
        }
        if (out.edits.size() > 1) out.title = "Name these arguments";
        return out;
    }
    return std::nullopt;
}

} // namespace fathom::language
