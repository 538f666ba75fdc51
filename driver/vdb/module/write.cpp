// The module libfathom-vdb: writes OpenVDB files by OpenVDB, which takes longer to load than most of
// what the library does.
#include "interface.h"

#include <openvdb/io/Stream.h>
#include <openvdb/openvdb.h>
#include <openvdb/tools/SignedFloodFill.h>

#include <cstdio>
#include <sstream>

namespace {

using openvdb::Coord;

openvdb::math::Transform::Ptr transform_of(const FathomVdbGrid &grid) {
    auto transform = openvdb::math::Transform::createLinearTransform(grid.side);
    transform->postTranslate({grid.origin[0], grid.origin[1], grid.origin[2]});
    return transform;
}

template <class Places> Coord place_of(const Places &grid, std::size_t k) {
    return {grid.at[3 * k], grid.at[3 * k + 1], grid.at[3 * k + 2]};
}

openvdb::GridPtrVec grids_of(const FathomVdbGrid &from) {
    openvdb::GridPtrVec grids;
    const auto surface = openvdb::FloatGrid::create(static_cast<float>(from.background));
    surface->setName("surface");
    surface->setGridClass(openvdb::GRID_LEVEL_SET);
    surface->setTransform(transform_of(from));
    auto values = surface->getAccessor();
    for (std::size_t k = 0; k < from.count; ++k)
        values.setValue(place_of(from, k), from.distances[k]);
    openvdb::tools::signedFloodFill(surface->tree());
    grids.push_back(surface);
    if (!from.colors) return grids;
    const auto colors = openvdb::Vec3SGrid::create();
    colors->setName("Cd");
    colors->setTransform(transform_of(from));
    auto to = colors->getAccessor();
    for (std::size_t k = 0; k < from.count; ++k)
        to.setValue(place_of(from, k),
                    {from.colors[3 * k], from.colors[3 * k + 1], from.colors[3 * k + 2]});
    grids.push_back(colors);
    return grids;
}

template <class Grid, class ValueAt>
openvdb::GridBase::Ptr grid_of(const FathomVdbGrid &lattice, const FathomVdbNumbers &from,
                               openvdb::GridClass kind, const ValueAt &value_at) {
    const auto grid = Grid::create();
    grid->setName(from.name);
    grid->setGridClass(kind);
    grid->setTransform(transform_of(lattice));
    auto values = grid->getAccessor();
    for (std::size_t k = 0; k < from.count; ++k) values.setValue(place_of(from, k), value_at(k));
    return grid;
}

openvdb::GridBase::Ptr grid_of(const FathomVdbGrid &lattice, const FathomVdbNumbers &from) {
    if (from.components == 1)
        return grid_of<openvdb::FloatGrid>(lattice, from, openvdb::GRID_FOG_VOLUME,
                                           [&](std::size_t k) { return from.values[k]; });
    return grid_of<openvdb::Vec3SGrid>(lattice, from, openvdb::GRID_UNKNOWN, [&](std::size_t k) {
        const float *v = from.values + 3 * k;
        return openvdb::Vec3s(v[0], v[1], v[2]);
    });
}

openvdb::GridPtrVec grids_of(const FathomVdbGrid &lattice, const FathomVdbNumbers *from,
                             std::size_t fields) {
    openvdb::GridPtrVec grids;
    for (std::size_t i = 0; i < fields; ++i) grids.push_back(grid_of(lattice, from[i]));
    return grids;
}

// A file has an identifier of 36 letters behind 21 bytes of its head, made at random. One of the
// file's own bytes makes files of equal volumes equal.
void name_by_content(std::string &bytes) {
    constexpr std::size_t at = 21, length = 36;
    if (bytes.size() < at + length || bytes[at + 8] != '-' || bytes[at + 13] != '-') return;
    std::uint64_t hash[2] = {0xcbf29ce484222325u, 0x84222325cbf29ce4u}; // FNV-1a, twice
    for (std::size_t k = at + length; k < bytes.size(); ++k)
        for (std::uint64_t &h : hash)
            h = (h ^ static_cast<unsigned char>(bytes[k])) * 0x100000001b3u;
    char text[length + 1];
    std::snprintf(text, sizeof text, "%08x-%04x-%04x-%04x-%012llx",
                  static_cast<unsigned>(hash[0] >> 32),
                  static_cast<unsigned>(hash[0] >> 16 & 0xffff),
                  static_cast<unsigned>(hash[0] & 0x0fff) | 0x4000u,
                  static_cast<unsigned>(hash[1] >> 48 & 0x3fff) | 0x8000u,
                  static_cast<unsigned long long>(hash[1] & 0xffffffffffffu));
    bytes.replace(at, length, text, length);
}

} // namespace

extern "C" __attribute__((visibility("default"))) int
fathom_write_volume(const FathomVdbGrid *grid, const FathomVdbNumbers *numbers, std::size_t fields,
                    void (*take)(void *to, const char *bytes, std::size_t count), void *to,
                    char *why, std::size_t room) {
    try {
        openvdb::initialize();
        std::ostringstream stream(std::ios::binary);
        openvdb::io::Stream(stream).write(fields > 0 ? grids_of(*grid, numbers, fields)
                                                     : grids_of(*grid));
        std::string bytes = std::move(stream).str();
        name_by_content(bytes);
        take(to, bytes.data(), bytes.size());
        return 0;
    } catch (const std::exception &error) {
        std::snprintf(why, room, "%s", error.what());
        return 1;
    }
}
