// One component of a vector that is turned: as steep as what is turned, whatever the angle.
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Part {
    const char *name;
    double steep; // for the worst angle
    std::function<NodeId(Scenery &, NodeId angle)> of;
};
const std::vector<Part> parts{
    {"x of a turn", 1,
     [](Scenery &s, NodeId a) { return s.g.sub(s.g.mul(s.cos(a), s.x), s.g.mul(s.sin(a), s.y)); }},
    {"y of a turn back", 1,
     [](Scenery &s, NodeId a) { return s.g.sub(s.g.mul(s.cos(a), s.y), s.g.mul(s.sin(a), s.x)); }},
    {"of what is larger one way", 2.24, // 2 is true
     [](Scenery &s, NodeId a) {
         return s.g.add(s.g.mul(s.cos(a), s.x), s.g.mul(s.sin(a), s.g.mul(s.n(2), s.y)));
     }},
    {"of lengths that read one coordinate", 2, // sqrt 2 is true
     [](Scenery &s, NodeId a) {
         const NodeId across = s.length(s.g.make(Op::Make, Type::Vec2, {s.x, s.y}));
         return s.g.add(s.g.mul(s.cos(a), s.x), s.g.mul(s.sin(a), across));
     }},
    {"two cosines", std::sqrt(2),
     [](Scenery &s, NodeId a) { return s.g.add(s.g.mul(s.cos(a), s.x), s.g.mul(s.cos(a), s.y)); }},
    {"two angles", std::sqrt(2), [](Scenery &s, NodeId a) {
         const NodeId twice = s.g.mul(s.n(2), a);
         return s.g.add(s.g.mul(s.cos(a), s.x), s.g.mul(s.sin(twice), s.y));
     }}};

} // namespace

TEST_CASE("one component of what is turned is as steep as what is turned, for any angle") {
    for (const auto &[name, steep, of] : parts) {
        INFO(name);
        Scenery s;
        const NodeId angle = s.parameter(0, 7), f = of(s, angle);
        const double bound = s.bound(f, cube(1)).lipschitz;
        CHECK(bound <= steep * (1 + 1e-6));
        double seen = 0;
        proof::Dice dice{5};
        for (int i = 0; i < 5000; ++i) {
            const double at = 7 * dice.next();
            std::array<double, 3> p{}, q{};
            for (std::size_t k = 0; k < 3; ++k) {
                p[k] = 2 * dice.next() - 1;
                q[k] = p[k] + 1e-3 * (dice.next() - 0.5);
            }
            const auto value = [&](const std::array<double, 3> &there) {
                const NodeId found = ir::substitute(
                    s.g, f, {{angle, s.n(at)}, {s.p, s.g.vec3(there[0], there[1], there[2])}});
                REQUIRE(s.g.is_constant(found));
                return s.g.constant_of(found).value[0];
            };
            const double run = std::hypot(p[0] - q[0], p[1] - q[1], p[2] - q[2]);
            seen = std::max(seen, std::fabs(value(p) - value(q)) / run);
        }
        CHECK(seen <= bound * (1 + 1e-6));
        CHECK(bound <= 1.5 * seen);
    }
}
