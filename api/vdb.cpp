#include <fathom/volume.h>

#include "api/impl.h"
#include "driver/vdb/vdb.h"

#include <fmt/format.h>

namespace fathom::v1 {

static void append(void *to, const char *bytes, std::size_t count) {
    static_cast<std::string *>(to)->append(bytes, count);
}

VdbFile vdb_file(const Volume &volume) noexcept {
    return guarded(
        [&]() -> VdbFile {
            VdbFile file;
            if (!(volume.band > 0))
                return {"", "a level set is a band about the surface: VolumeOptions::band"};
            const FathomWriteVdb write = driver::vdb_writer(file.message);
            if (!write) {
                file.message += ", or write .nrrd";
                return file;
            }
            std::vector<std::int32_t> at;
            std::vector<float> colors;
            for (const std::array<int, 3> &voxel : volume.voxels)
                at.insert(at.end(), voxel.begin(), voxel.end());
            for (const std::array<float, 3> &color : volume.colors)
                colors.insert(colors.end(), color.begin(), color.end());
            const FathomVdbGrid grid{{volume.origin[0], volume.origin[1], volume.origin[2]},
                                     volume.side,
                                     volume.band,
                                     volume.distances.size(),
                                     at.data(),
                                     volume.distances.data(),
                                     colors.empty() ? nullptr : colors.data()};
            std::array<char, 512> why{};
            if (write(&grid, append, &file.bytes, why.data(), why.size()) != 0)
                return {"", fmt::format("OpenVDB: {}", why.data())};
            return file;
        },
        [](const Diagnostic &why) {
            return VdbFile{"", why.message};
        });
}

} // namespace fathom::v1
