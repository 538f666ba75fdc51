#include "cli/terminal.h"

#include "base/encode.h"
#include "base/text.h"

#include <fathom/files.h>
#include <fathom/watch.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fmt/format.h>
#include <sys/ioctl.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::cli {
namespace {

constexpr std::size_t buffer_size = 1 << 16;

long long milliseconds_now() {
    return std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

std::string lines_for_terminal(std::string_view text) {
    std::string out;
    while (!text.empty()) {
        const std::size_t end = text.find('\n');
        out += for_terminal(text.substr(0, end));
        if (end == text.npos) break;
        out += '\n';
        text.remove_prefix(end + 1);
    }
    return out;
}

// Shows the text by a pager, until the reader leaves it. False: it fits, or there is no pager.
bool is_paged(const std::string &text) {
    winsize size{};
    if (::ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) != 0 || size.ws_row == 0 ||
        std::ranges::count(text, '\n') < size.ws_row)
        return false;
    const char *named = std::getenv("PAGER");
    if (named && !*named) return false;
    ::setenv("LESS", "FRX", 0); // where the reader says nothing: the text stays when less is left
    FILE *pager = ::popen(
        named ? named : "if command -v less >/dev/null; then exec less; else exec cat; fi", "w");
    if (!pager) return false;
    const auto before = std::signal(SIGINT, SIG_IGN); // Ctrl-C is the pager's
    (void)v1::write_all(::fileno(pager), text);       // the reader may leave before the end
    const int status = ::pclose(pager);
    std::signal(SIGINT, before);
    return !(WIFEXITED(status) && WEXITSTATUS(status) == 127); // the shell said that there is none
}

} // namespace

Terminal::Terminal(ColorChoice color) {
    const char *no_color = std::getenv("NO_COLOR");
    const char *kind = std::getenv("TERM");
    interactive_ = ::isatty(STDERR_FILENO) != 0 && kind && std::string_view(kind) != "dumb";
    switch (color) {
    case ColorChoice::Auto: color_ = interactive_ && !(no_color && *no_color); break;
    case ColorChoice::Always: color_ = true; break;
    case ColorChoice::Never: color_ = false; break;
    }
}

void Terminal::put(std::string_view results) {
    if (gone_ || failure_) return;
    buffer_ += results;
    if (!pages_ && buffer_.size() >= buffer_size) flush();
}

Exit Terminal::flush() {
    if (!failure_ && !gone_ && !buffer_.empty()) {
        const bool shown = ::isatty(STDOUT_FILENO) != 0;
        if (shown) buffer_ = lines_for_terminal(buffer_);
        const bool paged = shown && pages_ && is_paged(buffer_);
        const int error = paged ? 0 : v1::write_all(STDOUT_FILENO, buffer_);
        if (error == EPIPE)
            gone_ = true;
        else if (error) {
            failure_ = error;
            say(fmt::format("fathom: cannot write to standard output: {}", v1::error_words(error)));
        }
    }
    buffer_.clear();
    return failure_ ? device_error : done;
}

void Terminal::say(std::string_view words) { say_text(for_terminal(words)); }

void Terminal::say_text(std::string_view text) {
    finish_progress();
    std::string line(text);
    if (line.empty() || line.back() != '\n') line += '\n';
    (void)v1::write_all(STDERR_FILENO,
                        line); // where words cannot be said, nothing can be said about it
}

std::string duration_words(double seconds) {
    const long long s = std::llround(std::min(std::max(seconds, 0.0), 1e15));
    if (s < 60) return fmt::format("{} s", s);
    if (s < 3600) return fmt::format("{} min {} s", s / 60, s % 60);
    return fmt::format("{} h {} min", s / 3600, s / 60 % 60);
}

void Terminal::progress(std::string_view what, double share, double left) {
    if (!interactive_) return;
    long long now = milliseconds_now();
    if (now < next_bar_) return;
    next_bar_ = now + 50;
    constexpr int width = 30;
    int full = static_cast<int>(std::clamp(share, 0.0, 1.0) * width);
    (void)v1::write_all(STDERR_FILENO,
                        fmt::format("\r\x1b[K{} [{:#<{}}{:.<{}}] {:3.0f} %{}", for_terminal(what),
                                    "", full, "", width - full, 100 * share,
                                    left < 0 ? "" : ", " + duration_words(left) + " left"));
    bar_shown_ = true;
}

void Terminal::finish_progress() {
    if (preview_rows_ > 0)
        (void)v1::write_all(STDERR_FILENO, fmt::format("\r\x1b[{}A\x1b[J", preview_rows_));
    else if (bar_shown_)
        (void)v1::write_all(STDERR_FILENO, "\r\x1b[K");
    bar_shown_ = false;
    preview_rows_ = 0;
    next_bar_ = next_preview_ = 0;
}

void Terminal::preview(int rows, const std::function<std::string()> &lines) {
    const long long now = milliseconds_now();
    if (!interactive_ || rows <= 0 || now < next_preview_) return;
    next_preview_ = now + 200;
    std::string text = "\r";
    if (preview_rows_ > 0) text += fmt::format("\x1b[{}A", preview_rows_);
    (void)v1::write_all(STDERR_FILENO, text + lines());
    preview_rows_ = rows;
    next_bar_ = 0;
}

v1::CompileOptions library_options(const SceneArguments &scene) {
    v1::CompileOptions options;
    options.include_folders = scene.include_folders;
    for (const Definition &set : scene.overrides) options.definitions[set.name] = set.text;
    for (const LimitRow &row : limit_rows())
        if (scene.limits.*row.member != row.usual)
            options.limits[row.name] = fmt::to_string(scene.limits.*row.member);
    options.strict_proof = scene.strict_proof;
    return options;
}

v1::CompileOptions library_options(const SceneArguments &scene, double first, double last) {
    v1::CompileOptions options = library_options(scene);
    options.times = {first, last};
    return options;
}

void print_diagnostics(const std::vector<v1::Diagnostic> &diagnostics, std::size_t dropped,
                       const v1::Texts &texts, Terminal &terminal) {
    for (const v1::Diagnostic &diagnostic : diagnostics)
        terminal.say_text(v1::printed(diagnostic, texts, terminal.color()));
    if (dropped > 0) terminal.say(fmt::format("({} more are not shown)", dropped));
}

bool has_errors(const std::vector<v1::Diagnostic> &diagnostics) {
    return std::ranges::any_of(
        diagnostics, [](const v1::Diagnostic &d) { return d.severity == v1::Severity::Error; });
}

Exit report(const v1::CompileResult &result, Terminal &terminal) {
    print_diagnostics(result.diagnostics, result.dropped, result.texts, terminal);
    if (result.scene) return done;
    // The codes of what is wrong, but not in a text (fathom/scene.h).
    bool usage = false;
    for (const v1::Diagnostic &d : result.diagnostics) {
        if (d.code == "unreadable" || d.code == "memory" || d.code == "internal")
            return device_error;
        if (d.code == "usage")
            usage = true;
        else if (d.severity == v1::Severity::Error)
            return scene_error;
    }
    return usage ? usage_error : scene_error;
}

bool is_about_no_text(const v1::CompileResult &result) {
    return std::ranges::any_of(result.diagnostics, [](const v1::Diagnostic &d) {
        return d.code == "unreadable" || d.code == "usage";
    });
}

bool in_proved_time(const v1::Facts &facts, double first, double last, Terminal &terminal) {
    const double end = facts.time_end;
    if (v1::hold_at(facts, first) && v1::hold_at(facts, last)) return true;
    terminal.say(fmt::format("fathom: --time {}: this scene is proved from 0 to {} seconds; "
                             "`render(time: …)` in it says to which time",
                             format_shortest(first < 0 ? first : last), format_shortest(end)));
    return false;
}

Exit watch_scene(const SceneArguments &scene, const v1::CompileOptions &options, Terminal &terminal,
                 const std::function<Exit(const v1::CompileResult &)> &act) {
    v1::Watcher watcher;
    std::string told;
    for (;;) {
        {
            const v1::CompileResult result = v1::compile_file(scene.file, options);
            Exit exit = act(result);
            if (terminal.flush() != done || terminal.reader_gone()) return exit;
            watcher.watch(result);
        }
        if (watcher.polls_because() != told) {
            told = watcher.polls_because();
            terminal.say("fathom: " + told);
        }
        while (!watcher.wait(std::chrono::hours(1))) {
        }
        terminal.say(fmt::format("-- {} was saved", scene.file));
    }
}

} // namespace fathom::cli
