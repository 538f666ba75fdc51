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

// The places of what is not 0, and what is there.
void find_numbers(const Volume &volume, std::vector<std::int32_t> &at, std::vector<float> &values) {
    const auto size = static_cast<std::size_t>(volume.components);
    std::size_t k = 0;
    for (int z = 0; z < volume.counts[2]; ++z)
        for (int y = 0; y < volume.counts[1]; ++y)
            for (int x = 0; x < volume.counts[0]; ++x, k += size) {
                const auto first = volume.values.begin() + static_cast<std::ptrdiff_t>(k),
                           end = first + static_cast<std::ptrdiff_t>(size);
                if (std::all_of(first, end, [](float value) { return value == 0; })) continue;
                at.insert(at.end(), {x, y, z});
                values.insert(values.end(), first, end);
            }
}

} // namespace

VdbFile vdb_file(const Volume &volume, const std::string &name) noexcept {
    return guarded(
        [&]() -> VdbFile {
            VdbFile file;
            if (!(volume.band > 0) && volume.components == 0)
                return {"", "a level set is a band about the surface: VolumeOptions::band"};
            const FathomWriteVdb write = driver::vdb_writer(file.message);
            if (!write) {
                file.message += ", or write .nrrd";
                return file;
            }
            std::vector<std::int32_t> at;
            std::vector<float> colors, values;
            if (volume.components > 0) find_numbers(volume, at, values);
            const FathomVdbNumbers numbers{name.c_str(), volume.components, values.data()};
            for (const std::array<int, 3> &voxel : volume.voxels)
                at.insert(at.end(), voxel.begin(), voxel.end());
            for (const std::array<float, 3> &color : volume.colors)
                colors.insert(colors.end(), color.begin(), color.end());
            const FathomVdbGrid grid{{volume.origin[0], volume.origin[1], volume.origin[2]},
                                     volume.side,
                                     volume.band,
                                     at.size() / 3,
                                     at.data(),
                                     volume.distances.data(),
                                     colors.empty() ? nullptr : colors.data()};
            std::array<char, 512> why{};
            if (write(&grid, volume.components > 0 ? &numbers : nullptr, append, &file.bytes,
                      why.data(), why.size()) != 0)
                return {"", fmt::format("OpenVDB: {}", why.data())};
            return file;
        },
        [](const Diagnostic &why) {
            return VdbFile{"", why.message};
        });
}

} // namespace fathom::v1
