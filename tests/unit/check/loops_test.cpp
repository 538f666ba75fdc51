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
