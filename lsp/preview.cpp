#include "lsp/preview.h"

#include "base/text.h"
#include "system/system.h"

#include <fathom/files.h>
#include <fathom/language.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::lsp {
namespace {

constexpr int request_failed_code = -32803;

void shut(int &descriptor) {
    if (descriptor >= 0) ::close(descriptor);
    descriptor = -1;
}

// A socket in a new folder of this user alone; -1 where there can be none.
int listen_in(std::string &folder) {
    const char *runtime = std::getenv("XDG_RUNTIME_DIR");
    std::string name = (runtime && *runtime ? std::string(runtime) : "/tmp") + "/fathom-XXXXXX";
    if (!::mkdtemp(name.data())) return -1; // made with 0700
    folder = name;
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    const std::string path = folder + "/editor";
    if (path.size() >= sizeof address.sun_path) return -1;
    std::strcpy(address.sun_path, path.c_str());
    int descriptor = system::open_socket();
    if (descriptor >= 0 &&
        (::bind(descriptor, reinterpret_cast<sockaddr *>(&address), sizeof address) != 0 ||
         ::listen(descriptor, 1) != 0))
        shut(descriptor);
    return descriptor;
}

// What can be read without waiting, added to `bytes`; false at the end.
bool read_some(int descriptor, std::string &bytes) {
    std::array<char, 1 << 14> block{};
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    if (count > 0) bytes.append(block.data(), static_cast<std::size_t>(count));
    return count > 0 || (count < 0 && (errno == EINTR || errno == EAGAIN));
}

bool ready(int descriptor) {
    pollfd one{descriptor, POLLIN, 0};
    return descriptor >= 0 && ::poll(&one, 1, 0) > 0;
}

} // namespace

Previews::Previews(std::string program) : program_(std::move(program)) {}

Previews::~Previews() {
    for (Window &window : windows_) close(window);
}

void Previews::close(Window &window) {
    shut(window.listening);
    shut(window.connected);
    shut(window.errors);
    if (window.process > 0) {
        ::kill(window.process, SIGTERM);
        ::waitpid(window.process, nullptr, 0);
    }
    window.process = 0;
    std::error_code error;
    if (!window.folder.empty()) std::filesystem::remove_all(window.folder, error);
}

std::string Previews::open(const std::string &uri, const std::string &text) {
    for (Window &window : windows_)
        if (window.uri == uri) return "";
    const std::string path = path_of(uri);
    if (path.empty()) return "a text that is no file yet has no window";
    Window window;
    window.uri = uri;
    window.shown = text;
    window.listening = listen_in(window.folder);
    std::array<int, 2> errors{-1, -1};
    if (window.listening < 0 || !system::open_pipe(errors)) {
        const std::string why = fathom::v1::error_words(errno);
        close(window);
        return "cannot make a socket: " + why;
    }
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_addopen(&files, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_adddup2(&files, errors[1], STDERR_FILENO);
    std::vector<std::string> words{"fathom", "view", path, "--editor", window.folder + "/editor"};
    std::vector<char *> arguments;
    for (std::string &word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const int failed = ::posix_spawnp(&window.process, program_.c_str(), &files, nullptr,
                                      arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    ::close(errors[1]);
    window.errors = errors[0];
    if (failed != 0) {
        window.process = 0;
        close(window);
        return "cannot start the viewer: " + fathom::v1::error_words(failed);
    }
    windows_.push_back(std::move(window));
    return "";
}

// A record for the window; a window that is not there yet gets the newest text when it comes. One
// that does not read for seconds is given up: the editor does not wait for it.
static void tell(int &connected, const std::string &record) {
    for (std::size_t done = 0; connected >= 0 && done < record.size();) {
        const ssize_t count =
            ::send(connected, record.data() + done, record.size() - done, MSG_NOSIGNAL);
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return shut(connected);
        done += static_cast<std::size_t>(count);
    }
}

void Previews::show(Window &window, const std::string &text) {
    const auto moved = fathom::v1::moved_params(window.shown, text);
    window.shown = text;
    std::string records = fmt::format("text {}\n{}", text.size(), text);
    for (const auto &[name, value] : moved)
        records += fmt::format("param {} {}\n", name, format_shortest(value));
    tell(window.connected, records);
}

void Previews::follow(const Json &message, const std::map<std::string, Json> &texts) {
    try {
        const std::string method = message.at("method");
        const Json params = message.value("params", Json::object());
        if (method == "initialize")
            shows_documents_ =
                params.value("/capabilities/window/showDocument/support"_json_pointer, false);
        if (method == "textDocument/didClose")
            windows_.remove_if([&](Window &window) {
                const bool closed = window.uri == params.at("textDocument").at("uri");
                if (closed) close(window);
                return closed;
            });
        for (Window &window : windows_) {
            if (method != "textDocument/didChange" && method != "fathom/cursor") break;
            if (window.uri != params.at("textDocument").at("uri")) continue;
            if (method == "textDocument/didChange")
                show(window, texts.at(window.uri).at("text"));
            else
                tell(window.connected,
                     fmt::format("cursor {}\n",
                                 offset_at(window.shown, position_of(params.at("position")))));
        }
    } catch (const std::exception &) { // malformed: the server has said so
    }
}

bool Previews::handle(const Json &message, const std::map<std::string, Json> &texts,
                      std::vector<std::string> &out) {
    try {
        const std::string method = message.at("method");
        const Json params = message.value("params", Json::object());
        const bool command = method == "workspace/executeCommand" &&
                             params.value("command", Json()) == "fathom.show";
        if (!message.contains("id") || (!command && method != "fathom/preview")) return false;
        const std::string uri = command ? params.at("arguments").at(0).get<std::string>()
                                        : params.at("textDocument").at("uri").get<std::string>();
        const auto text = texts.find(uri);
        const std::string why =
            text == texts.end() ? "this text is not open" : open(uri, text->second.at("text"));
        Json answer{{"jsonrpc", "2.0"}, {"id", message["id"]}};
        if (why.empty())
            answer["result"] = nullptr;
        else
            answer["error"] = {{"code", request_failed_code}, {"message", why}};
        out.push_back(written(answer));
        return true;
    } catch (const Json::exception &) { // malformed: the server says so
        return false;
    }
}

void Previews::wait_for(std::vector<pollfd> &all) const {
    for (const Window &window : windows_)
        for (int descriptor : {window.listening, window.connected, window.errors})
            if (descriptor >= 0) all.push_back({descriptor, POLLIN, 0});
}

// Records `clicked LINE COLUMN FILE`, as requests to put the cursor there.
void Previews::hear(Window &window, std::vector<std::string> &messages) {
    for (std::size_t end; (end = window.received.find('\n')) != std::string::npos;) {
        const std::string record = window.received.substr(0, end);
        window.received.erase(0, end + 1);
        int line = 0, column = 0;
        const char *at = record.data() + std::min<std::size_t>(record.size(), 8);
        const char *last = record.data() + record.size();
        const auto first = std::from_chars(at, last, line);
        const auto second = std::from_chars(std::min(first.ptr + 1, last), last, column);
        if (!record.starts_with("clicked ") || line < 1 || column < 1 || second.ptr >= last)
            continue;
        const std::string file(second.ptr + 1, last);
        const Position place{line - 1, column - 1};
        const std::string uri = file == path_of(window.uri) ? window.uri : uri_of(file);
        if (shows_documents_)
            messages.push_back(written({{"jsonrpc", "2.0"},
                                        {"id", fmt::format("fathom-show-{}", ++requests_)},
                                        {"method", "window/showDocument"},
                                        {"params",
                                         {{"uri", uri},
                                          {"takeFocus", true},
                                          {"selection", json_of(Range{place, place})}}}}));
        else
            messages.push_back(written({{"jsonrpc", "2.0"},
                                        {"method", "fathom/clicked"},
                                        {"params", {{"uri", uri}, {"position", json_of(place)}}}}));
    }
}

std::vector<std::string> Previews::heard() {
    std::vector<std::string> messages;
    for (auto window = windows_.begin(); window != windows_.end();) {
        const auto here = window++;
        if (ready(here->listening)) {
            int connected = system::accept_connection(here->listening);
            if (connected >= 0 && (here->connected >= 0 || !system::is_of_this_user(connected)))
                shut(connected);
            if (connected >= 0) {
                here->connected = connected;
                const timeval patience{3, 0};
                ::setsockopt(connected, SOL_SOCKET, SO_SNDTIMEO, &patience, sizeof patience);
                tell(here->connected, fmt::format("text {}\n{}", here->shown.size(), here->shown));
            }
        }
        if (ready(here->connected) && !read_some(here->connected, here->received))
            shut(here->connected);
        hear(*here, messages);
        if (!ready(here->errors) || read_some(here->errors, here->said)) continue;
        // The window's process has ended; what a driver said of itself meanwhile is nobody's.
        int status = 0;
        ::waitpid(here->process, &status, 0);
        here->process = 0;
        if (!here->said.empty() && !(WIFEXITED(status) && WEXITSTATUS(status) == 0)) {
            constexpr int warning = 2;
            messages.push_back(written({{"jsonrpc", "2.0"},
                                        {"method", "window/showMessage"},
                                        {"params", {{"type", warning}, {"message", here->said}}}}));
            messages.push_back(written({{"jsonrpc", "2.0"},
                                        {"method", "fathom/windowFailed"},
                                        {"params", {{"uri", here->uri}}}}));
        }
        close(*here);
        windows_.erase(here);
    }
    return messages;
}

} // namespace fathom::lsp
