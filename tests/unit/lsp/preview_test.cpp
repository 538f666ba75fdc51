// Windows that follow a text: what is sent to them and heard of them, with a program in the viewer's
// place that writes down how it was started.
#include "client.h"

#include "lsp/preview.h"

#include <array>
#include <atomic>
#include <filesystem>
#include <fstream>
#include <grp.h>
#include <optional>
#include <sys/socket.h>
#include <sys/un.h>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace {

using namespace fathom::lsp;
using fathom::v1::moved_params;
namespace fs = std::filesystem;

const std::string a_uri = "file:///scenes/a.sdf";

struct Script { // a program of one line of shell
    fs::path folder =
        fs::temp_directory_path() / ("fathom-preview-test-" + std::to_string(getpid()));
    fs::path file = folder / "program";
    explicit Script(const std::string &line) {
        fs::create_directories(folder);
        std::ofstream(file) << "#!/bin/sh\n" << line << "\n";
        fs::permissions(file, fs::perms::owner_all);
    }
    ~Script() { fs::remove_all(folder); }
};

Json request(int id, const std::string &uri = a_uri) {
    return {{"jsonrpc", "2.0"},
            {"id", id},
            {"method", "fathom/preview"},
            {"params", {{"textDocument", {{"uri", uri}}}}}};
}

Json notification(const std::string &method, Json params) {
    return {{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(params)}};
}

std::map<std::string, Json> texts_with(const std::string &text) {
    return {{a_uri, {{"uri", a_uri}, {"version", 1}, {"text", text}}}};
}

// Waits for what the windows have to say.
std::vector<Json> heard(Previews &previews) {
    for (int i = 0; i < 200; ++i) {
        std::vector<Json> all;
        for (const std::string &message : previews.heard()) all.push_back(Json::parse(message));
        if (!all.empty()) return all;
        std::vector<pollfd> waited;
        previews.wait_for(waited);
        REQUIRE_FALSE(waited.empty());
        ::poll(waited.data(), waited.size(), 100);
    }
    return {};
}

std::string received(int descriptor) {
    pollfd one{descriptor, POLLIN, 0};
    if (::poll(&one, 1, 5000) <= 0) return "";
    std::array<char, 4096> block{};
    const ssize_t count = ::read(descriptor, block.data(), block.size());
    return std::string(block.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
}

int connected_to(const fs::path &path) {
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    REQUIRE(path.string().size() < sizeof address.sun_path);
    path.string().copy(address.sun_path, sizeof address.sun_path - 1);
    const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
    REQUIRE(::connect(descriptor, reinterpret_cast<sockaddr *>(&address), sizeof address) == 0);
    return descriptor;
}

} // namespace

TEST_CASE("numbers of params that moved are told apart from other edits") {
    using Moved = std::vector<std::pair<std::string, double>>;
    const std::string text = "param r = 0.5 in 0..2\nparam a = 30deg in 0..1turn\nsphere(r)\n";
    const auto with = [&](const std::string &from, const std::string &to) {
        std::string after = text;
        return after.replace(after.find(from), from.size(), to);
    };
    CHECK(moved_params(text, with("0.5", "0.75")) == Moved{{"r", 0.75}});
    CHECK(moved_params(text, with("0.5 ", "1  ")) == Moved{{"r", 1}});
    const Moved angle = moved_params(text, with("30deg", "180deg"));
    REQUIRE(angle.size() == 1);
    CHECK(angle[0].second == Approx(3.14159265));
    CHECK(moved_params(text, text).empty());
    CHECK(moved_params(text, with("0..2", "0..3")).empty());
    CHECK(moved_params(text, with("0.5", "0.5 + 1")).empty());
    CHECK(moved_params(text, with("sphere(r)", "box(r)")).empty());
    CHECK(moved_params(text, with("0.5", "(")).empty());
    CHECK(moved_params("sphere(1)\n", "sphere(2)\n").empty());
}

TEST_CASE("a window follows a text, and a click comes back as a place") {
    const Script script("echo \"$2 $4\" > \"$0.started\"; exec sleep 60");
    Previews previews(script.file);
    std::map<std::string, Json> texts = texts_with("sphere(1)\n");
    previews.follow(
        notification("initialize",
                     {{"capabilities", {{"window", {{"showDocument", {{"support", true}}}}}}}}),
        texts);
    std::vector<std::string> out;
    CHECK_FALSE(previews.handle(notification("fathom/cursor", Client::at(0, 3)), texts, out));
    REQUIRE(previews.handle(request(4), texts, out));
    REQUIRE(out.size() == 1);
    CHECK(Json::parse(out[0]) == Json{{"jsonrpc", "2.0"}, {"id", 4}, {"result", nullptr}});

    const fs::path started = script.file.string() + ".started";
    std::string file, socket;
    for (int i = 0; i < 500 && socket.empty(); ++i) {
        std::ifstream(started) >> file >> socket;
        if (socket.empty()) ::usleep(10000);
    }
    CHECK(file == "/scenes/a.sdf");
    REQUIRE_FALSE(socket.empty());
    // nobody else can enter the folder
    CHECK(fs::status(fs::path(socket).parent_path()).permissions() == fs::perms::owner_all);

    const int window = connected_to(socket);
    previews.heard();
    CHECK(received(window) == "text 10\nsphere(1)\n");
    texts = texts_with("param r = 1 in 0..2\nsphere(r)\n");
    const Json change =
        notification("textDocument/didChange", {{"textDocument", {{"uri", a_uri}}}});
    previews.follow(change, texts);
    CHECK(received(window) == "text 30\nparam r = 1 in 0..2\nsphere(r)\n");
    texts = texts_with("param r = 1.5 in 0..2\nsphere(r)\n");
    previews.follow(change, texts);
    CHECK(received(window) == "text 32\nparam r = 1.5 in 0..2\nsphere(r)\nparam r 1.5\n");
    previews.follow(notification("fathom/cursor", Client::at(1, 3)), texts);
    CHECK(received(window) == "cursor 25\n");

    const std::string said = "nonsense\nclicked 2 x\nclicked 2 3 /scenes/a.sdf\n";
    REQUIRE(::write(window, said.data(), said.size()) == static_cast<ssize_t>(said.size()));
    const std::vector<Json> messages = heard(previews);
    REQUIRE(messages.size() == 1);
    CHECK(messages[0].at("method") == "window/showDocument");
    CHECK(messages[0].at("params").at("uri") == a_uri);
    CHECK(messages[0].at("params").at("selection") == range(1, 2, 2));

    previews.follow(notification("textDocument/didClose", {{"textDocument", {{"uri", a_uri}}}}),
                    texts);
    CHECK(received(window).empty()); // its end
    CHECK_FALSE(fs::exists(fs::path(socket).parent_path()));
    ::close(window);
}

TEST_CASE("a window that is closed says nothing, and one that does not read is given up") {
    const Script script("echo 'a driver warns' >&2; echo \"$4\" > \"$0.started\"; exec sleep 1");
    Previews previews(script.file);
    std::map<std::string, Json> texts = texts_with(std::string(1 << 20, ' ') + "\n");
    std::vector<std::string> out;
    REQUIRE(previews.handle(request(1), texts, out));
    std::string socket;
    for (int i = 0; i < 500 && socket.empty(); ++i) {
        std::ifstream(script.file.string() + ".started") >> socket;
        if (socket.empty()) ::usleep(10000);
    }
    REQUIRE_FALSE(socket.empty());
    const int window = connected_to(socket); // which never reads
    for (int i = 0; i < 200; ++i) {
        std::vector<pollfd> waited;
        previews.wait_for(waited);
        if (waited.empty()) break;
        ::poll(waited.data(), waited.size(), 100);
        CHECK(previews.heard().empty());
    }
    std::vector<pollfd> waited;
    previews.wait_for(waited);
    CHECK(waited.empty());
    ::close(window);
}

// What another user reads who connects to the socket; nothing where he cannot.
static std::optional<std::string> read_by_another_user(const fs::path &socket) {
    constexpr uid_t nobody = 65534;
    int ends[2] = {-1, -1};
    REQUIRE(::pipe(ends) == 0);
    const pid_t child = ::fork();
    if (child == 0) {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        socket.string().copy(address.sun_path, sizeof address.sun_path - 1);
        const int descriptor = ::socket(AF_UNIX, SOCK_STREAM, 0);
        if (::setgroups(0, nullptr) != 0 || ::setresgid(nobody, nobody, nobody) != 0 ||
            ::setresuid(nobody, nobody, nobody) != 0 ||
            ::connect(descriptor, reinterpret_cast<sockaddr *>(&address), sizeof address) != 0)
            ::_exit(1);
        std::array<char, 64> block{};
        const ssize_t count = ::read(descriptor, block.data(), block.size());
        if (count > 0 && ::write(ends[1], block.data(), static_cast<std::size_t>(count)) < 0)
            ::_exit(2);
        ::_exit(0);
    }
    ::close(ends[1]);
    std::string read;
    std::array<char, 64> block{};
    for (ssize_t count; (count = ::read(ends[0], block.data(), block.size())) > 0;)
        read.append(block.data(), static_cast<std::size_t>(count));
    ::close(ends[0]);
    int status = 0;
    ::waitpid(child, &status, 0);
    return WIFEXITED(status) && WEXITSTATUS(status) == 0 ? std::optional(read) : std::nullopt;
}

TEST_CASE("another user cannot connect, and hears nothing where the folder is open") {
    if (::geteuid() != 0) {
        WARN("not tried: only root can be another user");
        return;
    }
    const Script script("echo \"$4\" > \"$0.started\"; exec sleep 60");
    Previews previews(script.file);
    const std::map<std::string, Json> texts = texts_with("sphere(1)\n");
    std::vector<std::string> out;
    REQUIRE(previews.handle(request(1), texts, out));
    std::string socket;
    for (int i = 0; i < 500 && socket.empty(); ++i) {
        std::ifstream(script.file.string() + ".started") >> socket;
        if (socket.empty()) ::usleep(10000);
    }
    REQUIRE_FALSE(socket.empty());
    CHECK_FALSE(read_by_another_user(socket)); // the folder's mode

    fs::permissions(fs::path(socket).parent_path(), fs::perms::all);
    fs::permissions(socket, fs::perms::all);
    std::atomic<bool> done = false;
    std::thread listener([&] {
        while (!done) {
            previews.heard();
            ::usleep(1000);
        }
    });
    CHECK(read_by_another_user(socket) == std::string()); // refused before a letter is sent
    done = true;
    listener.join();
    const int same = connected_to(socket); // and that refusal kept nobody else out
    previews.heard();
    CHECK(received(same) == "text 10\nsphere(1)\n");
    ::close(same);
}

TEST_CASE("a window that does not open says why") {
    const Script script("echo 'fathom: there is no display' >&2; exit 4");
    Previews previews(script.file);
    const std::map<std::string, Json> texts = texts_with("sphere(1)\n");
    std::vector<std::string> out;
    REQUIRE(previews.handle(request(1), texts, out));
    const std::vector<Json> messages = heard(previews);
    REQUIRE(messages.size() == 2);
    CHECK(messages[1] == notification("fathom/windowFailed", {{"uri", a_uri}}));
    CHECK(messages[0].at("method") == "window/showMessage");
    const std::string why = messages[0].at("params").at("message");
    CHECK(why.find("no display") != std::string::npos);

    out.clear();
    REQUIRE(previews.handle(request(2, "file:///scenes/other.sdf"), texts, out));
    CHECK(Json::parse(out.at(0)).contains("error")); // it is not open
    Previews none("/nonexistent/fathom");
    out.clear();
    REQUIRE(none.handle(request(3), texts, out));
    CHECK(Json::parse(out.at(0)).contains("error"));
}
