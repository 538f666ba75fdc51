// Polynomials of one number (Flattener::find_univariate): no steeper than is proved, and as steep as
// that but for a little.
#include "build.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Fade {
    Scenery s;
    Graph &g = s.g;
    NodeId n(double x) { return g.number(x); }
    double bound(NodeId field, double reach, std::size_t instructions) {
        proof::Work work;
        proof::Flattening context{g, work};
        const proof::Ranges ranges = proof::ranges_of(s.scene, work);
        proof::Domain domain;
        domain.box = {{ir::Interval(-reach, reach), ir::Interval(-1, 1), ir::Interval(-1, 1)}};
        proof::Budget budget;
        budget.instructions = instructions;
        return proof::bound_field(context, ranges, field, domain, budget).lipschitz;
    }
};

struct Polynomial {
    const char *name;
    std::function<NodeId(Fade &, NodeId)> of;
    double steepest; // over 0..1
};
const std::vector<Polynomial> polynomials{
    {"a quintic fade",
     [](Fade &f, NodeId x) {
         const NodeId inner = f.g.add(f.g.mul(x, f.g.sub(f.g.mul(x, f.n(6)), f.n(15))), f.n(10));
         return f.g.mul({f.g.mul({f.g.mul(x, x), x}), inner});
     },
     1.875},
    {"a cube of a shifted number",
     [](Fade &f, NodeId x) {
         const NodeId shifted = f.g.sub(x, f.n(0.5));
         return f.g.mul({f.g.mul(shifted, shifted), shifted});
     },
     0.75},
    {"a bump",
     [](Fade &f, NodeId x) {
         const NodeId y = f.g.mul(x, f.g.sub(f.n(1), x));
         return f.g.mul({f.g.mul(f.n(16), y), y});
     },
     3.08}};

} // namespace

TEST_CASE("a polynomial of one number is as steep as its derivative is great") {
    for (const auto &[name, of, steepest] : polynomials) {
        INFO(name);
        Fade f;
        // of a number that is any of 0..1 in every cell
        const NodeId saw = f.g.make(Op::Abs, {f.g.sub(f.s.call(Op::Fract, f.s.x), f.n(0.5))});
        const NodeId x = f.g.mul(f.n(2), saw);
        const double bound = f.bound(of(f, x), 20, 4000);
        CHECK(bound >= 2 * steepest * 0.99);
        CHECK(bound <= 2 * steepest * 1.4);
    }
}
