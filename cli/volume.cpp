// fathom volume: true distances on a lattice, or what a function gives there, as an OpenVDB, NRRD or
// NumPy file.
#include "cli/interrupt.h"
#include "cli/solid.h"

#include <fathom/volume.h>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>

namespace fathom::cli {
namespace {

v1::VolumeOptions volume_options(const VolumeCommand &command, const SolidFrame &frame) {
    const v1::MeshOptions solid = options_of(frame.arguments);
    v1::VolumeOptions options;
    options.side = in_scene(command.voxel, command.solid);
    options.resolution = solid.resolution;
    options.bounds = solid.bounds;
    options.time = solid.time;
    options.certify = command.certify;
    if (!command.solid.fields.empty()) return options;
    if (suffix_of(command.out) != ".vdb") return options;
    options.band = command.band;
    options.colors = true;
    return options;
}

// Of grids: the functions', where they have one, else `density`; no two are alike.
std::vector<std::string> names_of(const std::vector<std::string> &fields) {
    const auto in_name = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    std::vector<std::string> names;
    for (const std::string &field : fields) {
        const std::string name = std::ranges::all_of(field, in_name) ? field : "density";
        std::string own = name;
        for (int i = 2; std::ranges::find(names, own) != names.end(); ++i)
            own = fmt::format("{}_{}", name, i);
        names.push_back(own);
    }
    return names;
}

// What is to be written, or why there is nothing.
std::string bytes_of(const std::vector<v1::Volume> &volumes, const VolumeCommand &command,
                     std::string &why) {
    const std::string suffix = suffix_of(command.out);
    if (suffix == ".npy") return v1::npy_file(volumes[0]);
    if (suffix != ".vdb") return v1::nrrd_file(volumes[0]);
    const std::vector<std::string> names = names_of(command.solid.fields);
    std::vector<v1::NamedVolume> named;
    for (std::size_t i = 0; i < names.size(); ++i) named.push_back({names[i], &volumes[i]});
    v1::VdbFile file = named.empty() ? v1::vdb_file(volumes[0]) : v1::vdb_file(named);
    why = std::move(file.message);
    return std::move(file.bytes);
}

std::string json_of(const std::vector<v1::Volume> &volumes, const VolumeCommand &command) {
    nlohmann::ordered_json json;
    const v1::Volume &volume = volumes[0];
    if (volume.components > 0) {
        const auto size = static_cast<std::size_t>(volume.components);
        json["voxels"] = volume.values.size() / size;
        json["counts"] = volume.counts;
        json["origin"] = volume.origin;
        json["side"] = volume.side;
        if (volumes.size() == 1) json["components"] = volume.components;
        const std::vector<std::string> names = names_of(command.solid.fields);
        for (std::size_t i = 0; i < volumes.size() && volumes.size() > 1; ++i)
            json["grids"].push_back({{"name", names[i]}, {"components", volumes[i].components}});
        return json.dump() + "\n";
    }
    json["voxels"] = volume.distances.size();
    json["counts"] = volume.counts;
    json["origin"] = volume.origin;
    json["side"] = volume.side;
    json["band"] = volume.band > 0 ? nlohmann::ordered_json(volume.band) : nlohmann::ordered_json();
    json["error"] = volume.error ? nlohmann::ordered_json(*volume.error) : nlohmann::ordered_json();
    json["undecided_cells"] = volume.undecided_cells;
    json["colors"] = !volume.colors.empty();
    json["rests_on"] = volume.rests_on;
    return json.dump() + "\n";
}

Exit make(const VolumeCommand &command, const SolidFrame &frame, Terminal &terminal) {
    v1::VolumeOptions options = volume_options(command, frame);
    const std::size_t fields = command.solid.fields.size(),
                      count = std::max<std::size_t>(fields, 1);
    std::vector<v1::Volume> volumes;
    for (std::size_t i = 0; i < count; ++i) {
        if (fields > 0) options.field = i;
        if (frame.progress)
            options.progress = [&](double done) {
                return frame.progress((static_cast<double>(i) + done) / static_cast<double>(count));
            };
        volumes.push_back(v1::make_volume(frame.scene, options));
        stop_if_interrupted(terminal); // nothing is written
        if (volumes.back()) continue;
        terminal.finish_progress();
        return say_refusal(command.solid, frame.number ? frame.out : command.solid.scene.file,
                           "volume", volumes.back().status, volumes.back().message, terminal);
    }
    terminal.finish_progress();
    const v1::Volume &volume = volumes[0];
    if (volume.undecided_cells > 0)
        terminal.say(fmt::format(
            "{}: no error is proved: {} cells may hold surface that the distances do not know of; "
            "a smaller voxel or a tighter bound tells more",
            frame.out, volume.undecided_cells));
    std::string why;
    const std::string bytes = bytes_of(volumes, command, why);
    if (bytes.empty()) {
        terminal.say(fmt::format("fathom: {}: {}", frame.out,
                                 why.empty() ? "there is not enough memory" : why));
        return device_error;
    }
    const Exit exit = write_result(frame.out, bytes, terminal);
    if (exit == done && command.solid.json)
        terminal.put(frame_json(frame, json_of(volumes, command)));
    return exit;
}

} // namespace

Exit run(const VolumeCommand &command, Terminal &terminal) {
    if (overwrites(command.solid.scene.file, command.out, terminal) ||
        misnamed(command.out, Content::Volume, terminal))
        return usage_error;
    if (suffix_of(command.out) == ".vdb") // before any work is done
        if (const std::string why = v1::vdb_obstacle(); !why.empty()) {
            terminal.say(fmt::format("fathom: {}: {}", command.out, why));
            return device_error;
        }
    return make_frames(command.solid, command.out, terminal,
                       [&](const SolidFrame &frame) { return make(command, frame, terminal); });
}

} // namespace fathom::cli
