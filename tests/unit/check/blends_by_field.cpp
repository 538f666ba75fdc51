// Blends by a field of the point: as steep as their shapes differ where the field varies, however
// large these are.
#include "compiled.h"
#include "tests/support/slopes.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

using namespace fathom;
using namespace fathom::test;

namespace {

double bound_of_blend(const driver::Compilation &c) {
    return c.scene.facts[c.scene.top_level.at(0).shape.index].lipschitz_sup;
}

// By smoothstep(-0.3, 0.3, p.x), whose slope is 2.5.
std::string blended(const std::string &a, const std::string &b) {
    return fmt::format("blend({}, {}, p => smoothstep(-0.3, 0.3, p.x))\n", a, b);
}

struct Pair {
    const char *a, *b; // r stands for a size
    double most;       // of the bound
    int largest = 100;
};
// What each bound is of: the greatest difference.
const std::vector<Pair> alike{
    {"box(2*r)", "rounded_box([2*r, 2*r, 2*r], radius: 0.3)", 1.57}, // 0.3 (sqrt(3) - 1)
    {"box(2*r)", "box(2*r).translate(x: 0.2)", 1.51},
    {"box(2*r).rotate(1, axis: [1, 2, 3])",
     "box(2*r).translate([0, 0.12, 0.16]).rotate(1, axis: [1, 2, 3])", 1.51},
    {"box(2*r).rotate(0.5, axis: Y)", "box(2*r).rotate(0.5, axis: Y).translate(y: 0.2)", 1.51},
    {"box(2*r).offset(0.1)", "box(2*r)", 1.26},
    {"box(2*r) | sphere(1.2*r)", "box(2*r).translate(z: 0.2) | sphere(1.2*r + 0.1)", 1.51},
    {"sphere(r)", "sphere(r + 0.2)", 1.51},
    {"torus(r, 0.3)", "torus(r, 0.2)", 1.26},
    {"torus(r, 0.3)", "torus(r, 0.3).translate(y: 0.2)", 1.51},
    {"cylinder(r, 2*r)", "rounded_cylinder(r, 2*r, rounding: 0.2)", 1.5}, // 0.2 (sqrt(2) - 1)
    {"box(2*r)", "rounded_box([2*r, 2*r, 2*r], radius: 0.3).rotate(0.01, axis: Y)", 1.7, 10},
};

} // namespace

TEST_CASE("a blend by a field is as steep as its shapes differ, whatever their size") {
    for (const auto &[a, b, most, largest] : alike)
        for (int r = 1; r <= largest; r *= 10) {
            const std::string text = fmt::format("let r = {}.0\n", r) + blended(a, b);
            INFO(text);
            const driver::Compilation c = compiled(text);
            REQUIRE(!c.diagnostics.has_errors());
            CHECK(bound_of_blend(c) <= most);
            const double size = 1.5 * r;
            const Slopes seen = measure(c.scene, {-0.4, -size, -size}, {0.4, size, size}, 8'000);
            CHECK(seen.steepest <= 1 + 1e-3);
            CHECK(seen.unsafe == 0);
        }
}

TEST_CASE("a blend by a field needs no size of its shapes") {
    // nor a number of it
    const driver::Compilation sized =
        compiled("param r = 1.0 in 0.5..200.0\n" +
                 blended("box(2*r)", "rounded_box([2*r, 2*r, 2*r], radius: 0.3)"));
    REQUIRE(!sized.diagnostics.has_errors());
    CHECK(bound_of_blend(sized) <= 1 + 2.5 * 0.3 * (1 + std::sqrt(3)) * 1.01);
    // nor an end
    const driver::Compilation endless = compiled(blended("plane(Y, 0)", "plane(Y, 0.2)") + "\n");
    REQUIRE(!endless.diagnostics.has_errors());
    CHECK(bound_of_blend(endless) <= 1.51);
    CHECK(compiled(blended("plane(Y, 0)", "plane(Z, 0)")).diagnostics.has_errors());
}

// Both are distances: what is left out of the search lies where both have one sign.
TEST_CASE("no blend of two distances is steeper than proved") {
    const char *const shapes[] = {"sphere({0})",
                                  "box([{0}, {1}, {2}])",
                                  "torus({0}, {0}*0.4)",
                                  "cylinder({0}, {1})",
                                  "capsule([0, 0, 0], [{1}, {0}, {2}], 0.1*{2})",
                                  "rounded_box([{0}, {1}, {2}], radius: 0.1)",
                                  "box_frame([{0}, {1}, {2}], 0.1)",
                                  "box([{0}, {1}, {2}]).offset(0.1)",
                                  "box([{0}, {1}, {2}]).shell(0.1)",
                                  "(sphere({0}) | box([{2}, {1}, {0}]))"};
    std::uint64_t state = 1;
    const auto random = [&] { return double((state = state * 48271 % 2147483647)) / 2147483647.0; };
    for (int i = 0; i < 120; ++i) {
        const auto shape = [&] {
            const auto &form = shapes[std::size_t(random() * std::size(shapes))];
            const double a = 0.4 + random(), b = 0.4 + random(), c = 0.4 + random();
            return fmt::format(fmt::runtime(form), a, b, c) +
                   fmt::format(".rotate({}, axis: [1, {}, {}]).translate([{}, {}, {}])",
                               random() < 0.5 ? 0.0 : random(), random(), random(), random() - 0.5,
                               random() - 0.5, random() - 0.5);
        };
        const std::string a = shape(), b = random() < 0.3 ? a + ".translate(y: 0.1)" : shape();
        const std::string weights[] = {"smoothstep(-0.3, 0.3, p.x)", "0.5 + 0.5*sin(3*p.y)",
                                       "saturate(length(p - 0.7))"};
        const std::string text =
            fmt::format("blend({}, {}, p => {})\n", a, b, weights[std::size_t(random() * 3)]);
        INFO(text);
        const driver::Compilation c = compiled(text);
        REQUIRE(!c.diagnostics.has_errors());
        const Slopes seen = measure(c.scene, {-2, -2, -2}, {2, 2, 2}, 4'000);
        CHECK(seen.steepest <= 1 + 1e-3);
        CHECK(seen.unsafe == 0);
    }
}
