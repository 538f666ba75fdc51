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
