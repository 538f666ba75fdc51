// Ranges of numbers that stand still (proof/machine_still.cpp): they hold every value, and hardly
// more, also of numbers that are read more than once.
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Moving {
    Scenery s;
    Graph &g = s.g;
    NodeId a, t = g.time(), turn = s.call(Op::Fract, t), one = g.number(1);
    Moving() {
        ir::Param param;
        param.type = Type::Float;
        param.has_range = true;
        param.lo[0] = -0.5;
        param.hi[0] = 2;
        s.scene.params.push_back(param);
        a = g.param(0, Type::Float);
    }
    ir::Interval range(NodeId of) {
        proof::Work work;
        proof::Flattening context{g, work};
        const proof::Ranges ranges = proof::ranges_of(s.scene, work);
        return proof::range_of(context, ranges, of, proof::Cell{})[0];
    }
    double value(NodeId of, double at, double time) {
        const NodeId found = ir::substitute(g, of, {{a, g.number(at)}, {t, g.number(time)}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    }
};

struct Number {
    const char *name;
    std::function<NodeId(Moving &)> node;
    double near; // the width that is found, of the true one, at most
};
const std::vector<Number> numbers{
    {"a bounce",
     [](Moving &m) {
         return m.g.mul({m.g.mul(m.g.number(4), m.turn), m.g.sub(m.one, m.turn)});
     },
     1.1},
    {"a square less itself", [](Moving &m) { return m.g.sub(m.g.mul(m.a, m.a), m.a); }, 1.1},
    {"a ratio", [](Moving &m) { return m.g.div(m.a, m.g.add(m.one, m.g.mul(m.a, m.a))); }, 1.1},
    {"a sine and its square",
     [](Moving &m) {
         const NodeId sine = m.s.sin(m.g.mul(m.g.number(3), m.t));
         return m.g.sub(m.g.mul(sine, sine), m.g.mul(m.g.number(0.5), sine));
     },
     1.1},
    {"a param and the time",
     [](Moving &m) {
         return m.g.mul({m.a, m.g.sub(m.turn, m.g.mul(m.turn, m.a))});
     },
     1.9},
};

} // namespace

TEST_CASE("the range of what stands still holds its values, and is near them") {
    for (const auto &[name, number, near] : numbers) {
        INFO(name);
        Moving m;
        const NodeId of = number(m);
        const ir::Interval found = m.range(of);
        ir::Interval seen(ir::rounding::infinity, -ir::rounding::infinity);
        for (int i = 0; i <= 100; ++i)
            for (int k = 0; k <= 100; ++k)
                seen = hull(seen, ir::Interval(m.value(of, -0.5 + 0.025 * i, 0.0209 * k)));
        CHECK(found.lo <= seen.lo);
        CHECK(found.hi >= seen.hi);
        CHECK(found.width() < near * seen.width());
    }
}

TEST_CASE("a quotient by what stands still and is never 0 is no pole") {
    Moving m; // 1 - a + a a >= 3/4, which intervals see by pieces alone
    const NodeId below = m.g.add(m.g.sub(m.one, m.a), m.g.mul(m.a, m.a));
    const NodeId field = m.g.div(m.s.x, below);
    proof::Work work;
    proof::Flattening context{m.g, work};
    const proof::Ranges ranges = proof::ranges_of(m.s.scene, work);
    const proof::FieldBound bound = proof::bound_field(context, ranges, field, {}, {});
    CHECK(bound.lipschitz >= 4.0 / 3);
    CHECK(bound.lipschitz < 1.5);
}
