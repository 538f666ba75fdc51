// What editors ask of a text, a function each (fathom/language.h): the workspace, the text and places
// in it in, plain data out.
#pragma once

#include "api/language/workspace.h"

#include <stdexcept>

namespace fathom::language {

// A question that has no answer: its message is for the user.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

inline v1::Stretch stretch_of(Span span) { return {span.begin, span.end}; }

// facts.cpp
v1::Hover hover(Workspace &, Document &, std::size_t at);
std::vector<v1::BoundAt> bounds(Workspace &, Document &);
v1::Explanation why(Workspace &, Document &);
std::vector<v1::ArgumentName> argument_names(Workspace &, Document &, v1::Stretch within);

// complete.cpp
std::vector<v1::CompletionItem> completion(Workspace &, Document &, std::size_t at, bool snippets);
v1::SignatureHelp signature_help(Workspace &, Document &, std::size_t at);

// navigate.cpp
std::optional<v1::Location> definition(Workspace &, Document &, std::size_t at);
std::vector<v1::Location> references(Workspace &, Document &, std::size_t at,
                                     bool with_declaration);
std::vector<v1::Highlight> highlights(Workspace &, Document &, std::size_t at);
std::vector<v1::DocumentSymbol> symbols(Document &);
std::vector<v1::WorkspaceSymbol> find_symbols(Workspace &, const std::string &query);

// paths.cpp
std::vector<v1::DocumentLink> links(Document &);
v1::WorkspaceEdit rename_files(Workspace &, std::vector<v1::RenamedFile> files);

// rename.cpp
std::optional<v1::Stretch> renamable(Workspace &, Document &, std::size_t at);
v1::WorkspaceEdit rename(Workspace &, Document &, std::size_t at, const std::string &name);

// structure.cpp
std::vector<v1::SemanticToken> tokens(Workspace &, Document &, v1::Stretch within);
std::vector<v1::FoldingRange> folding(Document &);
std::vector<v1::Stretch> selections(Document &, std::size_t at);
std::vector<v1::ColorAt> colors(Workspace &, Document &);
std::vector<std::string> color_texts(const Workspace &, const std::array<double, 4> &rgba);

// formatting.cpp
std::vector<v1::TextEdit> format(Document &, v1::Stretch within);
std::vector<v1::TextEdit> format_typed(Document &, std::size_t at, char typed);

// actions.cpp
std::vector<v1::CodeAction> actions(Workspace &, Document &, v1::Stretch within,
                                    const v1::ActionKinds &kinds);

} // namespace fathom::language
