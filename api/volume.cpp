#include <fathom/volume.h>

#include "api/mesh.h"
#include "base/text.h"
#include "mesh/appearance.h"
#include "mesh/certify.h"
#include "mesh/volume.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>

namespace fathom::v1 {
namespace {

constexpr int padding = 3; // voxels about the solid's box, of a volume of all voxels

Volume without_volume(Refusal why) {
    Volume volume;
    volume.status = why.status;
    volume.message = std::move(why.message);
    return volume;
}

// The mesh has cells of half a voxel.
MeshOptions mesh_options(const VolumeOptions &options, double side) {
    MeshOptions mesh;
    mesh.tolerance = side / 2;
    mesh.bounds = options.bounds;
    mesh.time = options.time;
    mesh.threads = options.threads;
    mesh.progress = options.progress;
    return mesh;
}

Volume field_volume(const ir::Scene &ir, const VolumeOptions &options,
                    const fathom::mesh::VoxelGrid &grid) {
    const ir::FunctionId field = ir.fields[*options.field];
    Volume volume;
    volume.origin = grid.origin;
    volume.side = grid.side;
    volume.counts = grid.counts;
    volume.components = ir::components(ir.graph.type(ir.graph.function(field).result));
    fathom::mesh::Progress progress;
    progress.report = options.progress;
    volume.values = fathom::mesh::values_of(
        ir, field, settings_of(mesh_options(options, grid.side)), grid, progress);
    if (progress.cancelled) return without_volume(refusal_of(fathom::mesh::Failure::Cancelled));
    return volume;
}

Volume made_volume(const Scene &scene, const VolumeOptions &options) {
    using fathom::mesh::Failure;
    const ir::Scene &ir = ir_of(scene);
    fathom::mesh::Settings settings = settings_of(mesh_options(options, 1));
    ir::Box box;
    if (options.field && options.bounds) {
        for (std::size_t i = 0; i < 3; ++i) // whatever solid there is
            box.lo[i] = options.bounds->lo[i], box.hi[i] = options.bounds->hi[i];
    } else if (Refusal why = refusal_of(fathom::mesh::box_of(ir, settings, box))) {
        return without_volume(std::move(why));
    }
    double longest = 0;
    for (std::size_t i = 0; i < 3; ++i) longest = std::max(longest, box.hi[i] - box.lo[i]);
    const double side = options.side > 0 ? options.side : longest / options.resolution;
    const auto around = options.field      ? 0
                        : options.band > 0 ? static_cast<int>(std::ceil(options.band)) + 1
                                           : padding;
    const std::optional<fathom::mesh::VoxelGrid> grid = fathom::mesh::make_grid(box, side, around);
    if (!grid) return without_volume(refusal_of(Failure::TooFine));

    if (options.field) return field_volume(ir, options, *grid);
    const double meshed = options.certify ? 0.2 : 0.5, certified = options.certify ? 0.7 : meshed;
    settings = settings_of(mesh_options(options, side), meshed);
    const fathom::mesh::Made made = fathom::mesh::make_mesh(ir, settings);
    if (made.failure != Failure::None) return without_volume(refusal_of(made.failure, made.place));
    Volume volume;
    fathom::mesh::Progress progress;
    progress.report = options.progress;
    progress.from = meshed;
    progress.to = certified;
    if (options.certify) {
        const fathom::mesh::Certificate found = certify(ir, settings, made, progress);
        if (progress.cancelled) return without_volume(refusal_of(Failure::Cancelled));
        volume.undecided_cells = found.undecided.size() + found.unproved.size();
        // Beside it, what the voxels' places and the distances lose as floats.
        double farthest = 0;
        for (std::size_t i = 0; i < 3; ++i)
            farthest = std::max({farthest, std::fabs(box.lo[i]), std::fabs(box.hi[i])});
        if (found.certified())
            volume.error = std::max(found.mesh_to_surface, found.surface_to_mesh) +
                           (farthest + (around + 1) * side) * 0x1p-21;
        volume.rests_on = rests_on(found.used_bound);
    }
    const double off = volume.error.value_or(made.octree.lattice.side(made.octree.lattice.level));
    progress.phase(1);
    volume.origin = grid->origin;
    volume.side = side;
    volume.counts = grid->counts;
    volume.band = options.band * side;
    if (options.band > 0) {
        std::vector<fathom::mesh::Point> colors;
        if (options.colors)
            colors = colors_of(ir, options.time, made.mesh, made.octree.lattice.unit);
        if (std::ranges::all_of(colors, [&](const auto &color) { return color == colors[0]; }))
            colors.clear(); // one colour everywhere is none that somebody gave
        for (const fathom::mesh::Voxel &voxel : fathom::mesh::band_of(
                 ir, settings, made.mesh, off, *grid, volume.band, colors, progress)) {
            volume.voxels.push_back(voxel.at);
            volume.distances.push_back(voxel.distance);
            if (!colors.empty()) volume.colors.push_back(voxel.color);
        }
    } else {
        volume.distances =
            fathom::mesh::distances_of(ir, settings, made.mesh, off, *grid, progress);
    }
    if (progress.cancelled) return without_volume(refusal_of(Failure::Cancelled));
    return volume;
}

// Little-endian, as both formats say.
std::string bytes_of(const std::vector<float> &numbers) {
    std::string bytes(4 * numbers.size(), '\0');
    for (std::size_t k = 0; k < numbers.size(); ++k) {
        const auto word = std::bit_cast<std::uint32_t>(numbers[k]);
        for (std::size_t b = 0; b < 4; ++b)
            bytes[4 * k + b] = static_cast<char>(word >> (8 * b) & 0xff);
    }
    return bytes;
}

} // namespace

Volume make_volume(const Scene &scene, const VolumeOptions &options) noexcept {
    if (Refusal why = refusal_of(scene, mesh_options(options, options.side > 0 ? options.side : 1)))
        return without_volume(std::move(why));
    if (options.field && *options.field >= ir_of(scene).fields.size())
        return without_volume(
            {MeshStatus::BadOptions,
             "the scene was compiled with fewer fields (CompileOptions::fields)"});
    if (!(options.side >= 0) || options.resolution < 1 || options.resolution > 4000 ||
        !(options.band >= 0 && options.band <= 1000) || (options.band > 0 && options.band < 1))
        return without_volume(
            {MeshStatus::BadOptions,
             "a voxel's side is above 0, a resolution 1 to 4,000, and a band 1 to "
             "1,000 voxels"});
    return guarded([&] { return made_volume(scene, options); },
                   [](const Diagnostic &why) {
                       return without_volume({MeshStatus::TooLarge, why.message});
                   });
}

std::string nrrd_file(const Volume &volume) noexcept {
    return guarded(
        [&] {
            if (volume.band > 0) return std::string();
            const std::string side = format_shortest(volume.side);
            const bool vectors = volume.components > 1;
            return fmt::format(
                       "NRRD0004\ntype: float\ndimension: {}\nsizes: {}{} {} {}\n"
                       "space dimension: 3\nspace directions: {}({},0,0) (0,{},0) (0,0,{})\n"
                       "space origin: ({},{},{})\nkinds: {}domain domain domain\n"
                       "endian: little\nencoding: raw\n\n",
                       vectors ? 4 : 3, vectors ? "3 " : "", volume.counts[0], volume.counts[1],
                       volume.counts[2], vectors ? "none " : "", side, side, side,
                       format_shortest(volume.origin[0]), format_shortest(volume.origin[1]),
                       format_shortest(volume.origin[2]), vectors ? "3-vector " : "") +
                   bytes_of(volume.components > 0 ? volume.values : volume.distances);
        },
        [](const Diagnostic &) { return std::string(); });
}

std::string npy_file(const Volume &volume) noexcept {
    return guarded(
        [&] {
            if (volume.band > 0) return std::string();
            std::string header =
                fmt::format("{{'descr': '<f4', 'fortran_order': True, 'shape': ({}{}, {}, {}), }}",
                            volume.components > 1 ? "3, " : "", volume.counts[0], volume.counts[1],
                            volume.counts[2]);
            // Magic, version and length are ten bytes; all of it is a multiple of 64.
            header.append(63 - (10 + header.size()) % 64, ' ');
            header += '\n';
            std::string bytes("\x93NUMPY\x01\x00", 8);
            bytes += static_cast<char>(header.size() & 0xff);
            bytes += static_cast<char>(header.size() >> 8);
            return bytes + header +
                   bytes_of(volume.components > 0 ? volume.values : volume.distances);
        },
        [](const Diagnostic &) { return std::string(); });
}

} // namespace fathom::v1
