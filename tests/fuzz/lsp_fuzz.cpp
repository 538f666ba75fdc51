// libFuzzer target of the language server: whatever is sent, each request is answered once, by its
// number, with what can be sent as JSON, and only `exit` ends the server.
//
// The input is a text, and after a line `//==== session` what is done with it, a line each:
//   {…}             a message as it stands
//   + L C L C TEXT  the stretch between two positions becomes TEXT, in which `|` is a new line
//   R L C           the request number R (modulo how many there are) at a position
//   anything else   all requests, at the position that the line's length makes
// Without that line a quarter of the requests, which the text's length chooses, are made at a place
// in the middle.
#include "lsp/server.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

namespace {

using Json = nlohmann::json;

const std::vector<std::string> methods{
#define FATHOM_REQUEST(function, method, ...) method,
#include "lsp/requests.def"
#undef FATHOM_REQUEST
};

[[noreturn]] void wrong(const std::string &what, const std::string &message) {
    std::fprintf(stderr, "lsp_fuzz: %s: %s\n", what.c_str(), message.c_str());
    std::abort();
}

struct Session {
    fathom::lsp::Server server;
    int number = 0;
    Json document{{"uri", "file:///nowhere/fuzz.sdf"}};

    void send(const Json &message) {
        send(message.dump(-1, ' ', false, Json::error_handler_t::replace));
    }
    void send(const std::string &message) {
        const Json sent = Json::parse(message, nullptr, false);
        const bool request = sent.is_object() && sent.contains("id") && sent.contains("method") &&
                             sent["method"].is_string();
        int answers = 0;
        for (const std::string &said : server.handle(message)) {
            const Json answer = Json::parse(said, nullptr, false);
            if (answer.is_discarded()) wrong("no JSON was said", said);
            if (answer.contains("method")) continue;
            ++answers;
            if (request && answer.at("id") != sent["id"]) wrong("the answer to another", said);
            // our own fault, unlike what is malformed or cannot be done
            if (answer.contains("error") && answer["error"].at("code") == -32603)
                wrong("a request failed", said);
        }
        if (request && answers != 1) wrong("no answer, or several", message);
    }
    void idle() {
        for (const std::string &said : server.idle())
            if (Json::parse(said, nullptr, false).is_discarded()) wrong("no JSON was said", said);
    }
    // With all that any request may want to know.
    void request(std::size_t which, int line, int character) {
        const Json at{{"line", line}, {"character", character}},
            range{{"start", {{"line", line / 2}, {"character", 0}}}, {"end", at}};
        send(Json{{"jsonrpc", "2.0"},
                  {"id", ++number},
                  {"method", methods[which % methods.size()]},
                  {"params",
                   {{"textDocument", document},
                    {"position", at},
                    {"positions", {at}},
                    {"range", range},
                    {"options", {{"tabSize", 2}, {"insertSpaces", true}}},
                    {"ch", line % 2 ? "}" : "\n"},
                    {"context", {{"diagnostics", Json::array()}, {"includeDeclaration", true}}},
                    {"color", {{"red", 1}, {"green", 0.5}, {"blue", 0}, {"alpha", 1}}},
                    {"newName", "other"},
                    {"query", "a"},
                    {"command", "fathom.explain"},
                    {"arguments", {document["uri"]}}}}});
    }
    void all_requests(int line, int character) {
        for (std::size_t i = 0; i < methods.size(); ++i) request(i, line, character);
    }
};

void run(Session &session, const std::string &line) {
    std::istringstream in(line);
    if (line.starts_with("{")) {
        session.send(line);
        return;
    }
    if (line.starts_with("+ ")) {
        int a = 0, b = 0, c = 0, d = 0;
        char sign = 0;
        if (!(in >> sign >> a >> b >> c >> d)) return;
        in.get();
        std::string text;
        std::getline(in, text);
        for (char &each : text)
            if (each == '|') each = '\n';
        session.send(Json{{"jsonrpc", "2.0"},
                          {"method", "textDocument/didChange"},
                          {"params",
                           {{"textDocument", session.document},
                            {"contentChanges",
                             {{{"range",
                                {{"start", {{"line", a}, {"character", b}}},
                                 {"end", {{"line", c}, {"character", d}}}}},
                               {"text", text}}}}}}});
        return session.idle();
    }
    unsigned which = 0;
    int l = 0, c = 0;
    if (in >> which >> l >> c) return session.request(which, l, c);
    const int length = static_cast<int>(line.size());
    session.all_requests(length / 8, length % 8 * 4);
}

} // namespace

extern "C" int LLVMFuzzerInitialize(int *, char ***) {
    unsetenv("HOME"); // nothing is kept
    unsetenv("XDG_CACHE_HOME");
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t *data, std::size_t size) {
    std::string text(reinterpret_cast<const char *>(data), size), rest;
    if (const std::size_t end = text.find("\n//==== session"); end != text.npos) {
        rest = text.substr(end + 1);
        text.erase(end + 1);
        rest.erase(0, std::min(rest.find('\n'), rest.size() - 1) + 1);
    }
    Session session;
    session.send(Json{{"jsonrpc", "2.0"},
                      {"id", "start"},
                      {"method", "initialize"},
                      {"params", {{"rootUri", "file:///nowhere"}}}});
    Json opened = session.document;
    opened["text"] = text;
    session.send(Json{{"jsonrpc", "2.0"},
                      {"method", "textDocument/didOpen"},
                      {"params", {{"textDocument", opened}}}});
    session.idle();
    std::istringstream lines(rest);
    int count = 0;
    for (std::string line; std::getline(lines, line) && count < 40; ++count) run(session, line);
    if (rest.empty())
        for (std::size_t i = size % 4; i < methods.size(); i += 4)
            session.request(i, static_cast<int>(size / 64), static_cast<int>(size % 32));
    return 0;
}
