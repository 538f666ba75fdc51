// The tape computes what the graph says, keeps loops and calls, and joins what stands together.
#include "scenes.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>

using namespace fathom::cpu;
using namespace fathom::cpu::test;

TEST_CASE("a ball is one kernel and gives its distance") {
    Fields f;
    Program program = compile(f.scene, f.function(f.ball(1, 2, 3, 0.5)));
    CHECK(program.steps.size() == 1);
    CHECK(count_steps(program, "Ball") == 1);
    Points points = spread(1000); // not a multiple of any width
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i) {
        float dx = points.x[i] - 1, dy = points.y[i] - 2, dz = points.z[i] - 3;
        REQUIRE(out[i] == std::sqrt(dx * dx + dy * dy + dz * dz) - 0.5f);
    }
}

TEST_CASE("a union holds one running value, however many its operands") {
    Fields f;
    std::vector<NodeId> balls;
    for (int i = 0; i < 100; ++i) balls.push_back(f.ball(i % 10 - 5, i / 10 - 5, 0, 0.3));
    Program program = compile(f.scene, f.function(f.g.make(Op::Union, Type::Float, balls)));
    CHECK(program.registers <= 4);
    CHECK(program.steps.size() == 100);
    Points points = spread(500);
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i) {
        float minimum = 1e9f;
        for (int b = 0; b < 100; ++b)
            minimum = std::min(
                minimum,
                std::sqrt((points.x[i] - float(b % 10 - 5)) * (points.x[i] - float(b % 10 - 5)) +
                          (points.y[i] - float(b / 10 - 5)) * (points.y[i] - float(b / 10 - 5)) +
                          points.z[i] * points.z[i]) -
                    0.3f);
        REQUIRE(out[i] == minimum);
    }
}

TEST_CASE("solids cut out of each other run as one kernel, or apart to be pruned") {
    Fields f;
    Graph &g = f.g;
    const NodeId x = g.component(f.p, 0), y = g.component(f.p, 1);
    auto slab = [&](NodeId along, double lo, double hi) {
        return g.make(Op::Max, {g.sub(g.number(lo), along), g.sub(along, g.number(hi))});
    };
    const NodeId beam = g.make(Op::Intersection, {slab(x, -1, 0.5), slab(y, -0.25, 2)});
    const NodeId pair = g.make(Op::Union, {x, y});
    const NodeId both = g.make(Op::Union, {f.ball(0, 1, 0, 0.3), beam});
    const NodeId all =
        g.make(Op::Intersection, {f.ball(0, 0, 0, 3), pair, g.neg(g.make(Op::Length, {f.p}))});
    const FunctionId function = f.function(g.add(both, all));
    const Program joined = compile(f.scene, function),
                  apart = compile(f.scene, function, Choices::Apart);
    for (const char *name : {"Slab", "MinMax", "MaxMin", "MaxNeg"}) {
        INFO(name);
        CHECK(count_steps(joined, name) == (name == std::string("Slab") ? 2 : 1));
        CHECK(count_steps(apart, name) == 0);
    }
    const Points points = spread(1000);
    CHECK(values(joined, points) == values(apart, points));
}

// 100 balls from a table, least distance: acc = min(acc, |p - row.xyz| - row.w).
static FunctionId table_loop(Fields &f, NodeId count, NodeId condition_on = {}) {
    Graph &g = f.g;
    Table table;
    table.rows = 100;
    table.stride = 4;
    for (int i = 0; i < 100; ++i) {
        float row[] = {float(i % 10) - 5, float(i / 10) - 5, 0.25f * float(i % 3), 0.3f};
        table.data.insert(table.data.end(), row, row + 4);
    }
    TableId id = g.add_table(table);
    fathom::ir::Loop record;
    record.count = count;
    record.max_count = 100;
    record.index = g.fresh_var(Type::Int);
    NodeId acc = g.fresh_var(Type::Float);
    NodeId c = g.make(Op::TableRead, Type::Vec3, {record.index}, table_slot(id, 0));
    NodeId r = g.make(Op::TableRead, Type::Float, {record.index}, table_slot(id, 3));
    NodeId d = g.sub(f.length(g.sub(f.p, c)), r);
    record.vars = {acc};
    record.next = {g.make(Op::Min, {acc, d})};
    if (condition_on) record.condition = g.make(Op::Less, {condition_on, acc});
    NodeId loop = g.make(Op::Loop, Type::Float, {g.number(1e9)}, g.add_loop(record).index);
    return f.function(loop);
}

static float minimum_of(int count, float x, float y, float z) {
    float minimum = 1e9f;
    for (int b = 0; b < count; ++b) {
        float dx = x - (float(b % 10) - 5), dy = y - (float(b / 10) - 5),
              dz = z - 0.25f * float(b % 3);
        minimum = std::min(minimum, std::sqrt(dx * dx + dy * dy + dz * dz) - 0.3f);
    }
    return minimum;
}

TEST_CASE("a loop over a table stays a loop, its rows shared by all points") {
    Fields f;
    Program program = compile(f.scene, table_loop(f, f.g.integer(100)));
    CHECK(program.loops.size() == 1);
    CHECK(count_steps(program, "MinBall") == 1);
    CHECK(program.steps.size() <= 6);
    Points points = spread(700);
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i)
        REQUIRE(out[i] == minimum_of(100, points.x[i], points.y[i], points.z[i]));
}

TEST_CASE("each point iterates as often as it is told") {
    Fields f;
    NodeId count =
        f.g.make(Op::ToInt, Type::Int, {f.g.mul(f.g.add(f.x(), f.g.number(2)), f.g.number(25))});
    Program program = compile(f.scene, table_loop(f, count));
    Points points = spread(333);
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i)
        REQUIRE(out[i] ==
                minimum_of(int((points.x[i] + 2) * 25), points.x[i], points.y[i], points.z[i]));
}

TEST_CASE("a point that is done keeps its value while others go on") {
    Fields f;
    Program program = compile(f.scene, table_loop(f, f.g.integer(100), f.g.number(3.5)));
    Points points = spread(333);
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i) {
        float minimum = 1e9f;
        for (int b = 0; b < 100 && minimum > 3.5f; ++b)
            minimum = minimum_of(b + 1, points.x[i], points.y[i], points.z[i]);
        REQUIRE(out[i] == minimum);
    }
}

TEST_CASE("variables of a loop move on together") { // Fibonacci by (a, b) -> (b, a + b)
    Fields f;
    Graph &g = f.g;
    fathom::ir::Loop record;
    record.count = g.integer(20);
    record.max_count = 20;
    record.index = g.fresh_var(Type::Int);
    NodeId a = g.fresh_var(Type::Float), b = g.fresh_var(Type::Float);
    record.vars = {a, b};
    record.next = {b, g.add(a, b)};
    SECTION("the same for all points") {
        NodeId loop =
            g.make(Op::Loop, Type::Float, {g.number(0), g.number(1)}, g.add_loop(record).index);
        NodeId second = g.make(Op::LoopResult, Type::Float, {loop}, 1);
        Program program = compile(f.scene, f.function(g.add(g.mul(loop, g.number(0.5)), second)));
        CHECK(program.registers <= 3); // nothing but the point
        for (float v : values(program, spread(20))) REQUIRE(v == 6765 * 0.5f + 10946);
    }
    SECTION("different") {
        NodeId loop = g.make(Op::Loop, Type::Float, {g.number(0), f.x()}, g.add_loop(record).index);
        Program program = compile(f.scene, f.function(loop));
        Points points = spread(20);
        std::vector<float> out = values(program, points);
        for (std::size_t i = 0; i < 20; ++i) {
            float s = 0, t = points.x[i];
            for (int k = 0; k < 20; ++k) std::swap(s += t, t);
            REQUIRE(out[i] == Approx(s).epsilon(1e-5));
        }
    }
}

TEST_CASE("loops in loops, and what does not change in one is computed before it") {
    Fields f;
    Graph &g = f.g;
    fathom::ir::Loop inner, outer;
    outer.count = g.integer(4);
    outer.max_count = 4;
    outer.index = g.fresh_var(Type::Int);
    NodeId sum = g.fresh_var(Type::Float);
    inner.count = g.make(Op::Add, {outer.index, g.integer(1)});
    inner.max_count = 4;
    inner.index = g.fresh_var(Type::Int);
    NodeId part = g.fresh_var(Type::Float);
    NodeId fixed = g.make(Op::Sin, {f.x()}); // outside both
    NodeId iteration = g.make(
        Op::Cos, {g.add(f.y(), g.make(Op::ToFloat, Type::Float, {outer.index}))}); // in the outer
    inner.vars = {part};
    inner.next = {g.add(
        part, g.mul(g.add(fixed, iteration), g.make(Op::ToFloat, Type::Float, {inner.index})))};
    NodeId inner_loop = g.make(Op::Loop, Type::Float, {sum}, g.add_loop(inner).index);
    outer.vars = {sum};
    outer.next = {inner_loop};
    NodeId loop = g.make(Op::Loop, Type::Float, {g.number(0)}, g.add_loop(outer).index);
    Program program = compile(f.scene, f.function(loop));
    Points points = spread(50);
    std::vector<float> out = values(program, points);
    for (std::size_t i = 0; i < out.size(); ++i) {
        float s = 0;
        for (int o = 0; o < 4; ++o)
            for (int k = 0; k <= o; ++k)
                s = (std::sin(points.x[i]) + std::cos(points.y[i] + float(o))) * float(k) + s;
        REQUIRE(out[i] == Approx(s).epsilon(1e-5));
    }
    auto of_block = [&](std::uint32_t block) {
        std::size_t sines = 0;
        for (auto i = program.blocks[block].first; i < program.blocks[block].last; ++i)
            sines += program.steps[i].kind == StepKind::Run;
        return sines;
    };
    CHECK(of_block(program.loops[0].block) <= 4); // neither sine nor cosine
}

TEST_CASE(
    "functions that are called often stay functions: doubling twenty times is twenty functions") {
    Fields f;
    Graph &g = f.g;
    NodeId p = f.p;
    // Each is long enough not to be built in place.
    auto body = [&](NodeId v) {
        for (int i = 0; i < 30; ++i) v = g.add(g.mul(v, g.number(0.5)), g.make(Op::Sin, {v}));
        return v;
    };
    FunctionId last = f.function({p}, body(g.component(p, 0)));
    for (int level = 0; level < 20; ++level) {
        NodeId q = g.fresh_var(Type::Vec3);
        NodeId shifted = g.add(q, g.vec3(0.5, 0, 0));
        NodeId twice =
            g.make(Op::Min, {g.call(last, std::span(&q, 1)), g.call(last, std::span(&shifted, 1))});
        last = f.function({q}, body(twice));
    }
    Program program = compile(f.scene, last);
    CHECK(program.steps.size() < 4000);
}

TEST_CASE("a called function sees its arguments, shared or not, and keeps out of its caller's "
          "registers") {
    Fields f;
    Graph &g = f.g;
    NodeId a = g.fresh_var(Type::Float), k = g.fresh_var(Type::Float);
    NodeId v = a;
    for (int i = 0; i < 30; ++i) v = g.add(g.mul(v, k), a);
    FunctionId callee = g.add_function({"g", {}, {a, k}, v});
    auto call = [&](NodeId of, double with) {
        NodeId args[] = {of, g.number(with)};
        return g.call(callee, args);
    };
    NodeId both = g.add(g.mul(call(f.x(), 0.5), f.z()), call(f.y(), 0.25));
    Program program = compile(f.scene, f.function(both));
    Points points = spread(77);
    std::vector<float> out = values(program, points);
    auto expected = [](float a, float k) {
        float v = a;
        for (int i = 0; i < 30; ++i) v = v * k + a;
        return v;
    };
    for (std::size_t i = 0; i < out.size(); ++i)
        REQUIRE(out[i] == expected(points.x[i], 0.5f) * points.z[i] + expected(points.y[i], 0.25f));
}

TEST_CASE("params and time are read when a scratch is made") {
    Fields f;
    f.scene.params.resize(2);
    NodeId v = f.g.add(f.g.mul(f.x(), f.g.component(f.g.param(1, Type::Vec3), 1)), f.g.time());
    Program program = compile(f.scene, f.function(v));
    Inputs inputs;
    inputs.params = {{{1, 2, 3, 4}}, {{5, 6, 7, 8}}};
    inputs.time = 0.5;
    Points points = spread(3);
    std::vector<float> out = values(program, points, inputs);
    for (std::size_t i = 0; i < 3; ++i) CHECK(out[i] == points.x[i] * 6 + 0.5f);
}

TEST_CASE("the nearest hit carries its paint; the first wins a tie; unpainted is filled") {
    Fields f;
    Graph &g = f.g;
    NodeId zero4 = g.make(Op::Splat, Type::Vec4, {g.number(0)});
    auto hit = [&](NodeId d, int paint) {
        return g.make(Op::MakeHit, Type::Hit, {d, g.integer(paint), f.p, zero4});
    };
    NodeId near = g.make(
        Op::NearestHit, Type::Hit,
        {hit(f.ball(0, 0, 0, 1), 3), hit(f.ball(0, 0, 0, 1), 4), hit(f.ball(1, 0, 0, 1), -1)});
    NodeId filled = g.make(Op::FillPaint, Type::Hit, {near, g.integer(7), f.p, zero4});
    Program program = compile(f.scene, f.function(filled));
    Points points = spread(100);
    Scratch scratch = make_scratch(program, {});
    std::vector<std::vector<float>> out(9, std::vector<float>(100));
    float *to[9];
    for (std::size_t c = 0; c < 9; ++c) to[c] = out[c].data();
    const float *in[] = {points.x.data(), points.y.data(), points.z.data()};
    evaluate(program, scratch, in, to, 100);
    for (std::size_t i = 0; i < 100; ++i)
        CHECK(std::bit_cast<std::int32_t>(out[1][i]) == (points.x[i] > 0.5f ? 7 : 3));
}

TEST_CASE("the gradient is that of the operand that decides") {
    Fields f;
    Program program = compile(
        f.scene, f.function(f.g.make(Op::Union, {f.ball(-1, 0, 0, 0.5), f.ball(1, 0, 0, 0.25)})));
    GradientScratch scratch = make_gradient_scratch(program, {});
    Points points = spread(100);
    std::vector<std::vector<float>> out(4, std::vector<float>(100));
    float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data()};
    const float *in[] = {points.x.data(), points.y.data(), points.z.data()};
    evaluate_gradient(program, scratch, in, to, 100);
    std::vector<float> value = values(program, points);
    for (std::size_t i = 0; i < 100; ++i) {
        CHECK(out[0][i] == value[i]);
        float a = std::hypot(points.x[i] + 1, points.y[i], points.z[i]),
              b = std::hypot(points.x[i] - 1, points.y[i], points.z[i]);
        float cx = a - 0.5f <= b - 0.25f ? -1.0f : 1.0f, d = cx < 0 ? a : b;
        CHECK(out[1][i] == Approx((points.x[i] - cx) / d).margin(1e-5));
        CHECK(out[2][i] == Approx(points.y[i] / d).margin(1e-5));
        CHECK(out[3][i] == Approx(points.z[i] / d).margin(1e-5));
    }
}
