// The clock and the printed table.
#include "bench/measure.h"

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <fstream>
#include <thread>

namespace fathom::bench {

namespace {

double seconds(const std::function<void()> &run) {
    const auto begin = std::chrono::steady_clock::now();
    run();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
}

} // namespace

Rates rates(double amount, const std::function<void()> &run, double other_amount, const std::function<void()> &other) {
    double best = 1e30, best_other = 1e30, spent = 0;
    run();
    other();
    for (int turn = 0; turn < 5 || spent < 0.5; ++turn) {
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
    for (int turn = 0; turn < 5 || spent < 0.25; ++turn) {
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
    return name + ", " + std::to_string(std::thread::hardware_concurrency()) + " threads, " + __VERSION__;
}

void print(const Table &table) {
    std::printf("%-34s %12s %-14s %8s %7s  %s\n", "what", "rate", "unit", "ratio", "least", "to");
    for (const Row &row : table) {
        std::printf("%-34s %12.4g %-14s ", row.what.c_str(), row.rate, row.unit.c_str());
        if (row.baseline.empty()) {
            std::printf("\n");
            continue;
        }
        const double ratio = row.rate / row.baseline_rate;
        std::printf("%8.2f ", ratio);
        if (row.least > 0)
            std::printf("%7.2f%s", row.least, ratio >= row.least ? "  " : "! ");
        else
            std::printf("%7s  ", "");
        std::printf("%s (%.4g)\n", row.baseline.c_str(), row.baseline_rate);
    }
}

} // namespace fathom::bench
