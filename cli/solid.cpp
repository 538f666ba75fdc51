#include "cli/solid.h"

#include <fathom/parts.h>

#include <algorithm>
#include <fmt/format.h>

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

Solid open_solid(const SolidArguments &arguments, Terminal &terminal) {
    Solid solid;
    v1::CompileResult result =
        v1::compile_file(arguments.scene.file, library_options(arguments.scene));
    solid.files = result.files;
    solid.exit = report(result, terminal);
    if (solid.exit != done) return solid;
    solid.exit = usage_error; // unless all is well
    if (!in_proved_time(result.scene->facts(), arguments.time, arguments.time, terminal))
        return solid;
    solid.scene = arguments.part.empty() ? std::move(result.scene)
                                         : part_named(*result.scene, arguments.part, terminal);
    if (solid.scene) solid.exit = done;
    return solid;
}

v1::MeshOptions options_of(const SolidArguments &arguments) {
    v1::MeshOptions options;
    options.tolerance = arguments.tolerance;
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

Exit say_refusal(const std::string &file, const std::string &what, v1::MeshStatus status,
                 const std::string &message, Terminal &terminal) {
    const bool endless = status == v1::MeshStatus::Endless;
    terminal.say(fmt::format("fathom: {}: no {}: {}{}", file, what, message,
                             endless ? "; here `--bounds X,Y,Z,X,Y,Z` does it" : ""));
    return exit_of(status);
}

} // namespace fathom::cli
