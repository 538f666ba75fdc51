// Where things are: definitions, references, symbols, the files that a text names.
#include "lsp/requests.h"

#include <algorithm>

namespace fathom::lsp {
namespace {

// In the protocol's numbers.
int kind_of(v1::SymbolKind kind) {
    switch (kind) {
    case v1::SymbolKind::Module: return 2;
    case v1::SymbolKind::Function: return 12;
    case v1::SymbolKind::Variable: return 13;
    case v1::SymbolKind::Constant: return 14;
    }
    return 13;
}

Json tree(const Lines &lines, const std::vector<v1::DocumentSymbol> &symbols) {
    Json all = Json::array();
    for (const v1::DocumentSymbol &symbol : symbols) {
        Json one{{"name", symbol.name},
                 {"kind", kind_of(symbol.kind)},
                 {"range", range_json(lines, symbol.whole)},
                 {"selectionRange", range_json(lines, symbol.at)}};
        if (!symbol.inside.empty()) one["children"] = tree(lines, symbol.inside);
        all.push_back(std::move(one));
    }
    return all;
}

} // namespace

Json definition(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const auto place = taken(
        session.workspace.definition(text.path, offset_of(session, text, params.at("position"))));
    return place ? Places(session).location(*place) : Json();
}

Json references(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    const Json context = params.value("context", Json::object());
    Json all = Json::array();
    Places places(session);
    for (const v1::Location &place : taken(session.workspace.references(
             text.path, offset_of(session, text, params.at("position")),
             context.value("includeDeclaration", true))))
        all.push_back(places.location(place));
    return all;
}

Json highlights(Session &session, const Json &params) {
    constexpr int read = 2, write = 3;
    OpenText &text = text_of(session, params);
    Json all = Json::array();
    for (const v1::Highlight &one : taken(session.workspace.highlights(
             text.path, offset_of(session, text, params.at("position")))))
        all.push_back({{"range", range_json(lines_of(session, text), one.at)},
                       {"kind", one.written ? write : read}});
    return all;
}

Json document_symbols(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    return tree(lines_of(session, text), taken(session.workspace.symbols(text.path)));
}

Json workspace_symbols(Session &session, const Json &params) {
    Json all = Json::array();
    Places places(session);
    for (const v1::WorkspaceSymbol &symbol :
         taken(session.workspace.find_symbols(params.at("query"))))
        all.push_back({{"name", symbol.name},
                       {"kind", kind_of(symbol.kind)},
                       {"location", places.location(symbol.at)}});
    return all;
}

Json document_links(Session &session, const Json &params) {
    OpenText &text = text_of(session, params);
    Json all = Json::array();
    for (const v1::DocumentLink &link : taken(session.workspace.links(text.path)))
        all.push_back({{"range", range_json(lines_of(session, text), link.at)},
                       {"target", uri_of(link.path)}});
    return all;
}

} // namespace fathom::lsp
