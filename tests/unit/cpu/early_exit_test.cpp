// Loops that end early (ir/passes/early_exit.h): the same values to the bit, and only where the
// guard says so.
#include "ir/passes/early_exit.h"
#include "scenes.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <bit>

using namespace fathom;
using namespace fathom::cpu;
using namespace fathom::cpu::test;

namespace {

struct Escape { // for i in 0..12 { if guard(z, i) { z = z * |z|^0.9 + p, d = 2 d + 1 } }
    Fields f;
    LoopId id;
    NodeId loop_node;
    FunctionId function;
    enum class Guard { Inside, NotOutside, Index, Two, Cheap, While, Flag, FlagIndex, FlagRead };

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
        NodeId begin; // of the flag, which a `break` where the guard fails sets
        if (kind == Guard::While) loop.condition = g.make(Op::Less, {d, g.number(40)});
        if (kind == Guard::Flag || kind == Guard::FlagIndex || kind == Guard::FlagRead) {
            if (kind == Guard::FlagIndex)
                guard = g.make(Op::And, {g.make(Op::Less, {loop.index, g.integer(7)}), guard});
            loop.next = {chosen(z, moved), chosen(d, grown)};
            begin = g.boolean(false);
            loop.vars.push_back(g.fresh_var(Type::Bool));
            loop.next.push_back(g.make(Op::Not, {guard}));
            loop.condition = g.make(Op::Not, {loop.vars.back()});
        }
        if (kind == Guard::Two)
            loop.next[1] = g.make(Op::Select, {g.make(Op::Less, {d, g.number(9)}), grown, d});
        id = g.add_loop(loop);
        std::vector<NodeId> first{f.p, g.number(0)};
        if (begin) first.push_back(begin);
        const NodeId result = g.make(Op::Loop, Type::Vec3, first, id.index);
        loop_node = result;
        NodeId value =
            g.add(g.make(Op::Length, {result}), g.make(Op::LoopResult, Type::Float, {result}, 1));
        if (kind == Guard::FlagRead)
            value = g.make(Op::Select,
                           {g.make(Op::LoopResult, Type::Bool, {result}, 2), value, g.number(7)});
        function = f.function(value);
    }
};

} // namespace

TEST_CASE("a loop whose guard fails for good ends there, with the same values") {
    using enum Escape::Guard;
    for (const auto kind : {Inside, NotOutside, While, Flag, FlagIndex}) {
        Escape escape(kind);
        const Points points = spread(1000);
        const std::vector<float> before = values(compile(escape.f.scene, escape.function), points);
        end_loops_early(escape.f.g);
        const ir::Loop &loop = escape.f.g.loop(escape.id);
        REQUIRE(loop.condition);
        // The Loop node is made after what it computes.
        CHECK(loop.condition.index < escape.loop_node.index);
        for (const NodeId next : loop.next) CHECK(escape.f.g[next].op != Op::Select);
        if (loop.vars.size() > 2) { // the flag
            CHECK(loop.next[2] == loop.vars[2]);
            CHECK(std::ranges::count(escape.f.g.free_vars(loop.condition), loop.vars[2]) == 0);
        }
        const std::vector<float> after = values(compile(escape.f.scene, escape.function), points);
        for (std::size_t i = 0; i < before.size(); ++i)
            REQUIRE(std::bit_cast<int>(before[i]) == std::bit_cast<int>(after[i]));
    }
}

TEST_CASE("a loop that breaks goes on where the flag is read after it, with the same values") {
    Escape escape(Escape::Guard::FlagRead);
    const NodeId before = escape.f.g.loop(escape.id).condition;
    end_loops_early(escape.f.g);
    CHECK(escape.f.g.loop(escape.id).condition == before);
}

TEST_CASE("a loop goes on where its guard reads the index, where there are two, and where the way "
          "out would cost more than the body") {
    for (const auto kind : {Escape::Guard::Index, Escape::Guard::Two, Escape::Guard::Cheap}) {
        Escape escape(kind);
        end_loops_early(escape.f.g);
        CHECK_FALSE(escape.f.g.loop(escape.id).condition);
    }
}
