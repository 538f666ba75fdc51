// True distances to a solid's surface at the points of a lattice: all of them, or those of a band
// about the surface (docs/volumes.md).
#pragma once

#include "mesh/mesh.h"

#include <optional>
#include <span>

namespace fathom::mesh {

// Points at origin + side * (i, j, k), 0 <= i < counts[0] and so on.
struct VoxelGrid {
    std::array<double, 3> origin{};
    double side = 1;
    std::array<std::int32_t, 3> counts{};
    Point point(const Index &at) const {
        Point p;
        for (std::size_t i = 0; i < 3; ++i) p[i] = static_cast<float>(origin[i] + side * at[i]);
        return p;
    }
    double ulp() const; // of the largest coordinate
};

// About a box, with so many voxels to each side. Points lie at whole multiples of the side. None:
// more than 2^31 - 1 points, or such that floats cannot tell apart.
std::optional<VoxelGrid> make_grid(const ir::Box &box, double side, int padding);

struct Voxel {
    Index at{};
    float distance = 0; // negative in the solid
    Point color{};      // of the nearest point, where colours were given
};

// The voxels that are nearer to the mesh than `band`, in the order of blocks of eight a side. `off`: how
// far mesh and surface are apart at most. `colors`: by vertex of the mesh, or none.
std::vector<Voxel> band_of(const ir::Scene &scene, const Settings &settings, const Mesh &mesh,
                           double off, const VoxelGrid &grid, double band,
                           std::span<const Point> colors, Progress &progress);

// At all points, x the fastest.
std::vector<float> distances_of(const ir::Scene &scene, const Settings &settings, const Mesh &mesh,
                                double off, const VoxelGrid &grid, Progress &progress);

// What another function of the scene gives at all points, as many numbers a point as it has
// components (Scene::fields).
std::vector<float> values_of(const ir::Scene &scene, ir::FunctionId function,
                             const Settings &settings, const VoxelGrid &grid, Progress &progress);

} // namespace fathom::mesh
