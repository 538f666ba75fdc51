#include "viewer/editor.h"

#include "base/encode.h"

#include <algorithm>
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

std::vector<std::string> words_of(std::string_view text) {
    std::istringstream in{std::string(text)};
    std::vector<std::string> words;
    for (std::string word; in >> word;) words.push_back(word);
    return words;
}

std::string program_of(const std::string &editor) {
    const std::vector<std::string> words = words_of(editor);
    return words.empty() ? "" : std::filesystem::path(words.front()).filename().string();
}

enum class Lives { InWindow, InTerminal, AsTold }; // AsTold: in a terminal by -nw, -t or -tty

// How an editor is told a place: words, with blanks between them.
struct EditorRow {
    std::string_view program, words;
    Lives lives;
};
constexpr EditorRow editors[] = {
    {"code", "-g {file}:{line}:{column}", Lives::InWindow},
    {"code-insiders", "-g {file}:{line}:{column}", Lives::InWindow},
    {"codium", "-g {file}:{line}:{column}", Lives::InWindow},
    {"cursor", "-g {file}:{line}:{column}", Lives::InWindow},
    {"windsurf", "-g {file}:{line}:{column}", Lives::InWindow},
    {"subl", "{file}:{line}:{column}", Lives::InWindow},
    {"zed", "{file}:{line}:{column}", Lives::InWindow},
    {"zeditor", "{file}:{line}:{column}", Lives::InWindow},
    {"kate", "--line {line} --column {column} {file}", Lives::InWindow},
    {"hx", "{file}:{line}:{column}", Lives::InTerminal},
    {"helix", "{file}:{line}:{column}", Lives::InTerminal},
    {"vi", "+{line} {file}", Lives::InTerminal},
    {"vim", "+{line} {file}", Lives::InTerminal},
    {"nvim", "+{line} {file}", Lives::InTerminal},
    {"nano", "+{line} {file}", Lives::InTerminal},
    {"pico", "+{line} {file}", Lives::InTerminal},
    {"micro", "+{line} {file}", Lives::InTerminal},
    {"kak", "+{line} {file}", Lives::InTerminal},
    {"joe", "+{line} {file}", Lives::InTerminal},
    {"mg", "+{line} {file}", Lives::InTerminal},
    {"ne", "+{line} {file}", Lives::InTerminal},
    {"ed", "+{line} {file}", Lives::InTerminal},
    {"emacs", "+{line} {file}", Lives::AsTold},
    {"emacsclient", "+{line} {file}", Lives::AsTold},
};
constexpr EditorRow any_other{"", "+{line} {file}", Lives::InWindow};

// What stands between a terminal's name and the command that it runs; each takes the command as
// words, never as a line for a shell.
struct TerminalRow {
    std::string_view program, words;
};
constexpr TerminalRow terminals[] = {
    {"gnome-terminal", "--"}, {"xfce4-terminal", "-x"}, {"mate-terminal", "-x"},
    {"terminator", "-x"},     {"wezterm", "start --"},
};
constexpr TerminalRow any_other_terminal{"", "-e"}; // as Debian's policy wants (11.8.3)

template <std::size_t N, class Row>
const Row &row_of(const Row (&rows)[N], const Row &other, const std::string &program) {
    const auto *found = std::ranges::find(rows, program, &Row::program);
    return found == std::end(rows) ? other : *found;
}

// A name that no program takes for an option or a command: it begins with `/`, or with `./` where
// the working folder is gone.
std::string as_argument(const std::string &file) {
    std::error_code error;
    const std::filesystem::path path = std::filesystem::absolute(file, error);
    return error ? "./" + file : path.string();
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
    switch (row_of(editors, any_other, program_of(editor)).lives) {
    case Lives::InWindow: return false;
    case Lives::InTerminal: return true;
    case Lives::AsTold: break;
    }
    return std::ranges::any_of(words, [](const std::string &word) {
        return word == "-nw" || word == "-t" || word == "-tty";
    });
}

std::vector<std::string> editor_command(const std::string &editor, const std::string &file,
                                        unsigned line, unsigned column) {
    std::vector<std::string> words = words_of(editor);
    for (const std::string &form : words_of(row_of(editors, any_other, program_of(editor)).words))
        words.push_back(fmt::format(fmt::runtime(form), fmt::arg("file", as_argument(file)),
                                    fmt::arg("line", line), fmt::arg("column", column)));
    return words;
}

std::vector<std::string> in_terminal(const std::string &terminal,
                                     const std::vector<std::string> &command) {
    std::vector<std::string> words = words_of(terminal);
    const auto between =
        words_of(row_of(terminals, any_other_terminal, program_of(terminal)).words);
    words.insert(words.end(), between.begin(), between.end());
    words.insert(words.end(), command.begin(), command.end());
    return words;
}

std::string open_in_editor(const std::string &editor, const std::string &file, unsigned line,
                           unsigned column) {
    const std::string place = for_terminal(fmt::format("{}:{}", file, line));
    if (words_of(editor).empty()) return place + "; set $EDITOR, and a click opens it there";
    std::vector<std::string> words = editor_command(editor, file, line, column);
    if (needs_terminal(editor)) {
        const std::string terminal = variable("TERMINAL");
        words = in_terminal(words_of(terminal).empty() ? "x-terminal-emulator" : terminal, words);
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
