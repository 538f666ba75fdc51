// Measures: what is known of solids lies in the enclosures, and clearances are those of geometry.
#include "driver/compile.h"
#include "mesh/clearance.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <numbers>

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
    return mesh::measure(scene, settings, made, progress, 6e7);
}

mesh::Settings as_fine_as(int resolution) {
    mesh::Settings settings;
    settings.resolution = resolution;
    return settings;
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
