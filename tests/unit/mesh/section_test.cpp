// Sections: contours that are closed, do not cross, have holes right, and lie where they say.
#include "driver/compile.h"
#include "mesh/section_files.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>
#include <numbers>
#include <tuple>

using namespace fathom;

namespace {

mesh::Section cut(const std::string &text, std::size_t axis, float at, int resolution,
                  double side = 0) {
    const driver::Compilation c = driver::compile_text("cut.sdf", text, "", {});
    INFO(text);
    REQUIRE(c.good());
    mesh::Settings settings;
    settings.resolution = resolution;
    settings.side = side;
    ir::Box box;
    REQUIRE(mesh::box_of(c.scene, settings, box) == mesh::Failure::None);
    const mesh::Cut solid(c.scene, settings, box);
    mesh::Section made = mesh::section(solid, axis, at);
    REQUIRE(made.failure == mesh::Failure::None);
    return made;
}

double turn_of(const mesh::Flat &a, const mesh::Flat &b, const mesh::Flat &c) {
    const long double x = (long double)(b[0] - (long double)a[0]) * (c[1] - (long double)a[1]) -
                          (long double)(b[1] - (long double)a[1]) * (c[0] - (long double)a[0]);
    return static_cast<double>(x);
}

// Pairs of lines that meet elsewhere than at a common end.
std::size_t crossings_of(const mesh::Contours &contours) {
    struct Line {
        mesh::Flat a, b;
    };
    std::vector<Line> lines;
    for (const auto &contour : contours)
        for (std::size_t k = 0; k < contour.size(); ++k)
            lines.push_back({contour[k], contour[(k + 1) % contour.size()]});
    std::size_t count = 0;
    for (std::size_t i = 0; i < lines.size(); ++i)
        for (std::size_t j = i + 1; j < lines.size(); ++j) {
            const auto &[a, b] = lines[i];
            const auto &[c, d] = lines[j];
            if (a == c || a == d || b == c || b == d) continue;
            // Apart along one axis, as two lines of one line may be.
            if (std::max(a[0], b[0]) < std::min(c[0], d[0]) ||
                std::max(c[0], d[0]) < std::min(a[0], b[0]) ||
                std::max(a[1], b[1]) < std::min(c[1], d[1]) ||
                std::max(c[1], d[1]) < std::min(a[1], b[1]))
                continue;
            const double p = turn_of(a, b, c), q = turn_of(a, b, d), r = turn_of(c, d, a),
                         s = turn_of(c, d, b);
            count += p * q <= 0 && r * s <= 0;
        }
    return count;
}

double signed_area(const std::vector<mesh::Flat> &contour) { return mesh::area_of({contour}); }

} // namespace

TEST_CASE("a ball's section is a circle, counterclockwise, within what is claimed") {
    for (const std::size_t axis : {0u, 1u, 2u}) {
        const mesh::Section made = cut("sphere(1)", axis, 0.6f, 40);
        REQUIRE(made.contours.size() == 1);
        CHECK(made.undecided.empty());
        CHECK(signed_area(made.contours[0]) == Approx(std::numbers::pi * 0.64).epsilon(1e-3));
        CHECK((made.area.lo < std::numbers::pi * 0.64 && std::numbers::pi * 0.64 < made.area.hi));
        CHECK(made.to_section < made.side / 8);
        CHECK(made.to_contour < made.side / 4);
        for (std::size_t k = 0; k < made.contours[0].size(); ++k) {
            const mesh::Flat &p = made.contours[0][k],
                             &q = made.contours[0][(k + 1) % made.contours[0].size()];
            for (const double t : {0.0, 0.3, 0.5}) {
                const double r = std::hypot((1 - t) * p[0] + t * q[0], (1 - t) * p[1] + t * q[1]);
                CHECK(std::fabs(r - 0.8) <= made.to_section);
            }
        }
    }
}

TEST_CASE("what is right and what is up, across each axis") {
    // A small ball off the middle in all directions.
    const std::string text = "box(0.1) | sphere(0.2).translate([1, 2, 3])";
    const std::array<mesh::Flat, 3> wanted{{{-3, 2}, {1, -3}, {1, 2}}};
    const std::array<float, 3> at{1, 2, 3};
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const mesh::Section made = cut(text, axis, at[axis], 200);
        REQUIRE(made.contours.size() == 1);
        CHECK(signed_area(made.contours[0]) > 0);
        mesh::Flat mean{};
        for (const mesh::Flat &p : made.contours[0])
            for (std::size_t i = 0; i < 2; ++i)
                mean[i] += p[i] / static_cast<float>(made.contours[0].size());
        CHECK(mean[0] == Approx(wanted[axis][0]).margin(0.05));
        CHECK(mean[1] == Approx(wanted[axis][1]).margin(0.05));
    }
}

TEST_CASE("holes go clockwise, islands in them counterclockwise again") {
    const mesh::Section made = cut("sphere(2).shell(0.3) | sphere(1).shell(0.3)", 2, 0, 80);
    REQUIRE(made.contours.size() == 4);
    std::size_t outlines = 0;
    for (const auto &contour : made.contours) outlines += signed_area(contour) > 0;
    CHECK(outlines == 2);
    const double pi = std::numbers::pi;
    CHECK(mesh::area_of(made.contours) == Approx(pi * 2 * (2 + 1) * 0.3).epsilon(0.01));
    CHECK(crossings_of(made.contours) == 0);
}

TEST_CASE("straight sides have few points, and corners are kept") {
    const mesh::Section made = cut("box([2, 1, 1])", 2, 0.1f, 100);
    REQUIRE(made.contours.size() == 1);
    CHECK(made.contours[0].size() <= 12);
    CHECK(signed_area(made.contours[0]) == Approx(2).epsilon(1e-4));
    for (const float x : {-1.0f, 1.0f})
        for (const float y : {-0.5f, 0.5f}) {
            double nearest = 1;
            for (const mesh::Flat &p : made.contours[0])
                nearest = std::min<double>(nearest, std::hypot(p[0] - x, p[1] - y));
            CHECK(nearest < 1e-4);
        }
}

TEST_CASE("contours do not cross, whatever the solid and however coarse the squares") {
    for (const char *text : {"menger(2, 2)", "box(1) | box(1).translate([1, 1, 0])",
                             "gyroid(0.5, 0.05).within(ball(1))", "box(2).twist(0.8, axis: Z)",
                             "smooth_union(0.2) { sphere(1); box(1.4).rotate(0.3, axis: X) }",
                             "(sphere(1) | sphere(0.3).translate(x: 1.2)) - box([0.01, 3, 3])",
                             "torus(1, 0.3).rotate(0.7, axis: [1, 2, 3])"})
        for (const int resolution : {5, 13, 60})
            for (const float at : {0.013f, 0.31f}) {
                INFO(text << " at " << resolution << ", " << at);
                const mesh::Section made = cut(text, 2, at, resolution);
                CHECK(crossings_of(made.contours) == 0);
                for (const auto &contour : made.contours) {
                    CHECK(contour.size() >= 3);
                    for (std::size_t k = 0; k < contour.size(); ++k)
                        CHECK(contour[k] != contour[(k + 1) % contour.size()]);
                }
                CHECK((made.area.lo <= made.area.hi && made.area.lo >= 0));
            }
}

TEST_CASE("a thin wall is found, or said to be undecided") {
    const std::string text = "sphere(1).translate(x: -2) | box([0.01, 1, 1]).translate(x: 1.11)";
    const mesh::Section made = cut(text, 2, 0, 60);
    CHECK((made.contours.size() == 2 || !made.undecided.empty()));
    const mesh::Section coarse = cut("sphere(1).translate(x: -2) | box([1e-4, 1, 1])", 2, 0, 20);
    CHECK_FALSE(coarse.undecided.empty());
}

TEST_CASE("a plane beside the solid has no contour, and an estimate proves nothing by its bound") {
    CHECK(cut("sphere(1)", 2, 5, 20).contours.empty());
    CHECK(cut("sphere(1)", 2, 5, 20).area.hi == 0);
    CHECK_FALSE(
        cut("implicit(p => length(p) - 1, estimate: 1, within: ball(2))", 2, 0, 20).used_bound);
}

TEST_CASE("files of contours") {
    const mesh::Contours square{{{0, 0}, {2, 0}, {2, 1}, {0, 1}},
                                {{0.5f, 0.25f}, {0.5f, 0.75f}, {1, 0.5f}}};
    const mesh::Rectangle frame{{0, 0}, {2, 1}};
    const std::string svg = mesh::svg_of(square, frame, "a < b", mesh::Unit::Millimetre);
    CHECK(svg.find("width=\"2mm\" height=\"1mm\" viewBox=\"0 -1 2 1\"") != svg.npos);
    CHECK(svg.find("<title>a &lt; b</title>") != svg.npos);
    CHECK(svg.find("M0 0L2 0 2 -1 0 -1Z\nM0.5 -0.25L0.5 -0.75 1 -0.5Z\n") != svg.npos);
    const std::string dxf = mesh::dxf_of(square, mesh::Unit::Inch);
    CHECK(dxf.starts_with("0\nSECTION\n2\nHEADER\n9\n$ACADVER\n1\nAC1009\n9\n$INSUNITS\n70\n1\n"));
    CHECK(dxf.ends_with("0\nENDSEC\n0\nEOF\n"));
    std::size_t vertices = 0;
    for (std::size_t at = 0; (at = dxf.find("\nVERTEX\n", at)) != dxf.npos; ++at) ++vertices;
    CHECK(vertices == 7);
    // Pixels have the area that is covered, up to float sums: 2 less a triangle of 1/8.
    const std::vector<float> pixels = mesh::coverage_of(square, frame, 20, 10);
    double sum = 0;
    for (const float p : pixels) sum += p;
    CHECK(sum == Approx((2 - 0.125) * 100).epsilon(1e-4));
    CHECK(pixels[0] == Approx(1).margin(1e-5));
    CHECK(pixels[5 * 20 + 6] == Approx(0).margin(1e-5)); // in the hole
}

TEST_CASE("a plane in a face of the solid has the face") {
    const mesh::Section made = cut("box(1) | sphere(0.3).translate(x: 2)", 2, 0.5f, 200);
    CHECK(made.undecided.empty());
    CHECK(made.contours.size() == 1);
    CHECK(mesh::area_of(made.contours) == Approx(1).epsilon(1e-3));
    CHECK((made.area.lo == 0 && 1 <= made.area.hi && made.area.hi < 1.05));
}

TEST_CASE("a plane that only touches the solid proves no area") {
    for (const auto &[text, axis, at] : {std::tuple{"sphere(1)", 2, 1.0f},
                                         {"sphere(1).translate(z: 100)", 2, 101.0f},
                                         {"cylinder(5, 20)", 2, 5.0f},
                                         {"torus(10, 2)", 1, 2.0f}}) {
        INFO(text);
        const mesh::Section made = cut(text, static_cast<std::size_t>(axis), at, 100);
        CHECK(made.area.lo == 0);
        CHECK(made.area.hi < 1);
    }
}

TEST_CASE("a face that floats hide from the plane ends soon, and claims nothing there") {
    const mesh::Section made =
        cut("box(1).rotate(0.3, axis: [1, 2, 3]).rotate(-0.3, axis: [1, 2, 3])", 2, 0.5f, 40);
    CHECK((made.area.lo <= 1 && made.area.hi >= 0.99));
}

TEST_CASE("where parts touch there is no contour, along a seam or in its plane") {
    const char *halves = "box(1).translate(x: 0.5).mirror(X)",
               *thirds =
                   "box([1.1, 1, 1]).translate(x: 1.85) | box([1.1, 1, 1]).translate(x: 0.75)";
    // In the seam's plane the field is 0, which proves no area.
    for (const auto &[text, axis, at, area, proved] : {std::tuple{halves, 2, 0.1f, 2.0, 1.9},
                                                       {halves, 0, 0.0f, 1.0, 0.0},
                                                       {thirds, 1, 0.2f, 2.2, 2.1}}) {
        INFO(text << " across " << axis);
        const mesh::Section made = cut(text, static_cast<std::size_t>(axis), at, 60);
        CHECK(made.contours.size() == 1);
        CHECK(made.undecided.empty());
        CHECK((made.area.lo <= area && area <= made.area.hi && made.area.lo >= proved));
        CHECK(mesh::area_of(made.contours) == Approx(area).epsilon(1e-3));
    }
}
