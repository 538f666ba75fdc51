// Pieces and handles: where a certificate says that they are the solid's they are, and where it is
// certified they are not wrong.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "mesh/shape.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>

using namespace fathom;

namespace {

ir::Scene shape_scene(const std::string &text) {
    driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    return std::move(c.scene);
}

mesh::Mended mended_of(const std::string &text, int resolution, unsigned threads = 0) {
    mesh::Settings settings;
    settings.resolution = resolution;
    settings.threads = threads;
    return make_certified_mesh(shape_scene(text), settings);
}

struct Known {
    const char *text;
    int resolution;
    std::size_t pieces;
    long genus;
};

} // namespace

TEST_CASE("pieces and handles of plain solids are proved") {
    for (const auto &[text, resolution, pieces, genus] :
         {Known{"sphere(1)", 16, 1, 0}, Known{"box(1)", 16, 1, 0},
          Known{"cylinder(0.5, 1)", 24, 1, 0}, Known{"torus(1, 0.3)", 24, 1, 1},
          Known{"box(1) - sphere(0.6)", 32, 1, 5},
          Known{"(box(1) - cylinder(0.3, 2)).rotate(0.02, axis: X)", 24, 1, 1},
          Known{"smooth_union(0.2, [sphere(1), sphere(1).translate(x: 1.2)])", 24, 1, 0},
          Known{"sphere(1).shell(0.3) | sphere(0.4)", 24, 3, 0}}) {
        INFO(text);
        const mesh::Mended mended = mended_of(text, resolution);
        CHECK(mended.certificate.certified());
        CHECK(mended.certificate.shape.proved);
        CHECK(mended.certificate.components == pieces);
        CHECK(mended.certificate.genus == genus);
    }
}

TEST_CASE("pieces of long blends are proved: of most operands nothing is near") {
    const mesh::Mended mended = mended_of(R"(
smooth_union(0.02) {
  for i in 0..100 {
    let y = 1 - (2 * i + 1) / 100
    let ring = sqrt(1 - y * y)
    sphere(0.12).translate([ring * cos(2.4 * i), y, ring * sin(2.4 * i)])
  }
})",
                                          64);
    CHECK(mended.certificate.shape.proved);
    CHECK(mended.certificate.components == 100);
}

TEST_CASE("what is certified is in the right pieces, where walls and gaps are thinner than cells") {
    for (const auto &[text, resolution, pieces, genus] :
         {Known{"torus(1, 0.02)", 48, 1, 1}, Known{"torus(1, 0.005)", 96, 1, 1},
          Known{"cone(1, 0.2)", 24, 1, 0}, Known{"sphere(1).shell(0.058)", 24, 2, 0},
          Known{"capped_cone(1, 0.8532, 0.0197)", 24, 1, 0},
          Known{"sphere(1).shell(0.0975) | sphere(0.8424).shell(0.0975)", 24, 4, 0},
          Known{"cylinder(0.79, 2) - cylinder(0.77, 3)", 32, 1, 1},
          Known{"helix(0.6, 0.514, 2.0409, 0.0451)", 24, 1, 0},
          Known{"helix(0.6, 0.3825, 2.4377, 0.08).rotate(0.6447, axis: [0.17, 0.64, 0.21])", 16, 1,
                0}}) {
        INFO(text);
        const mesh::Mended mended = mended_of(text, resolution);
        REQUIRE(mended.made.failure == mesh::Failure::None);
        CHECK(mended.certificate.near());
        const test::Survey found =
            test::survey(mended.made.mesh.vertices, mended.made.mesh.triangles);
        CHECK(found.closed());
        if (!mended.certificate.certified()) {
            CHECK(mended.certificate.shape.doubted);
            CHECK_FALSE(mended.certificate.shape.proved);
            continue;
        }
        CHECK(mended.certificate.components == pieces);
        CHECK(mended.certificate.genus == genus);
    }
}

TEST_CASE("walls with holes of which nothing is undecided are drawn wider") {
    for (const char *text : {"sphere(1).shell(0.058)", "torus(1, 0.02)"}) {
        INFO(text);
        mesh::Settings settings;
        settings.resolution = 24;
        const ir::Scene scene = shape_scene(text);
        const mesh::Mended mended = make_certified_mesh(scene, settings);
        CHECK(mended.certificate.certified());
        const mesh::Made quick = make_mesh(scene, settings);
        CHECK(quick.widened > 0);
        CHECK(mesh::form_of(quick.mesh).components == (text[0] == 's' ? 2 : 1));
    }
}

TEST_CASE("two balls that all but touch are never proved to be in the wrong number of pieces") {
    std::size_t proved = 0, certified = 0;
    for (int k = 0; k < 24; ++k) {
        const double a = 0.5 + 0.013 * k, b = 1.1 - 0.03 * k;
        const double gap = (k % 2 ? 1 : -1) * (k % 3 == 0 ? 1e-3 : k % 3 == 1 ? 5e-3 : 0.03);
        const std::string text =
            fmt::format("sphere({}) | sphere({}).translate(x: {})", a, b, a + b + gap);
        INFO(text);
        const mesh::Mended mended =
            mended_of(text, 12 + k % 7 * 4, 1 + static_cast<unsigned>(k) % 3);
        const std::size_t pieces = gap > 0 ? 2 : 1;
        if (mended.certificate.shape.proved) {
            ++proved;
            CHECK(mended.certificate.components == pieces);
            CHECK(mended.certificate.genus == 0);
        }
        if (mended.certificate.certified()) {
            ++certified;
            CHECK(mended.certificate.components == pieces);
        }
    }
    CHECK(proved >= 16);
    CHECK(certified >= proved);
}

TEST_CASE("a mesh that joins what is apart is not proved to have the solid's shape") {
    mesh::Settings settings;
    settings.resolution = 16;
    const ir::Scene scene = shape_scene("sphere(0.7305) | sphere(0.375).translate(x: 1.1065)");
    const mesh::Made made = make_plain_mesh(scene, settings);
    REQUIRE(made.failure == mesh::Failure::None);
    REQUIRE(mesh::form_of(made.mesh).components == 1);
    mesh::Progress progress;
    mesh::Certificate certificate;
    prove_shape(mesh::Field(scene, 0, {}), settings, made, progress, certificate);
    CHECK_FALSE(certificate.shape.proved);
    CHECK(certificate.shape.open > 0);
    CHECK_FALSE(certificate.shape.cells.empty());
    const mesh::Mended mended = make_certified_mesh(scene, settings);
    CHECK((mended.certificate.components == 2 || !mended.certificate.certified()));
}
