// Which paint each triangle of a mesh has, and what colour at each corner.
#include "mesh/appearance.h"

#include "driver/compile.h"
#include "mesh/mesh.h"

#include <catch2/catch.hpp>

#include <cmath>

using namespace fathom;

namespace {

driver::Compilation compiled(const std::string &text) {
    driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    INFO(text);
    REQUIRE(c.good());
    return c;
}

} // namespace

TEST_CASE("each triangle has one paint, whose colour its corners have, also where others meet it") {
    const driver::Compilation c =
        compiled("let red = material(diffuse: #f00, name: \"rust\", exponent: 8)\n"
                 "box([2, 1, 2]).paint(red)\n"
                 "cylinder(0.5, 2).paint(#00f)\n"
                 "sphere(0.5).translate(x: 4).paint(p => [saturate(p.x - 3.5), 0, 1])\n");
    mesh::Settings settings;
    settings.resolution = 60;
    const mesh::Made made = mesh::make_mesh(c.scene, settings);
    REQUIRE(made.failure == mesh::Failure::None);
    const mesh::Mesh &mesh = made.mesh;
    const mesh::Appearance found = mesh::appearance_of(c.scene, 0, mesh, made.octree.lattice.unit);
    REQUIRE(found.materials.size() == 3);
    CHECK(found.materials[0].name == "rust");
    CHECK(found.materials[0].exponent == 8);
    CHECK(found.materials[1].name == "0000ff");
    CHECK(found.materials[2].name == "paint");
    CHECK(found.materials[2].colored);
    CHECK_FALSE((found.materials[0].colored || found.materials[1].colored));
    CHECK_FALSE((found.materials[0].varies || found.materials[2].varies));
    REQUIRE(found.material_of.size() == mesh.triangles.size());
    REQUIRE(found.corners.size() == mesh.triangles.size());
    std::array<std::size_t, 3> counts{};
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        ++counts[found.material_of[t]];
        const mesh::Point &p = mesh.vertices[mesh.triangles[t][0]];
        if (found.material_of[t] == 2)
            CHECK(p[0] > 3);
        else // one colour for all three corners
            CHECK(found.corners[t] ==
                  std::array{found.corners[t][0], found.corners[t][0], found.corners[t][0]});
        const mesh::Point middle = [&] {
            mesh::Point m{};
            for (const std::uint32_t v : mesh.triangles[t])
                for (std::size_t i = 0; i < 3; ++i) m[i] += mesh.vertices[v][i] / 3;
            return m;
        }();
        if (middle[0] < 3 && std::abs(middle[1]) > 0.51f) CHECK(found.material_of[t] == 1);
        if (std::hypot(middle[0], middle[2]) > 0.53f && middle[0] < 3)
            CHECK(found.material_of[t] == 0);
    }
    for (const std::size_t count : counts) CHECK(count > 100);
}

TEST_CASE("a highlight that differs from place to place is a mean, and said to be") {
    const driver::Compilation c = compiled("sphere(1).paint(material(diffuse: white, exponent: p "
                                           "=> if p.y > 0 { 10 } else { 30 }))\n");
    mesh::Settings settings;
    settings.resolution = 12;
    const mesh::Made made = mesh::make_mesh(c.scene, settings);
    const mesh::Appearance found =
        mesh::appearance_of(c.scene, 0, made.mesh, made.octree.lattice.unit);
    REQUIRE(found.materials.size() == 1);
    CHECK(found.materials[0].varies);
    CHECK_FALSE(found.materials[0].colored);
    CHECK(found.materials[0].exponent == Approx(20).margin(3));
}
