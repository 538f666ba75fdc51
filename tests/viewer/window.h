// A display of its own (Xvfb), the viewer on it, and a user's hands: keys and the mouse by xdotool,
// saves, pictures of the window that the program itself takes. Waits are upper limits for a loaded
// machine; nothing here measures time.
#pragma once

#include "driver/image.h"
#include "scratch_folder.h"

#include <catch2/catch.hpp>
#include <chrono>
#include <cmath>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <functional>
#include <memory>
#include <set>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fathom::viewer_test {

namespace fs = std::filesystem;

constexpr std::chrono::seconds patience{30};
constexpr int status_height = 90; // its numbers differ from run to run

// A child process that ends with its owner.
class Process {
  public:
    struct Streams {
        int extra = -1;  // becomes descriptor 3
        fs::path errors; // empty: nowhere
        fs::path folder; // to start in; empty: here
    };
    Process(const std::vector<std::string> &words, const Streams &streams) {
        pid_ = ::fork();
        if (pid_ == 0) {
            if (streams.extra >= 0) ::dup2(streams.extra, 3);
            const int nowhere = ::open("/dev/null", O_RDWR);
            ::dup2(nowhere, STDIN_FILENO);
            ::dup2(nowhere, STDOUT_FILENO);
            const int errors = streams.errors.empty() ? nowhere
                                                      : ::open(streams.errors.c_str(),
                                                               O_WRONLY | O_CREAT | O_APPEND, 0666);
            ::dup2(errors, STDERR_FILENO);
            if (!streams.folder.empty() && ::chdir(streams.folder.c_str()) != 0) ::_exit(126);
            std::vector<char *> arguments;
            for (const std::string &word : words)
                arguments.push_back(const_cast<char *>(word.c_str()));
            arguments.push_back(nullptr);
            ::execvp(arguments[0], arguments.data());
            ::_exit(127);
        }
    }
    Process(const Process &) = delete;
    Process &operator=(const Process &) = delete;
    ~Process() {
        if (ended_) return;
        ::kill(pid_, SIGTERM);
        ::waitpid(pid_, nullptr, 0);
    }
    bool runs() {
        if (!ended_ && ::waitpid(pid_, &status_, WNOHANG) != 0) ended_ = true;
        return !ended_;
    }
    int exit_status() { // waits
        if (!ended_) ::waitpid(pid_, &status_, 0);
        ended_ = true;
        return WIFEXITED(status_) ? WEXITSTATUS(status_) : -1;
    }
    pid_t id() const { return pid_; }

  private:
    pid_t pid_ = -1;
    int status_ = 0;
    bool ended_ = false;
};

// One for the whole program, without a screen.
class Display {
  public:
    static const Display &need() {
        static const Display display;
        INFO("this test needs Xvfb and xdotool (./fathom-test installs them)");
        REQUIRE(!display.number_.empty());
        return display;
    }

    // What stands on the screen now, finished or not: how many colours the pixels of a rectangle
    // from the upper left have, of which the window covers a part without panels. Xvfb keeps the
    // screen in a file of the XWD format: big-endian words, then colours, then rows.
    std::size_t colors(int width, int height) const {
        const std::string file = memory_.read("Xvfb_screen0");
        const auto word = [&](std::size_t i) {
            std::size_t value = 0;
            for (std::size_t k = 0; k < 4; ++k)
                value = value << 8 | static_cast<unsigned char>(file[4 * i + k]);
            return value;
        };
        const std::size_t row = word(12), begin = word(0) + 12 * word(19);
        std::set<std::string> found;
        for (std::size_t y = 0; y < static_cast<std::size_t>(height); y += 3)
            for (std::size_t x = 0; x < static_cast<std::size_t>(width); x += 3)
                found.insert(file.substr(begin + y * row + 4 * x, 3));
        return found.size();
    }

  private:
    ScratchFolder memory_;
    Display() {
        int ends[2];
        if (::pipe(ends) != 0) return;
        server_ = std::make_unique<Process>(
            std::vector<std::string>{"Xvfb", "-displayfd", "3", "-screen", "0", "1024x768x24",
                                     "-fbdir", memory_.path().string(), "-nolisten", "tcp"},
            Process::Streams{ends[1], {}, {}});
        ::close(ends[1]);
        for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';) number_ += c;
        ::close(ends[0]);
        if (!number_.empty()) ::setenv("DISPLAY", (":" + number_).c_str(), 1);
        ::unsetenv("WAYLAND_DISPLAY");
        ::unsetenv("VISUAL");
        ::unsetenv("EDITOR");
    }
    std::string number_;
    std::unique_ptr<Process> server_;
};

inline bool waited(const std::function<bool()> &done) {
    const auto end = std::chrono::steady_clock::now() + patience;
    while (!done()) {
        if (std::chrono::steady_clock::now() > end) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return true;
}

// The viewer with a scene in a folder of its own.
class Window {
  public:
    ScratchFolder folder;

    explicit Window(const std::string &scene, std::vector<std::string> options = {},
                    const std::function<void(const ScratchFolder &)> &prepare = {},
                    const std::string &name = "scene.sdf") {
        Display::need();
        if (prepare) prepare(folder);
        folder.write(name, scene);
        std::vector<std::string> words{FATHOM_PROGRAM, "view", name, "--times", "--still"};
        if (std::find(options.begin(), options.end(), "--size") == options.end())
            options.insert(options.end(), {"--size", "480x320"});
        words.insert(words.end(), options.begin(), options.end());
        process_ = std::make_unique<Process>(
            words, Process::Streams{-1, folder / "errors.txt", folder.path()});
        REQUIRE(reloads(1));
        INFO(scene);
        REQUIRE(lines().back().find("good") != std::string::npos);
    }

    Process &process() { return *process_; }
    void save(const std::string &text) { folder.write("scene.sdf", text); }

    // Lines that --times has written so far.
    std::vector<std::string> lines() const {
        std::istringstream in(folder.read("errors.txt"));
        std::vector<std::string> result;
        for (std::string line; std::getline(in, line);)
            if (line.find("reload:") != line.npos) result.push_back(line);
        return result;
    }
    bool reloads(std::size_t count) {
        return waited([&] { return lines().size() >= count || !process_->runs(); }) &&
               process_->runs();
    }
    // Saves, and waits until that is on the screen; its line.
    std::string reload(const std::string &text) {
        const std::size_t before = lines().size();
        save(text);
        REQUIRE(reloads(before + 1));
        return lines().back();
    }

    void hands(const std::string &commands) { // xdotool's own words
        REQUIRE(std::system(("xdotool " + commands).c_str()) == 0);
        std::this_thread::sleep_for(
            std::chrono::milliseconds(100)); // the window hears in order, but may be asleep
    }
    void key(const std::string &name) { hands("key " + name); }

    // What the window shows now, by its own key for that; the mouse out of the way first, unless it
    // is to stay.
    ir::ImageData picture(bool mouse_away = true) {
        if (mouse_away) hands("mousemove 2 2");
        key("p");
        const fs::path file = folder / (fmt::format("scene-{}.png", ++pictures_));
        REQUIRE(waited([&] { return fs::exists(file) || !process_->runs(); }));
        std::string error;
        auto image = driver::decode_image(folder.read(file.filename().string()), error);
        REQUIRE(image);
        // Kept for whoever wants to look at what the tests saw.
        if (const char *keep = std::getenv("FATHOM_KEEP_PICTURES")) {
            static int kept = 0;
            fs::copy_file(file, fs::path(keep) / (fmt::format("{}.png", 1000 + ++kept)),
                          fs::copy_options::overwrite_existing);
        }
        return *image;
    }

  private:
    std::unique_ptr<Process> process_;
    int pictures_ = 0;
};

using Picture = ir::ImageData;

// What the viewer shows when it is started on that text. Keys go to the window on top: no other may
// be open meanwhile.
inline Picture cold_picture(const std::string &scene, std::vector<std::string> options = {}) {
    return Window(scene, std::move(options)).picture();
}

inline std::array<float, 3> pixel(const Picture &picture, int x, int y) {
    const std::size_t at =
        4 * (static_cast<std::size_t>(y) * static_cast<std::size_t>(picture.width) +
             static_cast<std::size_t>(x));
    return {picture.rgba[at], picture.rgba[at + 1], picture.rgba[at + 2]};
}

// The share of pixels that differ, in a window less its status line; `least`: by how much, in
// linear light.
inline double difference(const Picture &a, const Picture &b, double from = 0, float minimum = 0) {
    REQUIRE(a.width == b.width);
    REQUIRE(a.height == b.height);
    int differing = 0, all = 0;
    for (int y = static_cast<int>(from * a.height); y < a.height - status_height; ++y)
        for (int x = 0; x < a.width; ++x, ++all) {
            const auto p = pixel(a, x, y), q = pixel(b, x, y);
            bool differs = false;
            for (std::size_t c = 0; c < 3; ++c) differs |= std::abs(p[c] - q[c]) > minimum;
            differing += differs;
        }
    return static_cast<double>(differing) / all;
}

// Pixels of the colour that outlines have, (1, 0.6, 0.1) in sRGB, in columns from..to.
inline int outlined(const Picture &picture, int from, int to) {
    int count = 0;
    for (int y = 0; y < picture.height - status_height; ++y)
        for (int x = from; x < to; ++x) {
            const auto p = pixel(picture, x, y);
            count += p[0] > 0.95f && std::abs(p[1] - 0.319f) < 0.02f && p[2] < 0.03f;
        }
    return count;
}

} // namespace fathom::viewer_test
