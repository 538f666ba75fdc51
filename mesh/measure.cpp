#include "mesh/measure.h"

#include "mesh/walk.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace fathom::mesh {
namespace {

// What the octree left out as inside, and the corners that are in the solid.
CellSums sums_of_octree(const Octree &octree, const Real3 &middle) {
    CellSums sums;
    std::vector<Cell> stack{{0, 0, {}}};
    while (!stack.empty()) {
        const Cell cell = stack.back();
        stack.pop_back();
        const Node &node = octree.nodes[static_cast<std::size_t>(cell.node)];
        const std::int32_t side = octree.lattice.cells(cell.level);
        if (node.children != none) {
            for (int k = 0; k < 8; ++k)
                stack.push_back({node.children + k, cell.level + 1, corner(cell.at, side / 2, k)});
        } else if (node.space == Space::Inside) {
            sums.add(point_of(octree.lattice, cell.at),
                     point_of(octree.lattice, corner(cell.at, side, 7)), node.space, middle);
        } else if (node.space == Space::Open) {
            for (int c = 0; c < 8; ++c) {
                if (!(node.signs >> c & 1)) continue;
                const Point at = point_of(octree.lattice, corner(cell.at, side, c));
                sums.know(at, at);
            }
        }
    }
    return sums;
}

} // namespace

Measures measure(const ir::Scene &scene, const Settings &settings, const Made &made,
                 Progress &progress, const MeasureEffort &effort) {
    const Octree &octree = made.octree;
    const Field field(scene, settings.time, settings.bounds);
    const Real3 middle = sums_of(made.mesh).center;
    CellSums sums = sums_of_octree(octree, middle);
    std::vector<OpenBlock> open;
    for (const Cell &leaf : open_leaves(octree)) {
        const Node &node = octree.nodes[static_cast<std::size_t>(leaf.node)];
        const Index end = corner(leaf.at, octree.lattice.cells(leaf.level), 7);
        open.push_back({{point_of(octree.lattice, leaf.at), point_of(octree.lattice, end)},
                        octree.tapes[static_cast<std::size_t>(node.task)]});
    }
    sums.add(sums_of_open(field, open, {middle, octree.lattice.ulp, seam_thickness(octree.lattice)},
                          threads_of(settings), progress, effort));

    Measures measures = measures_of(sums, middle);
    measures.used_bound = field.proved;
    // No solid of that volume has less surface than a ball.
    const double ball = std::cbrt(36 * std::numbers::pi) * std::pow(measures.volume.lo, 2.0 / 3);
    measures.area.lo = std::max(measures.area.lo, ball * (1 - rounding_share));
    return measures;
}

MeshSums sums_of(const Mesh &mesh) {
    MeshSums sums;
    if (mesh.vertices.empty()) return sums;
    // About one of its vertices, so that nothing is lost far from the origin.
    const Point &origin = mesh.vertices[0];
    Real3 moment{};
    for (const auto &t : mesh.triangles) {
        std::array<Real3, 3> p;
        for (std::size_t k = 0; k < 3; ++k)
            for (std::size_t i = 0; i < 3; ++i)
                p[k][i] = double(mesh.vertices[t[k]][i]) - origin[i];
        Real3 u, v;
        for (std::size_t i = 0; i < 3; ++i) u[i] = p[1][i] - p[0][i], v[i] = p[2][i] - p[0][i];
        const Real3 n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2],
                      u[0] * v[1] - u[1] * v[0]};
        sums.area += 0.5 * std::hypot(n[0], n[1], n[2]);
        const double volume = (p[0][0] * n[0] + p[0][1] * n[1] + p[0][2] * n[2]) / 6;
        sums.volume += volume;
        for (std::size_t i = 0; i < 3; ++i) moment[i] += volume * (p[0][i] + p[1][i] + p[2][i]) / 4;
    }
    for (std::size_t i = 0; i < 3; ++i)
        sums.center[i] = origin[i] + (sums.volume != 0 ? moment[i] / sums.volume : 0);
    return sums;
}

} // namespace fathom::mesh
