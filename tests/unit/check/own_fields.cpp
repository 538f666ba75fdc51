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
    std::string body;   // of a function of p
    double least, most; // of the bound
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
        CHECK(lipschitz(c) >= test.least * (1 - 1e-6));
        CHECK(lipschitz(c) <= test.most * (1 + 1e-6));
        const Slopes seen = measure(c.scene, {-3, -3, -3}, {3, 3, 3}, 20'000);
        INFO("at " << seen.where[0] << " " << seen.where[1] << " " << seen.where[2]);
        CHECK((test.region != "ball(3)" || seen.steepest <= 1 + 1e-3));
        CHECK(seen.unsafe == 0);
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
        // not a turn: a shear, a scale, and an angle that varies
        {"length([p.x + 0.5 * p.y, p.y, p.z]) - 1", 1.28, 1.3},
        {"length([2 * p.x, p.y, p.z]) - 1", 2, 2.01},
        {"var q = p; q.xz = rotate2(q.xz, p.y); length(q - X) - 0.5", 1.5, 4},
    });
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
