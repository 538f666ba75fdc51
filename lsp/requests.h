// The requests of the protocol, a function each: its parameters in, its result out. The table is
// requests.def. What is missing or of another type in the parameters throws, which the server
// answers with an error.
#pragma once

#include "lsp/session.h"

namespace fathom::lsp {

Json diagnostics_of(Session &session, OpenText &text);
Json diagnostic_json(Session &session, OpenText &text, const v1::Diagnostic &diagnostic);
Json semantic_legend(); // the kinds and modifiers of semantic tokens, as they are numbered

#define FATHOM_REQUEST(function, ...) Json function(Session &session, const Json &params);
#include "lsp/requests.def"
#undef FATHOM_REQUEST

} // namespace fathom::lsp
