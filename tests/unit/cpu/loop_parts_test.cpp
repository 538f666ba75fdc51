// Parts of loops by loops of their own (ir/passes/loop_parts.h): the same values to the bit, and
// only for what goes by itself and leads the rest.
#include "ir/passes/loop_parts.h"
#include "scenes.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace fathom;
using namespace fathom::cpu;
using namespace fathom::cpu::test;

namespace {

// for i in 0..7 while x < 50 { (x, y, z) = next }, by the components and a number of the index
struct Carrying {
    Fields f;
    Graph &g = f.g;
    ir::Loop loop;
    NodeId state = g.fresh_var(Type::Vec3), x = g.component(state, 0), y = g.component(state, 1),
           z = g.component(state, 2), turn;
    Carrying() {
        loop.count = g.integer(7);
        loop.max_count = 7;
        loop.index = g.fresh_var(Type::Int);
        turn = g.make(Op::ToFloat, Type::Float, {loop.index});
        loop.condition = g.make(Op::Less, {x, g.number(50)});
        loop.vars = {state};
    }
    NodeId result(NodeId next) {
        loop.next = {next};
        return g.make(Op::Loop, Type::Vec3, {f.p}, g.add_loop(loop).index);
    }
    NodeId made(NodeId a, NodeId b, NodeId c) { return g.make(Op::Make, Type::Vec3, {a, b, c}); }
};

} // namespace

TEST_CASE("what a loop computes of itself alone, and leads the rest, has a loop of its own") {
    Carrying c;
    Graph &g = c.g;
    const NodeId next_x = g.add({g.mul(c.x, g.number(1.7)), c.turn}),
                 nearer = g.make(Op::Less, {next_x, g.mul(g.number(3), c.x)});
    const NodeId whole = c.result(
        g.make(Op::Select, {nearer, c.made(next_x, g.add(c.y, c.turn), g.mul(c.z, c.x)), c.state}));
    const NodeId parts = loop_result(g, whole, 0);
    REQUIRE(parts != whole);
    const NodeId first = g.component(parts, 0);
    REQUIRE(g[first].op == Op::Loop);
    CHECK(g.loop(ir::LoopId{g[first].payload}).vars.size() == 1);
    for (int i : {1, 2}) CHECK(g.component(parts, i) == g.component(whole, i));
    const NodeId weights = g.vec3(0.3, 0.5, 0.7);
    const Points points = spread(1000);
    const auto value = [&](NodeId vector) {
        const ir::FunctionId function = c.f.function(g.make(Op::Dot, {vector, weights}));
        return values(compile(c.f.scene, function), points);
    };
    const std::vector<float> of_whole = value(whole), of_parts = value(parts);
    for (std::size_t i = 0; i < of_whole.size(); ++i)
        REQUIRE(std::bit_cast<int>(of_whole[i]) == std::bit_cast<int>(of_parts[i]));
}

TEST_CASE("a point that a loop folds stays a vector") {
    const auto stays = [](const std::function<NodeId(Carrying &)> &next) {
        Carrying c;
        c.loop.condition = {};
        const NodeId whole = c.result(next(c));
        return loop_result(c.g, whole, 0) == whole;
    };
    CHECK(stays([](Carrying &c) { // each component by itself, and none leads
        return c.g.sub(c.g.mul(c.state, c.g.number(2)), c.g.splat(c.turn, Type::Vec3));
    }));
    CHECK(stays([](Carrying &c) { return c.made(c.y, c.z, c.x); }));        // all by all
    CHECK(stays([](Carrying &c) { return c.g.make(Op::Sin, {c.state}); })); // not of scalars
}
