// `fathom check` and `fathom compile` as a user meets them: whole processes, from start to end.
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

double milliseconds_of(const timeval &time) {
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
    return Cost{wall * 1e3, milliseconds_of(used.ru_utime) + milliseconds_of(used.ru_stime)};
}

// Several runs of several commands in turn, so that what else the machine does meets all of them:
// the median of each. Nothing where one failed.
std::optional<std::vector<Cost>> costs(const std::string &program,
                                       const std::vector<std::vector<std::string>> &commands) {
    std::vector<std::vector<double>> wall(commands.size()), processor(commands.size());
    for (int i = 0; i < runs; ++i)
        for (std::size_t k = 0; k < commands.size(); ++k) {
            const auto each = cost(program, commands[k]);
            if (!each) return std::nullopt;
            wall[k].push_back(each->wall);
            processor[k].push_back(each->processor);
        }
    std::vector<Cost> medians;
    for (std::size_t k = 0; k < commands.size(); ++k)
        medians.push_back({median(wall[k]), median(processor[k])});
    return medians;
}

} // namespace

void measure_process(Table &table) {
    std::error_code failed;
    const std::string program =
        std::filesystem::read_symlink("/proc/self/exe", failed).replace_filename("fathom");
    const std::string small = FATHOM_SOURCE_DIR "/examples/01_sphere.sdf";
    const auto all =
        costs(program, {{"fathom", "check", FATHOM_SOURCE_DIR "/examples/03_colonnade.sdf"},
                        {"fathom", "check", small},
                        {"fathom", "compile", small, "-o", "-"},
                        {"fathom", "compile", small, "-o", "-", "--target", "es300"}});
    if (!all) {
        table.push_back({.what = "fathom check and fathom compile",
                         .missing = program + " could not be run, or failed"});
        return;
    }
    const auto row = [&](const std::string &what, double milliseconds, double maximum) {
        table.push_back({.what = what, .value = milliseconds, .unit = "ms", .maximum = maximum});
    };
    // The strongest peer takes 64 to 76 ms for a scene of this size.
    row("fathom check 03_colonnade, process, wall", (*all)[0].wall, 30);
    row("fathom check 03_colonnade, user + system", (*all)[0].processor, 30);
    const Cost check = (*all)[1], compile = (*all)[2], es = (*all)[3];
    row("fathom check 01_sphere, user + system", check.processor, 0);
    row("fathom compile 01_sphere, beyond it", compile.processor - check.processor, 20);
    row("the same, --target es300", es.processor - check.processor, 20);
}

} // namespace fathom::bench
