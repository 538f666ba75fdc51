// The server's process ends where it should not: the client hears of it, and goes on.
#include "client.h"

#include "lsp/worker.h"

#include <csignal>
#include <fstream>
#include <sys/wait.h>
#include <unistd.h>

namespace {

using fathom::lsp::Worker;

std::string message(const std::string &method, const Json &params, int id = 0) {
    Json json{{"jsonrpc", "2.0"}, {"method", method}, {"params", params}};
    if (id) json["id"] = id;
    return json.dump();
}

// Ends the process as a fault would.
void crash(const Worker &worker) {
    REQUIRE(worker.process() > 0);
    REQUIRE(kill(worker.process(), SIGSEGV) == 0);
}

std::string hover_text(Worker &worker, int id) {
    const auto answers = worker.handle(message("textDocument/hover", Client::at(0, 1), id));
    REQUIRE(answers.size() == 1);
    const Json answer = Json::parse(answers[0]);
    CHECK(answer.at("id") == id);
    return answer.at("result").at("contents").at("value");
}

} // namespace

TEST_CASE("a crash in a request is a message, and the texts are still there") {
    Worker worker;
    worker.handle(message("initialize", Json::object(), 1));
    worker.handle(
        message("textDocument/didOpen",
                {{"textDocument",
                  {{"uri", "file:///scenes/a.sdf"}, {"version", 1}, {"text", "torus(1, 1)\n"}}}}));
    REQUIRE(worker.idle().size() == 1);
    worker.handle(message("textDocument/didChange",
                          {{"textDocument", {{"uri", "file:///scenes/a.sdf"}, {"version", 2}}},
                           {"contentChanges", {{{"range", range(0, 0, 5)}, {"text", "box"}}}}}));
    const std::string before = hover_text(worker, 2);
    CHECK(before.find("box(") != std::string::npos);

    crash(worker);
    const auto answers = worker.handle(message("textDocument/hover", Client::at(0, 1), 3));
    REQUIRE(answers.size() == 2);
    const Json said = Json::parse(answers[0]), failed = Json::parse(answers[1]);
    CHECK(said.at("method") == "window/showMessage");
    CHECK(failed.at("id") == 3);
    const std::string why = failed.at("error").at("message");
    CHECK(why.find("textDocument/hover") != std::string::npos);

    CHECK(hover_text(worker, 4) == before);
    const auto diagnostics = worker.idle(); // said anew, of the text as it was edited
    REQUIRE(diagnostics.size() == 1);
    CHECK(Json::parse(diagnostics[0]).at("params").at("version") == 2);
}

TEST_CASE("a crash that comes with every message is told once, and each request is answered") {
    Worker worker;
    worker.handle(message("initialize", Json::object(), 1));
    int shown = 0, logged = 0;
    for (int id = 2; id < 6; ++id) {
        crash(worker);
        const auto answers = worker.handle(message("workspace/symbol", {{"query", ""}}, id));
        REQUIRE(answers.size() == 2);
        shown += Json::parse(answers[0]).at("method") == "window/showMessage";
        logged += Json::parse(answers[0]).at("method") == "window/logMessage";
        CHECK(Json::parse(answers[1]).at("id") == id);
        CHECK(worker.idle().empty()); // nothing is tried before the next message
        worker.handle(message("$/setTrace", {{"value", "off"}}));
    }
    CHECK(shown == 1);
    CHECK(logged == 3);
    worker.handle(message("shutdown", nullptr, 9));
    crash(worker);
    worker.handle(message("$/setTrace", {{"value", "off"}}));
    worker.handle(message("exit", nullptr));
    CHECK(worker.ended());
    CHECK(worker.exit_status() == 0); // the shutdown is not forgotten
}

// A field whose proof asks many times whether it is still wanted.
static const char *const slow_text =
    "implicit(p => sin(7*p.x + sin(5*p.y)) * cos(6*p.z + sin(4*p.x*p.y)) * sin(p.x*p.z), "
    "within: ball(8))\n";

TEST_CASE("what the client no longer waits for is left") {
    Worker worker;
    worker.handle(message("initialize", Json::object(), 1));
    worker.handle(
        message("textDocument/didOpen",
                {{"textDocument",
                  {{"uri", "file:///scenes/a.sdf"}, {"version", 1}, {"text", slow_text}}}}));
    int client[2] = {-1, -1};
    REQUIRE(::pipe(client) == 0);
    REQUIRE(::write(client[1], "x", 1) == 1); // the client has said something
    int heard = 0;
    worker.client.descriptor = client[0];
    worker.client.heard = [&] {
        ++heard;
        char byte = 0;
        REQUIRE(::read(client[0], &byte, 1) == 1);
        return fathom::lsp::Wanted::Modified;
    };
    CHECK(worker.idle().empty());
    CHECK(heard == 1);

    REQUIRE(::write(client[1], "x", 1) == 1);
    const auto hovered = worker.handle(message("textDocument/hover", Client::at(0, 1), 2));
    REQUIRE(hovered.size() == 1);
    CHECK(Json::parse(hovered[0]).at("error").at("code") == -32801); // content modified

    REQUIRE(::write(client[1], "x", 1) == 1);
    worker.client.heard = [&] {
        char byte = 0;
        REQUIRE(::read(client[0], &byte, 1) == 1);
        return fathom::lsp::Wanted::TakenBack;
    };
    const auto again = worker.handle(message("textDocument/hover", Client::at(0, 1), 3));
    REQUIRE(again.size() == 1);
    CHECK(Json::parse(again[0]).at("error").at("code") == -32800); // request cancelled

    worker.client.descriptor = -1;
    worker.handle(message("textDocument/didChange",
                          {{"textDocument", {{"uri", "file:///scenes/a.sdf"}, {"version", 2}}},
                           {"contentChanges", {{{"text", "sphere(1)\n"}}}}}));
    const auto diagnostics = worker.idle(); // of the text as it is now
    REQUIRE(diagnostics.size() == 1);
    CHECK(Json::parse(diagnostics[0]).at("params").at("version") == 2);
    ::close(client[0]);
    ::close(client[1]);
}

TEST_CASE("a worker does not outlive its server, however that ends") {
    int said[2] = {-1, -1};
    REQUIRE(::pipe(said) == 0);
    const pid_t server = ::fork();
    if (server == 0) {
        Worker worker;
        worker.handle(message("initialize", Json::object(), 1));
        const int process = worker.process();
        ::kill(process, SIGSTOP); // it hears of nothing
        (void)!::write(said[1], &process, sizeof process);
        for (;;) ::pause();
    }
    int process = 0;
    REQUIRE(::read(said[0], &process, sizeof process) == sizeof process);
    REQUIRE(process > 0);
    REQUIRE(::kill(process, 0) == 0);
    ::kill(server, SIGKILL);
    ::waitpid(server, nullptr, 0);
    const auto runs = [&] { // else it is gone, or only waits to be reaped
        std::ifstream status("/proc/" + std::to_string(process) + "/stat");
        std::string number, name, state;
        return status >> number >> name >> state && state != "Z" && state != "X";
    };
    for (int i = 0; i < 1000 && runs(); ++i) ::usleep(10'000);
    CHECK_FALSE(runs());
    ::kill(process, SIGKILL);
    ::close(said[0]), ::close(said[1]);
}
