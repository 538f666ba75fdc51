// What is made of shapes that are joined with their own box, of what is nowhere, of insides and of
// what is very large: no bound is exceeded, and nothing of a solid is cut off.
#include "driver/compile.h"
#include "ir/lower/lower.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>
#include <vector>

using namespace fathom;
using namespace fathom::test;

namespace {

driver::Compilation compiled(const std::string &text) {
    return driver::compile_text("combining.sdf", text, "", {});
}

// Balls about random points, of the size that is marched, that hold a point of the solid as it is
// without the boxes that are joined to it from outside.
int balls_cut(const std::string &text, double reach) {
    driver::Compilation marched = compiled(text), plain = compiled(text);
    for (ir::ShapeFact &fact : plain.scene.facts)
        fact.guard = false, fact.outward = std::numeric_limits<double>::infinity();
    ir::lower(marched.scene), ir::lower(plain.scene);
    Sampler distance(marched.scene), field(plain.scene);
    std::vector<Point3> centers, inside;
    for (int i = 0; i < 50'000; ++i)
        centers.push_back(distance.in_box({-reach, -reach, -reach}, {reach, reach, reach}));
    const std::vector<float> radii = distance.values(centers);
    for (std::size_t i = 0; i < centers.size(); ++i) {
        const double radius = std::min<double>(std::max(radii[i], 0.0f), 4 * reach);
        inside.push_back(distance.in_ball(centers[i], radius * 0.9999));
    }
    const std::vector<float> found = field.values(inside);
    const double least = 1e-5 * reach;
    int cut = 0;
    for (std::size_t i = 0; i < centers.size(); ++i) cut += radii[i] > least && found[i] < -least;
    return cut;
}

struct Case {
    std::string text;
    double reach = 8;
    bool refused = false; // it may be
};

// Whether it is taken.
bool holds(const Case &test) {
    driver::Compilation c = compiled(test.text);
    INFO(test.text);
    if (!c.good()) {
        CHECK(test.refused);
        return false;
    }
    ir::lower(c.scene);
    const double r = test.reach;
    const Slopes truth = measure(c.scene, {-r, -r, -r}, {r, r, r}, 50'000);
    std::printf("%.4g of what is proved: %s\n", truth.steepest, test.text.c_str());
    CHECK(truth.unsafe == 0);
    CHECK(truth.steepest <= 1 + 1e-3);
    CHECK(balls_cut(test.text, r) == 0);
    return true;
}

} // namespace

TEST_CASE("what is joined with its own box is measured so") {
    const std::string small = "implicit(p => 0.01 * (length(p) - 1)).twist(0.01, axis: Z)";
    const std::string bumped = "sphere(1).distort(p => [p.x + 0.01 * sin(p.x * p.x * p.x), "
                               "p.y + clamp(20 * p.y - 41, -1, 1), p.z])";
    const std::string bent = "implicit(p => 0.02 * (length(p) - 1)).bend(0.01, axis: X)";
    for (const std::string &a : {small, bumped, bent}) {
        const std::string b = "(" + a + ").translate(x: 6)";
        for (const std::string use :
             {"(a | ellipsoid([1, 0.5, 0.5])).offset(1.5)",
              "blend(a, b, p => clamp(length(p - [6, 0, 0]), 0, 1)).offset(1)",
              "blend(a, b, p => clamp(0.1 * p.x, 0, 1)).within(ball(6))",
              "(a | b).offset(0.5).taper(0.5, from: -1, to: 1)",
              "smooth_union(0.5, a, ellipsoid([1, 0.5, 0.5])).offset(0.7)"})
            holds({"let a = " + a + "\nlet b = " + b + "\n" + use + "\n", 8, true});
    }
}

TEST_CASE("what is nowhere is no distance to anything") {
    for (const std::string none :
         {"empty", "union {}", "union([for i in 0..0 { sphere(1) }])", "empty.translate(x: 1)",
          "empty.offset(-0.5)", "(empty | empty).scale(2)"})
        for (const std::string use : {"blend(sphere(1), NONE, p => clamp(2 - length(p), 0, 1))",
                                      "blend(NONE, box(1), p => clamp(0.5 - p.x, 0, 1))",
                                      "blend(NONE, NONE, p => clamp(0.5 - p.x, 0, 1)) | box(1)"}) {
            std::string text = use;
            for (std::size_t at; (at = text.find("NONE")) != text.npos;) text.replace(at, 4, none);
            holds({text + "\n", 3, true});
        }
}

TEST_CASE("the outside of a blend is where one of its shapes is not") {
    for (const std::string weight : {"0.5", "0.2", "0.9"})
        for (const std::string use :
             {"complement(m).displace(p => 0.01 * sin(p.x))",
              "complement(m.offset(-0.3)).displace(p => 0.01 * sin(p.x))",
              "complement(complement(complement(m))).displace(p => 0.02 * sin(p.y))"}) {
            const std::string text = "let a = sphere(5).translate(x: -3)\n"
                                     "let b = sphere(5).translate(x: 3)\n"
                                     "let m = blend(complement(a), complement(b), " +
                                     weight + ")\n" + use + "\n";
            CHECK(holds({text, 10}));
        }
}

TEST_CASE("what is drawn apart is flat between its halves") {
    for (const std::string apart :
         {"sphere(1).translate(x: 20).elongate([10, 0, 0])",
          "sphere(1).translate(x: 5).elongate([10, 0, 0])",
          "sphere(1).translate([3, 2, 0]).elongate([4, 6, 0])",
          "sphere(0.5).translate(x: 3).elongate([4, 0, 0]).scale(2)",
          "(sphere(1).translate(x: 8).elongate([6, 0, 0]) | box(1)).rotate(30deg)"})
        CHECK(holds({"let f = " + apart +
                         "\nlet g = sphere(1).translate(x: 25)\n"
                         "blend(f, g, p => clamp(p.y, 0, 1)).offset(35)\n",
                     60}));
}

TEST_CASE("no size is taken for what is nowhere") {
    struct Large {
        std::string text;
        double x, wanted;
    };
    const std::vector<Large> all{
        {"polygon([[-1, -1], [1, -1], [0, 1]]).extrude(1)", 4e10, 4e10},
        {"polygon([[-1, -1], [1, -1], [0, 1]]).revolve(3)", 4e10, 4e10},
        {"polygon([[0, -1], [1, -1], [0, 1]]).revolve()", 4e10, 4e10},
        {"union { for i in 0..300 { sphere(0.3).translate([0.01 * i, 0, 0.005 * i]) } }", 4e10,
         4e10},
        {"(union { for i in 0..300 { sphere(0.3).translate([0.01 * i, 0, 0.005 * i]) } })"
         ".offset(2e9)",
         4e10, 3.8e10},
        {"sphere(1) | empty", 4e10, 4e10},
        {"tubes([[-1, 0, 0], [1, 0, 0], [1, 1, 0]], radius: 2e9)", 4e10, 3.8e10},
        {"sphere(1).repeat_polar(40)", 4e10, 4e10},
    };
    for (const Large &test : all) {
        driver::Compilation c = compiled(test.text);
        INFO(test.text);
        REQUIRE(c.good());
        ir::lower(c.scene);
        Sampler sampler(c.scene);
        CHECK(sampler.values({{test.x, 0, 0}}).at(0) == Approx(test.wanted).epsilon(1e-4));
    }
}
