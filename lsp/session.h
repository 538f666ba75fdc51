// The open texts as the client names them, by addresses and by lines and UTF-16 units, and the
// workspace that knows what they mean, by paths and bytes (fathom/language.h).
#pragma once

#include "lsp/json.h"

#include <fathom/language.h>

#include <map>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fathom::lsp {

// An open text. What it says is the workspace's.
struct OpenText {
    std::string uri, path;
    int version = 0;
    bool published = false;     // its diagnostics were sent
    std::optional<Lines> lines; // of the text as it is; made when they are first wanted
};

struct Session {
    v1::Workspace workspace;
    std::map<std::string, OpenText> texts;          // by address
    bool snippets = false;                          // the client takes snippets from completion
    std::vector<std::pair<std::string, Json>> said; // methods and params that go before the answer
};

// What becomes of a request that has no answer.
struct UnknownDocument : std::exception {
    const char *what() const noexcept override { return "this text is not open"; }
};
struct Outdated : std::exception { // nobody waits for it any more
    const char *what() const noexcept override { return "no longer wanted"; }
};
struct Refusal : std::runtime_error { // its message is for the user
    using std::runtime_error::runtime_error;
};

// The workspace's answer, or what it says in place of one is thrown.
template <class T> T taken(v1::Answer<T> answer) {
    switch (answer.outcome) {
    case v1::Outcome::Answered: break;
    case v1::Outcome::NotOpen: throw UnknownDocument();
    case v1::Outcome::Refused: throw Refusal(answer.why);
    case v1::Outcome::Outdated: throw Outdated();
    case v1::Outcome::Failed: throw std::runtime_error(answer.why);
    }
    return std::move(answer.value);
}

// The text of a request, and bytes of it.
OpenText &text_of(Session &session, const Json &params);
const Lines &lines_of(Session &session, OpenText &text);
std::size_t offset_of(Session &session, OpenText &text, const Json &position);
v1::Stretch stretch_of(Session &session, OpenText &text, const Json &range);
Json range_json(const Lines &lines, v1::Stretch at);

// Places of other texts, within one request: each of their texts is looked at once.
class Places {
  public:
    explicit Places(Session &session) : session_(session) {}
    std::string uri(const std::string &path) const; // as the client has it, if that is open
    Json edits(const v1::WorkspaceEdit &changes);   // WorkspaceEdit
    Json location(const v1::Location &place);       // null where there is no such text

  private:
    const Lines *lines(const std::string &path); // null where there is no such text
    Session &session_;
    std::map<std::string, Lines> closed_;
};

Json edits_json(const Lines &lines, const std::vector<v1::TextEdit> &edits);

} // namespace fathom::lsp
