#include "driver/edit.h"

#include "lang/parse.h"

#include <algorithm>

namespace fathom::driver {
namespace {

struct Tree {
    Sources sources;
    lang::Ast ast;
    explicit Tree(const std::string &text) {
        const SourceId source = sources.add("", text);
        Diagnostics unheard;
        ast = lang::parse(sources, source, unheard);
    }
    const std::vector<lang::Stmt> &statements() const { return ast.blocks[ast.root].stmts; }
};

std::string replaced(std::string text, Span span, std::string_view by) {
    return text.replace(span.begin, span.end - span.begin, by);
}

std::string ended(std::string text) {
    if (!text.empty() && text.back() != '\n') text += '\n';
    return text;
}

constexpr std::string_view view_mark = "// view ";

// The camera of a line `// view N: camera(…)`, else nothing.
std::optional<std::string> view_of_line(std::string_view line) {
    if (!line.starts_with(view_mark)) return std::nullopt;
    line.remove_prefix(view_mark.size());
    const std::size_t digits = std::min(line.find_first_not_of("0123456789"), line.size());
    if (digits == 0 || !line.substr(digits).starts_with(": camera(")) return std::nullopt;
    return std::string(line.substr(digits + 2));
}

template <class F> void each_line(const std::string &text, F take) { // with its line end
    for (std::size_t begin = 0; begin < text.size();) {
        const std::size_t end = std::min(text.find('\n', begin), text.size() - 1) + 1;
        take(std::string_view(text).substr(begin, end - begin));
        begin = end;
    }
}

std::string_view without_end(std::string_view line) {
    while (!line.empty() && (line.back() == '\n' || line.back() == '\r')) line.remove_suffix(1);
    return line;
}

} // namespace

std::optional<std::string> with_param(const std::string &text, std::string_view name,
                                      std::string_view value) {
    const Tree tree(text);
    for (const lang::Stmt &statement : tree.statements())
        if (const auto *param = std::get_if<lang::Param>(&statement.kind))
            if (param->name.text == name)
                return replaced(text, tree.ast.exprs[param->value].span, value);
    return std::nullopt;
}

std::string with_camera(const std::string &text, std::string_view camera) {
    const Tree tree(text);
    std::optional<Span> found;
    for (const lang::Stmt &statement : tree.statements()) {
        const auto *expression = std::get_if<lang::ExprStmt>(&statement.kind);
        if (!expression) continue;
        const lang::Expr &value = tree.ast.exprs[expression->value];
        const auto *call = std::get_if<lang::Call>(&value.kind);
        if (!call) continue;
        const auto *callee = std::get_if<lang::Name>(&tree.ast.exprs[call->callee].kind);
        if (callee && callee->text == "camera") found = value.span;
    }
    if (found) return replaced(text, *found, camera);
    return ended(text) + std::string(camera) + "\n";
}

std::string with_views(const std::string &text, const std::vector<std::string> &cameras) {
    std::string result;
    each_line(text, [&](std::string_view line) {
        if (!view_of_line(without_end(line))) result += line;
    });
    if (!cameras.empty()) result = ended(std::move(result));
    for (std::size_t i = 0; i < cameras.size(); ++i)
        result += std::string(view_mark) + std::to_string(i + 2) + ": " + cameras[i] + "\n";
    return result;
}

std::vector<std::string> views_in(const std::string &text) {
    std::vector<std::string> views;
    each_line(text, [&](std::string_view line) {
        if (auto camera = view_of_line(without_end(line))) views.push_back(std::move(*camera));
    });
    return views;
}

} // namespace fathom::driver
