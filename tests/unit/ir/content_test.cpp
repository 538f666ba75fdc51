// Words of an expression: the same of the same expression in any graph, and the expression again.
#include "ir/passes/content.h"
#include "ir/passes/dump.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::ir;

namespace {

// An expression that has everything that words name: tables, functions, loops, cached fields,
// variables, params, images, constants. `seed` changes one number deep in it.
NodeId everything(Graph &g, double seed) {
    const NodeId p = g.point(), x = g.component(p, 0);
    Function squared;
    squared.name = "squared";
    squared.params = {g.fresh_var(Type::Float)};
    squared.result = g.mul(squared.params[0], g.add(squared.params[0], g.number(seed)));
    const FunctionId square = g.add_function(squared);
    Function field;
    field.params = {g.fresh_var(Type::Vec3)};
    field.result = g.call(square, std::array{g.component(field.params[0], 1)});
    const CacheId cache = g.add_cache({g.add_function(field), 0.25});

    Loop loop;
    loop.count = g.integer(3);
    loop.max_count = 3;
    loop.index = g.fresh_var(Type::Int);
    loop.vars = {g.fresh_var(Type::Float), g.fresh_var(Type::Float)};
    loop.next = {g.add(loop.vars[0], g.make(Op::ToFloat, {loop.index})), g.mul(loop.vars[1], x)};
    loop.condition = g.make(Op::Less, {loop.vars[0], g.number(10)});
    const LoopId id = g.add_loop(loop);
    const NodeId looped = g.make(Op::Loop, Type::Float, {x, g.number(1)}, id.index);
    const NodeId second = g.make(Op::LoopResult, Type::Float, {looped}, 1);

    Table table;
    table.rows = 2;
    table.stride = 2;
    table.data = {1, 2, 3, 4};
    const TableId rows = g.add_table(table);
    const NodeId read = g.make(Op::TableRead, Type::Float,
                               {g.make(Op::ToInt, {g.make(Op::Floor, {x})})}, table_slot(rows, 1));
    const NodeId image = g.make(Op::Image, Type::Vec4, {g.swizzle(p, std::array{0, 2})}, 0);
    NodeId all = g.add(looped, second);
    for (NodeId one :
         {read, g.component(image, 2), g.call(square, std::array{x}),
          g.make(Op::Cached, Type::Float, {p}, cache.index), g.param(0, Type::Float), g.time()})
        all = g.make(Op::Min, {all, one});
    return all;
}

} // namespace

TEST_CASE("an expression is rebuilt from its words") {
    Graph g;
    const NodeId root = everything(g, 2);
    const Content content = content_of(g, root);
    Graph other;
    const NodeId again = rebuilt(other, content.words);
    CHECK(content_of(other, again).words == content.words);
    // The one has a name for its function, and numbers in the order in which things were made.
    CHECK(other.type(again) == g.type(root));
    CHECK(other.reads(again) == g.reads(root));
    CHECK(other.function_count() == 2);
    CHECK(other.loop_count() == 1);
    CHECK(other.table_count() == 1);
    CHECK(other.cache_count() == 1);
    CHECK(content.params == std::vector<std::uint32_t>{0});
    CHECK(content.caches == std::vector<std::uint32_t>{0});
    CHECK(content.images == std::vector<std::uint32_t>{0});
    CHECK(content.vars.size() == 5);
}

TEST_CASE("words do not know what else is in a graph, and see each number") {
    Graph alone, full;
    const NodeId one = everything(alone, 2);
    // before it: other nodes, functions, tables, loops, variables
    everything(full, 5);
    full.fresh_var(Type::Vec3);
    full.mul(full.component(full.point(), 0), full.number(1.5));
    const NodeId same = everything(full, 2);
    CHECK(content_of(full, same).words == content_of(alone, one).words);
    CHECK(content_of(full, everything(full, 2.5)).words != content_of(full, same).words);

    Graph g;
    const NodeId x = g.component(g.point(), 0), y = g.component(g.point(), 1);
    CHECK(content_of(g, g.sub(x, y)).words != content_of(g, g.sub(y, x)).words);
    CHECK(content_of(g, g.param(3, Type::Float)).words ==
          content_of(g, g.param(1, Type::Float)).words); // which one: Content::params
    CHECK(content_of(g, g.param(3, Type::Float)).params == std::vector<std::uint32_t>{3});
    CHECK(content_of(g, g.number(1)).words != content_of(g, g.integer(1)).words);
}

TEST_CASE("a long chain is rebuilt, and nothing is folded on the way") {
    Graph g;
    NodeId sum = g.component(g.point(), 0);
    for (int i = 0; i < 100'000; ++i) sum = g.make(Op::Sin, {sum});
    const Content content = content_of(g, sum);
    Graph other;
    CHECK(content_of(other, rebuilt(other, content.words)).words == content.words);
    CHECK(other.size() == g.size());
}
