// OpenVDB files, by the module that loads OpenVDB (api/vdb/module.cpp): found beside the library, or in a
// folder `fathom` beside it.
#include <fathom/volume.h>

#include "api/impl.h"
#include "api/vdb/grid.h"

#include <fmt/format.h>

#include <dlfcn.h>

namespace fathom::v1 {
namespace {

// The folder of the file that this very code was loaded from.
std::filesystem::path folder_of_code() {
    static const char mark = 0;
    Dl_info info{};
    if (dladdr(&mark, &info) == 0 || !info.dli_fname) return {};
    std::error_code failed;
    const std::filesystem::path whole = std::filesystem::canonical(info.dli_fname, failed);
    return failed ? std::filesystem::path() : whole.parent_path();
}

FathomWriteVdb load(std::string &why) {
    constexpr const char *name = "libfathom-vdb.so";
    const std::filesystem::path here = folder_of_code();
    for (const std::filesystem::path &file :
         {here / name, here / "fathom" / name, here / ".." / FATHOM_LIBDIR / "fathom" / name}) {
        std::error_code none;
        if (here.empty() || !std::filesystem::exists(file, none)) continue;
        if (void *module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL))
            if (void *found = dlsym(module, "fathom_write_vdb"))
                return reinterpret_cast<FathomWriteVdb>(found);
        const char *error = dlerror();
        why = fmt::format("{}: {}", file.string(), error ? error : "it is no module of Fathom's");
        return nullptr;
    }
    why = "this Fathom was built without OpenVDB: build it where libopenvdb-dev and libboost-dev "
          "are, or write .nrrd";
    return nullptr;
}

void append(void *to, const char *bytes, std::size_t count) {
    static_cast<std::string *>(to)->append(bytes, count);
}

} // namespace

VdbFile vdb_file(const Volume &volume) noexcept {
    return guarded(
        [&]() -> VdbFile {
            VdbFile file;
            if (!(volume.band > 0))
                return {"", "a level set is a band about the surface: VolumeOptions::band"};
            const FathomWriteVdb write = load(file.message);
            if (!write) return file;
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
