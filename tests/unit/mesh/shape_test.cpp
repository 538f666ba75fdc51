// Pieces and handles: where a certificate says that they are the solid's they are, and where it is
// certified they are not wrong.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "mesh/shape.h"
#include "mesh/slopes.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>

#include <cmath>

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

TEST_CASE("pieces and handles of what bounds cut off are proved, and its area is enclosed") {
    struct Cut {
        Known known;
        ir::Box bounds;
        double area; // 0: not known
    };
    constexpr double pi = 3.14159265358979;
    for (const auto &[known, bounds, area] :
         {Cut{{"sphere(1)", 24, 1, 0}, {{-2, -0.5, -2}, {2, 2, 2}}, 3 * pi + 0.75 * pi},
          Cut{{"torus(1, 0.3)", 32, 1, 0}, {{0.01, -2, -2}, {2, 2, 2}}, 0},
          Cut{{"torus(1, 0.3)", 32, 2, 0}, {{-0.5, -2, -2}, {0.5, 2, 2}}, 0},
          Cut{{"torus(1, 0.3)", 32, 1, 1}, {{-2, -0.1, -2}, {2, 0.1, 2}}, 0},
          Cut{{"plane(Y, 0) | cylinder(0.3, 3)", 32, 1, 0}, {{-1, -0.6, -1}, {1, 0.9, 1}}, 0},
          Cut{{"plane(X, 0.03)", 16, 1, 0}, {{-1, -1, -1}, {1, 1, 1}}, 8 + 4 * 2 * 1.03},
          // all of it is filled
          Cut{{"plane(Y, 9)", 16, 1, 0}, {{-1, -1, -1}, {1, 1, 1}}, 24}}) {
        INFO(known.text);
        mesh::Settings settings;
        settings.resolution = known.resolution;
        settings.bounds = bounds;
        const ir::Scene scene = shape_scene(known.text);
        mesh::Mended mended = make_certified_mesh(scene, settings);
        CHECK(mended.certificate.certified());
        CHECK(mended.certificate.shape.proved);
        CHECK(mended.certificate.components == known.pieces);
        CHECK(mended.certificate.genus == known.genus);
        mesh::Progress progress;
        enclose_measures(scene, settings, mended.made, progress, mended.certificate);
        const mesh::Enclosure found = mended.certificate.area;
        CHECK(found.lo <= mended.certificate.mesh_area);
        CHECK(found.hi < 2 * mended.certificate.mesh_area);
        if (area > 0) {
            CHECK(found.lo <= area);
            CHECK(found.hi >= area);
        }
    }
}

TEST_CASE(
    "a way that the field rises along is none where bounds that it falls beyond come nearer") {
    const ir::Scene scene = shape_scene("sphere(1)");
    const mesh::Field field(scene, 0, ir::Box{{-2, -2, -2}, {0.5, 2, 2}});
    mesh::Evaluator evaluator(field);
    cpu::Boxes boxes;
    const auto rise = [&](const mesh::Point &lo, const mesh::Point &hi,
                          const std::array<double, 3> &along) {
        const auto found = rising_over(evaluator, *field.whole, boxes, lo, hi, along);
        REQUIRE(found);
        return found->least;
    };
    // Next to the cut, by a side where only the ball is, only the cut, and at their edge.
    CHECK(rise({0.1f, 0.9f, -0.1f}, {0.2f, 1.0f, 0.1f}, {0, 1, 0}) > 0.8);
    CHECK(rise({0.49f, -0.1f, -0.1f}, {0.51f, 0.1f, 0.1f}, {1, 0, 0}) > 0.99);
    CHECK(rise({0.49f, 0.84f, -0.05f}, {0.51f, 0.88f, 0.05f}, {0, 1, 0}) < 1e-9);
    CHECK(rise({0.49f, 0.84f, -0.05f}, {0.51f, 0.88f, 0.05f}, {0.7, 0.7, 0}) > 0.5);
    CHECK(rise({0.49f, 0.84f, -0.05f}, {0.51f, 0.88f, 0.05f}, {-0.3, 0.9, 0}) < -0.29);
}

TEST_CASE("where the shape is proved the same directions enclose area and volume") {
    constexpr double pi = 3.14159265358979;
    struct Measured {
        const char *text;
        int resolution;
        double area, volume;
    };
    for (const auto &[text, resolution, area, volume] :
         {Measured{"sphere(1)", 16, 4 * pi, 4 * pi / 3},
          Measured{"sphere(1)", 61, 4 * pi, 4 * pi / 3}, Measured{"box([1, 2, 0.5])", 24, 7, 1},
          Measured{"box([1, 2, 0.5]).rotate(0.4, axis: [1, 2, 3])", 33, 7, 1},
          Measured{"torus(1, 0.3)", 40, 4 * pi * pi * 0.3, 2 * pi * pi * 0.09},
          Measured{"cylinder(0.5, 1)", 48, 1.5 * pi, 0.25 * pi},
          Measured{"box(1) - cylinder(0.25, 2)", 48, 6 - pi / 8 + pi / 2, 1 - pi / 16},
          Measured{"sphere(1).shell(0.2) | sphere(0.3)", 48, 4 * pi * (1.21 + 0.81 + 0.09),
                   4 * pi / 3 * (1.331 - 0.729 + 0.027)}}) {
        INFO(text);
        const mesh::Certificate certificate = mended_of(text, resolution).certificate;
        REQUIRE(certificate.shape.proved);
        CHECK(certificate.shape.area.lo <= area);
        CHECK(certificate.shape.area.hi >= area);
        CHECK(certificate.shape.volume.lo <= volume);
        CHECK(certificate.shape.volume.hi >= volume);
        CHECK(certificate.shape.volume.lo > certificate.least_volume);
        CHECK(certificate.shape.volume.hi < certificate.largest_volume);
    }
}

TEST_CASE("blocks that take little leave others more to be looked at") {
    // All that takes work lies along its edges and its hole.
    const std::string text = "box([1, 0.7, 0.5]).rotate(0.5, axis: [1, 2, 3]) - cylinder(0.2, 2)";
    const mesh::Mended mended = mended_of(text, 128);
    CHECK(mended.certificate.shape.proved);
    CHECK(mended.certificate.genus == 1);
    CHECK(mended.certificate.shape.area.hi < 8 * mended.certificate.mesh_area);
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

TEST_CASE("a shape that is not proved says why") {
    using Why = mesh::Unknown::Why;
    const auto why_of = [](const std::string &text, int resolution) {
        const mesh::Mended mended = mended_of(text, resolution);
        REQUIRE(mended.made.failure == mesh::Failure::None);
        CHECK_FALSE(mended.certificate.shape.proved);
        CHECK(mended.certificate.shape.open > 0);
        return mended.certificate.shape;
    };
    const auto step_of = [&](const std::string &text) {
        const mesh::ShapeAnswer shape = why_of(text, 24);
        REQUIRE(shape.why);
        CHECK(shape.unknown > 0);
        CHECK(shape.why->why == Why::Step);
        return shape.why->missing;
    };
    using cpu::Kernel;
    using cpu::StepKind;
    CHECK(step_of("cone(0.6, 1)") == mesh::Missing{StepKind::Run, Kernel::SqrtF});
    CHECK(step_of("sphere(1).displace(p => 0.02 * noise(4 * p))") ==
          mesh::Missing{StepKind::Run, Kernel::Perlin});
    // Of what it was looked at in vain the cells are too large.
    const mesh::ShapeAnswer coarse =
        why_of("sphere(0.7305) | sphere(0.375).translate(x: 1.1055)", 16);
    CHECK_FALSE(coarse.why);
    CHECK(coarse.unknown == 0);
    CHECK(coarse.unseen < coarse.open);
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

// Across the edge of a wall that a ball cuts off the gradients all but go against each other, and are
// not equally long: the way between them is found by looking at them.
TEST_CASE("pieces and handles of a bent wall with sharp edges are proved") {
    const ir::Scene scene =
        shape_scene("implicit(p => abs(dot(sin(p / 0.35), cos(p.zxy / 0.35))) * 0.35 - 0.05, "
                    "within: ball(0.8)) & sphere(0.7)");
    mesh::Settings settings;
    settings.resolution = 48;
    const mesh::Mended mended = make_certified_mesh(scene, settings);
    CHECK(mended.certificate.certified());
    CHECK(mended.certificate.shape.proved);
    CHECK(mended.certificate.components == 1);
    CHECK(mended.certificate.genus == 0);
}

TEST_CASE("what is proved of a shape before some cells are divided is what is proved after that") {
    const ir::Scene scene = shape_scene("sphere(1) | sphere(1).translate(x: 2.003)");
    mesh::Settings settings;
    settings.resolution = 40;
    const mesh::Mended mended = make_certified_mesh(scene, settings);
    REQUIRE(mended.rounds > 0);
    REQUIRE(mended.certificate.shape.proved);
    mesh::Certificate again = mended.certificate;
    mesh::Progress progress;
    prove_shape(mesh::Field(scene, 0, {}), settings, mended.made, progress, again);
    CHECK(again.shape.proved);
    CHECK(again.shape.proved_tasks.size() == mended.certificate.shape.proved_tasks.size());
    const auto near = [](double x, double y) { return std::fabs(x - y) <= 0.01 * std::fabs(y); };
    CHECK(near(again.shape.area.hi, mended.certificate.shape.area.hi));
    CHECK(near(again.shape.volume.lo, mended.certificate.shape.volume.lo));
}
