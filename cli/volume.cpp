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
    options.side = command.voxel;
    options.resolution = solid.resolution;
    options.bounds = solid.bounds;
    options.time = solid.time;
    options.certify = command.certify;
    if (!command.solid.field.empty()) {
        options.field = 0;
        return options;
    }
    if (suffix_of(command.out) != ".vdb") return options;
    options.band = command.band;
    options.colors = true;
    return options;
}

// Of a grid: the function's, where it has one.
std::string name_of(const std::string &field) {
    const auto in_name = [](char c) {
        return std::isalnum(static_cast<unsigned char>(c)) || c == '_';
    };
    return !field.empty() && std::ranges::all_of(field, in_name) ? field : "density";
}

// What is to be written, or why there is nothing.
std::string bytes_of(const v1::Volume &volume, const VolumeCommand &command, std::string &why) {
    const std::string suffix = suffix_of(command.out);
    if (suffix == ".npy") return v1::npy_file(volume);
    if (suffix != ".vdb") return v1::nrrd_file(volume);
    v1::VdbFile file = v1::vdb_file(volume, name_of(command.solid.field));
    why = std::move(file.message);
    return std::move(file.bytes);
}

std::string json_of(const v1::Volume &volume) {
    nlohmann::ordered_json json;
    if (volume.components > 0) {
        const auto size = static_cast<std::size_t>(volume.components);
        json["voxels"] = volume.values.size() / size;
        json["counts"] = volume.counts;
        json["origin"] = volume.origin;
        json["side"] = volume.side;
        json["components"] = volume.components;
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
    options.progress = frame.progress;
    const v1::Volume volume = v1::make_volume(frame.scene, options);
    stop_if_interrupted(terminal); // nothing is written
    terminal.finish_progress();
    if (!volume)
        return say_refusal(frame.number ? frame.out : command.solid.scene.file, "volume",
                           volume.status, volume.message, terminal);
    if (volume.undecided_cells > 0)
        terminal.say(fmt::format(
            "{}: no error is proved: {} cells may hold surface that the distances do not know of; "
            "a smaller voxel or a tighter bound tells more",
            frame.out, volume.undecided_cells));
    std::string why;
    const std::string bytes = bytes_of(volume, command, why);
    if (bytes.empty()) {
        terminal.say(fmt::format("fathom: {}: {}", frame.out,
                                 why.empty() ? "there is not enough memory" : why));
        return device_error;
    }
    const Exit exit = write_result(frame.out, bytes, terminal);
    if (exit == done && command.json) terminal.put(frame_json(frame, json_of(volume)));
    return exit;
}

} // namespace

Exit run(const VolumeCommand &command, Terminal &terminal) {
    if (overwrites(command.solid.scene.file, command.out, terminal) ||
        misnamed(command.out, Content::Volume, terminal))
        return usage_error;
    return make_frames(command.solid, command.out, terminal,
                       [&](const SolidFrame &frame) { return make(command, frame, terminal); });
}

} // namespace fathom::cli
