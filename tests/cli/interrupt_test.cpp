// The program in a terminal of its own (a pseudo terminal): what it shows, and what Ctrl-C leaves.
#include "shell.h"

#include <catch2/catch.hpp>

#include <csignal>
#include <poll.h>
#include <pty.h>
#include <termios.h>
#include <unistd.h>

namespace {

struct Session {
    int status = 0;
    std::string shown;
    bool same_settings = false; // of the terminal, before and after
};

// Runs the program in the folder; once `until` was shown, types `keys`.
Session run_in_terminal(const ScratchFolder &folder, const std::vector<std::string> &arguments,
                        const std::string &until, const std::string &keys, bool colors) {
    Session session;
    winsize window{24, 80, 0, 0};
    int terminal = -1;
    const pid_t child = ::forkpty(&terminal, nullptr, nullptr, &window);
    REQUIRE(child >= 0);
    if (child == 0) {
        ::setenv("TERM", "xterm-256color", 1);
        ::setenv("LC_ALL", "C.UTF-8", 1);
        if (colors)
            ::setenv("COLORTERM", "truecolor", 1);
        else
            ::unsetenv("COLORTERM");
        std::vector<char *> words;
        static std::string program = FATHOM_PROGRAM;
        words.push_back(program.data());
        for (const std::string &argument : arguments)
            words.push_back(const_cast<char *>(argument.c_str()));
        words.push_back(nullptr);
        if (::chdir(folder.path().c_str()) == 0) ::execv(program.c_str(), words.data());
        ::_exit(127);
    }
    termios before{}, after{};
    ::tcgetattr(terminal, &before);
    bool typed = keys.empty();
    char buffer[4096];
    for (pollfd ready{terminal, POLLIN, 0}; ::poll(&ready, 1, 60000) > 0;) {
        const ssize_t n = ::read(terminal, buffer, sizeof buffer);
        if (n <= 0) break; // the other side is closed
        session.shown.append(buffer, static_cast<std::size_t>(n));
        if (typed || !contains(session.shown, until)) continue;
        ::tcgetattr(terminal, &after);
        CHECK(::write(terminal, keys.data(), keys.size()) == static_cast<ssize_t>(keys.size()));
        typed = true;
    }
    CHECK(typed);
    if (keys.empty()) after = before;
    session.same_settings = before.c_lflag == after.c_lflag && before.c_iflag == after.c_iflag &&
                            before.c_oflag == after.c_oflag;
    ::waitpid(child, &session.status, 0);
    ::close(terminal);
    return session;
}

struct Drawings : ScratchFolder {
    Drawings() { write("quick.sdf", "sphere(1)\n"); }
};

const std::vector<std::string> draw(const std::string &scene, const std::string &size) {
    return {"render", scene, "-o", "out.png", "--backend", "cpu", "--size", size};
}

std::size_t files_in(const ScratchFolder &folder) {
    return static_cast<std::size_t>(std::distance(fs::directory_iterator(folder.path()), {}));
}

} // namespace

TEST_CASE("Ctrl-C ends a picture, keeps the old file and leaves the terminal in order") {
    Drawings folder;
    folder.write("out.png", "what was there");
    const std::size_t files = files_in(folder);
    const Session session =
        run_in_terminal(folder, draw("quick.sdf", "6000x6000"), " %", "\x03", true);
    CHECK(WIFSIGNALED(session.status));
    CHECK(WTERMSIG(session.status) == SIGINT);
    CHECK(folder.read("out.png") == "what was there");
    CHECK(files_in(folder) == files); // no temporary file either
    CHECK(session.same_settings);
    // the last that was shown is the wiping of all below, in plain colour
    const std::size_t wiped = session.shown.rfind("\x1b[J");
    REQUIRE(wiped != std::string::npos);
    CHECK(session.shown.find_first_not_of("\r\n^C", wiped + 3) == std::string::npos);
    CHECK(session.shown.rfind("\x1b[0m") > session.shown.rfind("m▀"));
}

TEST_CASE("what is longer than the terminal goes to the reader's pager, and nothing else does") {
    Drawings folder;
    folder.write("pager", "#!/bin/sh\necho paged $LESS\nsed 's/^/| /'\n");
    fs::permissions(folder.path() / "pager", fs::perms::owner_all);
    const auto shown = [&](const std::vector<std::string> &arguments, const char *pager) {
        ::setenv("PAGER", pager, 1);
        const Session session = run_in_terminal(folder, arguments, "", "", false);
        ::unsetenv("PAGER");
        CHECK((WIFEXITED(session.status) && WEXITSTATUS(session.status) == 0));
        return session.shown;
    };
    const std::string all = shown({"doc"}, "./pager");
    CHECK(contains(all, "paged FRX"));
    CHECK(contains(all, "|   sphere "));
    CHECK(contains(all, "|   twist ")); // to the end
    CHECK(contains(shown({"explain"}, "./pager"), "| "));
    CHECK_FALSE(contains(shown({"doc", "sphere"}, "./pager"), "paged")); // it fits
    CHECK_FALSE(contains(shown({"doc"}, ""), "paged"));
    // A pager that is not there is said by the shell, and the text is shown; one that is left early is
    // no error.
    CHECK(contains(shown({"doc"}, "nowhere-at-all"), "  sphere "));
    CHECK(contains(shown({"doc"}, "head -n 3"), "shapes"));
}

TEST_CASE("a terminal that can shows the picture as it comes, any other the bar alone") {
    Drawings folder;
    const Session colors = run_in_terminal(folder, draw("quick.sdf", "600x400"), "", "", true);
    CHECK(WIFEXITED(colors.status));
    CHECK(WEXITSTATUS(colors.status) == 0);
    CHECK(contains(colors.shown, "▀"));
    CHECK(folder.read("out.png").starts_with("\x89PNG"));
    const Session plain = run_in_terminal(folder, draw("quick.sdf", "600x400"), "", "", false);
    CHECK(WEXITSTATUS(plain.status) == 0);
    CHECK_FALSE(contains(plain.shown, "▀"));
    CHECK(contains(plain.shown, " %"));
}

TEST_CASE("a result on a terminal does not steer it") {
    ScratchFolder folder;
    folder.write("ugly\x1b]0;title\x07.sdf", "sphere( 1 )\n");
    for (const std::vector<std::string> &line :
         {std::vector<std::string>{"fmt", "--check", "ugly\x1b]0;title\x07.sdf"},
          {"check", "--explain", "ugly\x1b]0;title\x07.sdf"}}) {
        const Session session = run_in_terminal(folder, line, "", "", false);
        CHECK(WIFEXITED(session.status));
        CHECK(contains(session.shown, "ugly\uFFFD]0;title\uFFFD.sdf"));
        CHECK_FALSE(contains(session.shown, "\x1b]0;"));
    }
}
