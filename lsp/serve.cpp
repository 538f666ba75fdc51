#include "lsp/serve.h"

#include "lsp/preview.h"
#include "lsp/transport.h"
#include "lsp/worker.h"

#include <algorithm>
#include <deque>

namespace fathom::lsp {

int serve(int in, int out) {
    Transport transport(in, out);
    Worker server;
    Previews previews;
    std::deque<std::string> waiting;
    const auto send = [&](const std::vector<std::string> &messages) {
        return std::ranges::all_of(messages,
                                   [&](const std::string &m) { return transport.write(m); });
    };
    const auto receive = [&] {
        std::optional<std::string> message = transport.read();
        if (!message) return false;
        server.foresee(*message);
        waiting.push_back(std::move(*message));
        return true;
    };
    bool open = true;
    while (!server.ended()) {
        while (open && transport.pending()) open = receive();
        if (waiting.empty()) {
            if (!send(server.idle())) break;
            if (!open) break;
            if (!transport.pending()) { // until the client or a window says something
                std::vector<pollfd> all{{in, POLLIN, 0}};
                previews.wait_for(all);
                ::poll(all.data(), all.size(), -1);
            }
            if (!send(previews.heard())) break;
            if (transport.pending() && !receive()) break;
            continue;
        }
        const std::string message = std::move(waiting.front());
        waiting.pop_front();
        // the windows follow what the server was told, and open without it
        std::vector<std::string> answers;
        const Json json = Json::parse(message, nullptr, false);
        if (!previews.handle(json, server.texts(), answers)) answers = server.handle(message);
        previews.follow(json, server.texts());
        if (!send(answers)) break;
    }
    return server.exit_status();
}

} // namespace fathom::lsp
