// Where things are: definitions, references, symbols.
#include "api/language/features.h"
#include "api/language/targets.h"

#include "driver/compile.h"

#include <algorithm>
#include <cctype>

namespace fathom::language {
namespace {

using v1::SymbolKind;

SymbolKind symbol_kind(const Declaration &declaration) {
    if (declaration.function) return SymbolKind::Function;
    switch (declaration.by) {
    case DeclaredBy::Function: return SymbolKind::Function;
    case DeclaredBy::Import: return SymbolKind::Module;
    case DeclaredBy::Let: return SymbolKind::Constant;
    case DeclaredBy::Var:
    case DeclaredBy::Param:
    case DeclaredBy::Parameter:
    case DeclaredBy::Loop: return SymbolKind::Variable;
    }
    return SymbolKind::Variable;
}

std::optional<v1::Location> library_location(const std::string &name, const std::string &module) {
    for (const typecheck::LibraryFile &file : driver::standard_library()) {
        if (file.prelude ? !module.empty() : module != file.name) continue;
        for (const std::string &start : {"fn " + name + "(", "let " + name + " "}) {
            const std::size_t at = ("\n" + std::string(file.text)).find("\n" + start);
            if (at == std::string::npos) continue;
            const std::size_t begin = at + start.find(' ') + 1;
            return v1::Location{std::string(file.name), {begin, begin + name.size()}, true};
        }
    }
    return std::nullopt;
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

std::vector<v1::DocumentSymbol> symbol_tree(const Reading &read, const ByStatement &declarations,
                                            const lang::Block &block) {
    std::vector<v1::DocumentSymbol> all;
    for (const lang::Stmt &stmt : block.stmts) {
        const auto found = declarations.find(stmt.span.begin);
        if (found == declarations.end() || found->second->statement != stmt.span) continue;
        const Declaration &declared = *found->second;
        all.push_back({declared.name,
                       symbol_kind(declared),
                       stretch_of(stmt.span),
                       stretch_of(declared.at),
                       {}});
        if (declared.function)
            all.back().inside = symbol_tree(
                read, declarations,
                read.syntax.ast.blocks[read.syntax.ast.functions[declared.function].body]);
    }
    return all;
}

} // namespace

std::optional<v1::Location> definition(Workspace &workspace, Document &document, std::size_t at) {
    const File file = file_of(document);
    const Names &names = file.reading->names;
    for (std::size_t import : names.open_imports) {
        const Declaration &declared = names.declarations[import];
        if (declared.at.begin > at || declared.at.end < at) continue;
        const auto imported = file_at(workspace, imported_path(file.path, declared.path));
        return imported ? std::optional(v1::Location{imported->path, {}, false}) : std::nullopt;
    }
    if (const auto target = target_at(workspace, file, at)) {
        const auto home = file_at(workspace, target->path);
        return v1::Location{home->path,
                            stretch_of(home->reading->names.declarations[target->declaration].at),
                            false};
    }
    const Use *use = names.use_at(at);
    if (!use || use->as == UsedAs::Argument) return std::nullopt;
    return library_location(use->name,
                            use->module ? names.declarations[*use->module].path : std::string());
}

std::vector<v1::Location> references(Workspace &workspace, Document &document, std::size_t at,
                                     bool with_declaration) {
    std::vector<v1::Location> all;
    const auto target = target_at(workspace, file_of(document), at);
    if (!target) return all;
    for (const Mention &mention : mentions_of(workspace, *target, all_files(workspace)))
        if (with_declaration || !mention.declared)
            all.push_back({mention.path, stretch_of(mention.at), false});
    return all;
}

std::vector<v1::Highlight> highlights(Workspace &workspace, Document &document, std::size_t at) {
    const File file = file_of(document);
    const auto target = target_at(workspace, file, at);
    std::vector<v1::Highlight> all;
    if (!target) return all;
    for (const Mention &mention : mentions_of(workspace, *target, {file}))
        if (mention.path == file.path) all.push_back({stretch_of(mention.at), mention.written});
    return all;
}

std::vector<v1::DocumentSymbol> symbols(Document &document) {
    const Reading &read = reading(document);
    return symbol_tree(read, by_statement(read.names),
                       read.syntax.ast.blocks[read.syntax.ast.root]);
}

std::vector<v1::WorkspaceSymbol> find_symbols(Workspace &workspace, const std::string &query) {
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
    std::vector<v1::WorkspaceSymbol> all;
    for (const File &file : all_files(workspace))
        for (const Declaration &declared : file.reading->names.declarations)
            if (declared.top_level && !declared.name.empty() && fits(declared.name))
                all.push_back({declared.name,
                               symbol_kind(declared),
                               {file.path, stretch_of(declared.at), false}});
    return all;
}

} // namespace fathom::language
