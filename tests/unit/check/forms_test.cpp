// Functions of several forms, and choices between lists by the point.
#include "compiled.h"

#include <catch2/catch.hpp>

using namespace fathom;
using test::compiled;

namespace {

std::string code_of(const std::string &text) {
    const auto c = compiled(text);
    return c.diagnostics.items().empty() ? std::string()
                                         : std::string(code_name(c.diagnostics.items()[0].code));
}

// The radius that a call gives: the solid is a ball of it.
double radius_of(const std::string &functions, const std::string &call) {
    const auto c = compiled(functions + "sphere(" + call + ")\n");
    REQUIRE(c.good());
    return c.scene.facts.at(c.scene.top_level.at(0).shape.index).bounds.hi[0];
}

} // namespace

TEST_CASE("a call means the form whose types its arguments have") {
    const std::string forms =
        "fn f(a: vec2) -> float = 2\nfn f(a: vec3) -> float = 3\n"
        "fn f(a: float) -> float = 1\nfn f(a: float, b: float) -> float = 4\n";
    CHECK(radius_of(forms, "f([1, 2])") == Approx(2).epsilon(1e-4));
    CHECK(radius_of(forms, "f(vec3(1))") == Approx(3).epsilon(1e-4));
    CHECK(radius_of(forms, "f(7)") == Approx(1).epsilon(1e-4));
    CHECK(radius_of(forms, "f(7, b: 1)") == Approx(4).epsilon(1e-4));
    CHECK(radius_of(forms, "[1, 2].f()") == Approx(2).epsilon(1e-4));
}

TEST_CASE("a call means the nearest form, in whatever order they stand") {
    const std::string a = "fn f(a: float) -> float = 1\n", b = "fn f(a: int) -> float = 2\n";
    const std::string c = "fn g(a: color) -> float = 1\n", d = "fn g(a: vec3) -> float = 2\n";
    for (const std::string &forms : {a + b, b + a}) {
        CHECK(radius_of(forms, "f(7)") == Approx(2).epsilon(1e-4));
        CHECK(radius_of(forms, "f(7.5)") == Approx(1).epsilon(1e-4));
    }
    for (const std::string &forms : {c + d, d + c}) {
        CHECK(radius_of(forms, "g(red)") == Approx(1).epsilon(1e-4));
        CHECK(radius_of(forms, "g(vec3(1, 2, 3))") == Approx(2).epsilon(1e-4));
    }
    const std::string e = "fn h(a: float, b: vec2) -> float = 1\n",
                      g = "fn h(a: vec2, b: vec2) -> float = 2\n";
    for (const std::string &forms : {e + g, g + e})
        CHECK(radius_of(forms, "h(1, 1)") == Approx(1).epsilon(1e-4));
    // one int is converted by either
    const std::string h = "fn k(a: int, b: float) -> float = 1\n",
                      i = "fn k(a: float, b: int) -> float = 2\n";
    CHECK(code_of(h + i + "sphere(k(1, 1))\n") == "type-mismatch");
    CHECK(radius_of(h + i, "k(1, 1.5)") == Approx(1).epsilon(1e-4));
}

TEST_CASE("forms call each other, also below what they call") {
    CHECK(compiled("fn g(p: vec3) -> float = g(p.xz) - p.y\nfn g(p: vec2) -> float = length(p)\n"
                   "implicit(p => g(p), within: ball(1))\n")
              .good());
}

TEST_CASE("forms that a call may not tell apart are two declarations of one name") {
    CHECK(code_of("fn f(a: float) = a\nfn f(b: float) = 2 * b\nsphere(f(1))\n") ==
          "duplicate-name");
    CHECK(code_of("fn f(a) = a\nfn f(b: vec2) = b.x\nsphere(f(1))\n") == "duplicate-name");
    CHECK(code_of("fn f(a: float, b: float = 1) = a\nfn f(a: float) = 2 * a\nsphere(f(1))\n") ==
          "duplicate-name");
    CHECK(code_of("let f = 1\nfn f(a: float) = a\nsphere(f(1))\n") == "duplicate-name");
    // a number fills vectors of both lengths
    CHECK(code_of("fn f(a: vec2) = a.x\nfn f(a: vec3) = a.y\nsphere(f(1))\n") == "type-mismatch");
}

TEST_CASE("the point chooses between lists of as many numbers") {
    const std::string nearer = "fn nearer(a, b) = if a[0] < b[0] { a } else { b }\n";
    const auto c = compiled(
        nearer + "fn scene(p: vec3) {\n  var best = [1e3, vec3(0)]\n  for i in 0..3 {\n"
                 "    best = nearer(best, [length(p - vec3(i, 0, 0)) - 0.4, vec3(0.2 * i, 0, 0)])\n"
                 "  }\n  best\n}\nimplicit(p => scene(p)[0], within: ball(3))\n"
                 ".paint(p => scene(p)[1])\n");
    REQUIRE(c.good());
    CHECK(c.scene.facts.at(c.scene.top_level.at(0).shape.index).lipschitz_sup < 1.00001);
    const auto chosen = [&](const std::string &a, const std::string &b) {
        return code_of("implicit(p => { let l = if p.x > 0 { " + a + " } else { " + b +
                       " }\n length(p) - 1 + 0 * l[0] }, within: ball(2))\n");
    };
    CHECK(chosen("[1, [2, vec3(0)]]", "[1, [3, p]]").empty());
    CHECK(chosen("[1, vec2(0)]", "[1, vec3(0)]") == "stage-mismatch");
    CHECK(chosen("[1, 2, red]", "[1, red]") == "stage-mismatch");
    CHECK(chosen("[1, \"a\", red]", "[1, \"b\", red]") == "stage-mismatch");
    std::string deep = "let l0 = [1, red]\nlet m0 = [2, red]\n"; // shared lists are no long ones
    for (int i = 0; i < 30; ++i) {
        const std::string n = std::to_string(i), next = std::to_string(i + 1);
        deep += "let l" + next + " = [l" + n + ", l" + n + "]\nlet m" + next + " = [m" + n + ", m" +
                n + "]\n";
    }
    CHECK(code_of(deep + "fn f(p) = if p.x > 0 { l30 } else { m30 }\n"
                         "implicit(p => length(p) - len(f(p)), within: ball(2))\n") ==
          "stage-mismatch");
}
