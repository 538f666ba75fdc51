// What the commands that look at a solid share: mesh, measure, slice and volume.
#pragma once

#include "cli/outputs.h"

#include <fathom/mesh.h>

namespace fathom::cli {

// The lengths that `--units` knows.
struct UnitRow {
    const char *name;
    v1::MeshUnit unit;
    double metres;
};
const UnitRow *unit_named(std::string_view name); // none: there is no such unit
std::vector<std::string> unit_names();

// A scene, or the part of it that is wanted. Says why there is none, and then holds no scene.
struct Solid {
    Exit exit = done;
    std::optional<v1::Scene> scene;
    std::vector<std::filesystem::path> files; // that it was read from
};
Solid open_solid(const SolidArguments &arguments, Terminal &terminal);
// That part of a scene; none, with what parts there are said, where it has no such part.
std::optional<v1::Scene> part_named(const v1::Scene &scene, const std::string &name,
                                    Terminal &terminal);

// How finely and of what, without a progress.
v1::MeshOptions options_of(const SolidArguments &arguments);

// How a command ends that could not do its work, which is said.
Exit say_refusal(const std::string &file, const std::string &what, v1::MeshStatus status,
                 const std::string &message, Terminal &terminal);

} // namespace fathom::cli
