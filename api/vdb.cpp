#include <fathom/volume.h>

#include "api/impl.h"
#include "driver/vdb/vdb.h"

#include <fmt/format.h>

#include <algorithm>

namespace fathom::v1 {

static void append(void *to, const char *bytes, std::size_t count) {
    static_cast<std::string *>(to)->append(bytes, count);
}

namespace {

// Numbers as a file holds them: those that are not 0, and where they are.
struct Sparse {
    std::vector<std::int32_t> at;
    std::vector<float> values;
};
Sparse sparse(const Volume &volume) {
    Sparse out;
    const auto size = static_cast<std::size_t>(volume.components);
    std::size_t k = 0;
    for (int z = 0; z < volume.counts[2]; ++z)
        for (int y = 0; y < volume.counts[1]; ++y)
            for (int x = 0; x < volume.counts[0]; ++x, k += size) {
                const auto first = volume.values.begin() + static_cast<std::ptrdiff_t>(k),
                           end = first + static_cast<std::ptrdiff_t>(size);
                if (std::all_of(first, end, [](float value) { return value == 0; })) continue;
                out.at.insert(out.at.end(), {x, y, z});
                out.values.insert(out.values.end(), first, end);
            }
    return out;
}

FathomVdbGrid lattice_of(const Volume &volume) {
    FathomVdbGrid grid{};
    std::ranges::copy(volume.origin, grid.origin);
    grid.side = volume.side;
    return grid;
}

VdbFile written(const FathomVdbGrid &grid, std::span<const FathomVdbNumbers> numbers) {
    VdbFile file;
    const FathomWriteVdb write = driver::vdb_writer(file.message);
    if (!write) return {"", file.message + ", or write .nrrd"};
    std::array<char, 512> why{};
    if (write(&grid, numbers.data(), numbers.size(), append, &file.bytes, why.data(), why.size()) !=
        0)
        return {"", fmt::format("OpenVDB: {}", why.data())};
    return file;
}

VdbFile file_of_fields(std::span<const NamedVolume> volumes) {
    const auto first = volumes.empty() ? nullptr : volumes.front().volume;
    const auto fits = [&](const NamedVolume &named) {
        return named.volume && named.volume->components > 0 &&
               named.volume->origin == first->origin && named.volume->side == first->side;
    };
    if (!first || !std::ranges::all_of(volumes, fits))
        return {"", "the grids of one file are of fields, on one lattice: VolumeOptions::field"};
    std::vector<Sparse> data;
    for (const NamedVolume &named : volumes) data.push_back(sparse(*named.volume));
    std::vector<FathomVdbNumbers> numbers;
    for (std::size_t i = 0; i < volumes.size(); ++i)
        numbers.push_back({volumes[i].name.c_str(), volumes[i].volume->components,
                           data[i].at.size() / 3, data[i].at.data(), data[i].values.data()});
    return written(lattice_of(*first), numbers);
}

VdbFile file_of_band(const Volume &volume) {
    if (!(volume.band > 0))
        return {"", "a level set is a band about the surface: VolumeOptions::band"};
    std::vector<std::int32_t> at;
    std::vector<float> colors;
    for (const std::array<int, 3> &voxel : volume.voxels)
        at.insert(at.end(), voxel.begin(), voxel.end());
    for (const std::array<float, 3> &color : volume.colors)
        colors.insert(colors.end(), color.begin(), color.end());
    FathomVdbGrid grid = lattice_of(volume);
    grid.background = volume.band;
    grid.count = at.size() / 3;
    grid.at = at.data();
    grid.distances = volume.distances.data();
    grid.colors = colors.empty() ? nullptr : colors.data();
    return written(grid, {});
}

VdbFile without_file(const Diagnostic &why) { return {"", why.message}; }

} // namespace

std::string vdb_obstacle() noexcept {
    return guarded(
        [] {
            std::string why;
            return driver::vdb_writer(why) ? std::string() : why + ", or write .nrrd";
        },
        [](const Diagnostic &why) { return why.message; });
}

VdbFile vdb_file(const Volume &volume, const std::string &name) noexcept {
    return guarded(
        [&] {
            const NamedVolume named{name, &volume};
            return volume.components > 0 ? file_of_fields({&named, 1}) : file_of_band(volume);
        },
        without_file);
}

VdbFile vdb_file(std::span<const NamedVolume> volumes) noexcept {
    return guarded([&] { return file_of_fields(volumes); }, without_file);
}

} // namespace fathom::v1
