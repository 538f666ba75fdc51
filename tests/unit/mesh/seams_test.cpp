// Where parts of a solid only touch: gaps and sheets of no width are found, and nothing else is taken
// for one.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "mesh/nearest.h"
#include "mesh/seams.h"
#include "mesh/slopes.h"
#include "mesh/thin.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>
#include <random>

using namespace fathom;

namespace {

ir::Scene flush_scene(const std::string &text) {
    const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    return c.scene;
}

mesh::Settings fine_cells(int resolution) {
    mesh::Settings settings;
    settings.resolution = resolution;
    return settings;
}

std::optional<mesh::Seam> seam_in(const std::string &text, const mesh::Point &lo,
                                  const mesh::Point &hi, bool closely = true) {
    const mesh::Field field(flush_scene(text), 0, {});
    mesh::Evaluator evaluator(field);
    cpu::Boxes boxes;
    return mesh::seam_in(evaluator, *field.whole, boxes, lo, hi, 2e-7, closely);
}

} // namespace

TEST_CASE("parts that are flush leave nothing undecided, however they lie") {
    struct Case {
        const char *text;
        double volume;
        std::size_t components;
        long genus;
    };
    const double pi = 3.14159265358979;
    for (const auto &[text, volume, components, genus] : std::vector<Case>{
             {"box(2) - box([1, 1, 2])", 6, 1, 1},
             {"box(2) - box([1, 1, 1]).translate(z: 0.5)", 7, 1, 0},
             {"box([0.7, 0.9, 1.1]) - box([0.7, 0.9, 1.1]).translate(x: 0.3)", 0.297, 1, 0},
             {"box(1) | box(1).translate(x: 1, y: 0.3)", 2, 1, 0},
             {"(box(2) - box([1, 1, 2])) | box([1, 1, 2])", 8, 1, 0},
             {"((box(2) - box([1, 1, 2])) | box([1, 1, 2])).translate([0.31, 0.17, 0.05])", 8, 1,
              0},
             {"(box(2) - box(1)) | box(1)", 8, 1, 0},
             {"(box(2) - sphere(0.7)) | sphere(0.7)", 8, 1, 0},
             {"sphere(0.7) | (box(2) - sphere(0.7))", 8, 1, 0},
             {"(box(2) - sphere(0.7).translate(y: 0.4)) | (box(2) & sphere(0.7).translate(y: 0.4))",
              8, 1, 0},
             {"box([0.8, 1, 0.8]) - box([0.4, 1, 0.4]).translate(z: 0.2)", 0.48, 1, 0},
             {"((box([0.4, 1, 1]) - box([1, 1, 0.8]).translate(x: -0.4)) | (box([0.4, 1, 1]) & "
              "box([1, 1, 0.8]).translate(x: -0.4))).rotate(0.744, axis: [3, -1, 1])",
              0.4, 1, 0},
             {"cylinder(2, 0.5) - cylinder(1, 0.5)", 1.5 * pi, 1, 1},
             {"(cylinder(2, 1) - cylinder(1, 1)) | cylinder(1, 1)", 4 * pi, 1, 0},
             {"(box(2) - box([1, 1, 2])).rotate(0.3, axis: [1, 2, 3])", 6, 1, 1},
             {"(box([1, 0.3, 0.2]) | box([1, 0.3, 0.2]).translate(x: 1)).rotate(0.3, axis: [1, 2, "
              "3])",
              0.12, 1, 0},
             {"box(1).rotate(0.3, axis: Z) | box(1).rotate(0.3, axis: Z).translate([0.955336489, "
              "0.295520207, 0])",
              2, 1, 0},
             {"box(2).rotate(0.3, axis: [1, 2, 3]) - "
              "box([1, 1, 2]).rotate(0.2, axis: [1, 2, 3]).rotate(0.1, axis: [1, 2, 3])",
              6, 1, 1},
             {"box(1).rotate(0.3, axis: [1, 2, 3]) & "
              "box(2).rotate(0.2, axis: [1, 2, 3]).rotate(0.1, axis: [1, 2, 3])",
              1, 1, 0},
             {"((box(2) - box(1)) | box(1)).rotate(0.3, axis: [1, 2, 3])", 8, 1, 0},
             {"(box(2) - box(1)).rotate(0.3, axis: [1, 2, 3]) | "
              "box(1).rotate(0.2, axis: [1, 2, 3]).rotate(0.1, axis: [1, 2, 3])",
              8, 1, 0},
             {"(box([2, 1.6, 1.8]) - box([1, 0.7, 0.8])).rotate(0.7, axis: [3, -1, 1]) | "
              "box([1, 0.7, 0.8]).rotate(0.5, axis: [3, -1, 1]).rotate(0.2, axis: [3, -1, 1])",
              5.76, 1, 0},
             {"box_frame(1, thickness: 0.16).repeat([1, 1, 1], count: [2, 2, 2])", 1.933312, 1, 28},
             {"box_frame(1, thickness: 0.16).repeat([1, 1, 1], count: [2, 2, 2]).rotate(0.3, "
              "axis: [1, 2, 3])",
              1.933312, 1, 28},
             {"((box([1, 0.5, 1]) - cylinder(0.3, 0.5)) | cylinder(0.3, 0.5)).scale(0.5)"
              ".repeat([0.75, 0.625, 1], count: [2, 2, 1])",
              0.25, 4, 0},
         }) {
        INFO(text);
        const mesh::Mended made = mesh::make_certified_mesh(flush_scene(text), fine_cells(30));
        REQUIRE(made.made.failure == mesh::Failure::None);
        CHECK(made.certificate.undecided.empty());
        CHECK(made.certificate.certified());
        CHECK(made.certificate.seam_width < 1e-5);
        CHECK(made.certificate.components == components);
        CHECK(made.certificate.genus == genus);
        CHECK(made.certificate.mesh_volume == Approx(volume).epsilon(0.01));
        CHECK((made.certificate.least_volume <= volume * (1 + 1e-6) &&
               volume * (1 - 1e-6) <= made.certificate.largest_volume));
        const test::Survey found = test::survey(made.made.mesh.vertices, made.made.mesh.triangles);
        CHECK(found.closed());
        CHECK(test::crossings(made.made.mesh.vertices, made.made.mesh.triangles) == 0);
    }
}

TEST_CASE("what only touches in faces makes no mesh, and says why") {
    CHECK(mesh::make_mesh(flush_scene("box(1) & box(1).translate(x: 1)"), fine_cells(30)).failure ==
          mesh::Failure::Flat);
}

TEST_CASE("gaps and sheets of no width are told from those of some") {
    const mesh::Point lo{0.4f, -0.1f, -0.07f}, hi{0.65f, 0.13f, 0.11f};
    const auto gap = seam_in("box(1) | box(1).translate(x: 1)", lo, hi);
    REQUIRE(gap);
    CHECK((gap->solid && gap->width < 1e-6));
    const auto sheet = seam_in("box(1) - box([2, 2, 2]).translate(x: -0.5)", lo, hi);
    REQUIRE(sheet);
    CHECK((!sheet->solid && sheet->width > 0 && sheet->width < 1e-6));
    for (const char *text :
         {"box(1) | box(1).translate(x: 1.0001)", "box(1) | box(1).translate(x: 1.000005)",
          "box(1) - box([2, 2, 2]).translate(x: -0.5001)",
          "box([1.00001, 1, 1]) - box([2, 2, 2]).translate(x: -0.5)", "box(1)",
          "(box(1) | box(1).translate(x: 1.0001)).rotate(0.02, axis: [1, 2, 3])",
          "(cylinder(2, 1) - cylinder(0.5, 1)) | cylinder(0.4999, 1)"}) {
        INFO(text);
        CHECK_FALSE(seam_in(text, lo, hi));
    }
}

TEST_CASE("planes that meet in an edge or a corner are found") {
    const char *edge = "(box(2) - box([1, 1, 2])) | box([1, 1, 2])";
    const mesh::Point lo{0.45f, 0.4f, 0.1f}, hi{0.57f, 0.56f, 0.3f};
    const auto seam = seam_in(edge, lo, hi);
    REQUIRE(seam);
    CHECK((seam->solid && seam->width < 3e-6));
    const auto corner =
        seam_in("(box(2) - box(1)) | box(1)", {0.45f, 0.4f, 0.45f}, {0.57f, 0.56f, 0.6f});
    REQUIRE(corner);
    CHECK((corner->solid && corner->width < 3e-6));
    CHECK_FALSE(
        seam_in("(box(2) - box(1)) | box(0.999)", {0.45f, 0.4f, 0.45f}, {0.57f, 0.56f, 0.6f}));
}

TEST_CASE("planes that cross in an edge or a corner are found") {
    const mesh::Point lo{-0.05f, -0.04f, 0.1f}, hi{0.07f, 0.06f, 0.2f};
    for (const char *text :
         {"box(1).repeat([1, 1, 1], count: [2, 2, 2])",
          "box_frame(1, thickness: 0.25).repeat([1, 1, 1], count: [2, 2, 2])",
          // One plane ends at another.
          "box([2, 1, 2]).translate(y: -0.5) | box(1).translate([0.5, 0.5, 0]) | "
          "box(1).translate([-0.5, 0.5, 0])"}) {
        INFO(text);
        const auto seam = seam_in(text, lo, hi);
        REQUIRE(seam);
        CHECK((seam->solid && seam->width < 6e-6));
    }
    for (const char *turn : {"", ".rotate(0.3, axis: [1, 2, 3])"}) {
        INFO(turn);
        const std::string cubes = "box(1).repeat([1, 1, 1], count: [2, 2, 2])";
        const auto corner = seam_in(cubes + turn, {-0.05f, -0.04f, -0.03f}, {0.07f, 0.06f, 0.05f});
        REQUIRE(corner);
        CHECK((corner->solid && corner->width < 6e-6));
        // A gap that is wide enough, and a hole along the edge, are none.
        CHECK_FALSE(seam_in("box(1).repeat([1, 1.00005, 1], count: [2, 2, 2])" + std::string(turn),
                            {-0.05f, -0.04f, -0.03f}, {0.07f, 0.06f, 0.05f}));
        CHECK_FALSE(seam_in("(" + cubes + " - box([0.001, 0.001, 3]))" + turn,
                            {-0.05f, -0.04f, -0.03f}, {0.07f, 0.06f, 0.05f}));
    }
}

TEST_CASE("past a tool that ends a hair beyond a face nothing is in doubt") {
    for (const char *text : {"cylinder(20, 10) - cylinder(18, 10.02)",
                             "capped_cone(6, 40, 40) - capped_cone(4.4, 38.4, 40.02)",
                             "(box(20) - cylinder(5, 20.01)).rotate(0.4, axis: [2, 1, 0])"}) {
        INFO(text);
        const mesh::Made plain = mesh::make_mesh(flush_scene(text), fine_cells(32));
        CHECK(plain.octree.undecided.empty());
        const mesh::Mended made = mesh::make_certified_mesh(flush_scene(text), fine_cells(32));
        CHECK(made.certificate.certified());
        CHECK(made.certificate.components == 1);
        CHECK(made.certificate.divisions < 10'000);
    }
}

TEST_CASE("parts that are flush are found where an angle has its cut") {
    // A herringbone gear: a tooth lies across the cut of the angle, turned on both sides of z = 0.
    const auto gear = [](const char *apart) {
        return fmt::format("let h = (circle(0.54) | rectangle([0.2, 0.14]).translate(x: 0.58)"
                           ".repeat_polar(12)).rotate(15deg).extrude(0.2, twist: 30deg)"
                           ".translate(z: {})\nh | h.reflect(Z)",
                           apart);
    };
    const mesh::Point lo{-0.6f, -0.004f, -0.005f}, hi{-0.59f, 0.006f, 0.005f},
        beside{-0.6f, -0.004f, -0.015f}, beside_hi{-0.59f, 0.006f, -0.005f};
    const auto seam = seam_in(gear("0.1"), lo, hi);
    REQUIRE(seam);
    CHECK((seam->solid && seam->width < 4e-6));
    const auto within = seam_in(gear("0.1"), beside, beside_hi); // all is solid there
    CHECK((!within || within->solid));
    for (const char *apart : {"0.1001", "0.10001", "0.100003"}) {
        INFO(apart);
        CHECK_FALSE(seam_in(gear(apart), lo, hi));
    }
    const mesh::Mended made = mesh::make_certified_mesh(flush_scene(gear("0.1")), fine_cells(48));
    CHECK(made.certificate.certified());
    CHECK(made.certificate.components == 1);
}

TEST_CASE("planes along the axes are guessed where they are, and take little work then") {
    const mesh::Field field(
        flush_scene("(box_frame(1, thickness: 0.16) | sphere(0.2).translate([0.42, 0.42, 0.42]))"
                    ".repeat([1, 1, 1], count: [4, 4, 4])"),
        0, {});
    mesh::Evaluator evaluator(field);
    cpu::Boxes boxes;
    constexpr double thin = 4e-7;
    constexpr std::size_t little = 20; // runs of the tape
    for (const mesh::Point &lo :
         {mesh::Point{1.0796f, 0.9991f, 0.9991f}, // two planes, and the ball
          mesh::Point{0.96f, -0.06f, 0.3f},       // … along another axis
          mesh::Point{0.97f, -0.03f, 0.96f}}) {   // three
        mesh::Extent box{lo, lo};
        for (float &x : box.hi) x += 0.0937f;
        if (lo[0] > 1) box.hi = {lo[0] + 0.005f, lo[1] + 0.005f, lo[2] + 0.005f};
        const auto sighting = mesh::look_for_seams(evaluator, *field.whole, {&box, 1}, thin)[0];
        CHECK(sighting.seen == mesh::Seen::MaySolid);
        const auto [seam, runs] =
            mesh::search_seam(evaluator, *field.whole, boxes, box, sighting, thin, true);
        CHECK((seam && seam->width < 1e-5));
        CHECK(runs <= little);
    }
}

TEST_CASE("numbers on the way change at least as fast as is said") {
    std::size_t seen = 0;
    for (const char *text : {"box(1).rotate(0.3, axis: [1, 2, 3]) | cylinder(0.3, 2)",
                             "torus(1, 0.3).translate(x: 0.2) | sphere(0.4)",
                             "cone(0.5, 1).scale(0.7) - box(0.3).rotate(45deg, axis: Y)",
                             "cylinder(0.1, 0.3).repeat([0.4, 0.5, 1], count: [3, 2, 1])",
                             "box([0.4, 1, 0.3]).translate(x: 0.3).twist(1.5) | "
                             "rectangle([1, 0.6]).extrude(2, twist: 200deg)"}) {
        INFO(text);
        const mesh::Field field(flush_scene(text), 0, {});
        mesh::Evaluator evaluator(field);
        cpu::Boxes boxes;
        std::mt19937 dice(7);
        std::uniform_real_distribution<float> place(-0.8f, 0.8f), share(0, 1);
        for (int n = 0; n < 40; ++n) {
            mesh::Point lo{}, hi{};
            for (std::size_t i = 0; i < 3; ++i) lo[i] = place(dice), hi[i] = lo[i] + 0.1f;
            for (const mesh::Level &level :
                 mesh::levels_in(evaluator, *field.whole, boxes, lo, hi)) {
                // By boxes that are points, in pairs along the axes.
                boxes.count = 16;
                for (std::size_t k = 0; k < 16; ++k)
                    for (std::size_t i = 0; i < 3; ++i) {
                        const float at = lo[i] + 0.09f * share(dice);
                        boxes.lo[i][k] = boxes.hi[i][k] = at;
                    }
                bool some = false;
                for (std::size_t axis = 0; axis < 3; ++axis) {
                    std::array<float, 16> before{};
                    bool all = true;
                    for (const float step : {0.0f, 0.01f}) {
                        cpu::Boxes moved = boxes;
                        for (std::size_t k = 0; k < 16; ++k)
                            moved.lo[axis][k] = moved.hi[axis][k] = boxes.lo[axis][k] + step;
                        const std::vector<mesh::Held> held{{level.where, {}}};
                        cpu::Selection steps = field.whole->selection(field.parts);
                        steps.steps = steps.steps.subspan(0, level.where.step + 1);
                        cpu::enter_boxes(field.parts, evaluator.ranges, moved);
                        cpu::run_steps(field.parts, evaluator.ranges, steps);
                        for (std::size_t k = 0; k < 16; ++k) {
                            const float value = evaluator.ranges.lo[level.where.address + k];
                            if (step == 0)
                                before[k] = value;
                            else
                                all = all && std::fabs(value - before[k]) >=
                                                 level.slope * 0.0099 - 2 * level.error - 1e-5;
                            CHECK((value >= level.lo - 1e-5f && value <= level.hi + 1e-5f));
                        }
                    }
                    some = some || all;
                }
                CHECK(some);
                ++seen;
            }
        }
    }
    CHECK(seen > 100);
}

TEST_CASE("how thin a wall is is measured, and what touches is seen") {
    for (const double thickness : {0.05, 0.004, 0.0003}) {
        const mesh::Field field(
            flush_scene("sphere(1) - sphere(" + std::to_string(1 - thickness) + ")"), 0, {});
        mesh::Evaluator evaluator(field);
        const auto lattice = mesh::make_lattice({{-1, -1, -1}, {1, 1, 1}}, 0.1, 3);
        REQUIRE(lattice);
        const mesh::Thin thin = thin_at(evaluator, *lattice, 0.1, {0.58f, 0.55f, 0.59f});
        CHECK_FALSE(thin.touches);
        CHECK(thin.thickness == Approx(thickness).epsilon(0.15));
    }
    const mesh::Field field(flush_scene("box(1) | box(1).translate(x: 1)"), 0, {});
    mesh::Evaluator evaluator(field);
    const auto lattice = mesh::make_lattice({{-1, -1, -1}, {2, 1, 1}}, 0.1, 3);
    CHECK(thin_at(evaluator, *lattice, 0.1, {0.47f, 0.1f, 0.1f}).touches);
    CHECK_FALSE(thin_at(evaluator, *lattice, 0.1, {0.1f, 0.1f, 0.1f}).touches);
}

TEST_CASE(
    "walls and gaps thinner than all cells are listed, in a mesh that is no larger for them") {
    const auto size_at = [](const char *text, int resolution) {
        return mesh::make_mesh(flush_scene(text), fine_cells(resolution)).mesh.triangles.size();
    };
    struct Case {
        const char *text;
        double thickness, size; // of the solid
    };
    std::size_t thin = 0;
    for (const auto &[text, thickness, size] : std::vector<Case>{
             {"sphere(2) - sphere(1.98)", 0.02, 4},
             {"sphere(2) - sphere(1.99)", 0.01, 4},
             {"sphere(2) - sphere(1.95)", 0.05, 4},
             {"(sphere(2) - sphere(1.98)) | box(1).translate(x: 3)", 0.02, 5.5},
             {"(box(2) - sphere(0.7)) | sphere(0.69)", 0.01, 2},
             {"torus(1, 0.3) - torus(1, 0.29)", 0.01, 2.6},
             {"(cylinder(1, 2) - cylinder(0.99, 2)).rotate(0.5, axis: [1, 2, 0])", 0.01, 2.5}})
        for (const int resolution : {8, 16, 24}) {
            if (thickness > size / resolution / 8) continue; // the finest cells may show it
            ++thin;
            INFO(text << " at " << resolution);
            const mesh::Made made = mesh::make_mesh(flush_scene(text), fine_cells(resolution));
            if (made.failure == mesh::Failure::Unseen) continue; // which is said
            REQUIRE(made.failure == mesh::Failure::None);
            CHECK(made.mesh.triangles.size() < 8 * size_at("sphere(2)", resolution) + 10'000);
            CHECK(test::survey(made.mesh.vertices, made.mesh.triangles).closed());
            CHECK(test::crossings(made.mesh.vertices, made.mesh.triangles) == 0);
        }
    CHECK(thin > 10);
    const mesh::Made shell =
        mesh::make_plain_mesh(flush_scene("sphere(2) - sphere(1.98)"), fine_cells(16));
    CHECK(shell.octree.undecided.size() > 400);
    // One that the finest cells show is drawn, and whole.
    const mesh::Made shown = mesh::make_mesh(flush_scene("box([4, 4, 0.06])"), fine_cells(16));
    CHECK(shown.octree.undecided.empty());
    CHECK(mesh::form_of(shown.mesh).components == 1);
}

TEST_CASE("what is certified beside thin gaps is as near to them as it says") {
    // Filled, but for a gap, which is surface where it is wider than rounding.
    std::size_t certified = 0;
    for (const double gap : {0.03, 0.0001}) {
        const std::string b = std::to_string(1 - gap), r = std::to_string(0.7 - gap);
        struct Case {
            std::string text;
            bool ball;
        };
        for (const auto &[text, ball] :
             std::vector<Case>{{"(box(2) - box([1, 1, 2])) | box([" + b + ", 1, 2])", false},
                               {"(box(2) - box(1)) | box(" + b + ")", false},
                               {"(box(2) - sphere(0.7)) | sphere(" + r + ")", true}}) {
            INFO(text);
            const mesh::Mended made = mesh::make_certified_mesh(flush_scene(text), fine_cells(12));
            REQUIRE(made.made.failure == mesh::Failure::None);
            if (!made.certificate.certified()) continue;
            ++certified;
            const mesh::TriangleTree tree(made.made.mesh);
            for (int k = 0; k < 196; ++k) { // on the wall of the gap
                const double u = (k % 14 - 6.5) / 14, v = (k / 14 - 6.5) / 14;
                std::array<double, 3> at{0.5, u, v};
                const double length = std::hypot(0.5, u, v);
                for (double &x : at) x *= ball ? 0.7 / length : 1;
                const auto near = tree.nearest(at, 10);
                REQUIRE(near);
                CHECK(near->distance <= made.certificate.surface_to_mesh * (1 + 1e-5) + 1e-5);
            }
        }
    }
    CHECK(certified > 0);
}
