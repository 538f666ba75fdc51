// Measures: what is known of solids lies in the enclosures, and clearances are those of geometry.
#include "driver/compile.h"
#include "mesh/certify.h"
#include "mesh/clearance.h"
#include "mesh/measure_flat.h"
#include "mesh/slopes.h"
#include "tests/support/effort.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>
#include <numbers>
#include <random>

using namespace fathom;

namespace {

ir::Scene scene_of(const std::string &text) {
    driver::Compilation c = driver::compile_text("measure.sdf", text, "", {});
    INFO(text);
    REQUIRE(c.good());
    return std::move(c.scene);
}

mesh::Measures measured(const std::string &text, const mesh::Settings &settings) {
    const ir::Scene scene = scene_of(text);
    const mesh::Made made = mesh::make_mesh(scene, settings);
    REQUIRE(made.failure == mesh::Failure::None);
    mesh::Progress progress;
    return mesh::measure(scene, settings, made, progress, {6e7});
}

mesh::Settings as_fine_as(int resolution) {
    mesh::Settings settings;
    settings.resolution = resolution;
    return settings;
}

mesh::FlatMeasures measured_flat(const std::string &text, int resolution) {
    driver::CompileOptions options;
    options.flat_thickness = 4;
    driver::Compilation c = driver::compile_text("drawing.sdf", text, "", options);
    INFO(text);
    REQUIRE(c.good());
    const mesh::Settings settings = as_fine_as(resolution);
    ir::Box box;
    REQUIRE(mesh::box_of(c.scene, settings, box) == mesh::Failure::None);
    mesh::Progress progress;
    return mesh::measure_flat(mesh::Cut(c.scene, settings, box), 1, 2, progress, {6e7});
}

bool holds(const mesh::Enclosure &e, double value) { return e.lo <= value && value <= e.hi; }

} // namespace

TEST_CASE("volume, centre and box of solids that are known") {
    struct Known {
        const char *text;
        double volume;
        std::array<double, 3> center, lo, hi;
    };
    const double pi = std::numbers::pi;
    const Known known[] = {
        {"sphere(1)", 4 * pi / 3, {0, 0, 0}, {-1, -1, -1}, {1, 1, 1}},
        {"box([1, 2, 3]).translate([5, -7, 11])", 6, {5, -7, 11}, {4.5, -8, 9.5}, {5.5, -6, 12.5}},
        {"torus(1, 0.25)",
         2 * pi * pi * 0.0625,
         {0, 0, 0},
         {-1.25, -0.25, -1.25},
         {1.25, 0.25, 1.25}},
        // Two boxes of unequal weight.
        {"box(1) | box([1, 1, 2]).translate(x: 3)", 3, {2, 0, 0}, {-0.5, -0.5, -1}, {3.5, 0.5, 1}},
        // Far from the origin, where floats are coarse.
        {"sphere(1).translate(x: 1000)", 4 * pi / 3, {1000, 0, 0}, {999, -1, -1}, {1001, 1, 1}},
        // Tiny and huge.
        {"sphere(1e-4)", 4e-12 * pi / 3, {0, 0, 0}, {-1e-4, -1e-4, -1e-4}, {1e-4, 1e-4, 1e-4}},
        {"sphere(1e4)", 4e12 * pi / 3, {0, 0, 0}, {-1e4, -1e4, -1e4}, {1e4, 1e4, 1e4}},
        // Of a bound that is loose.
        {"sphere(1).scale([1, 3, 1])", 4 * pi, {0, 0, 0}, {-1, -3, -1}, {1, 3, 1}},
    };
    for (const Known &k : known) {
        INFO(k.text);
        const mesh::Measures of = measured(k.text, as_fine_as(20));
        const double size = std::cbrt(k.volume), rounding = 1e-6 * (size + std::fabs(k.hi[0]));
        CHECK(holds(of.volume, k.volume));
        CHECK(of.volume.hi - of.volume.lo < 0.06 * k.volume);
        for (std::size_t i = 0; i < 3; ++i) {
            CHECK(holds(of.center[i], k.center[i]));
            CHECK(of.center[i].hi - of.center[i].lo < 0.1 * size);
            // The box is that of the floats' field.
            CHECK(of.least[i].lo <= k.lo[i] + rounding);
            CHECK(of.least[i].hi >= k.lo[i] - rounding);
            CHECK(of.greatest[i].lo <= k.hi[i] + rounding);
            CHECK(of.greatest[i].hi >= k.hi[i] - rounding);
            CHECK(of.least[i].hi - of.least[i].lo < 0.05 * size);
        }
    }
}

TEST_CASE("a solid that is thinner than all cells is enclosed, too") {
    const mesh::Measures of =
        measured("box([2, 2, 0.003]) | sphere(0.5).translate(x: 3)", as_fine_as(12));
    CHECK(holds(of.volume, 0.012 + std::numbers::pi / 6));
    CHECK(holds(of.least[0], -1));
}

TEST_CASE("a solid that bounds cut off is measured up to them") {
    mesh::Settings settings = as_fine_as(16);
    settings.bounds = ir::Box{{-1, -1, -1}, {1, 2, 1}};
    const mesh::Measures of = measured("plane(Y, 0)", settings);
    CHECK(holds(of.volume, 4));
    CHECK(holds(of.greatest[1], 0));
    CHECK(holds(of.least[1], -1));
}

TEST_CASE("the same measures for any number of threads") {
    std::optional<mesh::Measures> first;
    for (const unsigned threads : {1u, 5u}) {
        mesh::Settings settings = as_fine_as(20);
        settings.threads = threads;
        const mesh::Measures of = measured("sphere(1) - box(0.9).rotate(0.3, axis: X)", settings);
        if (!first) first = of;
        CHECK(of.volume.lo == first->volume.lo);
        CHECK(of.center[1].hi == first->center[1].hi);
    }
}

TEST_CASE("clearances of solids that are known") {
    struct Known {
        const char *a, *b;
        double distance;
    };
    const Known known[] = {
        {"sphere(1)", "sphere(1).translate(x: 3)", 1},
        {"sphere(1)", "sphere(1).translate([2, 2, 1])", 1},
        {"box(1)", "box(1).translate(x: 1.25)", 0.25},             // faces
        {"box(1)", "box(1).translate([2, 2, 0])", std::sqrt(2.0)}, // edges
        {"box(1)", "sphere(0.5).translate([1.5, 1.5, 1.5])", std::sqrt(3.0) - 0.5},
        {"sphere(3).shell(0.5)", "sphere(1)", 1.75}, // one in the other
        {"sphere(1).scale([1, 4, 1])", "sphere(1).translate(x: 2.5)", 0.5},
        {"plane(Y, -2)", "sphere(1)", 1}, // without an end
    };
    for (const Known &k : known) {
        INFO(k.a << " and " << k.b);
        for (const bool turned : {false, true}) {
            mesh::Progress progress;
            const mesh::Clearance found = mesh::clearance(
                scene_of(turned ? k.b : k.a), scene_of(turned ? k.a : k.b), 0, 0.02, progress);
            REQUIRE(found.failure == mesh::Failure::None);
            CHECK(holds(found.distance, k.distance));
            CHECK(found.distance.hi - found.distance.lo < 0.05);
            double apart = 0;
            for (std::size_t i = 0; i < 3; ++i)
                apart += std::pow(double(found.near[0][i]) - found.near[1][i], 2);
            CHECK(std::sqrt(apart) == Approx(found.distance.hi));
        }
    }
}

TEST_CASE("solids with common points have no clearance, and touching ones next to none") {
    mesh::Progress progress;
    for (const char *other : {"sphere(1).translate(x: 1)", "sphere(0.1)", "box(0.2)"}) {
        const mesh::Clearance found =
            mesh::clearance(scene_of("sphere(1)"), scene_of(other), 0, 0.01, progress);
        CHECK((found.distance.lo == 0 && found.distance.hi == 0));
    }
    const mesh::Clearance touching =
        mesh::clearance(scene_of("box(1)"), scene_of("box(1).translate(x: 1)"), 0, 0.02, progress);
    CHECK((touching.distance.lo == 0 && touching.distance.hi < 0.03));
    CHECK(mesh::clearance(scene_of("plane(Y, 0)"), scene_of("plane(-Y, 5)"), 0, 0.1, progress)
              .failure == mesh::Failure::Endless);
    CHECK(mesh::clearance(scene_of("sphere(1)"), scene_of("sphere(1) & sphere(1).translate(x: 5)"),
                          0, 0.1, progress)
              .failure == mesh::Failure::Empty);
}

TEST_CASE("the field lies about the plane that is said, wherever it is sampled") {
    constexpr int boxes_of_each = 400;
    constexpr std::size_t samples = 64;
    std::size_t known = 0, close = 0;
    std::mt19937 dice(5);
    for (const char *text :
         {"box([1, 0.7, 0.9])", "box(1) - cylinder(0.3, 2)", "rounded_box([1, 0.8, 0.6], 0.1)",
          "(box(1) | sphere(0.6).translate(x: 0.4)).rotate(0.4, axis: [1, 2, 3])",
          "cone(0.6, 1).scale([1, 1, 1]) & slab(0.7)", "torus(0.6, 0.2).shell(0.05)",
          "rectangle([1, 0.5]).extrude(1, twist: 90deg)", "box_frame(1, thickness: 0.2)",
          "polygon([[-0.5, -0.5], [0.5, -0.4], [0.2, 0.5], [0, 0]]).extrude(1)",
          "smooth_union(0.3, box(0.8), sphere(0.4).translate([0.4, 0.3, 0.1]))",
          "round_difference(0.2, box(1), cylinder(0.3, 2))",
          "chamfer_union(0.15, box(0.8), sphere(0.4).translate([0.4, 0.3, 0.1]))",
          "smooth_union(0.2) { for i in 0..12 { sphere(0.2).translate([0.5 * hash(i), 0.5 * "
          "hash(i + 0.3), 0.5 * hash(i + 0.6)]) } }"}) {
        INFO(text);
        const mesh::Field field(scene_of(text), 0, {});
        mesh::Evaluator evaluator(field);
        cpu::Boxes boxes;
        std::uniform_real_distribution<float> place(-0.8f, 0.8f), share(0, 1), width(-9, -1);
        for (int b = 0; b < boxes_of_each; ++b) {
            mesh::Point lo{}, hi{};
            const float side = std::exp2(width(dice));
            for (std::size_t i = 0; i < 3; ++i) lo[i] = place(dice), hi[i] = lo[i] + side;
            if (b % 2) lo[b % 3] = -0.5f - 0.3f * side, hi[b % 3] = lo[b % 3] + side; // on a face
            const auto linear = mesh::linear_over(evaluator, *field.whole, boxes, lo, hi);
            if (!linear) continue;
            ++known;
            close += linear->off < 1e-3 * side;
            mesh::Points points;
            for (std::size_t k = 0; k < samples; ++k) {
                mesh::Point p{};
                for (std::size_t i = 0; i < 3; ++i) // the corners first
                    p[i] = k < 8 ? (k >> i & 1 ? hi[i] : lo[i])
                                 : std::min(hi[i], lo[i] + share(dice) * (hi[i] - lo[i]));
                points.add(p);
            }
            std::vector<float> values;
            mesh::values_at(evaluator, *field.whole, points, values);
            const mesh::Point at = mesh::middle_point(lo, hi);
            double farthest = 0;
            for (std::size_t k = 0; k < samples; ++k) {
                double plane = linear->value;
                for (std::size_t i = 0; i < 3; ++i)
                    plane += linear->slope[i] * (double(points.at[i][k]) - at[i]);
                farthest = std::max(farthest, std::fabs(plane - values[k]));
            }
            CHECK(farthest <= linear->off);
        }
    }
    CHECK(known > 1000);
    CHECK(close > 150); // faces of boxes, for one
}

TEST_CASE("a smooth blend of next to no radius has the slopes of its parts, and no mean of them") {
    // Below 1e-9 it is the lesser of both (ir/blends.h).
    const mesh::Field field(
        scene_of("param r = 1e-10 in 0..1\nsmooth_union(r, plane(X, 0), plane(Y, 0)) & box(1)"), 0,
        {});
    mesh::Evaluator evaluator(field);
    cpu::Boxes boxes;
    const float half = 1e-11f;
    const mesh::Point lo{-half, -half, -half}, hi{half, half, half};
    const auto linear = mesh::linear_over(evaluator, *field.whole, boxes, lo, hi);
    REQUIRE(linear);
    mesh::Points points;
    points.add({-half, half, 0});
    std::vector<float> values;
    mesh::values_at(evaluator, *field.whole, points, values);
    CHECK(values[0] <= -0.9f * half);
    const double plane = linear->value + (linear->slope[1] - linear->slope[0]) * double(half);
    CHECK(std::fabs(plane - values[0]) <= linear->off);
}

TEST_CASE("where the field changes its sign in a box one of its sheets is 0") {
    constexpr int boxes_of_each = 600, ways = 12;
    std::size_t known = 0, roots = 0;
    std::mt19937 dice(6);
    for (const char *text :
         {"polygon([[-0.5, -0.5], [0.5, -0.4], [0.2, 0.5], [0, 0]]).extrude(1)",
          "polygon([[0.1, -0.5], [0.5, -0.4], [0.2, 0.5], [0.3, 0]]).revolve()",
          "polygon([[-0.5, -0.5], [0.5, 0.5], [0.5, -0.5], [-0.5, 0.5]]).extrude(0.6).rotate(1)",
          "cone(0.6, 1)", "capped_torus(0.5, 0.2, 60deg)", "box(0.8) | box(0.8).translate(x: 0.8)",
          "round_union(0.2, box(0.8), polygon([[0, 0], [0.7, 0], [0.3, 0.6]]).extrude(1))",
          "octahedron(0.7)", "octahedron(0.6).rotate(0.3, axis: [1, 2, 3])", "dodecahedron(0.7)",
          "icosahedron(0.6).rotate(0.3, axis: [1, 2, 3])",
          "sphere(0.4) | sphere(0.4).translate(x: 0.8) | sphere(0.3).translate(y: 0.7)",
          "(octahedron(0.7) - sphere(0.3).translate(x: 0.4)) | sphere(0.3).translate(z: -0.6)",
          "box(0.9).repeat_mirror([0.5, 1, 1]) & sphere(0.6)"}) {
        INFO(text);
        const mesh::Field field(scene_of(text), 0, {});
        mesh::Evaluator evaluator(field);
        cpu::Boxes boxes;
        std::uniform_real_distribution<float> place(-0.8f, 0.8f), share(0, 1), width(-9, -1);
        for (int b = 0; b < boxes_of_each; ++b) {
            mesh::Point lo{}, hi{};
            const float side = std::exp2(width(dice));
            for (std::size_t i = 0; i < 3; ++i) lo[i] = place(dice), hi[i] = lo[i] + side;
            const mesh::Border border = mesh::border_over(evaluator, *field.whole, boxes, lo, hi);
            if (border.linear) {
                mesh::Points points;
                for (int k = 0; k < 16; ++k) {
                    mesh::Point p{};
                    for (std::size_t i = 0; i < 3; ++i)
                        p[i] = k < 8 ? (k >> i & 1 ? hi[i] : lo[i])
                                     : std::min(hi[i], lo[i] + share(dice) * (hi[i] - lo[i]));
                    points.add(p);
                }
                std::vector<float> values;
                mesh::values_at(evaluator, *field.whole, points, values);
                const mesh::Point at = mesh::middle_point(lo, hi);
                double beyond = -1; // what is said of the field
                for (std::size_t k = 0; k < points.size(); ++k) {
                    double plane = border.linear->value;
                    for (std::size_t i = 0; i < 3; ++i)
                        plane += border.linear->slope[i] * (double(points.at[i][k]) - at[i]);
                    beyond = std::max(beyond, std::fabs(plane - values[k]) - border.linear->off);
                }
                CHECK(beyond <= 0);
            }
            if (!border.zeros.known) continue;
            ++known;
            for (int way = 0; way < ways; ++way) {
                mesh::Point from{}, to{};
                for (std::size_t i = 0; i < 3; ++i) {
                    from[i] = std::min(hi[i], lo[i] + share(dice) * (hi[i] - lo[i]));
                    to[i] = std::min(hi[i], lo[i] + share(dice) * (hi[i] - lo[i]));
                }
                const auto solid = [&](const mesh::Point &p) {
                    mesh::Points points;
                    points.add(p);
                    std::vector<float> values;
                    mesh::values_at(evaluator, *field.whole, points, values);
                    return values[0] <= 0;
                };
                const bool first = solid(from);
                if (solid(to) == first) continue;
                for (int k = 0; k < 40; ++k) {
                    mesh::Point half{};
                    for (std::size_t i = 0; i < 3; ++i) half[i] = 0.5f * (from[i] + to[i]);
                    (solid(half) == first ? from : to) = half;
                }
                ++roots;
                double nearest = 1;
                for (const mesh::Linear &sheet : border.zeros.sheets) {
                    const mesh::Point at = mesh::middle_point(lo, hi);
                    double plane = sheet.value;
                    for (std::size_t i = 0; i < 3; ++i)
                        plane += sheet.slope[i] * (double(to[i]) - at[i]);
                    nearest = std::min(nearest, std::fabs(plane) - sheet.off);
                }
                CHECK(nearest <= 1e-6);
            }
        }
    }
    CHECK(known > 1000);
    CHECK(roots > 300);
}

TEST_CASE("the area of solids that are known lies between two numbers, which are near") {
    struct Known {
        const char *text;
        double area, near; // the two numbers' distance, as a share of it
        int cells = 32;
    };
    const double pi = std::numbers::pi;
    const Known known[] = {
        {"sphere(1)", 4 * pi, 0.03},
        {"sphere(1).translate([5, -3, 2])", 4 * pi, 0.03},
        {"sphere(1e-4)", 4e-8 * pi, 0.03},
        {"sphere(1).scale(300)", 4 * pi * 9e4, 0.03},
        {"box([1, 2, 3])", 22, 0.03},
        {"box([1, 2, 3]).rotate(0.4, axis: [1, 2, 3])", 22, 0.08},
        {"torus(1, 0.5)", 4 * pi * pi * 0.5, 0.16, 48},
        {"cylinder(0.5, 2)", 2.5 * pi, 0.06, 48},
        {"sphere(1).shell(0.2)", 4 * pi * (1.1 * 1.1 + 0.9 * 0.9), 0.04, 48},
        {"sphere(1) | sphere(1).translate(x: 5)", 8 * pi, 0.06},
        {"sphere(1) | sphere(1).translate(x: 1)", 6 * pi, 0.05},
        {"sphere(1) & sphere(1).translate(x: 1)", 2 * pi, 0.06},
        {"sphere(1) - sphere(1).translate(x: 1)", 4 * pi, 0.06, 48},
        {"box(2) - box([1, 1, 3])", 24 - 2 + 8, 0.06},
        // Of faces that folds make of one, and of balls that touch.
        {"octahedron(1)", 4 * std::sqrt(3.0), 0.08},
        {"dodecahedron(1)", 10.514622, 0.06},
        {"icosahedron(1)", 9.574541, 0.12},
        {"sphere(1) | sphere(1).translate(x: 2)", 8 * pi, 0.2},
        {"capsule([-1, 0, 0], [1, 0, 0], 0.3)", 4 * pi * 0.09 + 2 * pi * 0.3 * 2, 0.15},
        // Blends of balls that are farther apart than they reach, and of one with itself: less by a
        // quarter of the radius.
        {"smooth_union(0.3, sphere(1), sphere(1).translate(x: 5))", 8 * pi, 0.06},
        {"smooth_union(0.4, sphere(1), sphere(1))", 4 * pi * 1.1 * 1.1, 0.05},
        {"chamfer_union(0.4, sphere(1), sphere(1))", 4 * pi * 1.2 * 1.2, 0.05},
        {"round_union(0.5, sphere(1), sphere(1))", 4 * pi * std::pow(1.5 - std::sqrt(0.125), 2),
         0.05},
    };
    for (const Known &k : known) {
        INFO(k.text);
        const mesh::Measures of = measured(k.text, as_fine_as(k.cells));
        INFO(of.area.lo << " to " << of.area.hi << " at " << of.open_places);
        CHECK(holds(of.area, k.area));
        CHECK(of.area.hi - of.area.lo < k.near * k.area);
        CHECK(of.open_places == 0);
    }
}

TEST_CASE("an area without an upper end says at how many places, and is as large as a ball's") {
    // The slopes of noise are not known.
    const mesh::Measures of =
        measured("sphere(1).displace(p => 0.001 * noise(3 * p))", as_fine_as(16));
    CHECK(of.open_places > 0);
    CHECK(std::isinf(of.area.hi));
    CHECK((of.area.lo <= 4 * std::numbers::pi && of.area.lo > 10));
}

TEST_CASE("where no slopes are known the surface is part of what numbers are 0 on") {
    struct Known {
        const char *text;
        double area, near;
        int cells = 32;
    };
    const double pi = std::numbers::pi;
    const Known known[] = {
        // Roots and signs.
        {"cone(0.8, 1.6)", pi * 0.8 * (0.8 + std::sqrt(0.64 + 2.56)), 0.12},
        {"capped_cone(0.8, 0.4, 1.2)", pi * (0.64 + 0.16 + 1.2 * std::hypot(0.4, 1.2)), 0.12},
        {"ellipsoid([2, 1, 1])", 2 * pi * (1 + 4 * pi / (3 * std::sqrt(3.0))), 0.03, 48},
        // A choice between two numbers that meet.
        {"capped_torus(1, 0.2, 60deg)", 0.4 * pi * 2 * pi / 3 + 4 * pi * 0.04, 0.5, 48},
        // The plane between two parts comes to the surface.
        {"box(1) | box(1).translate(x: 1)", 10, 0.08},
        {"box(1) | box([1, 2, 1]).translate(x: 1)", 4 + 1 + 9, 0.08},
        {"box(2) | cylinder(0.5, 1).translate(y: 1.5)", 24 + pi, 0.12},
        // Loops over corners.
        {"polygon([[0, 0], [4, 0], [4, 3]]).extrude(1)", 24, 0.1},
        {"polygon([[0, 0], [4, 0], [4, 3], [3, 1]]).extrude(1).rotate(0.4, axis: [1, 2, 3])",
         14 + std::sqrt(5.0) + std::sqrt(10.0), 0.32},
    };
    for (const Known &k : known) {
        INFO(k.text);
        const mesh::Measures of = measured(k.text, as_fine_as(k.cells));
        INFO(of.area.lo << " to " << of.area.hi << " at " << of.open_places);
        CHECK(holds(of.area, k.area));
        CHECK(of.area.hi - of.area.lo < k.near * k.area);
        CHECK(of.open_places == 0);
    }
}

TEST_CASE("what planes enclose holds the volume, and is narrow") {
    std::mt19937 dice(8);
    std::uniform_real_distribution<double> some(0.4, 1.6), turn(-1, 1);
    const double pi = std::numbers::pi;
    for (int n = 0; n < test::effort(2); ++n) {
        const double a = some(dice), b = some(dice), c = some(dice), r = 0.2 * a;
        const std::string turned = fmt::format(".rotate({:.4f}, axis: [{:.3f}, {:.3f}, 1])",
                                               turn(dice), turn(dice), turn(dice));
        const std::string block = fmt::format("box([{:.5f}, {:.5f}, {:.5f}])", a, b, c);
        const auto number = [](double x) { return std::stod(fmt::format("{:.5f}", x)); };
        const double volume = number(a) * number(b) * number(c);
        const mesh::Measures whole = measured(block + turned, as_fine_as(40));
        CHECK(holds(whole.volume, volume));
        CHECK(whole.volume.hi - whole.volume.lo < 0.02 * volume);
        const std::string bored =
            fmt::format("({} - cylinder({:.5f}, {:.5f})){}", block, r, 2 * b, turned);
        const double radius = number(r);
        if (2 * radius > std::min(number(a), number(c))) continue;
        CHECK(holds(measured(bored, as_fine_as(40)).volume,
                    volume - pi * radius * radius * number(b)));
    }
}

TEST_CASE("the area and the border of drawings that are known") {
    struct Known {
        const char *text;
        double area, border;
        std::array<double, 2> center;
    };
    const double pi = std::numbers::pi;
    const Known known[] = {
        {"circle(2)", 4 * pi, 4 * pi, {0, 0}},
        {"circle(2).translate([30, -50])", 4 * pi, 4 * pi, {30, -50}},
        {"rectangle([3, 2])", 6, 10, {0, 0}},
        {"rectangle([1, 1]).translate(x: 0.5)\nrectangle([1, 2]).translate(x: 3)",
         3,
         10,
         {(0.5 + 6) / 3, 0}},
        {"ring(2, 1)", 3 * pi, 6 * pi, {0, 0}},
        {"circle(1).scale([2, 1])", 2 * pi, 9.688448220547675, {0, 0}},
        {"circle(1) - circle(1).translate(x: 1)",
         pi / 3 + std::sqrt(3.0) / 2,
         2 * pi,
         {-0.3210210538742287, 0}},
    };
    for (const Known &k : known) {
        INFO(k.text);
        const mesh::FlatMeasures of = measured_flat(k.text, 64);
        INFO(of.perimeter.lo << " to " << of.perimeter.hi << " at " << of.open_places);
        CHECK(holds(of.area, k.area));
        CHECK(of.area.hi - of.area.lo < 1e-3 * k.area);
        CHECK(holds(of.perimeter, k.border));
        CHECK(of.perimeter.hi - of.perimeter.lo < 0.02 * k.border);
        CHECK(of.open_places == 0);
        for (std::size_t i = 0; i < 2; ++i) CHECK(holds(of.center[i], k.center[i]));
    }
}

TEST_CASE("a certificate says whether an upper end of the area was looked for") {
    const ir::Scene scene = scene_of("sphere(1)");
    for (const int resolution : {24, 400}) { // of the second, all cells have too many kernels
        mesh::Settings settings;
        settings.resolution = resolution;
        const mesh::Made made = mesh::make_mesh(scene, settings);
        REQUIRE(made.failure == mesh::Failure::None);
        mesh::Progress progress;
        mesh::Certificate certificate;
        certificate.largest_volume = 8;
        enclose_measures(scene, settings, made, progress, certificate);
        CHECK(certificate.looked_for_area == (resolution == 24));
        CHECK(std::isfinite(certificate.area.hi) == certificate.looked_for_area);
        CHECK((certificate.open_places == 0) == certificate.looked_for_area);
    }
}
