// The requests of the protocol, a function each: its parameters in, its result out. The table is
// requests.def. What is missing or of another type in the parameters throws, which the server
// answers with an error.
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
Json place_of(Document &document, const fathom::v1::Place &place);
Json range_json(const Lines &lines, Span span);

Json diagnostics_of(Workspace &workspace, Document &document);
Json diagnostic_json(Document &document, const fathom::v1::Diagnostic &diagnostic);
Json semantic_legend(); // the kinds and modifiers of semantic tokens, as they are numbered

#define FATHOM_REQUEST(function, ...) Json function(Workspace &workspace, const Json &params);
#include "lsp/requests.def"
#undef FATHOM_REQUEST

} // namespace fathom::lsp
