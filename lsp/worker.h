// The server in a process of its own. Where that ends in the middle of a request, by a fault of ours,
// the client is told so and the next message finds a new one, which knows the open texts. Used as
// the server is.
#pragma once

#include "lsp/json.h"
#include "lsp/server.h"
#include "lsp/transport.h"

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <sys/types.h>
#include <vector>

namespace fathom::lsp {

class Worker {
  public:
    Worker() = default;
    ~Worker();
    Worker(const Worker &) = delete;
    Worker &operator=(const Worker &) = delete;

    // As the server's. A request that ends the process is answered with an error, and the client is
    // shown a message.
    std::vector<std::string> handle(const std::string &message);
    std::vector<std::string> idle();
    void foresee(const std::string &message);
    bool ended() const { return ended_; }
    int exit_status() const { return exit_status_; }

    // Looked at while the process works. `heard` is called once the descriptor can be read, and says
    // whether what is in hand is still wanted; if not, it ends soon. -1: nothing is looked at.
    struct Client {
        int descriptor = -1;
        std::function<Wanted()> heard{};
    };
    Client client{};

    // `textDocument` of each open text, as it stands now.
    const std::map<std::string, Json> &texts() const { return opened_; }
    pid_t process() const { return process_; } // 0 where none runs

  private:
    bool start();
    void note(const Json &message);
    void wait();
    std::optional<std::vector<std::string>> ask(char what, const std::string &message);
    std::string failure(const std::string &what);

    pid_t process_ = 0;
    int socket_ = -1;
    std::optional<Transport> transport_;
    std::string cause_; // of the last end that was not wanted
    bool ended_ = false;
    int exit_status_ = 1;
    bool told_ = false; // the client was told, and nothing went well since

    // What a new process is told.
    std::string initialize_, shutdown_;  // messages; empty where there was none
    std::map<std::string, Json> opened_; // texts()
};

} // namespace fathom::lsp
