// What the commands that look at a solid share: mesh, measure, slice and volume.
#pragma once

#include "cli/outputs.h"

#include <fathom/mesh.h>

#include <functional>

namespace fathom::cli {

// The lengths that `--units` knows.
struct UnitRow {
    const char *name;
    v1::MeshUnit unit;
    double metres;
};
const UnitRow *unit_named(std::string_view name); // none: there is no such unit
std::vector<std::string> unit_names();
// Reads a length, as 0.01 or 0.01mm. What is wrong with it.
std::string read_length(const std::string &word, Length &length);
// In the scene's units.
double in_scene(const Length &length, const SolidArguments &solid);

// A scene, or the part of it that is wanted. Says why there is none, and then holds no scene.
struct Solid {
    Exit exit = done;
    std::optional<v1::Scene> scene;
    std::vector<std::filesystem::path> files; // that it was read from
    bool flat = false;                        // it is a drawing
};
// `again`: what is no error was said before.
Solid open_solid(const SolidArguments &arguments, Terminal &terminal, bool again = false);
// That part of a scene; none, with what parts there are said, where it has no such part.
std::optional<v1::Scene> part_named(const v1::Scene &scene, const std::string &name,
                                    Terminal &terminal);

// One file of a command: the scene at its frame.
struct SolidFrame {
    const v1::Scene &scene;
    SolidArguments arguments;                        // with the frame's time
    std::string out;                                 // with the frame's number
    const std::vector<std::filesystem::path> &files; // that the scene was read from
    std::optional<int> number;
    std::function<bool(double share)> progress; // MeshOptions::progress
};
// Makes each frame, or the one moment that there is without frames, in turn. A file that is there
// stays whole, whatever happens to the next one.
Exit make_frames(const SolidArguments &solid, const std::string &out, Terminal &terminal,
                 const std::function<Exit(const SolidFrame &)> &make);
// In the JSON document of a frame, or of one of several scenes, before the rest: which it is, and its
// file.
std::string frame_json(const SolidFrame &frame, const std::string &document);
// Ends the program where it was interrupted.
void stop_if_interrupted(Terminal &terminal);

// How finely and of what, without a progress.
v1::MeshOptions options_of(const SolidArguments &arguments);

// How a command ends that could not do its work, which is said.
Exit say_refusal(const SolidArguments &solid, const std::string &file, const std::string &what,
                 v1::MeshStatus status, const std::string &message, Terminal &terminal);

} // namespace fathom::cli
