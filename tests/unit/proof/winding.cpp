// Fields that wind about an axis (proof/winding.h): with the angle and the point turned by the same
// they keep their values; the bound is above all slopes, and less than without.
#include "proof/winding.h"
#include "build.h"
#include "ir/passes/walk.h"

#include <catch2/catch.hpp>

#include <functional>

using namespace fathom;
using namespace fathom::test;

namespace {

struct Winding {
    Scenery s;
    Graph &g = s.g;
    NodeId r = s.length(g.make(Op::Make, Type::Vec2, {s.x, s.z}));
    NodeId angle = g.add(g.mul(g.number(3), s.y), g.number(0.7));
    struct Pair {
        NodeId x, z;
    };
    Pair turned(NodeId a) {
        return {g.add(g.mul(s.cos(a), s.x), g.mul(s.sin(a), s.z)),
                g.sub(g.mul(s.cos(a), s.z), g.mul(s.sin(a), s.x))};
    }
    Pair turned_back(NodeId a) { return turned(g.neg(a)); }
    NodeId strand(Pair at, double x = 0.4) {
        const NodeId vector = g.make(Op::Make, Type::Vec2, {g.sub(at.x, g.number(x)), at.z});
        return g.sub(s.length(vector), g.number(0.2));
    }
    NodeId least(NodeId a, NodeId b) { return g.make(Op::Min, {a, b}); }
    NodeId plus(NodeId a, double b) { return g.add(a, g.number(b)); }
    double value(NodeId field, std::array<double, 3> at) {
        const NodeId found = ir::substitute(g, field, {{s.p, g.vec3(at[0], at[1], at[2])}});
        REQUIRE(g.is_constant(found));
        return g.constant_of(found).value[0];
    }
    double bound(NodeId field) {
        proof::Work work;
        proof::Flattening context{g, work};
        const proof::Ranges ranges = proof::ranges_of(s.scene, work);
        proof::Domain domain;
        domain.box = {{ir::Interval(-1, 1), ir::Interval(-1, 1), ir::Interval(-1, 1)}};
        proof::Budget budget;
        budget.most = 1'000'000;
        return proof::bound_field(context, ranges, field, domain, budget).lipschitz;
    }
};

struct Field {
    const char *name;
    std::function<NodeId(Winding &)> field;
};
const std::vector<Field> winding{
    {"a strand", [](Winding &w) { return w.strand(w.turned(w.angle)); }},
    {"a strand the other way", [](Winding &w) { return w.strand(w.turned_back(w.angle)); }},
    {"two strands of angles that a number sets apart",
     [](Winding &w) {
         return w.least(w.strand(w.turned(w.angle)), w.strand(w.turned(w.plus(w.angle, 1.3)), 0.5));
     }},
    {"a strand that is cut",
     [](Winding &w) {
         const NodeId cut = w.g.sub(w.s.call(Op::Abs, w.s.y), w.g.number(0.6));
         return w.g.make(Op::Max, {w.strand(w.turned(w.angle)), cut});
     }},
    {"a vortex", [](Winding &w) { return w.strand(w.turned(w.g.mul(w.g.number(2), w.r))); }},
    {"a wave of the angle beside",
     [](Winding &w) {
         return w.g.add(w.strand(w.turned(w.angle)), w.g.mul(w.g.number(0.3), w.s.sin(w.angle)));
     }},
    {"waves of the angle and of another one that make it thicker",
     [](Winding &w) {
         const NodeId both = w.g.sub(w.s.sin(w.g.mul(w.g.number(2), w.angle)), w.s.cos(w.angle));
         return w.g.sub(w.strand(w.turned(w.angle)), w.g.mul(w.g.number(0.05), both));
     }},
    {"a strand as thick as the distance says", [](Winding &w) {
         return w.g.sub(w.strand(w.turned(w.angle)), w.g.mul(w.g.number(0.1), w.r));
     }}};

const std::vector<Field> others{
    {"a coordinate beside",
     [](Winding &w) {
         return w.g.add(w.strand(w.turned(w.angle)), w.g.mul(w.g.number(0.3), w.s.x));
     }},
    {"a wave of the angle as a factor of a coordinate",
     [](Winding &w) {
         const NodeId beside = w.g.mul(w.g.number(0.3), w.g.mul(w.s.sin(w.angle), w.s.x));
         return w.g.add(w.strand(w.turned(w.angle)), beside);
     }},
    {"both ways at once",
     [](Winding &w) {
         return w.least(w.strand(w.turned(w.angle)), w.strand(w.turned_back(w.angle)));
     }},
    {"two angles",
     [](Winding &w) {
         const NodeId other = w.g.mul(w.g.number(2), w.s.y);
         return w.least(w.strand(w.turned(w.angle)), w.strand(w.turned(other)));
     }},
    {"an angle that reads a coordinate across",
     [](Winding &w) { return w.strand(w.turned(w.g.add(w.angle, w.s.x))); }},
    {"no turn", [](Winding &w) {
         const NodeId c = w.s.cos(w.angle), z = w.g.mul(w.g.number(1.1), w.s.z);
         const NodeId x = w.turned(w.angle).x;
         return w.strand({x, w.g.sub(w.g.mul(c, z), w.g.mul(w.s.sin(w.angle), w.s.x))});
     }}};

// With 0 in place of what is made up (Winding::field).
NodeId with_numbers(Graph &g, NodeId root) {
    ir::Substitution map;
    std::vector<NodeId> todo{root};
    while (!todo.empty()) {
        const NodeId id = todo.back();
        todo.pop_back();
        if (g[id].op == Op::Var) map[id] = g.number(0);
        todo.insert(todo.end(), g.args(id).begin(), g.args(id).end());
    }
    return ir::substitute(g, root, map);
}

double at_random(int i, int k) { // -1..1
    const double x = std::sin(i * 12.9898 + k * 78.233) * 43758.5453;
    return 2 * (x - std::floor(x)) - 1;
}

double steepest(Winding &w, NodeId field) {
    double most = 0;
    for (int i = 0; i < 3000; ++i) {
        constexpr double step = 1e-4;
        std::array<double, 3> p{at_random(i, 0), at_random(i, 1), at_random(i, 2)}, slope{};
        for (std::size_t k = 0; k < 3; ++k) {
            auto before = p, after = p;
            before[k] -= step, after[k] += step;
            slope[k] = (w.value(field, after) - w.value(field, before)) / (2 * step);
        }
        most = std::max(most, std::hypot(slope[0], slope[1], slope[2]));
    }
    return most;
}

} // namespace

TEST_CASE("what winds about an axis keeps its value where angle and point turn alike") {
    for (const auto &[name, make] : winding) {
        INFO(name);
        Winding w;
        const NodeId field = make(w);
        const auto found = proof::winding_of(w.g, field);
        REQUIRE(found);
        CHECK(found->axis == 1);
        for (int i = 0; i < 40; ++i) {
            const double by = 3 * at_random(i, 3);
            ir::Substitution waves;
            for (NodeId wave : found->waves)
                if (found->angles.contains(w.g.arg(wave, 0)))
                    waves[wave] = w.g.make(w.g[wave].op, {w.plus(w.g.arg(wave, 0), by)});
            const NodeId turned = with_numbers(w.g, ir::substitute(w.g, found->field, waves));
            const std::array<double, 3> p{at_random(i, 0), at_random(i, 1), at_random(i, 2)};
            double best = 1e9; // by one of the two ways to turn
            for (const double way : {by, -by}) {
                const std::array<double, 3> q{std::cos(way) * p[0] - std::sin(way) * p[2], p[1],
                                              std::sin(way) * p[0] + std::cos(way) * p[2]};
                best = std::min(best, std::fabs(w.value(turned, q) - w.value(field, p)));
            }
            CHECK(best < 1e-9);
        }
        const double seen = steepest(w, field), bound = w.bound(field);
        CHECK(bound >= seen * (1 - 1e-6));
        CHECK(bound <= 1.35 * seen);
    }
}

TEST_CASE("what only nearly winds about an axis is not taken for it") {
    for (const auto &[name, make] : others) {
        INFO(name);
        Winding w;
        const NodeId field = make(w);
        CHECK(!proof::winding_of(w.g, field));
        CHECK(w.bound(field) >= steepest(w, field) * (1 - 1e-6));
    }
}
