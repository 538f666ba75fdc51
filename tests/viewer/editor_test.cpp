// The window of an editor: texts come over a socket, and clicks go back.
#include "tests/viewer/window.h"

#include <array>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>

using namespace fathom;
using namespace fathom::viewer_test;

namespace {

const std::string seen_from = "camera(at: [0, 0, 6], look_at: [0, 0, 0])\n";

// The language server's end.
struct Editor {
    ScratchFolder folder;
    int listening = -1, window = -1;

    Editor() {
        sockaddr_un address{};
        address.sun_family = AF_UNIX;
        socket().copy(address.sun_path, sizeof address.sun_path - 1);
        listening = ::socket(AF_UNIX, SOCK_STREAM, 0);
        REQUIRE(::bind(listening, reinterpret_cast<sockaddr *>(&address), sizeof address) == 0);
        REQUIRE(::listen(listening, 1) == 0);
    }
    ~Editor() {
        ::close(listening);
        ::close(window);
    }
    std::string socket() const { return (folder / "editor").string(); }
    void accept() { window = ::accept(listening, nullptr, nullptr); }
    void say(const std::string &record) {
        REQUIRE(::write(window, record.data(), record.size()) ==
                static_cast<ssize_t>(record.size()));
    }
    void type(const std::string &text) { say(fmt::format("text {}\n{}", text.size(), text)); }
    std::string heard() {
        pollfd one{window, POLLIN, 0};
        if (::poll(&one, 1, 30000) <= 0) return "";
        std::array<char, 1024> block{};
        const ssize_t count = ::read(window, block.data(), block.size());
        return std::string(block.data(), static_cast<std::size_t>(std::max<ssize_t>(count, 0)));
    }
};

} // namespace

TEST_CASE("what an editor types is seen without a save; its cursor outlines, a click answers it") {
    Editor editor;
    Window window("sphere(1).paint(red)\n" + seen_from, {"--editor", editor.socket()});
    editor.accept();
    CHECK(pixel(window.picture(), 240, 160)[0] > 2 * pixel(window.picture(), 240, 160)[2]);

    const std::string typed = "box(2).paint(blue)\n" + seen_from;
    editor.type(typed);
    REQUIRE(window.reloads(2));
    const Picture blue = window.picture();
    CHECK(pixel(blue, 240, 160)[2] > 2 * pixel(blue, 240, 160)[0]);
    CHECK(window.folder.read("scene.sdf").starts_with("sphere")); // nothing was written

    editor.say("cursor 3\n");
    CHECK(waited([&] { return difference(blue, window.picture()) > 0; })); // the outline
    editor.say(fmt::format("cursor {}\n", typed.size()));                  // in no shape
    CHECK(waited([&] { return difference(blue, window.picture()) == 0; }));

    window.hands("mousemove 240 160 click 1");
    const std::string clicked = editor.heard();
    CHECK(clicked.starts_with("clicked 1 1 "));
    CHECK(clicked.ends_with("scene.sdf\n"));

    editor.type("box(\n"); // half typed: the last good picture stays
    REQUIRE(window.reloads(3));
    CHECK(window.lines().back().find("error") != std::string::npos);
    CHECK(pixel(window.picture(), 240, 220)[2] > 2 * pixel(window.picture(), 240, 220)[0]);
}

TEST_CASE("a number of a param that an editor moves is a uniform: nothing is compiled") {
    Editor editor;
    const auto scene = [](const std::string &r) {
        return "param r = " + r + " in 0.2..2\nsphere(r)\n" + seen_from;
    };
    Window window(scene("0.5"), {"--editor", editor.socket()});
    editor.accept();
    editor.type(scene("0.5"));
    REQUIRE(window.reloads(2));
    const Picture small = window.picture();
    const std::string larger = scene("1.5");
    editor.say(fmt::format("text {}\n{}param r 1.5\n", larger.size(), larger));
    CHECK(waited([&] { return difference(small, window.picture()) > 0.01; }));
    const Picture slid = window.picture();
    CHECK(window.lines().size() == 2); // no reload

    // The picture is that of the text itself; a value out of its range is compiled, and is an error.
    editor.type(larger + "\n");
    REQUIRE(window.reloads(3));
    CHECK(difference(slid, window.picture()) == 0);
    const std::string outside = scene("7");
    editor.say(fmt::format("text {}\n{}param r 7\n", outside.size(), outside));
    REQUIRE(window.reloads(4));
    CHECK(window.lines().back().find("error") != std::string::npos);
}
