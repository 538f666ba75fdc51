#include "lsp/serve.h"

#include "lsp/preview.h"
#include "lsp/transport.h"
#include "lsp/worker.h"

#include <algorithm>
#include <deque>

namespace fathom::lsp {

namespace {

constexpr int quiet_ms = 3; // for which nothing is said before a text is compiled unasked

// Whether what the server is at is still wanted beside a message that has come: a request until it
// is taken back or a text changes; the diagnostics of an idle server until a text changes or
// something is asked, which need not wait for them.
Wanted wanted_beside(const Json &in_hand, const Json &message) {
    const auto member = [](const Json &json, const char *name) {
        return json.is_object() ? json.value(name, Json()) : Json();
    };
    const Json id = member(in_hand, "id"), method = member(message, "method");
    if (!method.is_string()) return Wanted::Still; // an answer to us
    const bool changes = method == "textDocument/didChange" || method == "textDocument/didClose";
    if (in_hand.is_null())
        return changes || message.contains("id") || method == "exit" ? Wanted::Modified
                                                                     : Wanted::Still;
    if (id.is_null()) return Wanted::Still; // a notification has no answer
    if (method == "$/cancelRequest" && member(member(message, "params"), "id") == id)
        return Wanted::TakenBack;
    return changes ? Wanted::Modified : Wanted::Still;
}

} // namespace

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
    Json in_hand;                       // the message that the server is at; null: none
    std::deque<std::string> unforeseen; // came meanwhile
    server.client.descriptor = in;
    server.client.heard = [&] {
        Wanted wanted = Wanted::Still;
        do {
            std::optional<std::string> message = transport.read();
            if (!message) {
                open = false;
                server.client.descriptor = -1;
                break;
            }
            const Json json = Json::parse(*message, nullptr, false);
            if (wanted == Wanted::Still) wanted = wanted_beside(in_hand, json);
            unforeseen.push_back(*message);
            waiting.push_back(std::move(*message));
        } while (transport.pending());
        return wanted;
    };
    const auto foresee = [&] { // what could not be said while the server was busy
        for (; !unforeseen.empty(); unforeseen.pop_front()) server.foresee(unforeseen.front());
    };
    while (!server.ended()) {
        foresee();
        while (open && transport.pending()) open = receive();
        if (waiting.empty()) {
            // After a letter clients ask for something at once; what they wait for comes first.
            pollfd more{in, POLLIN, 0};
            if (open && ::poll(&more, 1, quiet_ms) > 0) {
                open = receive();
                continue;
            }
            if (!send(server.idle())) break;
            if (!waiting.empty()) continue;
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
        in_hand = json;
        if (!previews.handle(json, server.texts(), answers)) answers = server.handle(message);
        in_hand = nullptr;
        previews.follow(json, server.texts());
        if (!send(answers)) break;
    }
    return server.exit_status();
}

} // namespace fathom::lsp
