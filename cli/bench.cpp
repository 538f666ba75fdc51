// fathom bench: what a scene costs, phase by phase: medians of several runs on this machine, and
// counts that do not depend on it.
#include "cli/terminal.h"

#include <fathom/files.h>
#include <fathom/gl.h>

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>

namespace fathom::cli {

namespace {

double median(std::vector<double> values) {
    std::nth_element(values.begin(),
                     values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
    return values.empty() ? 0 : values[values.size() / 2];
}

using Clock = std::chrono::steady_clock;

double milliseconds_since(Clock::time_point start) {
    return std::chrono::duration<double, std::milli>(Clock::now() - start).count();
}

// The median time of a few calls: as many as fit into a second, at least three, at most 25.
double measure(const std::function<void()> &work) {
    std::vector<double> times;
    Clock::time_point start = Clock::now();
    while (times.size() < 3 || (times.size() < 25 && milliseconds_since(start) < 1000)) {
        Clock::time_point begin = Clock::now();
        work();
        times.push_back(milliseconds_since(begin));
    }
    return median(times);
}

using Json = nlohmann::ordered_json;

// What is measured, as it comes: a line each, beside an earlier run's number where there is one, or
// all as one document.
struct Measures {
    Terminal &terminal;
    bool json = false;
    Json rows = Json::array();
    std::map<std::string, double> earlier; // by name
};

void row(Measures &measures, std::string_view what, double value, std::string_view unit) {
    const std::string name(what.substr(what.find_first_not_of(' ')));
    measures.rows.push_back({{"name", name}, {"value", value}, {"unit", unit}});
    if (measures.json) return;
    std::string line = fmt::format("{:<26} {:>10.4g} {:<3}", what, value, unit);
    if (const auto old = measures.earlier.find(name); old != measures.earlier.end())
        line += fmt::format(" was {:>10.4g}{}", old->second,
                            old->second > 0 ? fmt::format(", x {:.3g}", value / old->second) : "");
    line.erase(line.find_last_not_of(' ') + 1);
    measures.terminal.put(line + "\n");
}

// What an earlier run wrote by --json; says what is wrong with it.
Exit read_earlier(const std::string &file, Measures &measures) {
    std::string error;
    const std::optional<std::string> text = v1::read_file(file, Limits{}.source * mebibyte, error);
    if (!text) {
        measures.terminal.say(fmt::format("fathom: cannot read `{}`: {}", file, error));
        return device_error;
    }
    const Json json = Json::parse(*text, nullptr, false);
    const bool rows = json.is_object() && json.contains("rows") && json["rows"].is_array();
    for (const Json &one : rows ? json["rows"] : Json::array())
        if (one.is_object() && one.contains("name") && one["name"].is_string() &&
            one.contains("value") && one["value"].is_number())
            measures.earlier[one["name"].get<std::string>()] = one["value"].get<double>();
    if (!measures.earlier.empty()) return done;
    measures.terminal.say(
        fmt::format("fathom: `{}` is not what `fathom bench --json` writes", file));
    return device_error;
}

std::string_view phase_name(v1::Phase phase) {
    switch (phase) {
    case v1::Phase::Read: return "read";
    case v1::Phase::Check: return "parse and check";
    case v1::Phase::Prove: return "prove";
    case v1::Phase::Lower: return "lower";
    case v1::Phase::Done: return "";
    }
    return "";
}

v1::CompileOptions options_of_picture(const BenchCommand &command) {
    v1::CompileOptions options = library_options(command.scene, 0, 0);
    if (!command.one_bound) options.cells = cells_of_pictures;
    return options;
}

void bench_front_end(const BenchCommand &command, Measures &measures) {
    std::map<v1::Phase, std::vector<double>> times;
    v1::CompileOptions options = library_options(command.scene);
    std::optional<v1::Phase> current;
    Clock::time_point entered;
    options.entered = [&](v1::Phase phase) {
        if (current) times[*current].push_back(milliseconds_since(entered));
        current = phase == v1::Phase::Done ? std::nullopt : std::optional(phase);
        entered = Clock::now();
    };
    double whole = measure([&] { v1::compile_file(command.scene.file, options); });
    for (const auto &[phase, each] : times) row(measures, phase_name(phase), median(each), "ms");
    row(measures, "front end, all", whole, "ms");
    const v1::CompileOptions for_pictures = options_of_picture(command);
    row(measures, "front end, for a picture",
        measure([&] { v1::compile_file(command.scene.file, for_pictures); }), "ms");
}

v1::PictureOptions picture_of(const BenchCommand &command) {
    v1::PictureOptions options;
    options.width = command.width;
    options.height = command.height;
    options.samples = 1;
    return options;
}

void bench_gl(const BenchCommand &command, const v1::Scene &scene, Measures &measures) {
    v1::GlPainter gl;
    const std::string closed = gl.open();
    std::string text;
    const double emitting = measure([&] { text = gl.text(scene); });
    if (!text.empty()) {
        row(measures, "emit and validate", emitting, "ms");
        row(measures, "shader", static_cast<double>(text.size()) / 1024, "KB");
    }
    if (!closed.empty()) {
        measures.terminal.say(fmt::format("fathom: nothing is measured by GL: {}", closed));
        return;
    }
    if (!measures.json) measures.terminal.put(fmt::format("{:<26} {}\n", "GL", gl.describe()));
    if (has_errors(gl.use(scene))) return;
    row(measures, "driver: compile and link", 1000 * gl.driver_seconds(),
        "ms"); // once: drivers keep what they compiled
    const v1::PictureOptions picture = picture_of(command);
    const auto draw = [&] { gl.draw_for_nothing(picture); };
    const Clock::time_point start = Clock::now();
    draw();
    row(measures, "first frame", milliseconds_since(start), "ms");
    row(measures, "frame", measure(draw), "ms");
    const v1::GlLists lists = gl.lists();
    if (lists.side == 0) return;
    row(measures, "  rows in a cell, mean", lists.in_cell, "");
    row(measures, "  rows in all", lists.all, "");
    row(measures, "  cells along an axis", lists.side, "");
    row(measures, "  making the lists", measure([&] { gl.remake_lists(); }), "ms");
}

// What all but one ray in a hundred take at most.
double steps_of_most(const v1::Scene &scene, const BenchCommand &command) {
    std::vector<int> steps = v1::eye_steps(scene, picture_of(command));
    if (steps.empty()) return 0;
    const auto at = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 99 / 100);
    std::nth_element(steps.begin(), at, steps.end());
    return *at;
}

void bench_cpu(const BenchCommand &command, const v1::Scene &scene, Measures &measures) {
    v1::Picture picture;
    const double time = measure([&] { picture = v1::draw(scene, picture_of(command)); });
    const auto rays = static_cast<double>(std::max<std::uint64_t>(picture.rays, 1));
    row(measures, "CPU frame", time, "ms");
    row(measures, "steps a ray", static_cast<double>(picture.steps) / rays, "");
    row(measures, "steps, 99 of 100 rays", steps_of_most(scene, command), "");
    row(measures, "undecided rays", static_cast<double>(picture.undecided), "");
    row(measures, "evaluations a pixel", static_cast<double>(picture.evaluations) / rays, "");
}

} // namespace

Exit run(const BenchCommand &command, Terminal &terminal) {
    if (command.scene.file == "-") {
        terminal.say("fathom: bench reads its file many times; standard input can be read once");
        return usage_error;
    }
    Measures measures{terminal, command.json, Json::array(), {}};
    if (!command.compare.empty())
        if (const Exit exit = read_earlier(command.compare, measures); exit != done) return exit;
    const v1::CompileResult result =
        v1::compile_file(command.scene.file, options_of_picture(command));
    if (const Exit exit = report(result, terminal); exit != done) return exit;
    if (!command.json)
        terminal.put(
            fmt::format("{} at {}x{}\n", command.scene.file, command.width, command.height));
    bench_front_end(command, measures);
    bench_gl(command, *result.scene, measures);
    bench_cpu(command, *result.scene, measures);
    if (command.json)
        terminal.put(Json{{"file", command.scene.file},
                          {"size", {command.width, command.height}},
                          {"rows", std::move(measures.rows)}}
                         .dump(2, ' ', false, Json::error_handler_t::replace) +
                     "\n");
    return done;
}

} // namespace fathom::cli
