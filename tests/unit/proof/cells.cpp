// Bounds cell by cell are not sought where a few cells beside the surface show that they would not
// pay. By counted work.
#include "proof/cells.h"

#include "build.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Sought {
    bool found = false;
    std::size_t work = 0;
};

// Slope 0.5, and within 0.05 of the surface x = 0 10 more.
Sought cells_of_a_step(bool bends) {
    Scenery s;
    Graph &g = s.g;
    const NodeId steep = g.make(Op::Clamp, {g.mul(s.x, s.n(10)), s.n(-0.5), s.n(0.5)});
    const NodeId field = g.add(steep, g.mul(s.x, s.n(0.5)));
    proof::Work work;
    proof::Flattening context{g, work};
    const proof::Ranges ranges = proof::ranges_of(s.scene, work);
    proof::CellAim aim;
    aim.refining = aim.instructions;
    aim.bends = bends;
    const std::size_t before = work.left;
    const bool found =
        proof::bound_cells(context, ranges, field, {cube(1), nullptr}, 10.5, aim).has_value();
    return {found, before - work.left};
}

} // namespace

TEST_CASE("cells are given up early where the field is steep beside its surface") {
    const Sought given_up = cells_of_a_step(false);
    CAPTURE(given_up.work);
    CHECK_FALSE(given_up.found);
    CHECK(given_up.work > 0);
    CHECK(given_up.work < 4'096); // less than one operation for each of the 4,096 cells
    // By curvature they pay all the same, and none is given up.
    const Sought kept = cells_of_a_step(true);
    CHECK(kept.work > 10 * given_up.work);
}
