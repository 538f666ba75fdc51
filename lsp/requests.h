// The requests of the protocol, a function each: its parameters in, its result out. What is missing
// or of another type in the parameters throws, which the server answers with an error.
#pragma once

#include "lsp/json.h"
#include "lsp/workspace.h"

namespace fathom::lsp {

// A request that cannot be done: its message is for the user.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

// Places of a document and of the request's parameters.
Document &document_of(Workspace &workspace, const Json &params);
std::size_t offset_of(const Document &document, const Json &params);
Json place_of(const Document &document, const fathom::v1::Place &place);
Json range_json(std::string_view text, Span span);

// diagnose.cpp
Json diagnostics_of(Workspace &workspace, Document &document);
Json diagnostic_json(const Document &document, const fathom::v1::Diagnostic &diagnostic);

// facts.cpp: what is proved
Json hover(Workspace &workspace, const Json &params);
Json inlay_hints(Workspace &workspace, const Json &params);
Json code_lenses(Workspace &workspace, const Json &params);
std::string explanation(Workspace &workspace, Document &document); // of the bounds, a line a step

// complete.cpp
Json completion(Workspace &workspace, const Json &params);
Json signature_help(Workspace &workspace, const Json &params);

// navigate.cpp
Json definition(Workspace &workspace, const Json &params);
Json references(Workspace &workspace, const Json &params);
Json highlights(Workspace &workspace, const Json &params);
Json document_symbols(Workspace &workspace, const Json &params);
Json workspace_symbols(Workspace &workspace, const Json &params);

// rename.cpp
Json prepare_rename(Workspace &workspace, const Json &params);
Json rename(Workspace &workspace, const Json &params);

// structure.cpp
Json semantic_legend();
Json semantic_tokens(Workspace &workspace, const Json &params);
Json folding_ranges(Workspace &workspace, const Json &params);
Json selection_ranges(Workspace &workspace, const Json &params);
Json document_colors(Workspace &workspace, const Json &params);
Json color_presentations(Workspace &workspace, const Json &params);

// formatting.cpp
Json formatting(Workspace &workspace, const Json &params);
Json range_formatting(Workspace &workspace, const Json &params);
Json on_type_formatting(Workspace &workspace, const Json &params);

// actions.cpp
Json code_actions(Workspace &workspace, const Json &params);

} // namespace fathom::lsp
