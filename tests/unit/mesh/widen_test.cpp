// Walls and gaps thinner than cells: what is drawn of them is whole, at its place, and certified.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace fathom;

namespace {

ir::Scene thin_scene(const std::string &text) {
    driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    return std::move(c.scene);
}

mesh::Settings wide_cells(int resolution, unsigned threads = 0) {
    mesh::Settings settings;
    settings.resolution = resolution;
    settings.threads = threads;
    return settings;
}

void check_whole(const mesh::Mesh &made) {
    const test::Survey found = test::survey(made.vertices, made.triangles);
    CHECK(found.closed());
    CHECK(test::crossings(made.vertices, made.triangles) == 0);
}

} // namespace

TEST_CASE("closed shells and gaps far thinner than cells are drawn whole, and certified") {
    struct Case {
        const char *text;
        std::size_t pieces;
        long genus;
        double volume;
    };
    const double pi = std::numbers::pi;
    for (const auto &[text, pieces, genus, volume] :
         {Case{"sphere(2).shell(0.01)", 2, 0, 4 * pi * 4 * 0.01},
          Case{"box(3).shell(0.01).rotate(0.3, axis: [1, 2, 3])", 2, 0, 6 * 9 * 0.01},
          Case{"sphere(3) - sphere(2).shell(0.01)", 3, 0, 4 * pi * (27.0 / 3 - 4 * 0.01)}}) {
        INFO(text);
        const ir::Scene scene = thin_scene(text);
        const mesh::Settings settings = wide_cells(30);
        const mesh::Mended mended = make_certified_mesh(scene, settings);
        REQUIRE(mended.made.failure == mesh::Failure::None);
        CHECK(mended.made.widened != 0);
        CHECK(mended.certificate.certified());
        check_whole(mended.made.mesh);
        CHECK(mended.certificate.components == pieces);
        CHECK(mended.certificate.genus == genus);
        // Triangles between the two sides of a wall lose less of it than it is off by itself.
        const double spare = 0.01 * volume + 0.002 * mended.certificate.mesh_area;
        CHECK(std::fabs(mended.certificate.mesh_volume - volume) < 0.1 * volume + spare);
        CHECK(mended.certificate.least_volume <= volume);
        CHECK(volume <= mended.certificate.largest_volume);
        const double side = mended.made.octree.lattice.side(mended.made.octree.lattice.level);
        CHECK(mended.certificate.surface_to_mesh <= side);
        CHECK(mended.certificate.mesh_to_surface <= side);

        const mesh::Field field(scene, 0, {});
        mesh::Evaluator evaluator(field);
        mesh::Points points;
        for (const mesh::Point &p : mended.made.mesh.vertices) points.add(p);
        std::vector<float> values;
        values_at(evaluator, *field.whole, points, values);
        std::size_t off = 0;
        for (const float value : values) {
            if (std::fabs(value) > mended.certificate.mesh_to_surface) FAIL(value);
            off += std::fabs(value) > 0.002 * side;
        }
        CHECK(off < values.size() / 50);

        const mesh::Made plain = make_mesh(scene, settings); // without a certificate
        CHECK(plain.widened != 0);
        check_whole(plain.mesh);
        CHECK(plain.octree.undecided.empty());
    }
}

TEST_CASE("a wider mesh whose shape is in doubt is whole") {
    const mesh::Mended mended = make_certified_mesh(
        thin_scene("let wall = box(0.5625) - box(0.548)\n"
                   "(wall | wall.translate(x: 0.5)).rotate(1.36, axis: [1, 2, 3])"),
        wide_cells(15));
    REQUIRE(mended.made.failure == mesh::Failure::None);
    CHECK(mended.made.widened != 0);
    CHECK(mended.certificate.shape.doubted);
    REQUIRE(!mended.made.mesh.triangles.empty());
    CHECK(!mended.made.octree.nodes.empty());
    check_whole(mended.made.mesh);
}

TEST_CASE("a plate that no corner of the finest cells shows is drawn") {
    const ir::Scene scene = thin_scene("box([2, 2, 0.0003])");
    CHECK(make_plain_mesh(scene, wide_cells(12)).failure == mesh::Failure::Unseen);
    const mesh::Made made = make_mesh(scene, wide_cells(12));
    REQUIRE(made.failure == mesh::Failure::None);
    check_whole(made.mesh);
    CHECK(mesh::form_of(made.mesh).components == 1);
    const double area = mesh::sums_of(made.mesh).area;
    CHECK(area == Approx(8).epsilon(0.01));
}

TEST_CASE("a solid is grown to draw thin walls alike however many threads there are") {
    const ir::Scene scene = thin_scene("box(3).shell(0.01).rotate(0.3, axis: [1, 2, 3])");
    const mesh::Made one = make_mesh(scene, wide_cells(24, 1)),
                     more = make_mesh(scene, wide_cells(24, 3));
    CHECK(one.widened > 0);
    CHECK(one.mesh.vertices == more.mesh.vertices);
    CHECK(one.mesh.triangles == more.mesh.triangles);
}

TEST_CASE("what is grown to be drawn ends where bounds cut it off") {
    const ir::Scene scene = thin_scene("sphere(2).shell(0.01)");
    mesh::Settings settings = wide_cells(32);
    settings.bounds = ir::Box{{-3, -3, -3}, {3, 3, 0.5}};
    const mesh::Mended mended = make_certified_mesh(scene, settings);
    REQUIRE(mended.made.failure == mesh::Failure::None);
    CHECK(mended.certificate.certified());
    check_whole(mended.made.mesh);
    for (const mesh::Point &p : mended.made.mesh.vertices) CHECK(p[2] <= 0.5f + 0.001f);
}

TEST_CASE("a field that is grown lies below by as much, in points and in boxes, before it is cut") {
    const ir::Scene scene = thin_scene("sphere(1) | box([1, 2, 3]).translate(x: 1)");
    const ir::Box box{{-1, -1, -1}, {1, 1, 1}};
    const mesh::Field as_it_is(scene, 0, {}), grown(scene, 0, box, 0.25f);
    mesh::Evaluator one(as_it_is), other(grown);
    mesh::Points points;
    cpu::Boxes boxes;
    for (int k = 0; k < 16; ++k) {
        const float x = -1.5f + 0.19f * static_cast<float>(k), size = k % 2 ? 0.3f : 0.0f;
        points.add({x, 0.3f * x, 0.7f});
        for (std::size_t i = 0; i < 3; ++i) {
            const auto n = static_cast<std::size_t>(k);
            boxes.lo[i][n] = points[n][i], boxes.hi[i][n] = points[n][i] + size;
        }
    }
    boxes.count = 16;
    std::vector<float> value, wider;
    values_at(one, *as_it_is.whole, points, value);
    values_at(other, *grown.whole, points, wider);
    ranges_over(other, *grown.whole, boxes);
    for (std::size_t k = 0; k < 16; ++k) {
        const float outside = std::max({std::fabs(points[k][0]) - 1, std::fabs(points[k][1]) - 1,
                                        std::fabs(points[k][2]) - 1});
        CHECK(wider[k] == std::max(value[k] - 0.25f, outside));
        CHECK(other.ranges.result_lo[k] <= wider[k]);
        CHECK(wider[k] <= other.ranges.result_hi[k]);
    }
}
