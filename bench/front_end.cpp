// What the front end takes for long texts (parse, check, prove, lower), and the proof for many
// deformed parts. Processor time, since all of it is one thread's; on a quiet machine the same as
// the clock's.
#include "bench/measure.h"

#include "lang/parse.h"

#include <algorithm>
#include <filesystem>
#include <fmt/format.h>

namespace fathom::bench {

namespace {

// The block, as often as makes `lines` of it, with `_0` counted up: `at_0 = 0` becomes `at_7 = 7`.
std::string long_text(const std::string &block, std::size_t lines) {
    const auto block_lines = static_cast<std::size_t>(std::count(block.begin(), block.end(), '\n'));
    std::string text;
    for (std::size_t copy = 0; copy * block_lines < lines; ++copy) {
        const std::string suffix = fmt::format("_{}", copy), start = "let at_0 = 0";
        for (std::size_t at = 0; at < block.size();) {
            if (block.compare(at, start.size(), start) == 0) {
                text += fmt::format("let at{} = {}", suffix, copy);
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
    std::sort(all.begin(), all.end(),
              [](const auto &a, const auto &b) { return a.all() < b.all(); });
    return all[all.size() / 2];
}

void measure_proof(Table &table, const std::string &what, const std::string &text, double maximum) {
    std::string wrong;
    const PhaseTimes times = median_times(7, [&] {
        PhaseTimes each;
        wrong = complaint(compiled_text("parts.sdf", text, &each));
        return each;
    });
    if (wrong.empty())
        table.push_back({.what = what, .value = times.prove, .unit = "ms", .maximum = maximum});
    else
        table.push_back({.what = what, .missing = wrong});
}

} // namespace

void measure_front_end(Table &table) {
    // What a scene of one line costs: above all the standard library, which every scene is checked
    // with.
    table.push_back({.what = "front end, a scene of 1 line",
                     .value = median_times(11,
                                           [] {
                                               PhaseTimes each;
                                               compiled_text("sphere.sdf", "sphere(1)\n", &each);
                                               return each;
                                           })
                                  .all(),
                     .unit = "ms"});
    const std::string block = text_of(scene_path("typical.sdf"));
    for (const int lines : {1'000, 10'000, 100'000}) {
        const std::string text = long_text(block, static_cast<std::size_t>(lines));
        const std::string what = fmt::format("front end, {} lines", lines);
        const int runs = lines > 10'000 ? 1 : lines > 1'000 ? 3 : 11;
        std::string wrong;
        const PhaseTimes times = median_times(runs, [&] {
            PhaseTimes each;
            wrong = complaint(compiled_text("typical.sdf", text, &each));
            return each;
        });
        if (!wrong.empty()) {
            table.push_back({.what = what, .missing = wrong});
            continue;
        }
        std::vector<double> parses;
        for (int i = 0; i < runs; ++i) {
            Sources sources;
            Diagnostics diagnostics;
            const SourceId source = sources.add("typical.sdf", text);
            const double begin = processor_seconds();
            lang::parse(sources, source, diagnostics);
            parses.push_back((processor_seconds() - begin) * 1e3);
        }
        auto row = [&](const std::string &of, double milliseconds, double maximum) {
            table.push_back({.what = of,
                             .value = milliseconds / (lines / 1000.0),
                             .unit = "ms/1000 lines",
                             .maximum = maximum});
        };
        row(what, times.all(), 5);
        row("  of it parse", median(parses), 0);
        row("  of it check", times.check - median(parses), 0);
        row("  of it prove", times.prove, 0);
        row("  of it lower", times.lower, 0);
    }

    const std::string deformed = text_of(scene_path("deformed_75.sdf"));
    const std::string displaced = text_of(scene_path("displaced_25.sdf"));
    const std::string fields = text_of(scene_path("fields_3.sdf"));
    measure_proof(table, "proof of 100 deformed parts, 3 fields", deformed + displaced + fields,
                  50);
    measure_proof(table, "  75 twisted, bent, tapered parts alone", deformed, 0);
    measure_proof(table, "  25 spheres alone, each displaced by another formula", displaced, 0);
    measure_proof(table, "  3 implicit fields alone", fields, 0);
}

} // namespace fathom::bench
