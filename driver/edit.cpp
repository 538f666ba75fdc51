#include "driver/edit.h"

#include "lang/parse.h"
#include "save-format/save_format.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::driver {
namespace {

struct Tree {
    Sources sources;
    lang::Ast ast;
    Diagnostics diagnostics; // told elsewhere
    explicit Tree(const std::string &text) {
        const SourceId source = sources.add("", text);
        ast = lang::parse(sources, source, diagnostics);
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

const lang::Param *param_named(const Tree &tree, std::string_view name) {
    for (const lang::Stmt &statement : tree.statements())
        if (const auto *param = std::get_if<lang::Param>(&statement.kind))
            if (param->name.text == name) return param;
    return nullptr;
}

// The unit of the first number in an expression that has one: `-30deg`, `[0, 45deg, 0]`.
std::string unit_in(const lang::Ast &ast, lang::ExprId id) {
    const lang::ExprKind &kind = ast.exprs[id].kind;
    if (const auto *number = std::get_if<lang::Number>(&kind)) return std::string(number->unit);
    if (const auto *unary = std::get_if<lang::Unary>(&kind)) return unit_in(ast, unary->operand);
    if (const auto *list = std::get_if<lang::List>(&kind))
        for (const lang::ExprId item : list->items)
            if (std::string unit = unit_in(ast, item); !unit.empty()) return unit;
    return "";
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
    const lang::Param *param = param_named(tree, name);
    if (!param) return std::nullopt;
    return replaced(text, tree.ast.exprs[param->value].span, value);
}

bool can_be_read(const std::string &text) { return !Tree(text).diagnostics.has_errors(); }

Notation notation_of_param(const std::string &text, std::string_view name) {
    const Tree tree(text);
    const lang::Param *param = param_named(tree, name);
    if (!param) return {};
    Notation notation;
    notation.hex = std::holds_alternative<lang::Color>(tree.ast.exprs[param->value].kind);
    notation.unit = unit_in(tree.ast, param->value);
    if (notation.unit == "rad") notation.unit.clear();
    return notation;
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
        result += fmt::format("{}{}: {}\n", view_mark, i + 2, cameras[i]);
    return result;
}

std::vector<std::string> views_in(const std::string &text) {
    std::vector<std::string> views;
    each_line(text, [&](std::string_view line) {
        if (auto camera = view_of_line(without_end(line))) views.push_back(std::move(*camera));
    });
    return views;
}

bool is_save_file(const std::filesystem::path &file) {
    return file.extension() == ".yaml" || file.extension() == ".yml";
}

// The language's text is the middle of the way, so all that an import keeps is in the file again.
std::variant<std::string, EditError> save_file_with_camera(const std::string &yaml,
                                                           std::string_view camera,
                                                           const std::filesystem::path &folder,
                                                           const CompileOptions &options) {
    const auto first_error = [](const Diagnostics &diagnostics) {
        for (const Diagnostic &diagnostic : diagnostics.sorted())
            if (diagnostic.severity == Severity::Error) return diagnostic.message;
        return std::string("it holds no scene");
    };
    Sources sources;
    Diagnostics reading;
    const SourceId source = sources.add("", yaml);
    const save::ImportResult imported = save::import_yaml(sources, source, reading);
    if (reading.has_errors()) return EditError{first_error(reading)};
    const Compilation compilation =
        compile_text("", with_camera(imported.sdf, camera), folder, options);
    if (!compilation.good()) return EditError{first_error(compilation.diagnostics)};
    Diagnostics writing;
    std::string text = save::export_yaml(compilation.scene, writing, {options.limits, {}});
    for (const Diagnostic &remark : writing.sorted()) // a note says what is kept under labels
        if (remark.severity != Severity::Note)
            return EditError{"the save format has no place for all of it: " + remark.message};
    return text;
}

} // namespace fathom::driver
