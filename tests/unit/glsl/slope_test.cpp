// Slopes: tight for what pruning meets, never below what finite differences find.
#include "tests/support/reference_eval.h"
#include "tests/unit/glsl/scenes.h"

#include "backend-glsl/slope.h"

#include <catch2/catch.hpp>

#include <random>

using namespace fathom;
using namespace fathom::scenes;

namespace {

struct Sloped {
    const char *name;
    double slope; // expected
    std::function<NodeId(Graph &, NodeId p)> field;
};

NodeId zero3(Graph &g) { return g.vec3(0, 0, 0); }

NodeId box(Graph &g, NodeId p) {
    const NodeId q = g.sub(g.make(Op::Abs, {p}), g.vec3(1, 0.5, 0.25));
    const NodeId outside = g.make(Op::Length, {g.make(Op::Max, {q, zero3(g)})});
    const NodeId maximum = g.make(
        Op::Max, {g.component(q, 0), g.make(Op::Max, {g.component(q, 1), g.component(q, 2)})});
    return g.add(outside, g.make(Op::Min, {maximum, g.number(0)}));
}

NodeId ring(Graph &g, NodeId p) {
    const NodeId xz = g.swizzle(p, std::array{0, 2});
    const NodeId args[] = {g.sub(g.make(Op::Length, {xz}), g.number(1)), g.component(p, 1)};
    return g.sub(g.make(Op::Length, {g.make(Op::Make, Type::Vec2, args)}), g.number(0.25));
}

const std::vector<Sloped> cases{
    {"sphere", 1,
     [](Graph &g, NodeId p) { return sphere_distance(g, p, g.vec3(1, 2, 3), g.number(1)); }},
    {"box", 1, box},
    {"ring", 1, ring},
    {"moved ring, twice as large", 2,
     [](Graph &g, NodeId p) { return ring(g, g.mul(g.sub(p, g.vec3(1, 0, 0)), g.number(2))); }},
    {"two spheres' sum", 2,
     [](Graph &g, NodeId p) {
         return g.add(sphere_distance(g, p, g.vec3(1, 0, 0), g.number(1)),
                      sphere_distance(g, p, g.vec3(-1, 0, 0), g.number(1)));
     }},
    {"a box's length plus a sphere's inside", 2,
     [](Graph &g, NodeId p) {
         const NodeId q = g.sub(g.make(Op::Abs, {p}), g.vec3(1, 1, 1));
         const NodeId inside =
             g.make(Op::Min, {sphere_distance(g, p, zero3(g), g.number(4)), g.number(0)});
         return g.add(g.make(Op::Length, {g.make(Op::Max, {q, zero3(g)})}), inside);
     }},
    {"least of a box and half a ring", 1,
     [](Graph &g, NodeId p) {
         return g.make(Op::Union, {box(g, p), g.mul(g.number(0.5), ring(g, p))});
     }},
    {"the same component twice", std::sqrt(2.0),
     [](Graph &g, NodeId p) {
         const NodeId args[] = {g.component(p, 0), g.component(p, 0)};
         return g.make(Op::Length, {g.make(Op::Make, Type::Vec2, args)});
     }},
    {"a product of two", std::numeric_limits<double>::infinity(),
     [](Graph &g, NodeId p) { return g.mul(g.component(p, 0), g.component(p, 1)); }},
};

} // namespace

TEST_CASE("slopes are as expected, and no difference is steeper") {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-3, 3);
    for (const Sloped &c : cases) {
        CAPTURE(c.name);
        const Scene scene = of_field(c.field);
        const Function &f = scene.graph.function(scene.distance);
        const double slope = glsl::slope_of(scene.graph, f.result, f.params[0]);
        CHECK(slope == Approx(c.slope));
        if (!std::isfinite(slope)) continue;
        test::Reference reference(scene);
        for (int i = 0; i < 200; ++i) {
            std::array<double, 3> a{place(random), place(random), place(random)}, b = a;
            double way = 0;
            for (double &x : b) {
                const double by = 0.1 * place(random);
                x += by;
                way += by * by;
            }
            CHECK(std::fabs(reference.distance(a) - reference.distance(b)) <=
                  slope * std::sqrt(way) + 1e-9);
        }
    }
}

TEST_CASE("a row's numbers count by the largest that the table holds, matrices by their norm") {
    Scene scene;
    Graph &g = scene.graph;
    const NodeId p = g.fresh_var(Type::Vec3), row = g.fresh_var(Type::Int);
    ir::Table table{3, 10, {}};
    for (int i = 0; i < 3; ++i) {
        const float s = std::sin(float(i)), c = std::cos(float(i));
        const float numbers[] = {c, 0, -s, 0, 1, 0, s, 0, c, float(i)};
        table.data.insert(table.data.end(), std::begin(numbers), std::end(numbers));
    }
    const TableId id = g.add_table(table);
    const NodeId turn = g.make(Op::TableRead, Type::Mat3, {row}, table_slot(id, 0));
    const NodeId by = g.make(Op::TableRead, Type::Float, {row}, table_slot(id, 9));
    const NodeId d = box(g, g.make(Op::MatMul, Type::Vec3, {p, turn}));
    CHECK(glsl::slope_of(g, d, p) == Approx(1).epsilon(1e-3));
    CHECK(glsl::slope_of(g, g.mul(by, d), p) == Approx(2).epsilon(1e-3));
}
