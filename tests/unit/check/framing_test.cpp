// A view without a camera frames the solid itself, however its text says it.
#include "compiled.h"

#include "ir/view.h"

#include <catch2/catch.hpp>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include <array>
#include <cmath>

using namespace fathom;

namespace {

driver::Compilation framed(const std::string &text) {
    driver::Compilation made = test::compiled(text);
    INFO(text);
    REQUIRE(made.good());
    return made;
}

bool told(const driver::Compilation &made) {
    for (const Diagnostic &d : made.diagnostics.items())
        if (d.code == Code::NothingFramed) return true;
    return false;
}

// Each side of what is framed lies at most `share` of the box's diagonal from what is wanted, and
// outward.
void check_frame(const std::string &text, const std::array<double, 3> &lo,
                 const std::array<double, 3> &hi, double share = 0.005) {
    const driver::Compilation made = framed(text);
    const ir::Box &box = made.scene.framed;
    INFO(text);
    INFO("framed [" << box.lo[0] << ", " << box.lo[1] << ", " << box.lo[2] << "] to [" << box.hi[0]
                    << ", " << box.hi[1] << ", " << box.hi[2] << "]");
    const double by = share * std::hypot(hi[0] - lo[0], hi[1] - lo[1], hi[2] - lo[2]);
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(box.lo[i] == Approx(lo[i]).margin(by));
        CHECK(box.hi[i] == Approx(hi[i]).margin(by));
    }
    CHECK(!told(made));
}

} // namespace

TEST_CASE("texts of one solid are framed equally") {
    const std::vector<std::vector<std::string>> solids{
        {"box(2)",
         "plane([1, 0, 0], 1) & plane([-1, 0, 0], 1) & plane([0, 1, 0], 1) & plane([0, -1, 0], 1) "
         "& plane([0, 0, 1], 1) & plane([0, 0, -1], 1)",
         "slab(2) & slab(2, axis: X) & slab(2, axis: Z)", "box([2, 2, 50]) & slab(2, axis: Z)",
         "box(2) | (box(40) & sphere(1).translate(x: 1000))", "box(9) & box(2)",
         "box(2)\nplane(Y, -1)", "box(2) | plane(Y, -1)", "(box(1) | plane(Y, -0.5)).scale(2)",
         "(box(4) | plane(Y, -2)).scale([0.5, 0.5, 0.5]) - box(0.5)",
         "smooth_union(0.2, box(2), plane(Y, -1))", "(box([2, 4, 2]) | plane(Y, -3)) & slab(2)",
         "(box(2).translate(x: -7) | plane(Y, -1)).paint(#ff0000).translate(x: 7)",
         "param s = 2 in 1.0..50.0\nbox(s)", "param s = 0 in -30.0..30.0\nbox(2).translate(x: s)",
         "implicit(p => max(abs(p.x), max(abs(p.y), abs(p.z))) - 1, within: ball(30))"},
        {"sphere(1) & plane(-Y, -0.5)", "sphere(1) - plane(Y, 0.5)",
         "sphere(1) - box([9, 9, 9]).translate(y: -4)"},
    };
    for (const std::vector<std::string> &texts : solids) {
        const auto distance_of = [](const std::string &text) {
            return ir::view_of(framed(text).scene, 0, 1).focus;
        };
        const double first = distance_of(texts.front());
        for (const std::string &text : texts) {
            INFO(text);
            CHECK(distance_of(text) == Approx(first).epsilon(0.01));
        }
    }
}

TEST_CASE("the solid fills what is framed") {
    check_frame("box([1, 1, 1000]).shell(0.1) & slab(2)", {-0.55, -0.55, -500.05},
                {0.55, 0.55, 500.05});
    check_frame("box([1, 1, 1000]).shell(0.1) & slab(2, axis: Z)", {-0.55, -0.55, -1},
                {0.55, 0.55, 1});
    check_frame("sphere(10) & plane(-Y, -9)", {-4.3589, 9, -4.3589}, {4.3589, 10, 4.3589});
    check_frame("smooth_union(0.5) { sphere(1); sphere(1).translate(x: 5) }", {-1, -1, -1},
                {6, 1, 1});
    check_frame("sphere(0.001)", {-0.001, -0.001, -0.001}, {0.001, 0.001, 0.001});
    check_frame("sphere(5000)", {-5000, -5000, -5000}, {5000, 5000, 5000});
    check_frame("sphere(1).shell(0.001)", {-1, -1, -1}, {1, 1, 1});
    check_frame("implicit(p => p.x*p.x + 2*p.y*p.y + p.z*p.z - 1, within: ball(3))",
                {-1, -0.7071, -1}, {1, 0.7071, 1});
    check_frame("sphere(0.3).repeat(cell: 1) & box([20, 1, 1])", {-10, -0.3, -0.3}, {10, 0.3, 0.3});
    check_frame("param r = 1.0 in 0.5..50.0\nsphere(r)", {-1, -1, -1}, {1, 1, 1});
    check_frame("sphere(1)\nsphere(1).translate(x: 9)\nplane(Y, -1)\nslab(2, axis: X)",
                {-1, -1, -1}, {10, 1, 1});
    check_frame("sphere(1).translate([3 * sin(time), 0, 0])", {-4, -1, -1}, {4, 1, 1}, 0.02);
}

TEST_CASE("the solid fills nine tenths of the picture's height or width") {
    // Where points of the surface stand in the picture; 1 is at its edge.
    const auto fills = [](const driver::Compilation &made, double aspect,
                          const std::vector<glm::dvec3> &points) {
        const double width = std::min(aspect, 4.0 / 3);
        const ir::View view = ir::view_of(made.scene, 0, aspect);
        double most = 0;
        for (const glm::dvec3 &point : points) {
            const glm::dvec3 from = point - view.origin;
            const double deep = glm::dot(from, view.forward);
            REQUIRE(deep > 0);
            most = std::max({most, std::abs(glm::dot(from, view.up)) / (deep * view.extent),
                             std::abs(glm::dot(from, view.right)) / (deep * view.extent * width)});
        }
        return most;
    };
    std::vector<glm::dvec3> ball, box, pair;
    for (int i = 0; i < 4000; ++i) {
        const double y = 1 - 2 * (i + 0.5) / 4000, r = std::sqrt(1 - y * y), turn = 2.399963 * i;
        ball.emplace_back(r * std::cos(turn), y, r * std::sin(turn));
        pair.push_back(ball.back());
        pair.push_back(0.1 * ball.back() + glm::dvec3(6, 0, -2));
    }
    for (int k = 0; k < 8; ++k)
        box.emplace_back((k & 1) ? 2 : -2, (k & 2) ? 0.25 : -0.25, (k & 4) ? 1 : -1);
    const std::pair<std::string, std::vector<glm::dvec3>> solids[] = {
        {"sphere(1)", ball},
        {"box([4, 0.5, 2])", box},
        {"sphere(1)\nsphere(0.1).translate([6, 0, -2])", pair},
        {"implicit(p => length(p) - 1, within: ball(30))", ball}};
    for (const auto &[text, points] : solids) {
        const driver::Compilation made = framed(text);
        for (const double aspect : {0.2, 0.6, 1.0, 4.0 / 3, 16.0 / 9, 2.5, 4.0, 7.0}) {
            const double most = fills(made, aspect, points);
            INFO(text << ", aspect " << aspect << ": fills " << most);
            CHECK(most <= 0.9001);
            CHECK(most > 0.82);
        }
    }
}

TEST_CASE("a field is framed alike whatever its region is") {
    for (const char *region :
         {"ball(2.8)", "ball(3.6)", "aabb([-2.3, -2.3, -2.3], [2.3, 2.3, 2.3])"})
        check_frame(std::string("implicit(p => { let q = p * p\n"
                                "dot(q, q) - 5 * (q.x + q.y + q.z) + 11.8 }, within: ") +
                        region + ")",
                    {-2.26, -2.26, -2.26}, {2.26, 2.26, 2.26}, 0.01);
}

TEST_CASE("of many parts the solid fills what is framed") {
    std::string halves, moving;
    for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
            const std::string place =
                fmt::format("[{}, {}, {}]", 3 * i, (7 * i + 5 * j) % 12, 3 * j);
            // whose bounds are that of the sphere
            halves += fmt::format("(sphere(1) & plane(-Y, -0.5)).translate({})\n", place);
            moving += fmt::format("sphere(1).translate({} + [s, 0, 0])\n", place);
        }
    const double r = std::sqrt(0.75);
    check_frame(halves, {-r, 0.5, -r}, {33 + r, 12, 33 + r});
    check_frame("union {\n" + halves + "}\n", {-r, 0.5, -r}, {33 + r, 12, 33 + r});
    check_frame(halves + "plane(Y, -9)\n", {-r, 0.5, -r}, {33 + r, 12, 33 + r});
    check_frame("param s = 1.0 in -50.0..50.0\n" + moving, {0, -1, -1}, {35, 12, 34});
    // a part that is far out by its bounds, a lens of 0.02 by 0.0001; and an empty one
    check_frame(halves + "(sphere(1) & sphere(1).translate(x: 1.9999)).translate(x: 90)\n"
                         "(box(4) - box(6)).translate(x: -90)\n",
                {-r, -0.01, -r}, {91, 12, 33 + r});
}

TEST_CASE("a field too dear to be searched is framed by its box") {
    const std::string loops =
        "implicit(p => {\n var s = p.y\n for i in 0..600 { for j in 0..600 { s = s + sin(i * p.x "
        "+ j) } }\n length(p) - 1 + 0.0000001 * s\n}, lipschitz: 5, within: ball(3))";
    const driver::Compilation made = framed(loops);
    CHECK(!told(made));
    CHECK(made.scene.framed.hi[0] == Approx(3).epsilon(0.01));
}

TEST_CASE("shapes that share their parts are opened so far and no further") {
    const driver::Compilation made =
        framed("fold(0..14, gyroid(1, 0.1), (s, i) => s | s.translate(x: 0.01 * 2 ^ i))");
    CHECK(made.scene.framed_alone.size() == 1); // of 16,384 places
}

TEST_CASE("what moves is framed at the moment of a still, and over the frames of a film") {
    const std::string ball = "sphere(0.5).translate(x: time)\n";
    const auto at = [](const std::string &text, double first, double last) {
        driver::CompileOptions options;
        options.times = {first, last};
        const auto made = driver::compile_text("scene.sdf", text, "", options);
        REQUIRE(made.good());
        CHECK(!told(made));
        return made.scene.framed;
    };
    for (const std::string &text : {ball, ball + "box(1)\n"}) {
        INFO(text);
        CHECK(at(text, 6, 6).hi[0] == Approx(6.5).margin(0.1));
        CHECK(at(text, 0, 12).hi[0] > 11.5); // one of the moments that are looked at
    }
    CHECK(at(ball, 6, 6).lo[0] == Approx(5.5).margin(0.1));
}

TEST_CASE("what stands on the ground of one's own field is framed") {
    const auto framed = [](const std::string &ground, const std::string &part) {
        const auto c =
            compiled("implicit(p => min(" + ground + ", " + part + "), within: everywhere)\n");
        REQUIRE(c.good());
        CHECK(c.diagnostics.items().empty());
        return c.scene.framed;
    };
    const ir::Box ball = framed("p.y", "length(p - vec3(9, 1, -6)) - 1");
    const std::array<double, 3> lo{8, 0, -7}, hi{10, 2, -5};
    for (std::size_t i = 0; i < 3; ++i) {
        CHECK(ball.lo[i] == Approx(lo[i]).margin(0.1));
        CHECK(ball.hi[i] == Approx(hi[i]).margin(0.1));
    }
    const ir::Box above = framed("p.y - 0.2*sin(p.x)*sin(p.z) + 3", "length(p - X) - 1");
    CHECK(above.lo[1] < -2.8);
    CHECK(above.hi[1] == Approx(1).margin(0.1));
    // a row of balls without an end, walls, and hills alone have nothing of the kind
    for (const std::string field :
         {"min(p.y, length(vec3(p.x - 4*round(p.x/4), p.y - 1, p.z)) - 1)", "abs(p.x) - 0.1",
          "p.y - 0.3*sin(p.x) - 0.3*sin(p.z)"}) {
        const auto c = compiled("implicit(p => " + field + ", within: everywhere)\n");
        REQUIRE(c.good());
        REQUIRE(c.diagnostics.items().size() == 1);
        CHECK(code_name(c.diagnostics.items()[0].code) == "nothing-framed");
    }
}

TEST_CASE("what has no end is seen from outside") {
    const auto begins = [](const std::string &text) {
        const driver::Compilation made = framed(text);
        CHECK(told(made));
        return ir::view_of(made.scene, 0, 1.5).origin;
    };
    // Hills about a height of 3 and of 40, up to 2 higher; a lattice, outside of its balls.
    for (const double height : {-3.0, 3.0, 40.0}) {
        INFO(height);
        const glm::dvec3 eye =
            begins(fmt::format("implicit(p => 0.5 * (p.y - {} - 2 * sin(p.x) * cos(p.z)), "
                               "within: everywhere)",
                               height));
        CHECK(eye.y - height > 2.5);
    }
    CHECK(begins("plane(Y, 0)") == begins("plane(Y, -1)"));
    const glm::dvec3 eye = begins("sphere(1).repeat([3, 3, 3])");
    CHECK(glm::length(eye - 3.0 * glm::round(eye / 3.0)) > 1);
    CHECK(begins("plane(Y, 1e9)").y < 1e9); // nowhere: as near the origin as ever
}

TEST_CASE("what cannot be framed is told, and what to write") {
    for (const char *text : {"plane(Y, 0)", "plane(Y, 0) - sphere(1)", "gyroid(1, 0.1)", "slab(1)",
                             "sphere(0.2).repeat(cell: 1)", "sphere(1) & sphere(1).translate(x: 5)",
                             "sphere(1) - box(4)", "plane(Y, -1) & plane(-Y, -1)", "empty"}) {
        INFO(text);
        CHECK(told(framed(text)));
    }
    for (const char *text : {"sphere(1)", "plane(Y, 0)\ncamera(at: [3, 2, 5], look_at: [0, 0, 0])",
                             "sphere(1)\nplane(Y, 0)", "let a = 1"}) {
        INFO(text);
        CHECK(!told(framed(text)));
    }
}
