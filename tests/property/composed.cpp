// Fields of what is moved, turned or folded (proof/composed.h): each function of a list at each place
// of a list has the bound that it has at the origin, times what the place makes steeper, and no
// steeper slope. What jumps does so wherever it stands.
#include "driver/compile.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Text {
    const char *name, *text;
};

// A function f of its own, 1-Lipschitz.
constexpr Text functions[] = {
    {"cone", "fn f(p: vec3) -> float {\n"
             "  let q = 1.2 * vec2(0.75, -1)\n  let w = vec2(length(p.xz), p.y)\n"
             "  let a = w - q * clamp(dot(w, q) / dot(q, q), 0, 1)\n"
             "  let b = w - q * vec2(clamp(w.x / q.x, 0, 1), 1)\n  let k = sign(q.y)\n"
             "  let d = min(dot(a, a), dot(b, b))\n"
             "  let s = max(k * (w.x * q.y - w.y * q.x), k * (w.y - q.y))\n"
             "  sqrt(d) * sign(s)\n}\n"},
    {"capped torus",
     "fn f(point: vec3) -> float {\n  let sc = vec2(sin(1.2), cos(1.2))\n"
     "  let p = vec3(abs(point.x), point.y, point.z)\n"
     "  let k = if sc.y * p.x > sc.x * p.y { dot(p.xy, sc) } else { length(p.xy) }\n"
     "  sqrt(dot(p, p) + 0.81 - 1.8 * k) - 0.2\n}\n"},
    {"link", "fn f(p: vec3) -> float {\n  let q = vec3(p.x, max(abs(p.y) - 0.4, 0), p.z)\n"
             "  length(vec2(length(q.xy) - 0.5, q.z)) - 0.15\n}\n"},
    {"smooth union", "fn f(p: vec3) -> float {\n"
                     "  let a = length(p - vec3(0.3, 0, 0)) - 0.5\n"
                     "  let q = abs(p - vec3(0, 0.2, 0)) - vec3(0.4, 0.6, 0.3)\n"
                     "  let b = length(max(q, 0)) + min(max(q.x, max(q.y, q.z)), 0)\n"
                     "  let h = max(0.2 - abs(a - b), 0) / 0.2\n  min(a, b) - h * h * 0.05\n}\n"},
    {"slab", "fn f(p: vec3) -> float = max(abs(p.x) - 0.5, abs(p.z) - 0.4)\n"},
};

struct Place {
    const char *name, *text; // of `place`, from f
    double steep = 1;
    bool moves = false; // with the time
};
constexpr Place places[] = {
    {"turned about y", "f(vec3(cos(0.6)*p.x - sin(0.6)*p.z, p.y, sin(0.6)*p.x + cos(0.6)*p.z))"},
    {"tilted", "f(vec3(cos(0.6)*p.x - sin(0.6)*p.y, sin(0.6)*p.x + cos(0.6)*p.y, p.z))"},
    {"turned with the time about y",
     "f(vec3(cos(time)*p.x - sin(time)*p.z, p.y, sin(time)*p.x + cos(time)*p.z))", 1, true},
    {"turned with the time about z, away from the axis",
     "f(vec3(cos(time)*p.x - sin(time)*p.y - 0.4, sin(time)*p.x + cos(time)*p.y, p.z + 0.2))", 1,
     true},
    {"in a frame", "f(vec3(dot(p, vec3(0.6, 0.8, 0)), dot(p, vec3(-0.8, 0.6, 0)), p.z - 0.2))"},
    {"in a frame that turns with the time",
     "f(vec3(dot(p, vec3(cos(time), sin(time), 0)), dot(p, vec3(-sin(time), cos(time), 0)), p.z))",
     1, true},
    {"across a direction", "f(cross(vec3(0, 0.6, 0.8), p) + vec3(0.1, 0, 0))"},
    {"between mirrors", "f(vec3(abs(mod(p.x + 0.7, 1.4) - 0.7) - 0.2, p.y, p.z))"},
    {"folded", "f(vec3(abs(p.x) - 0.5, p.y, abs(p.z) - 0.3))"},
    {"made smaller", "f(1.5 * vec3(p.y, p.z - 0.2, p.x)) / 1.5"},
    {"not made smaller", "f(1.5 * vec3(p.z - 0.1, p.x, p.y))", 1.5},
    {"with others",
     "min(f(vec3(cos(time)*p.x - sin(time)*p.y, sin(time)*p.x + cos(time)*p.y, p.z)),"
     " length(p - vec3(0.5, 0, 0)) - 0.3)",
     1, true},
    {"in a smooth union",
     "smooth_min(f(vec3(cos(0.6)*p.x - sin(0.6)*p.y, sin(0.6)*p.x + cos(0.6)*p.y, p.z)),"
     " f(p + vec3(0.8, 0, 0)), 0.2)"},
    {"less its own depth",
     "f(vec3(cos(time)*p.x - sin(time)*p.z, p.y, sin(time)*p.x + cos(time)*p.z))"
     " - 0.2 * p.y",
     1.2, true},
};

std::string placed(const Text &function, const std::string &at, const char *claim) {
    return std::string("fn smooth_min(a, b, k) {\n  let h = max(k - abs(a - b), 0) / k\n"
                       "  min(a, b) - h * h * k / 4\n}\n") +
           function.text + "fn place(p: vec3) -> float = " + at + "\nimplicit(place, " + claim +
           ")\n";
}

std::optional<double> bound(const std::string &text) {
    const driver::Compilation c = driver::compile_text("placed.sdf", text, "", {});
    if (!c.good()) return {};
    double most = 0;
    for (std::size_t i = 0; i < c.scene.shapes.size(); ++i)
        if (c.scene.shapes[ir::ShapeId{i}].kind == ir::ShapeKind::Leaf)
            most = std::max(most, c.scene.facts[i].lipschitz_sup);
    return most;
}

double steepest(const std::string &text, double time) {
    const driver::Compilation c = driver::compile_text("placed.sdf", text, "", {});
    REQUIRE(c.good());
    Sampler sampler(c.scene, time);
    double out = 0;
    for (const double apart : {1e-2, 0.3}) {
        std::vector<Point3> p, q;
        for (int i = 0; i < 4'000; ++i) {
            p.push_back(sampler.in_ball({0, 0, 0}, 1.9));
            q.push_back(sampler.in_ball(p.back(), apart));
        }
        const std::vector<float> a = sampler.values(p), b = sampler.values(q);
        for (std::size_t i = 0; i < p.size(); ++i) {
            const double run = std::hypot(p[i][0] - q[i][0], p[i][1] - q[i][1], p[i][2] - q[i][2]);
            if (run > 0.2 * apart)
                out = std::max(out, (std::fabs(double(a[i]) - b[i]) - 2e-6) / run);
        }
    }
    return out;
}

} // namespace

TEST_CASE("what is placed is as steep as where it stands, times its place") {
    for (const Text &function : functions)
        for (const Place &place : places) {
            INFO(function.name << " " << place.name);
            const auto proved = bound(placed(function, place.text, "within: ball(2)"));
            REQUIRE(proved);
            CHECK(*proved <= 1.01 * place.steep);
            for (const double time : {0.0, 0.7, 4.0})
                if (place.moves || time == 0)
                    CHECK(steepest(placed(function, place.text, "estimate: 1"), time) <=
                          *proved * (1 + 1e-4));
        }
}

TEST_CASE("what jumps does so wherever it stands") {
    constexpr Text jumping[] = {
        {"a step", "fn f(p: vec3) -> float = length(p) - 1 + (if p.x > 0.1 { 0.2 } else { 0 })\n"},
        {"arms that nearly meet",
         "fn f(p: vec3) -> float = if p.x > 0 { length(p) - 1 } else { length(p.yz) - 0.99 }\n"},
        {"a repetition of one half",
         "fn f(p: vec3) -> float = length(vec3(mod(p.x, 1) - 0.3, p.y, p.z)) - 0.2\n"},
    };
    for (const Text &function : jumping)
        for (const Place &place : places) {
            if (std::string(place.name) == "between mirrors") continue; // may leave no jump
            INFO(function.name << " " << place.name);
            CHECK_FALSE(bound(placed(function, place.text, "within: ball(2)")));
        }
}

TEST_CASE("a field that also reads the point itself is no field of what is placed") {
    constexpr std::array<const char *, 3> beside{"q.x + 0.8 * q.z + p.x",
                                                 "length(q) + 0.5 * length(p - vec3(1, 0, 0)) - 1",
                                                 "max(q.x, p.z) + 0.3 * q.z"};
    for (const char *body : beside) {
        const std::string of =
            std::string("fn f(q: vec3, p: vec3) -> float = ") + body +
            "\nfn place(p: vec3) -> float = f(vec3(cos(time)*p.x - sin(time)*p.z, p.y, "
            "sin(time)*p.x + cos(time)*p.z), p)\nimplicit(place, ";
        INFO(body);
        const auto proved = bound(of + "within: ball(2))\n");
        REQUIRE(proved);
        for (int i = 0; i < 12; ++i)
            CHECK(steepest(of + "estimate: 1)\n", 0.5 * i) <= *proved * (1 + 1e-4));
    }
}

namespace {

// A function g of a distance r and its square rr, and of a coordinate y beside it.
struct Profile {
    const char *text;
    double slope;
};
constexpr Profile profiles[] = {
    {"0.35 - max(1 - rr, 0) ^ 3", 1.7174},
    {"exp(-rr) + 0.2 * y", 0.8808}, // sqrt(2/e), and 0.2 at right angles to it
    {"length(vec2(r - 1, y)) - 0.3", 1},
    {"rr / (1 + rr) - max(0.3 - rr, 0)", 1.7436},
    {"min(abs(sin(3 * r)) / 3, max(r, abs(y)))", 1},
};
// … and where they are measured.
constexpr const char *spellings[] = {
    "let rr = dot(q, q)\n  let r = length(q)",
    "let rr = q.x * q.x + q.y * q.y + q.z * q.z\n  let r = sqrt(rr)",
};
constexpr const char *centres[] = {
    "p",
    "p - vec3(sin(time), 0.5 * cos(1.7 * time), 0.3)",
    "vec3(cos(time)*p.x - sin(time)*p.z, p.y, sin(time)*p.x + cos(time)*p.z) - vec3(0.5, 0, 0)",
    "p - vec3(slider, 0, slider)",
    "abs(p) - vec3(0.4, slider, 0.2)",
};

std::string measured(const Profile &profile, const char *centre, const char *spelling, bool axis,
                     const char *claim) {
    return "param slider = 0.2 in -1..1\nimplicit(p => {\n  let at = " + std::string(centre) +
           "\n  let q = at * " +
           (axis ? "vec3(1, 0, 1)\n  let y = at.y\n  " : "1\n  let y = 0\n  ") + spelling + "\n  " +
           profile.text + " }, " + claim + ")\n";
}

} // namespace

TEST_CASE("what reads the point through a distance is as steep as its profile") {
    for (const Profile &profile : profiles)
        for (const char *centre : centres)
            for (const char *spelling : spellings)
                for (const bool axis : {false, true}) {
                    const std::string text =
                        measured(profile, centre, spelling, axis, "within: ball(2)");
                    INFO(text);
                    const auto proved = bound(text);
                    REQUIRE(proved);
                    CHECK(*proved <= 1.03 * profile.slope);
                    const std::string free =
                        measured(profile, centre, spelling, axis, "estimate: 1");
                    for (const double time : {0.0, 0.7, 4.0})
                        CHECK(steepest(free, time) <= *proved * (1 + 1e-4));
                }
}

TEST_CASE("what reads a distance and what it is of is no field of the distance") {
    constexpr std::array<const char *, 4> beside{
        "length(q) + 0.8 * q.x", "dot(q, q) - q.x * q.x + 0.3 * length(q.xy)",
        "length(q.xz) + sin(2 * length(q))", "max(1 - dot(q, q), 0) * (1 + p.y)"};
    for (const char *body : beside) {
        const std::string text = std::string("implicit(p => {\n  let q = p - vec3(sin(time), 0, 0)"
                                             "\n  ") +
                                 body + " }, ";
        INFO(body);
        const auto proved = bound(text + "within: ball(2))\n");
        REQUIRE(proved);
        for (int i = 0; i < 12; ++i)
            CHECK(steepest(text + "estimate: 1)\n", 0.5 * i) <= *proved * (1 + 1e-4));
    }
    for (const char *jumps : {"floor(2 * length(q))", "fract(dot(q, q))"})
        CHECK_FALSE(bound(std::string("implicit(p => {\n  let q = p - vec3(sin(time), 0, 0)\n  ") +
                          jumps + " - 0.5 }, within: ball(2))\n"));
}

namespace {

// A height over a place q in the plane, and its steepest slope by q.
struct Height {
    const char *text;
    double slope;
};
constexpr Height heights[] = {
    {"pow(1 - (1 - abs(sin(q.x))) * (abs(sin(q.x)) + abs(cos(q.x))), 4)", 3.3},
    {"abs(sin(q.x)) * cos(q.y)", 1},
    {"exp(-abs(sin(q.x)) - abs(sin(q.y)))", 1.4143},
    {"max(sin(q.x) * sin(q.y), 0.3 * cos(q.x + q.y))", 1},
};
// … and which place that is, with what makes it steeper.
struct Ground {
    const char *text;
    double steep;
};
constexpr Ground grounds[] = {
    {"2 * p.xz + 0.5 * time", 2},
    {"3 * rotate2(p.zx, 0.4) - vec2(time, 0.3 * slider)", 3},
    {"rotate2(2 * p.xz, time) + slider", 2},
};

} // namespace

TEST_CASE("a sum of two that read other coordinates is as steep as both at right angles") {
    for (const Height &height : heights)
        for (const Ground &ground : grounds)
            for (const char *field :
                 {"p.y - 0.3 * h", "-0.8 * (p.y + 0.3 * h)",
                  // what reads the same coordinates is no such sum
                  "p.y - 0.3 * h - 0.4 * p.x", "p.y - 0.3 * h * (1 + 0.2 * p.y)"}) {
                const std::string text =
                    "param slider = 0.2 in -1..1\nimplicit(p => {\n  let q = " +
                    std::string(ground.text) + "\n  let h = " + height.text + "\n  " + field +
                    " }, ";
                INFO(text);
                const auto proved = bound(text + "within: ball(2))\n");
                REQUIRE(proved);
                const std::string said = field;
                const double both = std::hypot(1, 0.3 * height.slope * ground.steep);
                if (said == "p.y - 0.3 * h") CHECK(*proved <= 1.15 * both);
                if (said.starts_with("-0.8")) CHECK(*proved <= 1.15 * 0.8 * both);
                for (const double time : {0.0, 0.7, 4.0})
                    CHECK(steepest(text + "estimate: 1)\n", time) <= *proved * (1 + 1e-4));
            }
}

TEST_CASE("a part reads the coordinates that its loops read") {
    const std::string text = "param k = 0.5 in 0.3..0.7\nfn rope(p: vec3) -> float {\n"
                             "  var d = 10.0\n  for i in 0..3 {\n"
                             "    let a = 3 * p.y + 2 * pi / 3 * i\n"
                             "    let q = vec2(cos(a) * p.x + sin(a) * p.z, "
                             "cos(a) * p.z - sin(a) * p.x)\n"
                             "    d = min(d, length(q - vec2(0.3, 0)) - 0.15)\n  }\n  d\n}\n"
                             "implicit(p => max(rope(p - vec3(k, 0, 0.35)), p.y - k), ";
    const auto proved = bound(text + "within: ball(2))\n");
    REQUIRE(proved);
    CHECK(steepest(text + "estimate: 1)\n", 0) <= *proved * (1 + 1e-4));
}
