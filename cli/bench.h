// The parts of `fathom bench` that stand in files of their own.
#pragma once

#include "cli/terminal.h"

#include <vector>

namespace fathom::cli {

double median(std::vector<double> values); // 0 of none

Exit bench_noise_cache(const BenchCommand &command, const ir::Scene &scene,
                       Terminal &terminal); // bench_cache.cpp

} // namespace fathom::cli
