// A language server: one message in, some messages out. What it answers comes of the library's
// workspace (fathom/language.h); unsaved texts are what is compiled. Reads files that scenes import and the scenes of the client's folders;
// writes none but copies of the library's texts, for a client that wants to see them.
#pragma once

#include "lsp/session.h"

#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace fathom::lsp {

// Of a request in hand: whether its answer is wanted, and if not, why.
enum class Wanted : char { Still = 's', TakenBack = 't', Modified = 'm' }; // the text was edited

class Server {
  public:
    Server() = default;
    Server(const Server &) = delete;
    Server &operator=(const Server &) = delete;

    // Messages to send, for one that came. What is no JSON, or no request that is known, gets an
    // error for an answer; nothing ends the server but the notification `exit`.
    std::vector<std::string> handle(const std::string &message);

    // Messages that can wait until nothing more has come: the diagnostics of what has changed. What
    // was found outdated stays to be done.
    std::vector<std::string> idle();

    // Whether somebody still waits for what `handle` or `idle` is at: asked while a text is
    // compiled. If not, the request is answered with an error, and the diagnostics are left for later.
    void ask_whether_wanted(std::function<Wanted()> ask) {
        session_.workspace.set_outdated(
            [this, ask = std::move(ask)] { return (wanted_ = ask()) != Wanted::Still; });
    }

    // Looks at a message that will be handled later: where it takes a request back, that is answered
    // as cancelled once its turn comes.
    void foresee(const std::string &message);

    bool ended() const { return ended_; }
    int exit_status() const { return shut_down_ ? 0 : 1; } // as the protocol wants it

  private:
    Json answer(const std::string &method, const Json &params, bool &known);
    Json initialize(const Json &params);
    void notified(const std::string &method, const Json &params);
    void edited(const Json &params);
    void opened(const Json &params);
    void changed(const std::vector<std::string> &paths);
    void send(const char *method, Json params);

    Session session_;
    std::vector<std::string> outbox_; // what goes out before the answer
    std::set<std::string> cancelled_; // ids of requests, as JSON
    Wanted wanted_ = Wanted::Still;   // as last asked
    bool watches_ = false;            // the client can tell of files that change
    bool shut_down_ = false, ended_ = false;
};

} // namespace fathom::lsp
