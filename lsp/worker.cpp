#include "lsp/worker.h"

#include "system/system.h"

#include <array>
#include <cerrno>
#include <csignal>
#include <cstring>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>
#include <utility>

namespace fathom::lsp {
namespace {

// Between the two processes a body is a letter and a text: to the server what is asked of it, and
// the message; back each message for the client, and at the end that this was all.
constexpr char handle_it = 'h', foresee_it = 'f', be_idle = 'i';
// Sent while the other works, and without an answer: that it need not. The text says why.
constexpr char leave_it = 'l';
constexpr char for_client = 'm', that_was_all = 'd', will_end_well = '0', will_end_badly = '1';
constexpr std::size_t any_body = std::size_t(-1) / 2;

// Of the new process, until the other one goes or wants its end.
void serve_other(int socket) {
    Transport other(socket, socket, any_body);
    Server server;
    server.ask_whether_wanted([&] {
        if (!other.pending()) return Wanted::Still;
        const std::optional<std::string> why = other.read();
        return why && why->size() > 1 ? Wanted((*why)[1]) : Wanted::TakenBack;
    });
    while (const std::optional<std::string> asked = other.read()) {
        if (asked->empty() || asked->front() == leave_it) continue; // it came too late
        const std::string message = asked->substr(1);
        std::vector<std::string> answers;
        if (asked->front() == handle_it) answers = server.handle(message);
        if (asked->front() == be_idle) answers = server.idle();
        if (asked->front() == foresee_it) server.foresee(message);
        for (const std::string &answer : answers) other.write(for_client + answer);
        std::string end(1, that_was_all);
        if (server.ended()) end += server.exit_status() == 0 ? will_end_well : will_end_badly;
        if (!other.write(end)) return;
    }
}

std::string in_words(int status) {
    if (WIFSIGNALED(status)) return ::strsignal(WTERMSIG(status));
    return "exit status " + std::to_string(WEXITSTATUS(status));
}

} // namespace

Worker::~Worker() {
    if (process_ == 0) return;
    transport_.reset();
    ::close(socket_);
    ::waitpid(process_, nullptr, 0);
}

bool Worker::start() {
    if (process_ != 0) return true;
    std::signal(SIGPIPE, SIG_IGN); // an end that is gone is seen where it is written to
    std::array<int, 2> ends{-1, -1};
    if (!system::open_socket_pair(ends)) return false;
    const pid_t parent = ::getpid(), process = ::fork();
    if (process == 0) {
        system::end_with(parent); // it may be in the middle of long work, and hear of nothing
        ::close(ends[0]);
        const int nothing = ::open("/dev/null", O_RDWR); // what prints reaches no client
        ::dup2(nothing, STDIN_FILENO);
        ::dup2(nothing, STDOUT_FILENO);
        serve_other(ends[1]);
        ::_exit(0);
    }
    ::close(ends[1]);
    if (process < 0) {
        ::close(ends[0]);
        cause_ = std::strerror(errno);
        return false;
    }
    process_ = process;
    socket_ = ends[0];
    transport_.emplace(socket_, socket_, any_body);
    if (!initialize_.empty() && !ask(handle_it, initialize_)) return false;
    for (const auto &[uri, text] : opened_)
        if (!ask(handle_it, written({{"jsonrpc", "2.0"},
                                     {"method", "textDocument/didOpen"},
                                     {"params", {{"textDocument", text}}}})))
            return false;
    return shutdown_.empty() || ask(handle_it, shutdown_);
}

// What a new process would have to be told of a message. What is malformed is left to the server.
void Worker::note(const Json &message) {
    try {
        const std::string method = message.at("method");
        if (method == "initialize") initialize_ = written(message);
        if (method == "shutdown") shutdown_ = written(message);
        if (method == "textDocument/didOpen") {
            const Json &text = message.at("params").at("textDocument");
            opened_[text.at("uri").get<std::string>()] = text;
        }
        if (method == "textDocument/didClose")
            opened_.erase(message.at("params").at("textDocument").at("uri").get<std::string>());
        if (method == "textDocument/didChange") {
            const Json &named = message.at("params").at("textDocument");
            const auto found = opened_.find(named.at("uri").get<std::string>());
            if (found == opened_.end()) return;
            change(found->second.at("text").get_ref<std::string &>(),
                   message.at("params").at("contentChanges"));
            if (named.contains("version")) found->second["version"] = named["version"];
        }
    } catch (const Json::exception &) {
    }
}

// Until the process says something; meanwhile the client is heard.
void Worker::wait() {
    while (client.descriptor >= 0 && !transport_->pending()) {
        pollfd both[] = {{socket_, POLLIN, 0}, {client.descriptor, POLLIN, 0}};
        if (::poll(both, 2, -1) < 0 && errno != EINTR) return;
        if (both[0].revents != 0) return;
        if (both[1].revents == 0) continue;
        const Wanted wanted = client.heard();
        if (wanted != Wanted::Still) transport_->write({leave_it, static_cast<char>(wanted)});
    }
}

// Nothing where the process ended before it had answered.
std::optional<std::vector<std::string>> Worker::ask(char what, const std::string &message) {
    std::vector<std::string> messages;
    if (transport_->write(what + message)) {
        for (;;) {
            if (what != foresee_it) wait();
            const std::optional<std::string> body = transport_->read();
            if (!body) break;
            if (body->empty()) continue;
            if (body->front() == for_client) {
                messages.push_back(body->substr(1));
                continue;
            }
            ended_ = body->size() > 1;
            if (ended_) exit_status_ = (*body)[1] == will_end_well ? 0 : 1;
            return messages;
        }
    }
    int status = 0;
    transport_.reset();
    ::close(socket_);
    ::waitpid(process_, &status, 0);
    process_ = 0;
    cause_ = in_words(status);
    return std::nullopt;
}

// Tells the client that the process has ended, once until something goes well.
std::string Worker::failure(const std::string &what) {
    constexpr int error = 1, log = 4;
    const bool first = !std::exchange(told_, true);
    return written({{"jsonrpc", "2.0"},
                    {"method", first ? "window/showMessage" : "window/logMessage"},
                    {"params", {{"type", first ? error : log}, {"message", what}}}});
}

std::vector<std::string> Worker::handle(const std::string &message) {
    const Json json = Json::parse(message, nullptr, false);
    const bool request = json.is_object() && json.contains("id") && json.contains("method");
    const bool started = start();
    note(json);
    if (started)
        if (auto messages = ask(handle_it, message)) {
            if (request) told_ = false;
            return std::move(*messages);
        }
    const std::string method =
        json.is_object() ? written(json.value("method", Json("a message"))) : "a message";
    const std::string what = "fathom lsp failed in " + method + " (" + cause_ + "), and goes on";
    std::vector<std::string> messages{failure(what)};
    if (request)
        messages.push_back(written({{"jsonrpc", "2.0"},
                                    {"id", json["id"]},
                                    {"error", {{"code", internal_error}, {"message", what}}}}));
    return messages;
}

// Where it fails it is not tried again before the next message.
std::vector<std::string> Worker::idle() {
    if (process_ == 0) return {};
    if (auto messages = ask(be_idle, "")) return std::move(*messages);
    return {failure("fathom lsp failed in looking for errors (" + cause_ + "), and goes on")};
}

void Worker::foresee(const std::string &message) {
    if (process_ != 0 && message.find("$/cancelRequest") != message.npos)
        (void)ask(foresee_it, message);
}

} // namespace fathom::lsp
