#include "viewer/editor.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <spawn.h>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fathom::viewer {
namespace {

std::vector<std::string> words_of(const std::string &text) {
    std::istringstream in(text);
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

std::string program_of(const std::string &editor) {
    const std::vector<std::string> words = words_of(editor);
    return words.empty() ? "" : std::filesystem::path(words.front()).filename().string();
}

bool one_of(const std::string &name, std::initializer_list<const char *> names) {
    return std::find(names.begin(), names.end(), name) != names.end();
}

std::string variable(const char *name) {
    const char *value = std::getenv(name);
    return value ? value : "";
}

} // namespace

std::string users_editor() {
    const std::string visual = variable("VISUAL");
    return visual.empty() ? variable("EDITOR") : visual;
}

bool needs_terminal(const std::string &editor) {
    const std::vector<std::string> words = words_of(editor);
    const std::string program = program_of(editor);
    if (one_of(program, {"emacs", "emacsclient"}))
        return std::any_of(words.begin(), words.end(), [](const std::string &word) {
            return word == "-nw" || word == "-t" || word == "-tty";
        });
    return one_of(program, {"vi", "vim", "nvim", "nano", "pico", "micro", "hx", "helix", "kak",
                            "joe", "mg", "ne", "ed"});
}

std::vector<std::string> editor_command(const std::string &editor, const std::string &file,
                                        unsigned line, unsigned column) {
    std::vector<std::string> words = words_of(editor);
    const std::string program = program_of(editor);
    if (one_of(program, {"code", "code-insiders", "codium", "cursor", "windsurf"})) {
        words.push_back("-g");
        words.push_back(fmt::format("{}:{}:{}", file, line, column));
    } else if (one_of(program, {"subl", "hx", "helix", "zed", "zeditor"})) {
        words.push_back(fmt::format("{}:{}:{}", file, line, column));
    } else if (program == "kate") {
        words.insert(words.end(),
                     {"--line", std::to_string(line), "--column", std::to_string(column), file});
    } else {
        words.push_back(fmt::format("+{}", line));
        words.push_back(file);
    }
    return words;
}

std::string open_in_editor(const std::string &editor, const std::string &file, unsigned line,
                           unsigned column) {
    const std::string place = fmt::format("{}:{}", file, line);
    if (words_of(editor).empty()) return place + "; set $EDITOR, and a click opens it there";
    std::vector<std::string> words = editor_command(editor, file, line, column);
    if (needs_terminal(editor)) {
        std::string terminal = variable("TERMINAL");
        if (terminal.empty()) terminal = "x-terminal-emulator";
        words.insert(words.begin(), {terminal, "-e"});
    }
    std::vector<char *> arguments;
    for (std::string &word : words) arguments.push_back(word.data());
    arguments.push_back(nullptr);
    posix_spawn_file_actions_t files;
    posix_spawn_file_actions_init(&files);
    posix_spawn_file_actions_addopen(&files, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    pid_t child = 0;
    const int failure =
        ::posix_spawnp(&child, arguments[0], &files, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&files);
    if (failure != 0) return fmt::format("cannot start `{}`; it is at {}", words.front(), place);
    std::thread([child] { ::waitpid(child, nullptr, 0); }).detach(); // nobody else would bury it
    return "opened " + place;
}

} // namespace fathom::viewer
