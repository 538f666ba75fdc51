// Distance functions as people bring them along: what is a distance is proved to be one, however
// it is written.
#include "compiled.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

const std::string toolbox = R"(
fn sd_box(p: vec3, b: vec3) -> float {
  let q = abs(p) - b
  length(max(q, 0)) + min(max(q.x, max(q.y, q.z)), 0)
}
fn sd_torus(p: vec3, t: vec2) -> float = length(vec2(length(p.xz) - t.x, p.y)) - t.y
fn rot(a: float) -> mat2 = mat2(cos(a), sin(a), -sin(a), cos(a))
param angle = 0.3 in 0..6
)";

struct Case {
    std::string body;        // of a function of p
    double minimum, maximum; // of the bound
    std::string region = "ball(3)";
};

driver::Compilation field(const Case &test) {
    return compiled(toolbox + "fn own(p: vec3) -> float {\n" + test.body +
                    "\n}\nimplicit(own, within: " + test.region + ")\n");
}

std::string errors(const driver::Compilation &c) {
    std::string out;
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error) out += d.message + "\n";
    return out;
}

double lipschitz(const driver::Compilation &c) {
    return c.scene.facts[c.scene.top_level.at(0).shape.index].lipschitz_sup;
}

void hold(const std::vector<Case> &cases) {
    for (const Case &test : cases) {
        INFO(test.body);
        driver::Compilation c = field(test);
        INFO(errors(c));
        REQUIRE(!c.diagnostics.has_errors());
        CHECK(lipschitz(c) >= test.minimum * (1 - 1e-6));
        CHECK(lipschitz(c) <= test.maximum * (1 + 1e-6));
        const Slopes seen = measure(c.scene, {-3, -3, -3}, {3, 3, 3}, 20'000);
        CHECK(seen.balls > 0);
        CHECK(seen.unsafe == 0); // no step passes a surface
    }
}

} // namespace

TEST_CASE("turning the point by any angle, in any way of writing, costs nothing") {
    hold({
        {"var q = p; q.xz = rotate2(q.xz, time); sd_box(q, [1, 0.5, 0.3])", 1, 1},
        {"var q = p; q.xy = rot(angle) * q.xy; q.yz = q.yz * rot(2 * angle); sd_torus(q, [1, 0.2])",
         1, 1},
        {"let c = cos(angle); let s = sin(angle)\n"
         "sd_box([c * p.x - s * p.z, p.y, s * p.x + c * p.z], [1, 0.5, 0.3])",
         1, 1},
        {"let m = mat3([1, 0, 0], [0, cos(angle), sin(angle)], [0, -sin(angle), cos(angle)])\n"
         "sd_box(transpose(m) * (m * m * p - X), [1, 0.5, 0.3])",
         1, 1},
        // a fold, turned at each of its levels
        {"var q = p; var s = 1.0\n"
         "for i in 0..6 {\n"
         "q = abs(q) - [0.5, 0.4, 0.3]; q.xy = rotate2(q.xy, angle); q.yz = rot(0.7 * i) * q.yz\n"
         "q *= 1.3; s *= 1.3\n"
         "}\n"
         "(length(max(abs(q) - 0.4, 0)) - 0.05) / s",
         1, 1},
        {"let k = normalize([1, 1, 0])\n"
         "let q = p * cos(time) + cross(k, p) * sin(time) + k * dot(k, p) * (1 - cos(time))\n"
         "sd_box(q, [1, 0.5, 0.3])",
         1, 1},
        // a matrix that is made of the point
        {"let m = mat3(normalize(p + [4, 0, 0]), Y, Z); length(m * p) - 1", 0.5, 9},
        // not a turn: a shear, a scale, and an angle that varies
        {"length([p.x + 0.5 * p.y, p.y, p.z]) - 1", 1.28, 1.3},
        {"length([2 * p.x, p.y, p.z]) - 1", 2, 2.01},
        {"var q = p; q.xz = rotate2(q.xz, p.y); length(q - X) - 0.5", 1.5, 4},
    });
}

TEST_CASE("folds and segments cost nothing") {
    hold({
        {"let a = [1, 0, 0]; let b = [-1, 0.4, 0.3]; let pa = p - a; let ba = b - a\n"
         "length(pa - ba * clamp(dot(pa, ba) / dot(ba, ba), 0, 1)) - 0.2",
         1, 1},
        {"var q = p; let n = normalize([1, 0.3, 0.2])\n"
         "for i in 0..6 { q = q - 2 * min(0, dot(q, n)) * n; q.xy = rotate2(q.xy, 0.4) - 0.1 }\n"
         "length(q) - 0.3",
         1, 1},
        {"var q = p; var s = 1.0\n"
         "for i in 0..5 {\n"
         "if q.x + q.y < 0 { q.xy = -q.yx }\nif q.x + q.z < 0 { q.xz = -q.zx }\n"
         "q = q * 2 - 1; s *= 2\n"
         "}\n(length(q) - 1.5) / s",
         1, 1},
        // too far: what lay on the other side lies further off than it was
        {"let n = normalize([1, 2, 0.5]); length(p - 3 * n * min(0, dot(p, n)) - X) - 0.3", 1.9,
         2.6},
        {"let q = p - 0.5 * X * clamp(p.x, -1, 1); length(q) - 1", 1, 1.1},
    });
    CHECK(compiled(
              "fn f(p: vec3) -> float { var q = p; if q.x < 0 { q.x = 1 - q.x }; length(q) - 1 }\n"
              "implicit(f, within: ball(2))\n")
              .diagnostics.has_errors());
}

TEST_CASE("smooth minima by hand are as steep as the steeper") {
    const std::string a = "length(p) - 0.8", b = "abs(p.y) - 0.2";
    const std::string mixed = "let x = " + a + "; let y = " + b + "; let k = 0.3\n" +
                              "let h = clamp(0.5 + 0.5 * (y - x) / k, 0, 1)\n";
    const std::string minimum =
        "let x = " + a + "; let y = " + b + "; let k = 0.3\n" + "let h = max(k - abs(x - y), 0)";
    hold({
        {mixed + "mix(y, x, h) - k * h * (1 - h)", 1, 1},
        {minimum + "\nmin(x, y) - h * h / (4 * k)", 1, 1},
        {minimum + " / k\nmin(x, y) - h * h * k * (1 / 4)", 1, 1},
        {minimum + "\nmax(x, y) + h * h * 0.25 / k", 1, 1},
        {"smin(" + a + ", " + b + ", 0.3)", 1, 1},
        {"smax(2 * (" + a + "), " + b + ", 0.3)", 1.99, 2},
        {"-log(exp(-8 * (" + a + ")) + exp(-8 * (" + b + "))) / 8", 1, 1},
        // another bulge is none
        {mixed + "mix(y, x, h) - 4 * k * h * (1 - h)", 1, 12},
        {minimum + "\nmin(x, y) - h * h / k", 1, 4},
        {mixed + "mix(x, y, h) - k * h * (1 - h)", 1, 40},
    });
    CHECK(!compiled(
               "param k = 0.2 in 0.05..1\n"
               "fn s(a, b, k) {\n"
               "let h = clamp(0.5 + 0.5 * (b - a) / k, 0, 1); mix(b, a, h) - k * h * (1 - h)\n}\n"
               "implicit(p => s(length(p) - 1, length(p - X) - 0.5, k))\n")
               .diagnostics.has_errors());
}

TEST_CASE("parts that depend on different coordinates are as steep as the steepest") {
    hold({
        {"sd_torus(p, [1, 0.2])", 1, 1},
        {"let d = abs(vec2(length(p.xz), p.y)) - [0.5, 1]\n"
         "min(max(d.x, d.y), 0) + length(max(d, 0))",
         1, 1},
        {"let q = p - [0.3, 0.2, 0.1]; let r = vec3(q.y, q.x, q.z) * 0.5; 2 * sd_torus(r, [1, "
         "0.2])",
         1, 1},
        {"sqrt((length(p.xz) - 1)^2 + p.y^2) - 0.2", 1, 1},
        // both of x
        {"length([length(p.xz) - 1, p.x]) - 0.2", 1.4, 1.4143},
    });
}

TEST_CASE("waves round an axis may turn on the way") {
    const std::string off = "ball(2) - tube(Y, 0.4)";
    hold({
        {"max(length(p.xz) - 1 - 0.2 * cos(5 * atan(p.z, p.x) + 2 * p.y), abs(p.y) - 0.3)", 1, 6,
         off},
        {"max(length(p.xz) - 1 - 0.2 * cos(5 * atan(p.z, p.x)), abs(p.y) - 0.3)", 1, 6, off},
        {"let a = atan(p.z, p.x); let r = length(p.xz)\n"
         "max(abs(p.y - 0.1 * sin(3 * (a + r) + time)) - 0.1, r - 1)",
         1, 6, off},
    });
    CHECK(!compiled("param n = 5 in 3..9\n"
                    "implicit(p => length(p.xz) - 1 - 0.1 * cos(n * atan(p.z, p.x)), "
                    "within: ball(2) - tube(Y, 0.4))\n")
               .diagnostics.has_errors());
    for (const std::string wave : {"sin(2.5 * atan(p.z, p.x) + p.y)", "sin(atan(p.z, p.x) / 2)",
                                   "cos(3 * atan(p.z, p.x)) * atan(p.z, p.x)"}) {
        INFO(wave);
        CHECK(compiled("implicit(p => length(p.xz) - 1 - 0.1 * " + wave +
                       ", within: ball(2) - tube(Y, 0.4))\n")
                  .diagnostics.has_errors());
    }
    // what is masked has no slope at the axis
    CHECK(!compiled("sphere(1).displace(p => 0.1 * cos(5 * atan(p.z, p.x) + p.y) * "
                    "smoothstep(0.2, 0.5, length(p.xz)))\n")
               .diagnostics.has_errors());
}

TEST_CASE("a blend's weight that grows without limit wants a region") {
    const driver::Compilation c = compiled("blend(box(2), sphere(1), p => p.y)\n");
    REQUIRE(c.diagnostics.has_errors());
    CHECK(c.diagnostics.items()[0].code == Code::NeedsRegion);
    CHECK(
        !compiled("blend(box(2), sphere(1), p => p.y).within(ball(2))\n").diagnostics.has_errors());
}

TEST_CASE("a refusal names no singular place that is none") {
    const driver::Compilation c = compiled("fn f(p: vec3) -> float {\n"
                                           "  let q = (p.xz + 1.5) % 3 - 1.5\n"
                                           "  length(q) - 0.35 - 0.02 * cos(16 * atan(q.y, q.x)) * "
                                           "smoothstep(0.05, 0.3, length(q))\n}\n"
                                           "implicit(f, within: everywhere)\n");
    for (const Diagnostic &d : c.diagnostics.items()) {
        INFO(d.message);
        CHECK(d.code != Code::FieldSingular);
    }
    // As `repeat` writes the cells, which the help names, it is proved.
    CHECK(!compiled("fn f(p: vec3) -> float = length(p.xz) - 0.35 - 0.02 * cos(16 * atan(p.z, "
                    "p.x)) * smoothstep(0.05, 0.3, length(p.xz))\n"
                    "implicit(f, within: everywhere).repeat([3, 0, 3])\n")
               .diagnostics.has_errors());
}

// Where a border is entered its first value is a whole number, which has no other values.
TEST_CASE("a step of a loop's first value leaves the loop its other values") {
    const std::string turns = "fn f(p: vec3) -> float {\n"
                              "  var b = p.y\n"
                              "  var a = p.x\n"
                              "  for i in 0..300 {\n"
                              "    b = 0.997 * b + 0.001 * sin(a)\n"
                              "    a = a + 0.003 * b\n"
                              "  }\n"
                              "  let i = floor(a)\n"
                              "  let u = a - i\n  ",
                      end = "\n}\nimplicit(f, within: ball(2))\n";
    const auto accepted = [&](const char *field) {
        return !compiled(turns + field + end).diagnostics.has_errors();
    };
    CHECK(accepted("0.1 * mix(hash(i) * b, hash(i + 1) * b, u * u * (3 - 2 * u))"));
    CHECK_FALSE(accepted("0.1 * mix(hash(i) * b, hash(i + 1) * a, u * u * (3 - 2 * u))"));
}
