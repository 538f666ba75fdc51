// A save's way to the screen, part by part: how soon the watcher tells, what the front end takes,
// how long until the window shows an error or the new picture. The last are measured in the program
// itself (`view --times`), on a display of its own. Clock time by its nature: on a busy machine it
// says little.
#include "bench/measure.h"

#include "driver/watch.h"

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <fcntl.h>
#include <filesystem>
#include <fmt/format.h>
#include <fstream>
#include <optional>
#include <sstream>
#include <sys/wait.h>
#include <thread>
#include <unistd.h>

namespace fathom::bench {

namespace {

namespace fs = std::filesystem;
using std::chrono::milliseconds;

struct Folder {
    fs::path path;
    Folder() {
        std::string name = (fs::temp_directory_path() / "fathom-bench-XXXXXX").string();
        path = ::mkdtemp(name.data()) ? fs::path(name) : fs::path();
    }
    ~Folder() {
        std::error_code ignored;
        if (!path.empty()) fs::remove_all(path, ignored);
    }
    Folder(const Folder &) = delete;
    Folder &operator=(const Folder &) = delete;
    void write(const std::string &text) const { std::ofstream(path / "scene.sdf") << text; }
};

double at_share(std::vector<double> values, double share) {
    std::sort(values.begin(), values.end());
    const double rank = share * static_cast<double>(values.size());
    return values[std::min(static_cast<std::size_t>(rank), values.size() - 1)];
}

// -- the event

void measure_events(Table &table) {
    const Folder folder;
    folder.write("sphere(1)\n");
    driver::Watcher watcher;
    const fs::path file = folder.path / "scene.sdf";
    watcher.watch({{file, driver::stamp_of(file)}});
    std::vector<double> taken;
    for (int i = 0; i < 200; ++i) {
        double wrote = 0, told = 0;
        std::thread writer([&] {
            std::this_thread::sleep_for(milliseconds(5)); // the other one waits by then
            folder.write(fmt::format("sphere(1.{})\n", i));
            wrote = seconds_now();
        });
        const bool seen = watcher.wait(milliseconds(2000));
        told = seconds_now();
        writer.join();
        if (seen) taken.push_back((told - wrote) * 1e3);
    }
    if (taken.size() < 200) {
        table.push_back({.what = "save to event, p99",
                         .missing = fmt::format("{} of 200 saves missed", 200 - taken.size())});
        return;
    }
    table.push_back(
        {.what = "save to event, median of 200", .value = at_share(taken, 0.5), .unit = "ms"});
    table.push_back(
        {.what = "save to event, p99", .value = at_share(taken, 0.99), .unit = "ms", .maximum = 5});
}

// -- the window

struct Child {
    pid_t id = -1;
    ~Child() {
        if (id <= 0) return;
        ::kill(id, SIGTERM);
        ::waitpid(id, nullptr, 0);
    }
};

void start(Child &child, const std::vector<std::string> &words, int extra, const fs::path &errors) {
    child.id = ::fork();
    if (child.id != 0) return;
    if (extra >= 0) ::dup2(extra, 3);
    const int nowhere = ::open("/dev/null", O_RDWR);
    ::dup2(nowhere, STDOUT_FILENO);
    ::dup2(errors.empty() ? nowhere : ::open(errors.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0666),
           STDERR_FILENO);
    std::vector<char *> arguments;
    for (const std::string &word : words) arguments.push_back(const_cast<char *>(word.c_str()));
    arguments.push_back(nullptr);
    ::execvp(arguments[0], arguments.data());
    ::_exit(127);
}

// `DISPLAY` for a server of our own; empty where there is none.
std::string own_display(Child &server) {
    int ends[2];
    if (::pipe(ends) != 0) return "";
    start(server, {"Xvfb", "-displayfd", "3", "-screen", "0", "800x600x24", "-nolisten", "tcp"},
          ends[1], {});
    ::close(ends[1]);
    std::string number;
    for (char c; ::read(ends[0], &c, 1) == 1 && c != '\n';) number += c;
    ::close(ends[0]);
    return number.empty() ? "" : ":" + number;
}

std::vector<std::string> lines_of(const fs::path &file) {
    std::ifstream in(file);
    std::vector<std::string> lines;
    for (std::string line; std::getline(in, line);)
        if (line.find("reload:") != line.npos) lines.push_back(line);
    return lines;
}

// The number before " ms" that follows `word`.
double number_after(const std::string &line, const std::string &word) {
    const std::size_t at = line.find(word);
    return at == line.npos ? 0 : std::atof(line.c_str() + at + word.size());
}

void measure_window(Table &table) {
    Child server;
    const std::string display = own_display(server);
    if (display.empty()) {
        table.push_back({.what = "save to screen", .missing = "there is no Xvfb"});
        return;
    }
    ::setenv("DISPLAY", display.c_str(), 1);
    const Folder folder;
    const auto text = [](int i) {
        return fmt::format("sphere({}).paint(orange)\nbox(1).translate([1.5, 0, 0])\n",
                           1 + i * 0.001);
    };
    folder.write(text(0));
    std::error_code failed;
    const std::string program =
        fs::read_symlink("/proc/self/exe", failed).replace_filename("fathom");
    const fs::path said = folder.path / "said";
    Child viewer;
    start(viewer,
          {program, "view", (folder.path / "scene.sdf").string(), "--times", "--size", "320x240"},
          -1, said);
    const auto wait_for = [&](std::size_t count) {
        for (int tries = 0; tries < 3000; ++tries) {
            if (lines_of(said).size() >= count) return true;
            std::this_thread::sleep_for(milliseconds(2));
        }
        return false;
    };
    if (!wait_for(1)) {
        table.push_back({.what = "save to screen", .missing = "the viewer does not start"});
        return;
    }
    std::vector<double> front_end, number, error;
    std::size_t count = 1;
    for (int i = 1; i <= 60; ++i) {
        const bool wrong = i % 3 == 0;
        folder.write(wrong ? "sphre(1)\n" : text(i));
        if (!wait_for(++count)) {
            table.push_back({.what = "save to screen", .missing = "a save was missed"});
            return;
        }
        const std::string line = lines_of(said).back();
        if (i < 4) continue; // the first edit of a number is compiled by the driver
        const double since = number_after(line, "on the screen ");
        front_end.push_back(number_after(line, "front end "));
        (wrong ? error : number).push_back(since);
    }
    table.push_back({.what = "reload, front end, median",
                     .value = median(front_end),
                     .unit = "ms",
                     .maximum = 20});
    table.push_back({.what = "save to error on the screen, median",
                     .value = median(error),
                     .unit = "ms",
                     .maximum = 50});
    table.push_back({.what = "save to new picture, a number edited, median",
                     .value = median(number),
                     .unit = "ms"});

    // Fifty saves in a second: how often is compiled after the last?
    for (int i = 0; i < 50; ++i) {
        folder.write(text(100 + i));
        std::this_thread::sleep_for(milliseconds(20));
    }
    const std::size_t at_last = lines_of(said).size();
    std::this_thread::sleep_for(milliseconds(1500));
    table.push_back({.what = "50 saves in a second, reloads after the last",
                     .value = static_cast<double>(lines_of(said).size() - at_last),
                     .unit = "",
                     .maximum = 2});
}

} // namespace

void measure_reload(Table &table) {
    measure_events(table);
    measure_window(table);
}

} // namespace fathom::bench
