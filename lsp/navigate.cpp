// Where things are: definitions, references, symbols.
#include "lsp/kept.h"
#include "lsp/requests.h"
#include "lsp/targets.h"

#include "driver/compile.h"

#include <algorithm>
#include <cctype>

namespace fathom::lsp {
namespace {

constexpr int symbol_module = 2, symbol_function = 12, symbol_variable = 13, symbol_constant = 14;

int symbol_kind(const Declaration &declaration) {
    if (declaration.function) return symbol_function;
    switch (declaration.by) {
    case DeclaredBy::Function: return symbol_function;
    case DeclaredBy::Import: return symbol_module;
    case DeclaredBy::Let: return symbol_constant;
    case DeclaredBy::Var:
    case DeclaredBy::Param:
    case DeclaredBy::Parameter:
    case DeclaredBy::Loop: return symbol_variable;
    }
    return symbol_variable;
}

Json location(const Lines &lines, const std::string &path, Span at) {
    return {{"uri", uri_of(path)}, {"range", range_json(lines, at)}};
}

Json library_location(const std::string &name, const std::string &module) {
    for (const typecheck::LibraryFile &file : driver::standard_library()) {
        if (file.prelude ? !module.empty() : module != file.name) continue;
        for (const std::string &start : {"fn " + name + "(", "let " + name + " "}) {
            const std::size_t at = ("\n" + std::string(file.text)).find("\n" + start);
            if (at == std::string::npos) continue;
            std::string base(file.name);
            if (!base.ends_with(".sdf")) base += ".sdf";
            const auto path = kept_file("library/" + base, file.text);
            if (!path) return nullptr;
            const std::size_t begin = at + start.find(' ') + 1;
            return {{"uri", uri_of(path->string())},
                    {"range", json_of(range_of(lines_of(file.text), begin, begin + name.size()))}};
        }
    }
    return nullptr;
}

// Declarations by where their statement begins, without those that are in no list of symbols.
using ByStatement = std::map<std::uint32_t, const Declaration *>;

ByStatement by_statement(const Names &names) {
    ByStatement all;
    for (const Declaration &declared : names.declarations)
        if (!declared.name.empty() && declared.by != DeclaredBy::Parameter &&
            declared.by != DeclaredBy::Loop)
            all[declared.statement.begin] = &declared;
    return all;
}

Json symbol_tree(const Reading &read, const ByStatement &declarations, const lang::Block &block) {
    Json all = Json::array();
    for (const lang::Stmt &stmt : block.stmts) {
        if (const auto found = declarations.find(stmt.span.begin);
            found != declarations.end() && found->second->statement == stmt.span) {
            const Declaration &declared = *found->second;
            Json symbol{{"name", declared.name},
                        {"kind", symbol_kind(declared)},
                        {"range", range_json(read.lines, stmt.span)},
                        {"selectionRange", range_json(read.lines, declared.at)}};
            if (declared.function) {
                Json inner = symbol_tree(
                    read, declarations,
                    read.syntax.ast.blocks[read.syntax.ast.functions[declared.function].body]);
                if (!inner.empty()) symbol["children"] = std::move(inner);
            }
            all.push_back(std::move(symbol));
        }
    }
    return all;
}

} // namespace

Json definition(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    const std::size_t offset = offset_of(document, params);
    const File file = file_of(document);
    const Names &names = file.reading->names;
    for (std::size_t import : names.open_imports) {
        const Declaration &declared = names.declarations[import];
        if (declared.at.begin > offset || declared.at.end < offset) continue;
        const auto imported = file_at(workspace, imported_path(file.path, declared.path));
        return imported ? location(imported->reading->lines, imported->path, {}) : Json();
    }
    if (const auto target = target_at(workspace, file, offset)) {
        const auto home = file_at(workspace, target->path);
        return location(home->reading->lines, home->path,
                        home->reading->names.declarations[target->declaration].at);
    }
    const Use *use = names.use_at(offset);
    if (!use || use->as == UsedAs::Argument) return nullptr;
    return library_location(use->name,
                            use->module ? names.declarations[*use->module].path : std::string());
}

Json references(Workspace &workspace, const Json &params) {
    Document &document = document_of(workspace, params);
    const auto target = target_at(workspace, file_of(document), offset_of(document, params));
    Json all = Json::array();
    if (!target) return all;
    const Json context = params.value("context", Json::object());
    const bool declaration = context.value("includeDeclaration", true);
    for (const Mention &mention : mentions_of(workspace, *target, all_files(workspace)))
        if (declaration || !mention.declared)
            all.push_back(location(file_at(workspace, mention.path)->reading->lines, mention.path,
                                   mention.at));
    return all;
}

Json highlights(Workspace &workspace, const Json &params) {
    constexpr int read = 2, write = 3;
    Document &document = document_of(workspace, params);
    const File file = file_of(document);
    const auto target = target_at(workspace, file, offset_of(document, params));
    Json all = Json::array();
    if (!target) return all;
    for (const Mention &mention : mentions_of(workspace, *target, {file}))
        if (mention.path == file.path)
            all.push_back({{"range", range_json(file.reading->lines, mention.at)},
                           {"kind", mention.written ? write : read}});
    return all;
}

Json document_symbols(Workspace &workspace, const Json &params) {
    const Reading &read = reading(document_of(workspace, params));
    return symbol_tree(read, by_statement(read.names),
                       read.syntax.ast.blocks[read.syntax.ast.root]);
}

Json workspace_symbols(Workspace &workspace, const Json &params) {
    const std::string query = params.at("query");
    const auto fits = [&query](const std::string &name) { // its letters, in this order
        std::size_t at = 0;
        for (char c : query) {
            while (at < name.size() && std::tolower(static_cast<unsigned char>(name[at])) !=
                                           std::tolower(static_cast<unsigned char>(c)))
                ++at;
            if (at++ >= name.size()) return false;
        }
        return true;
    };
    Json all = Json::array();
    for (const File &file : all_files(workspace))
        for (const Declaration &declared : file.reading->names.declarations)
            if (declared.top_level && !declared.name.empty() && fits(declared.name))
                all.push_back(
                    {{"name", declared.name},
                     {"kind", symbol_kind(declared)},
                     {"location", location(file.reading->lines, file.path, declared.at)}});
    return all;
}

} // namespace fathom::lsp
