// Loops of field time whose iterations can be counted when the scene is read.
#include "compiled.h"

#include <catch2/catch.hpp>

using namespace fathom;
using test::compiled;

namespace {

std::string folding(const std::string &head, const std::string &tail) {
    return "fn f(p: vec3) -> float {\n  var q = p\n  var k = 0\n  " + head +
           " {\n    q = abs(q) - 0.3\n" + tail + "  }\n  length(q) - 0.2\n}\n" +
           "implicit(f, within: ball(2))\n";
}

} // namespace

TEST_CASE("a while loop that a counter ends is a loop of that many iterations") {
    // so its end is no choice that depends on the point, and the field is proved continuous
    CHECK(compiled(folding("while k < 4 limit 9", "    k += 1\n")).good());
    CHECK(compiled(folding("while k < 4", "    k += 1\n")).good());
    CHECK(compiled(folding("while k * k < 50", "    k = 2 * k + 1\n")).good());
    const auto loops = compiled(folding("while k < 7", "    k += 1\n")).scene.graph;
    REQUIRE(loops.loop_count() > 0);
    bool counted = false;
    for (std::size_t i = 0; i < loops.loop_count(); ++i)
        counted = counted || loops.loop(ir::LoopId{i}).max_count == 7;
    CHECK(counted);
}

TEST_CASE("a while loop that the point ends needs a limit") {
    const auto c = compiled(folding("while length(q) < 4", "    q *= 2\n"));
    REQUIRE(c.diagnostics.items().size() == 1);
    CHECK(code_name(c.diagnostics.items()[0].code) == "loop-limit");
    CHECK_FALSE(compiled(folding("while k < 4", "    k += 0\n")).good()); // no end
}

TEST_CASE("directions by the hash of a loop's number are known as unit vectors") {
    const auto bound_of = [](const std::string &angle, const std::string &height) {
        const driver::Compilation made = test::compiled(
            "fn cut(p: vec3) -> float {\n  var d = -1000.0\n  for i in 0..20 {\n    let a = " +
            angle + "\n    let z = " + height +
            "\n    let r = sqrt(1 - z * z)\n"
            "    d = max(d, dot(p, vec3(r * cos(a), z, r * sin(a))) - 0.8)\n  }\n  d\n}\n"
            "implicit(cut, within: ball(3))\n");
        REQUIRE(made.good());
        return made.scene.facts.at(made.scene.top_level.at(0).shape.index).lipschitz_sup;
    };
    CHECK(bound_of("6.2831 * hash(i)", "2 * hash(i + 100) - 1") < 1.00001);
    CHECK(bound_of("6.2831 * hash([i, 1])", "2 * hash(3.0 * i + 1) - 1") < 1.00001);
    CHECK(bound_of("6.2831 * hash(0.1 * i)", "0.5") > 1.00001); // in single precision not known
}
