// Loops that end early (ir/passes/early_exit.h): the same values to the bit, and only where the
// guard says so.
#include "ir/passes/early_exit.h"
#include "scenes.h"

#include <catch2/catch.hpp>

#include <bit>

using namespace fathom;
using namespace fathom::cpu;
using namespace fathom::cpu::test;

namespace {

struct Escape { // for i in 0..12 { if guard(z, i) { z = z * |z|^0.9 + p, d = 2 d + 1 } }
    Fields f;
    LoopId id;
    FunctionId function;
    enum class Guard { Inside, NotOutside, Index, Two, Cheap };

    explicit Escape(Guard kind) {
        Graph &g = f.g;
        ir::Loop loop;
        loop.count =
            g.make(Op::Min, {g.constant({Type::Int, {12}}), g.constant({Type::Int, {13}})});
        loop.max_count = 12;
        loop.index = g.fresh_var(Type::Int);
        const NodeId z = g.fresh_var(Type::Vec3), d = g.fresh_var(Type::Float);
        loop.vars = {z, d};
        const NodeId size = g.make(Op::Length, {z}), two = g.number(2);
        NodeId guard = g.make(Op::LessEqual, {size, two});
        if (kind == Guard::NotOutside) guard = g.make(Op::Less, {two, size});
        if (kind == Guard::Index)
            guard = g.make(Op::Less, {g.make(Op::ToFloat, Type::Float, {loop.index}), size});
        NodeId moved = g.add(g.mul(g.make(Op::Pow, {size, g.number(0.9)}), z), f.p);
        moved = g.add(moved, g.make(Op::Sin, {z}));
        if (kind == Guard::Cheap) moved = g.swizzle(z, std::array{1, 0, 2});
        const NodeId grown = g.add(g.mul(two, d), g.number(1));
        const auto chosen = [&](NodeId now, NodeId then) {
            if (kind == Guard::NotOutside) std::swap(now, then);
            return g.make(Op::Select, {guard, then, now});
        };
        loop.next = {chosen(z, moved), chosen(d, kind == Guard::Cheap ? g.neg(d) : grown)};
        if (kind == Guard::Two)
            loop.next[1] = g.make(Op::Select, {g.make(Op::Less, {d, g.number(9)}), grown, d});
        id = g.add_loop(loop);
        const NodeId result = g.make(Op::Loop, Type::Vec3, {f.p, g.number(0)}, id.index);
        function = f.function(
            g.add(g.make(Op::Length, {result}), g.make(Op::LoopResult, Type::Float, {result}, 1)));
    }
};

} // namespace

TEST_CASE("a loop whose guard fails for good ends there, with the same values") {
    for (const auto kind : {Escape::Guard::Inside, Escape::Guard::NotOutside}) {
        Escape escape(kind);
        const Points points = spread(1000);
        const std::vector<float> before = values(compile(escape.f.scene, escape.function), points);
        end_loops_early(escape.f.g);
        CHECK(escape.f.g.loop(escape.id).condition);
        for (const NodeId next : escape.f.g.loop(escape.id).next)
            CHECK(escape.f.g[next].op != Op::Select);
        const std::vector<float> after = values(compile(escape.f.scene, escape.function), points);
        for (std::size_t i = 0; i < before.size(); ++i)
            REQUIRE(std::bit_cast<int>(before[i]) == std::bit_cast<int>(after[i]));
    }
}

TEST_CASE("a loop goes on where its guard reads the index, where there are two, and where the way "
          "out would cost more than the body") {
    for (const auto kind : {Escape::Guard::Index, Escape::Guard::Two, Escape::Guard::Cheap}) {
        Escape escape(kind);
        end_loops_early(escape.f.g);
        CHECK_FALSE(escape.f.g.loop(escape.id).condition);
    }
}
