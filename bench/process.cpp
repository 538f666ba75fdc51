// `fathom check` as a user meets it: a whole process, from its start to its end.
#include "bench/measure.h"

#include <fcntl.h>
#include <filesystem>
#include <optional>
#include <spawn.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace fathom::bench {

namespace {

constexpr int runs = 31;

double milliseconds(const timeval &time) {
    return static_cast<double>(time.tv_sec) * 1e3 + static_cast<double>(time.tv_usec) * 1e-3;
}

struct Cost {
    double wall = 0, processor = 0; // milliseconds
};

// What a program that says nothing costs; nothing where it could not be run, or failed.
std::optional<Cost> cost(const std::string &program, std::vector<std::string> arguments) {
    std::vector<char *> argv;
    for (std::string &argument : arguments) argv.push_back(argument.data());
    argv.push_back(nullptr);
    posix_spawn_file_actions_t quiet;
    posix_spawn_file_actions_init(&quiet);
    posix_spawn_file_actions_addopen(&quiet, STDOUT_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&quiet, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    bool done = false;
    rusage used{};
    const double wall = seconds([&] {
        pid_t child = 0;
        int status = 0;
        done = posix_spawn(&child, program.c_str(), &quiet, nullptr, argv.data(), environ) == 0 &&
               wait4(child, &status, 0, &used) == child && WIFEXITED(status) &&
               WEXITSTATUS(status) == 0;
    });
    posix_spawn_file_actions_destroy(&quiet);
    if (!done) return std::nullopt;
    return Cost{wall * 1e3, milliseconds(used.ru_utime) + milliseconds(used.ru_stime)};
}

} // namespace

void measure_process(Table &table) {
    std::error_code failed;
    const std::string program =
        std::filesystem::read_symlink("/proc/self/exe", failed).replace_filename("fathom");
    std::vector<double> wall, processor;
    for (int i = 0; i < runs; ++i) {
        const auto each =
            cost(program, {"fathom", "check", FATHOM_SOURCE_DIR "/examples/03_colonnade.sdf"});
        if (!each) {
            table.push_back({.what = "fathom check 03_colonnade",
                             .missing = program + " could not be run, or failed"});
            return;
        }
        wall.push_back(each->wall);
        processor.push_back(each->processor);
    }
    // The strongest peer takes 64 to 76 ms for a scene of this size.
    table.push_back({.what = "fathom check 03_colonnade, process, wall",
                     .value = median(wall),
                     .unit = "ms",
                     .maximum = 30});
    table.push_back({.what = "fathom check 03_colonnade, user + system",
                     .value = median(processor),
                     .unit = "ms",
                     .maximum = 30});
}

} // namespace fathom::bench
