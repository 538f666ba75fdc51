// Families of maps of which single rules were wrong: what is drawn is nowhere steeper than a
// distance, jumps nowhere and lies in its box, or the scene is refused.
#include "compiled.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::test;

namespace {

// Refused, or no steeper than 1.
void holds(const std::string &text, Point3 lo, Point3 hi, bool accepted = true) {
    INFO(text);
    const driver::Compilation made = compiled(text);
    CHECK((!accepted || !made.diagnostics.has_errors()));
    if (made.diagnostics.has_errors()) return;
    const Slopes found = measure(made.scene, lo, hi, 20'000);
    INFO("at " << found.where[0] << ", " << found.where[1] << ", " << found.where[2]);
    CHECK(found.steepest < 1.002);
    CHECK(found.unsafe == 0);
}

} // namespace

TEST_CASE("what grows as a box is turned with its corners") {
    const std::string cube = "(box([2,9,9]) & box([9,2,9]) & box([9,9,2]))",
                      square = "(rectangle([2,9]) & rectangle([9,2]))";
    const auto reach = [](const std::string &text) {
        INFO(text);
        const driver::Compilation made = compiled(text);
        REQUIRE(!made.diagnostics.has_errors());
        return made.scene.bounds;
    };
    for (const double angle : {0.0, 10.0, 30.0, 45.0, 60.0, 90.0, 180.0}) {
        const double u = angle / 180 * 3.14159265358979, c = std::cos(u), s = std::sin(u);
        const double least = 2 * (std::fabs(c) + std::fabs(s)); // of the corner (2, 2)
        for (const std::string &text :
             {fmt::format("{}.rotate({}deg, axis: Z).offset(1)", cube, angle),
              fmt::format("complement(complement({}).rotate({}deg, axis: Z).offset(-1))", cube,
                          angle),
              fmt::format("{}.rotate({}deg).extrude(9).offset(1)", square, angle),
              fmt::format("union {{ for i in 0..40 {{ {}.rotate({}deg + 1e-9*i, axis: Z)"
                          ".translate(x: 1e-9*i) }} }}.offset(1)",
                          cube, angle)}) {
            const ir::Box box = reach(text);
            CHECK(box.hi[0] >= least - 1e-5);
            CHECK(box.lo[1] <= -least + 1e-5);
        }
        // no more where axes are only renamed, and of what is exact
        const std::string turn = fmt::format(".rotate({}deg, axis: Z).offset(1)", angle);
        if (std::fmod(angle, 90) == 0) CHECK(reach(cube + turn).hi[0] < 2.001);
        CHECK(reach("box(2)" + turn).hi[0] < least / 2 + 1.001);
    }
    const ir::Box all = reach(cube + ".rotate(54.7356deg, axis: [1, -1, 0]).offset(1)");
    CHECK(std::max({all.hi[0], all.hi[1], all.hi[2]}) >= 2 * std::sqrt(3.0) - 1e-3);
}

TEST_CASE("a region in a region is asked where its nearest points are") {
    for (const std::string around : {"aabb([5, -3, -3], [6, 3, 3])",
                                     "aabb([0.9, -3, -3], [3, 3, 3])", "ball(0.5, at: [2, 0, 0])",
                                     "aabb([0.6, -3, -3], [3, 3, 3]) - ball(0.2, at: [1.5, 0, 0])"})
        for (const std::string inner :
             {"ball(1)", "aabb([-1, -1, -1], [1, 1, 1])", "tube(Z, 1)", "ball(1) - ball(0.3)"}) {
            const std::string steep =
                fmt::format("implicit(p => length(p - [1, 0, 0]) - 0.2 + 5*max(0.7 - p.x, 0)*(1 + "
                            "sin(20*p.y)), within: {}).within({})",
                            inner, around);
            holds(steep, {-3, -3, -3}, {8, 3, 3}, false);
            holds(steep + ".offset(2)", {-3, -3, -3}, {8, 3, 3}, false);
        }
    holds("implicit(p => length(p) - 0.2 + 5*sin(20*p.y), within: ball(1))"
          ".within(aabb([5, -3, -3], [6, 3, 3])).offset(5)",
          {-3, -3, -3}, {8, 3, 3});
}

TEST_CASE("lever arms of what a fold mirrors are those of what lies behind it, too") {
    for (const double at : {-5.0, -1.0, 2.0})
        for (const std::string fold : {"turnaround(X)", "elongate([1, 0, 0])"})
            for (const std::string turn :
                 {"twist(1)", "bend(0.3, axis: Y, towards: X)", "taper(0.4, from: -1, to: 1)"})
                holds(fmt::format("sphere(1).translate(x: {}).{}.{}.offset({})", at, fold, turn,
                                  std::max(-at - 0.5, 0.1)),
                      {-6, -3, -6}, {6, 3, 6}, false);
}

TEST_CASE("what is deformed in its own box is asked there, whatever the region") {
    const std::string steep =
        "implicit(p => (length(p - [0, 3.5, 0]) - 0.5)*(1 + 4*clamp(p.y - 2, 0, 2)))";
    for (const std::string turn :
         {"twist(0.2)", "twist(0.2, axis: Z)", "bend(0.1, axis: Y, towards: X)",
          "taper(0.8, from: -3, to: 5)", "distort(p => p + [0.2*sin(p.y), 0, 0])"})
        for (const std::string region : {"tube(X, 1)", "tube(Z, 1)", "aabb([-1,-1,-1], [1,1,1])",
                                         "aabb([-9,-1,-9], [9,30,9])"})
            for (const std::string by : {"0.1", "4"})
                holds(fmt::format("{}.{}.offset({}).within({})", steep, turn, by, region),
                      {-2, -2, -2}, {2, 6, 2}, false);
}

TEST_CASE("a twist's measured bound has the twist's sign") {
    // a wall that leans along the axis as a screw does, with or against the twist
    const std::array<std::string, 3> names{"x", "y", "z"};
    for (std::size_t a = 0; a < 3; ++a)
        for (const double rate : {2.0, -2.0})
            for (const double lean : {2.0, -2.0}) {
                const std::string w = names[a], u = names[(a + 1) % 3], v = names[(a + 2) % 3];
                const std::string wall = fmt::format(
                    "implicit(p => max(0.5*(p.{0} + {3}*clamp(p.{2}, -0.3, 0.3)*clamp(p.{1}, -3, "
                    "3)), max(abs(p.{2}) - 0.2, length([p.{0}, p.{1}]) - 2)))",
                    u, v, w, lean);
                const std::string axis(1, "XYZ"[a]);
                holds(fmt::format("{}.twist({}, axis: {}).offset(0.01)", wall, rate, axis),
                      {-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5});
                holds(fmt::format("{}.twist({}, axis: {}).taper(0.8, axis: {}, from: -0.2, to: "
                                  "0.2).offset(0.01)",
                                  wall, rate, axis, axis),
                      {-2.5, -2.5, -2.5}, {2.5, 2.5, 2.5}, false);
            }
}

TEST_CASE("an axis is renamed by whole quarter turns, and not by nearly none") {
    const auto bound = [](const std::string &text) {
        INFO(text);
        const driver::Compilation made = compiled(text);
        CHECK(!made.diagnostics.has_errors());
        return made.scene.facts[made.scene.root.index].lipschitz_sup;
    };
    const std::string rod = "capsule([-20, 0, 0], [20, 0, 0], 0.002)";
    for (const int quarters : {0, 1, 2, 3, 4, 40, -7})
        for (const std::string axis : {"Y", "Z"}) {
            const std::string along = quarters % 2 == 0 ? "X" : axis == "Y" ? "Z" : "Y";
            CHECK(bound(fmt::format("{}.rotate({}deg, axis: {}).twist(50, axis: {})", rod,
                                    90 * quarters, axis, along)) < 1.06);
        }
    for (const double angle : {1.4e-6, -1.4e-6, 1e-7, 1e-9}) {
        const double s = 50 * (20 * std::fabs(angle) + 0.002);
        const std::string turned = fmt::format("{}.rotate({}, axis: Z)", rod, angle);
        CHECK(bound(turned + ".twist(50, axis: X)") >= (s + std::sqrt(s * s + 4)) / 2 - 1e-6);
    }
    // copies' neighbours fit where the motif is its own mirror image
    CHECK(!compiled("box([1, 0.5, 1]).rotate(180deg, axis: Z).repeat([1, 0, 0])")
               .diagnostics.has_errors());
    holds("box([1000, 0.0005, 1]).rotate(1.4e-6, axis: Z).repeat([1000, 0, 0])",
          {499.9, -0.003, -0.1}, {500.1, 0.003, 0.1}, false);
}

TEST_CASE("a profile's edges on the axis are opened where the axis has it on one side") {
    // The flat shape's sign is the turned one's, on the side that is asked.
    for (const auto &[profile, offset] : std::vector<std::pair<std::string, double>>{
             {"polygon([[-1,-1],[0,-1],[0,1],[1,1],[1,-2],[-1,-2]])", 0},
             {"polygon([[-2,0],[0,0],[0,1],[1,1],[1,-1],[-2,-1]])", 0},
             {"polygon([[-2,0],[-0.5,0],[-0.5,1],[1,1],[1,-1],[-2,-1]])", 0.5},
             {"(polygon([[0,-1],[0,1],[-1,1],[-1,-1]]) | polygon([[0,2],[1,2],[1,3],[0,3]]))", 0},
             {"polygon([[0,-1],[0,1],[-1,1],[-1,-1]]).reflect([1,0])", 0},
             {"polygon([[0,-1],[0,1],[-1,1],[-1,-1]]).scale([-1,1])", 0},
             {"polygon([[0,-1],[0,1],[1,1],[1,-1]]).reflect([0,1])", 0},
             {"polygon([[1,-1],[1,1],[0,1],[0,-1]]).reflect([1,0]).translate(x: 1)", 0},
             {"polygon([[0,0],[1,0],[1,1],[0,1]]).rotate(90deg).translate(x: 1)", 0},
             {"polygon([[0,-1],[1,0],[0,1]])", 0}}) {
        const std::string text = fmt::format("{}.revolve({})", profile, offset);
        holds(text, {-3, -3, -3}, {3, 4, 3});
        Sampler solid(compiled(text).scene), flat(compiled(profile + ".extrude(100)").scene);
        std::vector<Point3> there, here;
        for (int i = 0; i < 4000; ++i) {
            const Point3 p = solid.in_box({0, -3, 0}, {3, 4, 6.28});
            there.push_back({p[0] * std::cos(p[2]), p[1], p[0] * std::sin(p[2])});
            here.push_back({p[0] - offset, p[1], 0});
        }
        const std::vector<float> a = solid.values(there), b = flat.values(here);
        int different = 0;
        for (std::size_t i = 0; i < a.size(); ++i)
            different += a[i] * b[i] < 0 && std::fabs(a[i]) > 1e-3 && std::fabs(b[i]) > 1e-3;
        CHECK(different == 0);
    }
}
