#include "cli/solid.h"

#include "base/single.h"
#include "base/text.h"
#include "cli/frames.h"
#include "cli/interrupt.h"
#include "cli/progress.h"

#include <fathom/parts.h>

#include <algorithm>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace fathom::cli {
namespace {

constexpr UnitRow units[] = {
    {"um", v1::MeshUnit::Micron, 1e-6},     {"mm", v1::MeshUnit::Millimetre, 1e-3},
    {"cm", v1::MeshUnit::Centimetre, 1e-2}, {"m", v1::MeshUnit::Metre, 1},
    {"in", v1::MeshUnit::Inch, 0.0254},     {"ft", v1::MeshUnit::Foot, 0.3048}};

Exit exit_of(v1::MeshStatus status) {
    switch (status) {
    case v1::MeshStatus::Done:
    case v1::MeshStatus::Cancelled: return done;
    case v1::MeshStatus::Empty:
    case v1::MeshStatus::Endless:
    case v1::MeshStatus::Contradicted: return scene_error;
    case v1::MeshStatus::TooCoarse:
    case v1::MeshStatus::TooFine:
    case v1::MeshStatus::BadOptions: return usage_error;
    case v1::MeshStatus::TooLarge: return device_error;
    }
    return done;
}

// A flat scene is made as thick as it is wide, so that its outlines are far from the ends.
v1::CompileResult compiled(const SolidArguments &arguments) {
    v1::CompileOptions options =
        library_options(arguments.scene, arguments.time, arguments.until.value_or(arguments.time));
    if (arguments.flat) options.flat_thickness = 1;
    options.fields = arguments.fields;
    v1::CompileResult result = v1::compile_file(arguments.scene.file, options);
    if (!arguments.flat || !result || !result.scene->facts().bounds) return result;
    const v1::Box box = *result.scene->facts().bounds;
    options.flat_thickness = std::max(box.hi[0] - box.lo[0], box.hi[1] - box.lo[1]);
    if (!(options.flat_thickness > 0)) return result;
    return v1::compile_file(arguments.scene.file, options);
}

// Whether nothing is wrong with a scene but that it is a drawing.
bool is_drawing(const v1::CompileResult &result) {
    const auto is_error = [](const v1::Diagnostic &d) {
        return d.severity == v1::Severity::Error && d.code != "flat-shape";
    };
    return !result && std::ranges::none_of(result.diagnostics, is_error);
}

} // namespace

const UnitRow *unit_named(std::string_view name) {
    for (const UnitRow &row : units)
        if (name == row.name) return &row;
    return nullptr;
}

std::vector<std::string> unit_names() {
    std::vector<std::string> names;
    for (const UnitRow &row : units) names.emplace_back(row.name);
    return names;
}

std::string read_length(const std::string &word, Length &length) {
    const std::size_t end = word.find_last_not_of("abcdefghijklmnopqrstuvwxyz") + 1;
    const std::string unit = word.substr(end);
    const std::optional<double> number = parse_number(word.substr(0, end));
    if (!number || !(*number > 0) || !fits_single(*number) || (!unit.empty() && !unit_named(unit)))
        return fmt::format("wants a length above 0, as 0.01 or 0.01mm, not `{}`", word);
    length = {*number, unit};
    return "";
}

double in_scene(const Length &length, const SolidArguments &solid) {
    const UnitRow *of = unit_named(length.unit);
    const UnitRow *one = unit_named(solid.units.empty() ? solid.unsaid : solid.units);
    if (!of || !one || of == one) return length.number;
    return length.number * of->metres / one->metres;
}

std::optional<v1::Scene> part_named(const v1::Scene &scene, const std::string &name,
                                    Terminal &terminal) {
    std::optional<v1::Scene> part = v1::part_of(scene, name);
    if (part) return part;
    constexpr std::size_t most = 20;
    const std::vector<v1::Part> parts = v1::parts_of(scene);
    std::string known;
    for (std::size_t k = 0; k < std::min(most, parts.size()); ++k)
        known += (k == 0 ? "" : ", ") + parts[k].name;
    terminal.say(fmt::format(
        "fathom: there is no part `{}`; this scene has {}{}", name, parts.empty() ? "none" : known,
        parts.size() > most ? fmt::format(" and {} more", parts.size() - most) : ""));
    return std::nullopt;
}

Solid open_solid(const SolidArguments &arguments, Terminal &terminal, bool again) {
    Solid solid;
    v1::CompileResult result = compiled(arguments);
    solid.flat = arguments.flat;
    if (arguments.maybe && is_drawing(result) && arguments.scene.file != "-") {
        SolidArguments drawing = arguments;
        drawing.flat = true;
        if (v1::CompileResult flat = compiled(drawing)) {
            result = std::move(flat);
            solid.flat = true;
        }
    }
    solid.files = result.files;
    if (arguments.bounds) // what is cut off here has an end, and no camera looks at it
        std::erase_if(result.diagnostics,
                      [](const v1::Diagnostic &d) { return d.code == "nothing-framed"; });
    solid.exit = again && result ? done : report(result, terminal);
    if (arguments.json && !result) terminal.put(v1::verdict_json(result));
    if (arguments.maybe && is_drawing(result) && arguments.scene.file == "-")
        terminal.say(
            "fathom: flat shapes are read twice, and standard input can be read once: name "
            "the scene");
    if (solid.exit != done) return solid;
    solid.exit = usage_error; // unless all is well
    if (!in_proved_time(result.scene->facts(), arguments.time, arguments.time, terminal))
        return solid;
    solid.scene = arguments.part.empty() ? std::move(result.scene)
                                         : part_named(*result.scene, arguments.part, terminal);
    if (solid.scene) solid.exit = done;
    return solid;
}

Exit make_frames(const SolidArguments &solid, const std::string &out, Terminal &terminal,
                 const std::function<Exit(const SolidFrame &)> &make) {
    const std::vector<int> &film = solid.frames.numbers;
    const std::size_t count = std::max<std::size_t>(film.size(), 1);
    const auto file_of = [&](std::size_t k) {
        return film.empty() ? out : frame_name(out, film[k]);
    };
    const auto at = [&](std::size_t k) {
        SolidArguments moment = solid;
        if (film.empty()) return moment;
        moment.time = solid.time + film[k] / solid.frame_rate;
        for (Definition &value : swept(solid.sweeps, film, film[k]))
            moment.scene.overrides.push_back(std::move(value));
        return moment;
    };
    for (const std::size_t k : {std::size_t{0}, count - 1})
        if (unwritable(file_of(k), terminal)) return device_error;
    const Interrupts interrupts;
    Progress progress(ProgressFormat::Bar, count, terminal);
    SolidArguments all = at(0);
    all.until = at(count - 1).time;
    Solid opened = open_solid(all, terminal);
    if (!opened.scene) return opened.exit;
    if (!in_proved_time(opened.scene->facts(), at(0).time, at(count - 1).time, terminal))
        return usage_error;
    for (std::size_t k = 0; k < count; ++k)
        if (overwrites(opened.files, file_of(k), terminal)) return usage_error;
    for (std::size_t k = 0; k < count; ++k) {
        if (!film.empty()) opened = open_solid(at(k), terminal, true); // as if it were made alone
        if (!opened.scene) return opened.exit;
        SolidFrame frame{*opened.scene, at(k), file_of(k), opened.files, std::nullopt, {}};
        if (!film.empty()) frame.number = film[k];
        frame.progress = [&](double share) {
            progress.share(frame.out, share);
            return !Interrupts::noticed();
        };
        if (const Exit exit = make(frame); exit != done) return exit;
        progress.finished(film.empty() ? 0 : film[k], frame.out, false);
        stop_if_interrupted(terminal); // between files, each of them whole
    }
    terminal.finish_progress();
    return done;
}

std::string frame_json(const SolidFrame &frame, const std::string &document) {
    nlohmann::ordered_json head;
    if (frame.arguments.several) head["scene"] = frame.arguments.scene.file;
    if (frame.number) head["frame"] = *frame.number;
    if (head.empty()) return document;
    head["file"] = frame.out;
    std::string text = head.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace);
    text.back() = ',';
    return text + document.substr(1);
}

void stop_if_interrupted(Terminal &terminal) {
    if (!Interrupts::noticed()) return;
    terminal.finish_progress();
    terminal.flush();
    Interrupts::obey();
}

v1::MeshOptions options_of(const SolidArguments &arguments) {
    v1::MeshOptions options;
    options.tolerance = in_scene(arguments.tolerance, arguments);
    options.resolution = arguments.resolution;
    options.time = arguments.time;
    if (!arguments.bounds) return options;
    options.bounds.emplace();
    for (std::size_t i = 0; i < 3; ++i) {
        options.bounds->lo[i] = static_cast<float>((*arguments.bounds)[0][i]);
        options.bounds->hi[i] = static_cast<float>((*arguments.bounds)[1][i]);
    }
    return options;
}

Exit say_refusal(const SolidArguments &solid, const std::string &file, const std::string &what,
                 v1::MeshStatus status, const std::string &message, Terminal &terminal) {
    const bool endless = status == v1::MeshStatus::Endless;
    terminal.say(fmt::format("fathom: {}: no {}: {}{}", file, what, message,
                             endless ? "; here `--bounds X,Y,Z,X,Y,Z` does it" : ""));
    if (solid.json)
        terminal.put(
            nlohmann::ordered_json{{"ok", false}, {"status", nullptr}, {"why", message}}.dump() +
            "\n");
    return exit_of(status);
}

} // namespace fathom::cli
