// Certificates: what they say is true where the truth is known, and what is not known they do not
// say.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

using namespace fathom;

namespace {

struct Certified {
    mesh::Made made;
    mesh::Certificate certificate;
};

Certified certified(const std::string &text, mesh::Settings settings) {
    const driver::Compilation c =
        driver::compile_text("mesh.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
    REQUIRE(c.good());
    Certified result;
    result.made = mesh::make_plain_mesh(c.scene, settings);
    REQUIRE(result.made.failure == mesh::Failure::None);
    mesh::Progress progress;
    result.certificate = mesh::certify(c.scene, settings, result.made, progress);
    return result;
}

mesh::Settings cells(int resolution) {
    mesh::Settings settings;
    settings.resolution = resolution;
    return settings;
}

} // namespace

TEST_CASE("a ball's certificate encloses what is known of balls") {
    const auto [made, certificate] = certified("sphere(1)", cells(30));
    CHECK(certificate.certified());
    const double side = made.octree.lattice.side(made.octree.lattice.level);
    CHECK(certificate.surface_to_mesh <= side);
    CHECK(certificate.mesh_to_surface <= side);
    double farthest = 0; // of the vertices, from the ball
    for (const mesh::Point &p : made.mesh.vertices)
        farthest = std::max(farthest, std::fabs(std::hypot(p[0], p[1], p[2]) - 1.0));
    CHECK(farthest <= certificate.mesh_to_surface);
    const double volume = 4.0 / 3 * std::numbers::pi;
    CHECK(certificate.least_volume < volume);
    CHECK(volume < certificate.largest_volume);
    CHECK(certificate.largest_volume - certificate.least_volume < 3 * side * 4 * std::numbers::pi);
    CHECK(certificate.mesh_volume == Approx(volume).epsilon(0.01));
    CHECK((certificate.components == 1 && certificate.genus == 0));
    CHECK(std::isinf(certificate.area.hi));

    const driver::Compilation c = driver::compile_text("mesh.sdf", "sphere(1)", "", {});
    mesh::Certificate narrow = certificate;
    mesh::Progress progress;
    enclose_measures(c.scene, cells(30), made, progress, narrow);
    CHECK((narrow.least_volume < volume && volume < narrow.largest_volume));
    CHECK(narrow.largest_volume - narrow.least_volume <
          0.15 * (certificate.largest_volume - certificate.least_volume));
    const double area = 4 * std::numbers::pi;
    CHECK((narrow.area.lo < area && area < narrow.area.hi));
    CHECK(narrow.area.hi - narrow.area.lo < 0.3 * area);
}

TEST_CASE("pieces and handles of the mesh are counted") {
    const auto [made, certificate] =
        certified("torus(1, 0.3) | sphere(0.4) | menger(1, 1).translate(x: 3)", cells(70));
    CHECK(certificate.components == 3);
    CHECK(certificate.genus == 6);
    CHECK(certificate.certified());
}

TEST_CASE("corners and creases are certified") {
    for (const char *text : {"box([2, 1, 1.5])", "box(1) - sphere(0.62)", "cone(1, 1.5)",
                             "box(1).rotate(0.4, axis: [1, 2, 3])"}) {
        INFO(text);
        const auto [made, certificate] = certified(text, cells(25));
        CHECK(certificate.undecided.size() == 0);
        CHECK(certificate.unproved.size() == 0);
    }
}

TEST_CASE("a mesh that misses part of the surface is not certified") {
    mesh::Settings settings = cells(20);
    settings.extra = 0; // nothing is looked for between corners
    const std::string text = "sphere(1).translate(x: -2) | box([0.002, 1, 1]).translate(x: 1.11)";
    const auto [made, certificate] = certified(text, settings);
    CHECK(certificate.components == 1); // the plate is missed
    CHECK_FALSE(certificate.certified());
    CHECK(certificate.undecided.size() > 20);
    for (const mesh::Cell &cell : certificate.undecided) // all of them lie about the plate
        CHECK(mesh::point_of(made.octree.lattice, cell.at)[0] > 0.8f);
    // Wherever the plate is, some undecided cell is.
    for (int k = 0; k < 100; ++k) {
        const double y = (k % 10) / 10.0 - 0.45, z = (k / 10) / 10.0 - 0.45;
        bool found = false;
        for (const mesh::Cell &cell : certificate.undecided) {
            const auto lo = mesh::point_of(made.octree.lattice, cell.at),
                       hi = mesh::point_of(
                           made.octree.lattice,
                           mesh::corner(cell.at, made.octree.lattice.cells(cell.level), 7));
            found = found || (lo[0] <= 1.11f && hi[0] >= 1.11f && lo[1] <= y && hi[1] >= y &&
                              lo[2] <= z && hi[2] >= z);
        }
        CHECK(found);
    }
}

TEST_CASE("a mesh that is moved from its surface is not certified") {
    const driver::Compilation c = driver::compile_text("mesh.sdf", "sphere(1)", "", {});
    REQUIRE(c.good());
    mesh::Made made = mesh::make_mesh(c.scene, cells(24));
    for (mesh::Point &p : made.mesh.vertices) p[0] += 0.4f;
    mesh::Progress progress;
    const mesh::Certificate certificate = mesh::certify(c.scene, cells(24), made, progress);
    CHECK(certificate.unproved.size() > 0);
    CHECK_FALSE(certificate.undecided.empty());
}

namespace {

mesh::Mended mended(const std::string &text, const mesh::Settings &settings) {
    const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    mesh::Mended result = mesh::make_certified_mesh(c.scene, settings);
    REQUIRE(result.made.failure == mesh::Failure::None);
    const test::Survey found = test::survey(result.made.mesh.vertices, result.made.mesh.triangles);
    CHECK(found.closed());
    CHECK(test::crossings(result.made.mesh.vertices, result.made.mesh.triangles) == 0);
    return result;
}

} // namespace

TEST_CASE("cells that a certificate leaves undecided are divided until all is decided") {
    int rounds = 0;
    for (const char *text : {
             "cone(0.3, 5)",
             "sphere(1) | sphere(1).translate(x: 2) | sphere(0.5).translate(x: 3.5)",
             "cylinder(0.01, 4) | cylinder(0.01, 4).rotate(1.5, axis: X)",
             "torus(1, 0.005)",
         }) {
        INFO(text);
        const auto [made, before] = certified(text, cells(96));
        CHECK_FALSE(before.certified());
        const mesh::Mended after = mended(text, cells(96));
        CHECK(after.certificate.certified());
        rounds += after.rounds;
        // What was proved again in parts is proved of the whole.
        mesh::Progress progress;
        const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
        CHECK(certify(c.scene, cells(96), after.made, progress).certified());
    }
    CHECK(rounds > 0);
}

TEST_CASE("mending has an end, and what is undecided then is listed") {
    mesh::Settings settings = cells(40);
    const mesh::Mended result = mended("sphere(1) | box([1, 1, 0.0001])"
                                       ".repeat([0, 0, 0.01], count: [1, 1, 60]).translate(z: 2)",
                                       settings);
    CHECK_FALSE(result.certificate.certified());
    CHECK(result.certificate.undecided.size() > 100);
}

TEST_CASE("mending ends where no round gains, and alike however many threads there are") {
    // Plates far thinner than the finest cell, too near to each other to be drawn wider: they are divided
    // as deep as the work allows.
    const driver::Compilation c =
        driver::compile_text("mesh.sdf",
                             "sphere(1) | box([0.32, 0.32, 0.00001])"
                             ".repeat([0, 0, 0.01], count: [1, 1, 30]).translate(z: 2)",
                             "", {});
    REQUIRE(c.good());
    std::vector<mesh::Mended> all;
    for (const unsigned threads : {1u, 3u, 16u}) {
        mesh::Settings settings = cells(24);
        settings.threads = threads;
        all.push_back(mesh::make_certified_mesh(c.scene, settings));
        const mesh::Mended &result = all.back();
        const mesh::Lattice &lattice = result.made.octree.lattice;
        CHECK_FALSE(result.certificate.certified());
        CHECK(result.certificate.undecided.size() > 10);
        for (const mesh::Cell &cell : result.certificate.undecided)
            CHECK(cell.level > lattice.level);
        // One for each level, one that still found seams, and the one that showed it was in vain.
        CHECK(result.rounds <= lattice.depth - lattice.level + 2);
        CHECK(result.rounds == all[0].rounds);
        CHECK(result.certificate.undecided.size() == all[0].certificate.undecided.size());
        CHECK(result.made.mesh.vertices == all[0].made.mesh.vertices);
        CHECK(result.made.mesh.triangles == all[0].made.mesh.triangles);
    }
}

TEST_CASE("surface that is seen to be too far from the mesh is not looked into any closer") {
    // Fins that cells of a third of their distance lose: as many boxes as are open, and no more.
    const auto [made, certificate] =
        certified("box([10, 0.5, 10]) | box([0.1, 3, 10]).repeat([0.5, 0, 0], count: [19, 1, 1])"
                  ".translate(y: 1.7)",
                  cells(32));
    CHECK(certificate.undecided.size() > 500);
    CHECK(certificate.divisions < 12 * certificate.undecided.size());
}

TEST_CASE("a root on a flat face is known to a small part of its edge") {
    const driver::Compilation c = driver::compile_text("mesh.sdf", "box([2, 1, 1.5])", "", {});
    REQUIRE(c.good());
    const mesh::Made made = mesh::make_mesh(c.scene, cells(25));
    const double side = made.octree.lattice.side(made.octree.lattice.level);
    for (const float slack : made.root_slack) CHECK(slack <= side / 200);
}

TEST_CASE("within a root's slack the field changes its sign, also on edges that cross many times") {
    std::size_t several = 0; // roots with more than one change of sign within their slack
    for (const char *text : {"gyroid(0.3, thickness: 0.05) & sphere(1)",
                             "sphere(1) & box([4, 0.02, 4]).repeat([0, 0.05, 0])"}) {
        INFO(text);
        const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
        REQUIRE(c.good());
        const mesh::Settings settings = cells(12);
        const mesh::Made made = mesh::make_mesh(c.scene, settings);
        REQUIRE(made.failure == mesh::Failure::None);
        const mesh::Field field(c.scene, settings.time, settings.bounds);
        mesh::Evaluator evaluator(field);
        constexpr int samples = 400;
        std::size_t still = 0;
        for (std::size_t k = 0; k < made.roots.size(); ++k) {
            mesh::Points points;
            for (int i = -samples; i <= samples; ++i) {
                mesh::Point at = made.roots[k];
                at[made.loops.crossings[k].axis] +=
                    1.001f * made.root_slack[k] * static_cast<float>(i) / samples;
                points.add(at);
            }
            std::vector<float> values;
            values_at(evaluator, *field.whole, points, values);
            int changes = 0;
            for (std::size_t i = 1; i < values.size(); ++i)
                changes += (values[i] <= 0) != (values[i - 1] <= 0);
            still += changes == 0;
            several += changes > 1;
        }
        CHECK(made.roots.size() > 500);
        CHECK(still == 0);
    }
    CHECK(several > 0);
}
