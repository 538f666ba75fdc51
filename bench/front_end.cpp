// What the front end takes for long texts (parse, check, prove, lower), and the proof for many deformed parts.
#include "bench/measure.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>

namespace fathom::bench {

namespace {

std::string text_of(const std::string &path) {
    std::ifstream in(path);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

// The block, as often as makes `lines` of it, with `_0` counted up: `at_0 = 0` becomes `at_7 = 7`.
std::string long_text(const std::string &block, std::size_t lines) {
    const auto block_lines = static_cast<std::size_t>(std::count(block.begin(), block.end(), '\n'));
    std::string text;
    for (std::size_t copy = 0; copy * block_lines < lines; ++copy) {
        const std::string suffix = '_' + std::to_string(copy), start = "let at_0 = 0";
        for (std::size_t at = 0; at < block.size();) {
            if (block.compare(at, start.size(), start) == 0) {
                text += "let at" + suffix + " = " + std::to_string(copy);
                at += start.size();
            } else if (block.compare(at, 2, "_0") == 0) {
                text += suffix;
                at += 2;
            } else {
                text += block[at++];
            }
        }
    }
    return text;
}

// Several runs, the one of median length.
PhaseTimes median_times(int runs, const std::function<PhaseTimes()> &run) {
    std::vector<PhaseTimes> all;
    for (int i = 0; i < runs; ++i) all.push_back(run());
    std::sort(all.begin(), all.end(), [](const auto &a, const auto &b) { return a.all() < b.all(); });
    return all[all.size() / 2];
}

} // namespace

void measure_front_end(Table &table) {
    const std::string block = text_of(scene_path("typical.sdf"));
    for (const int lines : {1'000, 10'000, 100'000}) {
        const std::string text = long_text(block, static_cast<std::size_t>(lines));
        const std::string what = "front end, " + std::to_string(lines) + " lines";
        std::string wrong;
        const PhaseTimes times = median_times(lines > 10'000 ? 1 : lines > 1'000 ? 3 : 11, [&] {
            PhaseTimes each;
            wrong = complaint(compiled_text("typical.sdf", text, &each));
            return each;
        });
        if (!wrong.empty()) {
            table.push_back({.what = what, .missing = wrong});
            continue;
        }
        const double thousands = lines / 1000.0;
        table.push_back({.what = what, .value = times.all() / thousands, .unit = "ms/1000 lines", .most = 5});
        table.push_back({.what = "  of it parse and check", .value = times.check / thousands, .unit = "ms/1000 lines"});
        table.push_back({.what = "  of it prove", .value = times.prove / thousands, .unit = "ms/1000 lines"});
        table.push_back({.what = "  of it lower", .value = times.lower / thousands, .unit = "ms/1000 lines"});
    }

    std::string wrong;
    std::vector<double> proofs;
    for (int i = 0; i < 9; ++i) {
        PhaseTimes times;
        wrong = complaint(compiled("deformed_100.sdf", &times));
        proofs.push_back(times.prove);
    }
    const std::string what = "proof of 100 deformed parts, 3 fields";
    if (wrong.empty())
        table.push_back({.what = what, .value = median(proofs), .unit = "ms", .most = 50});
    else
        table.push_back({.what = what, .missing = wrong});
}

} // namespace fathom::bench
