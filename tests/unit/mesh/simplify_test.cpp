// Fewer triangles: still closed, without crossings, near, and of one paint each.
#include "driver/compile.h"
#include "mesh/appearance.h"
#include "mesh/certify.h"
#include "mesh/exact.h"
#include "mesh/simplify.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

using namespace fathom;

namespace {

struct Fewer {
    driver::Compilation compilation;
    mesh::Settings settings;
    mesh::Made made;
    mesh::Simplified simplified;
    double side = 0;
};

Fewer fewer(const std::string &text, int resolution, double share, unsigned threads = 2,
            bool painted = false) {
    Fewer f;
    f.compilation = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(f.compilation.good());
    f.settings.resolution = resolution;
    f.made = mesh::make_mesh(f.compilation.scene, f.settings);
    REQUIRE(f.made.failure == mesh::Failure::None);
    const mesh::Lattice &lattice = f.made.octree.lattice;
    f.side = lattice.side(lattice.level);
    mesh::Paints paints;
    if (painted) {
        mesh::Appearance found = appearance_of(f.compilation.scene, 0, f.made.mesh, lattice.unit);
        paints = {std::move(found.colors), std::move(found.material_of)};
    }
    mesh::Progress progress;
    f.simplified = simplify(f.made.mesh, paints, {share * f.side, f.side, threads}, progress);
    return f;
}

} // namespace

TEST_CASE("flat faces take few triangles, and what comes of it is a mesh like the first") {
    for (const char *text :
         {"box([2, 1, 1.5])", "box(1) - sphere(0.62)", "torus(1, 0.3) | box([3, 0.1, 0.1])",
          "smooth_union(0.2) { sphere(0.6); box(0.8).translate(x: 0.7) }",
          "box([2, 2, 0.01]) | cone(0.4, 1.5)", "box(1) | box(1).translate([1, 1, 0])"}) {
        INFO(text);
        const Fewer f = fewer(text, 40, 0.2);
        const test::Survey before = test::survey(f.made.mesh.vertices, f.made.mesh.triangles),
                           after = test::survey(f.simplified.mesh.vertices,
                                                f.simplified.mesh.triangles);
        CHECK_FALSE(f.simplified.undone);
        CHECK(f.simplified.before == f.made.mesh.triangles.size());
        CHECK(f.simplified.mesh.triangles.size() < f.simplified.before / 2);
        CHECK(after.closed());
        CHECK(after.equal_points == 0);
        CHECK(after.components == before.components);
        CHECK(after.genus == before.genus);
        CHECK(after.volume == Approx(before.volume).epsilon(0.05));
        CHECK(test::crossings(f.simplified.mesh.vertices, f.simplified.mesh.triangles) == 0);
    }
}

TEST_CASE("a box comes down to its twelve triangles, a plate with a hole to few") {
    const auto count = [](const std::string &text, double share) {
        const Fewer f = fewer(text, 64, share);
        CHECK_FALSE(f.simplified.undone);
        CHECK(test::survey(f.simplified.mesh.vertices, f.simplified.mesh.triangles).closed());
        return f.simplified.mesh.triangles.size();
    };
    for (const double share : {0.05, 0.5}) {
        CHECK(count("box([2, 1, 1.5])", share) <= 16);
        CHECK(count("box(1).rotate(0.4, axis: [1, 2, 3])", share) <= (share < 0.1 ? 800 : 100));
    }
    CHECK(count("box(2) - box([1, 1, 2])", 0.5) <= 60);
    CHECK(count("box([2, 1, 1.5]) - cylinder(0.3, 3)", 0.5) < 400);
}

TEST_CASE("a simplified mesh has a certificate of its own") {
    Fewer f = fewer("box(1) - sphere(0.62)", 28, 0.25);
    f.made.mesh = f.simplified.mesh;
    f.made.simplified = 0.25 * f.side;
    mesh::Progress progress;
    const mesh::Certificate certificate =
        certify(f.compilation.scene, f.settings, f.made, progress);
    CHECK(certificate.certified());
    CHECK(certificate.mesh_to_surface <= 1.25 * f.side);
    CHECK(certificate.surface_to_mesh <= 1.25 * f.side);
    // A triangle that is moved away is seen.
    for (mesh::Point &p : f.made.mesh.vertices) p[0] += static_cast<float>(3 * f.side);
    CHECK_FALSE(certify(f.compilation.scene, f.settings, f.made, progress).certified());
}

TEST_CASE("where paints meet, triangles stay as they are") {
    const Fewer f =
        fewer("box([2, 1, 1]).paint(p => if p.x > 0.1 { red } else { blue })", 40, 0.2, 2, true);
    CHECK(f.simplified.colored > 0);
    CHECK(f.simplified.mesh.triangles.size() < f.simplified.before / 2);
    // The colours of a triangle's corners differ only next to the border.
    const std::vector<mesh::Point> colors =
        colors_of(f.compilation.scene, 0, f.simplified.mesh, f.made.octree.lattice.unit);
    std::size_t mixed = 0;
    for (const auto &t : f.simplified.mesh.triangles) {
        if (colors[t[0]] == colors[t[1]] && colors[t[1]] == colors[t[2]]) continue;
        ++mixed;
        for (const std::uint32_t v : t)
            CHECK(std::abs(f.simplified.mesh.vertices[v][0] - 0.1) < 2 * f.side);
    }
    CHECK(mixed > 20);
}

TEST_CASE("simplified meshes do not depend on the number of threads") {
    const char *text = "gyroid(0.5, thickness: 0.1) & box(1)";
    const Fewer one = fewer(text, 32, 0.3, 1), five = fewer(text, 32, 0.3, 5);
    CHECK(one.simplified.mesh.vertices == five.simplified.mesh.vertices);
    CHECK(one.simplified.mesh.triangles == five.simplified.mesh.triangles);
}

TEST_CASE("signs of points are exact") {
    const mesh::Point a{0.1f, 0.1f, 0.1f}, b{12, 12, 12}, c{24, 24, 24.000002f};
    CHECK(mesh::turn_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 2) == 1);
    CHECK(mesh::turn_of({0, 0, 0}, {0.1f, 0.1f, 0}, {0.3f, 0.3f, 0}, 2) == 0);
    CHECK(mesh::is_flat(a, b, {24, 24, 24}));
    CHECK_FALSE(mesh::is_flat(a, b, c));
    CHECK(mesh::side_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.3f, 1e-30f}) == 1);
    CHECK(mesh::side_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.3f, -1e-30f}) == -1);
    CHECK(mesh::side_of({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0.3f, 0.3f, 0}) == 0);
}

TEST_CASE("triangles cross, or share a vertex or an edge alone") {
    const std::vector<mesh::Point> p{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},  {1, 1, -1}, {1, 1, 1},
                                     {3, 3, 1}, {1, 1, 0}, {-4, 0, 0}, {0, -4, 0}, {9, 1, 0}};
    const auto cross = [&](std::array<std::uint32_t, 3> s, std::array<std::uint32_t, 3> t) {
        return mesh::crossing_of(p, s, t).has_value();
    };
    CHECK(cross({0, 1, 2}, {3, 4, 5}));       // through it
    CHECK_FALSE(cross({0, 7, 2}, {3, 4, 5})); // beside it
    CHECK(cross({0, 1, 2}, {0, 3, 4}));       // a vertex in common, and more
    CHECK_FALSE(cross({0, 1, 2}, {0, 7, 8})); // in one plane, a vertex alone
    CHECK(cross({0, 1, 2}, {0, 6, 1}));       // in one plane, an edge, folded
    CHECK_FALSE(cross({0, 1, 2}, {1, 0, 8})); // in one plane, an edge alone
    CHECK(cross({0, 1, 2}, {6, 9, 5}));       // in one plane, in part
    CHECK(cross({0, 1, 2}, {0, 7, 6}));       // in one plane, over a vertex in common
    // Boxes that touch in one plane: a vertex on a side, and beside it by the last place.
    const std::vector<mesh::Point> q{{0, 0, 0},  {4, 0, 0},   {0, 4, 0},      {0, 2, 0},
                                     {-1, 2, 1}, {-1, 2, -1}, {-1e-45f, 2, 0}};
    CHECK(mesh::crossing_of(q, {0, 1, 2}, {3, 4, 5}));
    CHECK_FALSE(mesh::crossing_of(q, {0, 1, 2}, {6, 4, 5}));
}
