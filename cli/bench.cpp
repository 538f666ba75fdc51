// fathom bench: what a scene costs, phase by phase: medians of several runs on this machine, and
// counts that do not depend on it.
#include "backend-cpu/trace/march.h"
#include "backend-glsl/emit.h"
#include "cli/compiled.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"

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
    const std::optional<std::string> text =
        driver::read_file(file, driver::max_source_bytes, error);
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

std::string_view phase_name(driver::Phase phase) {
    switch (phase) {
    case driver::Phase::Read: return "read";
    case driver::Phase::Check: return "parse and check";
    case driver::Phase::Prove: return "prove";
    case driver::Phase::Lower: return "lower";
    case driver::Phase::Done: return "";
    }
    return "";
}

driver::CompileOptions options_of_picture(const BenchCommand &command) {
    driver::CompileOptions options = compile_options(command.scene, 0, 0);
    if (!command.one_bound) options.cells = driver::cells_of_pictures;
    return options;
}

void bench_front_end(const BenchCommand &command, Measures &measures) {
    std::map<driver::Phase, std::vector<double>> times;
    driver::CompileOptions options = compile_options(command.scene);
    std::optional<driver::Phase> current;
    Clock::time_point entered;
    options.entered = [&](driver::Phase phase) {
        if (current) times[*current].push_back(milliseconds_since(entered));
        current = phase == driver::Phase::Done ? std::nullopt : std::optional(phase);
        entered = Clock::now();
    };
    double whole = measure([&] { driver::compile_file(command.scene.file, options); });
    for (const auto &[phase, each] : times) row(measures, phase_name(phase), median(each), "ms");
    row(measures, "front end, all", whole, "ms");
    const driver::CompileOptions for_pictures = options_of_picture(command);
    row(measures, "front end, for a picture",
        measure([&] { driver::compile_file(command.scene.file, for_pictures); }), "ms");
}

void bench_gl(const BenchCommand &command, const ir::Scene &scene, Measures &measures) {
    auto context = gl::Context::make();
    Diagnostics diagnostics;
    glsl::Options options;
    options.target = glsl::Target::Glsl330;
    options.passes = true;
    options.buffers = true;
    options.pruning = std::holds_alternative<gl::Context>(context) && gl::can_prune();
    glsl::Output output;
    double emitting = measure([&] { output = glsl::emit(scene, options, diagnostics); });
    row(measures, "emit and validate", emitting, "ms");
    row(measures, "shader", static_cast<double>(output.text.size()) / 1024, "KB");
    if (diagnostics.has_errors()) return;
    if (const std::string *why = std::get_if<std::string>(&context)) {
        measures.terminal.say(fmt::format("fathom: nothing is measured by GL: {}", *why));
        return;
    }
    if (!measures.json)
        measures.terminal.put(
            fmt::format("{:<26} {}\n", "GL", std::get<gl::Context>(context).describe()));
    Clock::time_point start = Clock::now();
    auto program = gl::Program::build(output, scene);
    row(measures, "driver: compile and link", milliseconds_since(start),
        "ms"); // once: drivers keep what they compiled
    if (!std::holds_alternative<gl::Program>(program)) return;
    gl::Request request;
    request.width = command.width;
    request.height = command.height;
    auto draw = [&] { gl::draw(std::get<gl::Program>(program), scene, request, gl::Mode::Linear); };
    start = Clock::now();
    draw();
    row(measures, "first frame", milliseconds_since(start), "ms");
    row(measures, "frame", measure(draw), "ms");
    gl::Pruning *pruning = std::get<gl::Program>(program).pruning();
    if (!pruning) return;
    row(measures, "  rows in a cell, mean", pruning->tally().rows, "");
    row(measures, "  rows in all", pruning->tally().all, "");
    row(measures, "  cells along an axis", pruning->tally().side, "");
    row(measures, "  making the lists", measure([&] {
            pruning->remake(scene.params, 0);
            gl::finish();
        }),
        "ms");
}

// What all but one ray in a hundred take at most.
double steps_of_most(const ir::Scene &scene, const BenchCommand &command) {
    const double aspect = static_cast<double>(command.width) / command.height;
    const cpu::Stage stage =
        cpu::prepare(scene, ir::view_of(scene, 0, aspect), command.width, command.height, 0);
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < command.height; ++y)
        for (int x = 0; x < command.width; ++x)
            rays.push_back(
                cpu::eye_ray(stage, static_cast<float>(x) + 0.5f, static_cast<float>(y) + 0.5f));
    std::vector<int> steps;
    for (const cpu::Landing &landing : cpu::cast(stage, rays)) steps.push_back(landing.steps);
    const auto at = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() * 99 / 100);
    std::nth_element(steps.begin(), at, steps.end());
    return *at;
}

void bench_cpu(const BenchCommand &command, const ir::Scene &scene, Measures &measures) {
    double aspect = static_cast<double>(command.width) / command.height;
    cpu::Work work;
    double time = measure([&] {
        cpu::Stage stage =
            cpu::prepare(scene, ir::view_of(scene, 0, aspect), command.width, command.height, 0);
        work = cpu::render(stage, {}).work;
    });
    row(measures, "CPU frame", time, "ms");
    row(measures, "steps a ray",
        static_cast<double>(work.steps) /
            static_cast<double>(std::max<std::uint64_t>(work.rays, 1)),
        "");
    row(measures, "steps, 99 of 100 rays", steps_of_most(scene, command), "");
    row(measures, "undecided rays", static_cast<double>(work.undecided), "");
    row(measures, "evaluations a pixel",
        static_cast<double>(work.evaluations) /
            static_cast<double>(std::max<std::uint64_t>(work.rays, 1)),
        "");
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
    driver::Compilation compilation =
        driver::compile_file(command.scene.file, options_of_picture(command));
    Exit exit = report(compilation, command.scene, terminal);
    if (exit != done) return exit;
    if (!command.json)
        terminal.put(
            fmt::format("{} at {}x{}\n", command.scene.file, command.width, command.height));
    bench_front_end(command, measures);
    bench_gl(command, compilation.scene, measures);
    bench_cpu(command, compilation.scene, measures);
    if (command.json)
        terminal.put(Json{{"file", command.scene.file},
                          {"size", {command.width, command.height}},
                          {"rows", std::move(measures.rows)}}
                         .dump(2, ' ', false, Json::error_handler_t::replace) +
                     "\n");
    return done;
}

} // namespace fathom::cli
