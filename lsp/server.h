// A language server: one message in, some messages out. What it answers comes of the library
// (include/fathom) and of the open texts alone; unsaved texts are what is compiled. Reads and
// writes nothing but the files that scenes import.
#pragma once

#include "lsp/document.h"

#include <fathom/fathom.h>

#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

namespace fathom::lsp {

// A text that a client has open.
struct Document {
    std::string path, text;
    int version = 0;
    // Of the text as it is: compiled when it is first wanted.
    std::optional<fathom::v1::CompileResult> compiled;
    bool published = false; // its diagnostics were sent
};

class Server {
  public:
    Server();
    ~Server();

    // Messages to send, for one that came. What is no JSON, or no request that is known, gets an
    // error for an answer; nothing ends the server but the notification `exit`.
    std::vector<std::string> handle(const std::string &message);

    // Messages that can wait until nothing more has come: the diagnostics of what has changed.
    std::vector<std::string> idle();

    bool ended() const { return ended_; }
    int exit_status() const { return shut_down_ ? 0 : 1; } // as the protocol wants it

  private:
    using Json = nlohmann::json;

    Json answer(const std::string &method, const Json &params, bool &known);
    void notified(const std::string &method, const Json &params);
    void changed(Document &document);
    const fathom::v1::CompileResult &compiled(Document &document);
    Document *document_of(const Json &params);
    Json diagnostic_of(const Document &document, const fathom::v1::Diagnostic &diagnostic) const;
    Json place_of(const Document &document, const fathom::v1::Place &place) const;

    Json initialize() const;
    Json hover(const Json &params);
    Json completion(const Json &params);
    Json definition(const Json &params);
    Json symbols(const Json &params);
    Json formatting(const Json &params);
    Json code_actions(const Json &params);
    Json inlay_hints(const Json &params);

    std::map<std::string, Document> documents_; // by address
    std::vector<fathom::v1::LibraryEntry> library_;
    bool shut_down_ = false, ended_ = false;
};

} // namespace fathom::lsp
