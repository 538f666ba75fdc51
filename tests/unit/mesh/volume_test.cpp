// Volumes: stored numbers are distances within what is claimed, and the band is whole.
#include "driver/compile.h"
#include "mesh/nearest.h"
#include "mesh/volume.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <map>

using namespace fathom;

namespace {

struct Banded {
    mesh::VoxelGrid grid;
    std::vector<mesh::Voxel> voxels;
};

// A band three voxels wide, of a mesh with cells of half a voxel.
Banded banded(const std::string &text, double side, unsigned threads = 0) {
    const driver::Compilation c = driver::compile_text("volume.sdf", text, "", {});
    INFO(text);
    REQUIRE(c.good());
    mesh::Settings settings;
    settings.side = side / 2;
    settings.threads = threads;
    const mesh::Made made = mesh::make_mesh(c.scene, settings);
    REQUIRE(made.failure == mesh::Failure::None);
    const std::optional<mesh::VoxelGrid> grid = mesh::make_grid(made.box, side, 4);
    REQUIRE(grid);
    mesh::Progress progress;
    return {*grid, mesh::band_of(c.scene, settings, made.mesh, settings.side, *grid, 3 * side, {},
                                 progress)};
}

} // namespace

TEST_CASE("a ball's band has all voxels near its surface, with their distances") {
    const double side = 0.07;
    const Banded ball = banded("sphere(1).translate([0.3, 0, 0])", side);
    std::map<mesh::Index, float> stored;
    for (const mesh::Voxel &voxel : ball.voxels) {
        CHECK(stored.emplace(voxel.at, voxel.distance).second); // each once
        const mesh::Point p = ball.grid.point(voxel.at);
        const double d = std::hypot(p[0] - 0.3, p[1], p[2]) - 1;
        CHECK(std::fabs(voxel.distance - d) < side / 50);
        if (std::fabs(d) > 1e-6) CHECK((voxel.distance < 0) == (d < 0));
    }
    std::size_t wanted = 0;
    for (std::int32_t x = 0; x < ball.grid.counts[0]; ++x)
        for (std::int32_t y = 0; y < ball.grid.counts[1]; ++y)
            for (std::int32_t z = 0; z < ball.grid.counts[2]; ++z) {
                const mesh::Point p = ball.grid.point({x, y, z});
                if (std::fabs(std::hypot(p[0] - 0.3, p[1], p[2]) - 1) > 2.95 * side) continue;
                ++wanted;
                CHECK(stored.count({x, y, z}) == 1);
            }
    CHECK(wanted > 1000);
}

TEST_CASE("fields that are no distances give distances, outside and inside") {
    // The union's own field is less than the distance in both balls' common part; the ellipsoid's
    // everywhere.
    const double side = 0.06;
    const Banded two = banded("sphere(0.5) | sphere(0.5).translate(x: 0.4)", side);
    for (const mesh::Voxel &voxel : two.voxels) {
        const mesh::Point p = two.grid.point(voxel.at);
        // The surface is two caps that meet in the ring x = 0.2.
        const double ring = std::hypot(p[0] - 0.2, std::hypot(p[1], p[2]) - std::sqrt(0.21)),
                     left = std::hypot(p[0], p[1], p[2]),
                     right = std::hypot(p[0] - 0.4, p[1], p[2]);
        double d = ring;
        if (0.5 * p[0] / left <= 0.2) d = std::min(d, std::fabs(left - 0.5));
        if (0.4 + 0.5 * (p[0] - 0.4) / right >= 0.2) d = std::min(d, std::fabs(right - 0.5));
        CHECK(std::fabs(std::fabs(voxel.distance) - d) < side / 10);
    }
}

TEST_CASE("all voxels, and the nearest triangle") {
    const driver::Compilation c = driver::compile_text("volume.sdf", "box([1, 2, 3])", "", {});
    REQUIRE(c.good());
    mesh::Settings settings;
    settings.side = 0.1;
    const mesh::Made made = mesh::make_mesh(c.scene, settings);
    const std::optional<mesh::VoxelGrid> grid = mesh::make_grid(made.box, 0.2, 3);
    REQUIRE(grid);
    mesh::Progress progress;
    const std::vector<float> all =
        mesh::distances_of(c.scene, settings, made.mesh, settings.side, *grid, progress);
    REQUIRE(all.size() == std::size_t(grid->counts[0]) * std::size_t(grid->counts[1]) *
                              std::size_t(grid->counts[2]));
    const mesh::TriangleTree tree(made.mesh);
    std::size_t k = 0;
    for (std::int32_t z = 0; z < grid->counts[2]; ++z)
        for (std::int32_t y = 0; y < grid->counts[1]; ++y)
            for (std::int32_t x = 0; x < grid->counts[0]; ++x, ++k) {
                const mesh::Point p = grid->point({x, y, z});
                const double a = std::fabs(p[0]) - 0.5, b = std::fabs(p[1]) - 1,
                             e = std::fabs(p[2]) - 1.5;
                const double d = std::hypot(std::max(a, 0.0), std::max(b, 0.0), std::max(e, 0.0)) +
                                 std::min(std::max({a, b, e}), 0.0);
                CHECK(all[k] == Approx(d).margin(1e-3));
                CHECK_FALSE(tree.nearest(p, std::max(0.9 * std::fabs(d) - 1e-3, 0.0)));
            }
}

TEST_CASE("voxels lie at whole multiples of their side, and the same for any number of threads") {
    const Banded one = banded("torus(1, 0.3)", 0.11, 1), many = banded("torus(1, 0.3)", 0.11, 5);
    REQUIRE(one.voxels.size() == many.voxels.size());
    for (std::size_t k = 0; k < one.voxels.size(); ++k) {
        CHECK(one.voxels[k].at == many.voxels[k].at);
        CHECK(one.voxels[k].distance == many.voxels[k].distance);
    }
    for (const double origin : one.grid.origin)
        CHECK(origin / 0.11 == Approx(std::round(origin / 0.11)));
    const double nan = std::nan("");
    CHECK_FALSE(mesh::make_grid({{0, 0, 0}, {1, 1, 1}}, nan, 3));
    CHECK_FALSE(mesh::make_grid({{0, 0, 0}, {1, 1, 1}}, 1e-9, 3));
    CHECK_FALSE(mesh::make_grid({{1e6, 0, 0}, {1e6 + 1, 1, 1}}, 0.01, 3));
}
