// How fathom-bench measures, and what a row of its table is. A file of rows defines `void measure_…(Table &)` and main
// calls it. Everything is a ratio of two things timed in the same run, as near to each other as can be; the absolute
// numbers are for the eye.
#pragma once

#include <functional>
#include <string>
#include <vector>

namespace fathom::bench {

struct Row {
    std::string what;     // "100-sphere smooth union"
    double rate = 0;      // of us, in `unit`
    std::string unit;     // "M points/s"
    std::string baseline; // what it is compared with; empty: nothing
    double baseline_rate = 0;
    double least = 0;     // the ratio to reach; 0: none
};
using Table = std::vector<Row>;

// Times `run`, which does `amount` of work, and `other` in turn for about half a second; the best rates of both.
struct Rates {
    double first = 0, second = 0;
};
Rates rates(double amount, const std::function<void()> &run, double other_amount, const std::function<void()> &other);
double rate(double amount, const std::function<void()> &run);

void print(const Table &table);
std::string machine(); // processor, cores, compiler

void measure_interpreter(Table &table);

} // namespace fathom::bench
