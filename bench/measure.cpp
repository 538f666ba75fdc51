// The clock and the printed table.
#include "bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <ctime>
#include <fmt/format.h>
#include <fstream>
#include <sstream>
#include <thread>

namespace fathom::bench {

double seconds(const std::function<void()> &run) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

double seconds_now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
        .count();
}

double processor_seconds() {
    timespec now{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

double median(std::vector<double> values) {
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

Rates rates(double amount, const std::function<void()> &run, double other_amount,
            const std::function<void()> &other) {
    double best = 1e30, best_other = 1e30, spent = 0;
    run();
    other();
    for (int iteration = 0; iteration < 5 || spent < 0.5; ++iteration) {
        const double a = seconds(run), b = seconds(other);
        best = std::min(best, a);
        best_other = std::min(best_other, b);
        spent += a + b;
    }
    return {amount / best, other_amount / best_other};
}

double rate(double amount, const std::function<void()> &run) {
    double best = 1e30, spent = 0;
    run();
    for (int iteration = 0; iteration < 5 || spent < 0.25; ++iteration) {
        const double a = seconds(run);
        best = std::min(best, a);
        spent += a;
    }
    return amount / best;
}

std::string machine() {
    std::string line, name = "unknown processor";
    std::ifstream info("/proc/cpuinfo");
    while (std::getline(info, line))
        if (line.starts_with("model name")) {
            name = line.substr(line.find(':') + 2);
            break;
        }
    return fmt::format("{}, {} threads, {}", name, std::thread::hardware_concurrency(),
                       __VERSION__);
}

void print(const Table &table) {
    std::printf("%-54s %10s %-15s %7s %9s  %s\n", "what", "value", "unit", "ratio", "goal", "to");
    for (const Row &row : table) {
        if (!row.missing.empty()) {
            std::printf("%-54s %10s %s\n", row.what.c_str(), "-", row.missing.c_str());
            continue;
        }
        const bool compared = !row.baseline.empty();
        const double judged = compared ? row.value / row.baseline_value : row.value;
        std::printf("%-54s %10.4g %-15s ", row.what.c_str(), row.value, row.unit.c_str());
        if (compared)
            std::printf("%7.3f ", judged);
        else
            std::printf("%7s ", "");
        const double goal = row.minimum > 0 ? row.minimum : row.maximum;
        const bool reached = row.minimum > 0 ? judged >= row.minimum : judged <= row.maximum;
        if (goal > 0)
            std::printf("%s %6.4g%s", row.minimum > 0 ? ">=" : "<=", goal, reached ? " " : "!");
        else
            std::printf("%9s ", "");
        if (compared) std::printf(" %s (%.4g)", row.baseline.c_str(), row.baseline_value);
        std::printf("\n");
    }
}

namespace {

driver::Compilation
timed(PhaseTimes *times,
      const std::function<driver::Compilation(const driver::CompileOptions &)> &compile) {
    driver::CompileOptions options;
    double *current = nullptr, entered = 0;
    if (times)
        options.entered = [&](driver::Phase phase) {
            const double now = processor_seconds();
            if (current) *current += (now - entered) * 1e3;
            entered = now;
            switch (phase) {
            case driver::Phase::Check: current = &times->check; break;
            case driver::Phase::Prove: current = &times->prove; break;
            case driver::Phase::Lower: current = &times->lower; break;
            case driver::Phase::Read:
            case driver::Phase::Done: current = nullptr; break;
            }
        };
    return compile(options);
}

} // namespace

std::string text_of(const std::string &path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::string scene_path(const std::string &name) {
    return FATHOM_SOURCE_DIR "/bench/scenes/" + name;
}

driver::Compilation compiled(const std::string &name, PhaseTimes *times) {
    return timed(times, [&](const auto &options) {
        return driver::compile_file(scene_path(name), options);
    });
}

driver::Compilation compiled_text(const std::string &name, std::string text, PhaseTimes *times) {
    return timed(times, [&](const auto &options) {
        return driver::compile_text(name, std::move(text), FATHOM_SOURCE_DIR "/bench/scenes",
                                    options);
    });
}

std::string complaint(const driver::Compilation &compilation) {
    if (!compilation.unreadable.empty()) return compilation.unreadable;
    for (const Diagnostic &diagnostic : compilation.diagnostics.items())
        if (diagnostic.severity == Severity::Error) return diagnostic.message;
    return "";
}

} // namespace fathom::bench
