// The embedded library as a scene meets it: read where it is asked for, its calls run once, and
// neither to be noticed but by the work that is saved.
#include "compiled.h"

#include <catch2/catch.hpp>

#include <algorithm>

using namespace fathom;
using test::compiled;

namespace {

std::vector<std::string> codes(const driver::Compilation &c) {
    std::vector<std::string> out;
    for (const Diagnostic &d : c.diagnostics.items()) out.emplace_back(code_name(d.code));
    return out;
}

} // namespace

TEST_CASE("a scene pays for the part of the library that it uses") {
    // reading all of the library takes thousands of evaluations more
    CHECK(compiled("sphere(1)\n").evaluations < 100);
}

TEST_CASE("a library call with the same numbers runs once") {
    const std::string one = "cylinder(0.3, 2).translate(x: 1)\n";
    const std::size_t once = compiled(one).evaluations;
    const std::size_t again = compiled(one + "cylinder(0.3, 2).translate(x: 3)\n").evaluations;
    const std::size_t other = compiled(one + "cylinder(0.3, 3).translate(x: 3)\n").evaluations;
    CHECK(again < other);
    CHECK(other < 2 * once);
}

TEST_CASE("whole numbers and floats are not taken for each other") {
    const auto c = compiled("let a = clamp(7, 0, 5)\nlet b = clamp(7.0, 0.0, 5.0)\n"
                            "let l = [0, 1, 2, 3, 4, 5]\nprint(l[a])\nsphere(b)\n");
    CHECK(c.good());
}

TEST_CASE("a wrong call is reported each time it is made") {
    CHECK(codes(compiled("sphere(-1)\nsphere(-1)\n")) ==
          std::vector<std::string>{"bad-argument", "bad-argument"});
}

TEST_CASE("names of the library that nobody asked for yet are still known") {
    const auto misspelt = compiled("sphre(1)\n");
    REQUIRE(misspelt.diagnostics.items().size() == 1);
    REQUIRE(misspelt.diagnostics.items()[0].fix);
    CHECK(misspelt.diagnostics.items()[0].fix->message == "did you mean `sphere`?");
    CHECK(codes(compiled("let torus = sphere(1)\ntorus\n")) ==
          std::vector<std::string>{"hides-name"});
}

TEST_CASE("a library function first asked for inside a field is the same as elsewhere") {
    const std::string inside = "sphere(1).displace(p => 0.1 * noise(p))\n";
    CHECK(compiled(inside).good());
    CHECK(compiled("let f = noise\n" + inside + "sphere(1).displace(f).translate(x: 4)\n").good());
}

TEST_CASE("names that a missing file would have brought are not reported one by one") {
    CHECK(codes(compiled(
              "import \"nowhere.sdf\"\nvault(2).translate(x: 1)\nsphere(1).gilded_leaf()\n")) ==
          std::vector<std::string>{"import-not-found"});
    CHECK(codes(compiled("import \"../arch.sdf\"\narch(2)\n")) ==
          std::vector<std::string>{"import-outside"}); // though `arc` is near
    // what is near to a name that is there is still a slip
    CHECK(codes(compiled("import \"nowhere.sdf\"\nspere(1)\n")) ==
          std::vector<std::string>{"import-not-found", "unknown-name"});
}

TEST_CASE("the library's own module is offered to whom asks for its file") {
    const auto c = compiled("import \"dfmodel.sdf\" as thesis\nthesis.sphere(1)\n");
    REQUIRE(codes(c) == std::vector<std::string>{"import-not-found"});
    const auto &fix = c.diagnostics.items()[0].fix;
    REQUIRE(fix);
    REQUIRE(fix->edits.size() == 1);
    CHECK(fix->edits[0].replacement == "\"dfmodel\"");
}

TEST_CASE("a count says nothing where the cell is 0") {
    CHECK(compiled("sphere(0.3).repeat([1, 0, 1], [3, 0, 3])\n").good());
    CHECK(codes(compiled("sphere(0.3).repeat([1, 0, 0], [0, 1, 1])\n")) ==
          std::vector<std::string>{"bad-argument"});
}

TEST_CASE("a block whose only statement cannot be read is reported once") {
    CHECK(codes(compiled("smooth_difference(0.2) { sphere(1) box(1.2) }\n")) ==
          std::vector<std::string>{"syntax-error"});
}

TEST_CASE("a displaced polyhedron of distances along normals has a box") {
    const auto c = compiled("gdf_icosahedron(1).displace(p => 0.1 * sin(p.x))\n");
    REQUIRE(c.good());
    CHECK(c.scene.facts[c.scene.root.index].bounds.finite());
}
