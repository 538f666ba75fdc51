// Loops, choices, tables and hits in a shader: the values that they must have, at each pixel's p =
// (x, y, 0).
#include "tests/unit/glsl/scenes.h"
#include "tests/unit/render_gl/harness.h"

using namespace fathom;
using namespace fathom::scenes;

namespace {

std::vector<float> values(const Scene &scene, int count, bool buffers = false, int rows = 1) {
    Diagnostics diagnostics;
    const glsl::Output output =
        glsl::emit(scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = buffers},
                   diagnostics);
    for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
    REQUIRE_FALSE(diagnostics.has_errors());
    return run_shader(output, count, rows);
}

} // namespace

TEST_CASE("a loop's values are all of the iteration before") {
    require_context();
    // Fibonacci: (a, b) = (b, a + b), as often as p.x says.
    const auto found =
        values(of_field([](Graph &g, NodeId p) {
                   const NodeId a = g.fresh_var(Type::Float), b = g.fresh_var(Type::Float),
                                i = g.fresh_var(Type::Int);
                   const NodeId count = g.make(Op::ToInt, Type::Int, {g.component(p, 0)});
                   const LoopId record = g.add_loop({count, i, {a, b}, {b, g.add(a, b)}, {}, 100});
                   const NodeId loop =
                       g.make(Op::Loop, Type::Float, {g.number(0), g.number(1)}, record.index);
                   return g.make(Op::LoopResult, Type::Float, {loop}, 0);
               }),
               12);
    CHECK(found == std::vector<float>{0, 1, 1, 2, 3, 5, 8, 13, 21, 34, 55, 89});
}

TEST_CASE("a loop ends before the iteration whose condition fails") {
    require_context();
    // Powers of two until one exceeds p.x.
    const auto found =
        values(of_field([](Graph &g, NodeId p) {
                   const NodeId x = g.fresh_var(Type::Float), i = g.fresh_var(Type::Int);
                   const NodeId condition = g.make(Op::LessEqual, {x, g.component(p, 0)});
                   const LoopId record =
                       g.add_loop({g.integer(50), i, {x}, {g.mul(x, g.number(2))}, condition, 50});
                   const NodeId loop = g.make(Op::Loop, Type::Float, {g.number(1)}, record.index);
                   return g.make(Op::LoopResult, Type::Float, {loop}, 0);
               }),
               9);
    CHECK(found == std::vector<float>{1, 2, 4, 4, 8, 8, 8, 8, 16});
}

TEST_CASE("one loop begun twice is two loops") {
    require_context();
    const auto found =
        values(of_field([](Graph &g, NodeId p) {
                   const NodeId x = g.fresh_var(Type::Float), i = g.fresh_var(Type::Int);
                   const LoopId record =
                       g.add_loop({g.integer(3), i, {x}, {g.add(g.mul(x, x), g.number(1))}, {}, 3});
                   const NodeId one =
                       g.make(Op::Loop, Type::Float, {g.component(p, 0)}, record.index);
                   const NodeId two = g.make(Op::Loop, Type::Float, {g.number(0)}, record.index);
                   return g.sub(g.make(Op::LoopResult, Type::Float, {one}, 0),
                                g.make(Op::LoopResult, Type::Float, {two}, 0));
               }),
               3);
    CHECK(found == std::vector<float>{0, 21, 672});
}

TEST_CASE("loops nest, and what does not change in them is computed before") {
    require_context();
    // The sum of x^2 + i*j over i < 3, j < 2.
    const auto found = values(
        of_field([](Graph &g, NodeId p) {
            const NodeId outer = g.fresh_var(Type::Float), i = g.fresh_var(Type::Int);
            const NodeId inner = g.fresh_var(Type::Float), j = g.fresh_var(Type::Int);
            const NodeId square = g.mul(g.component(p, 0), g.component(p, 0));
            const NodeId product = g.make(Op::ToFloat, Type::Float, {g.make(Op::Mul, {i, j})});
            const LoopId over_j = g.add_loop(
                {g.integer(2), j, {inner}, {g.add(inner, g.add(square, product))}, {}, 2});
            const NodeId row = g.make(Op::Loop, Type::Float, {outer}, over_j.index);
            const LoopId over_i = g.add_loop(
                {g.integer(3), i, {outer}, {g.make(Op::LoopResult, Type::Float, {row}, 0)}, {}, 3});
            return g.make(Op::LoopResult, Type::Float,
                          {g.make(Op::Loop, Type::Float, {g.number(0)}, over_i.index)}, 0);
        }),
        4);
    CHECK(found == std::vector<float>{3, 9, 27, 57});
}

TEST_CASE("tables are read alike from a buffer and from the text, and never beside their rows") {
    require_context();
    const Scene scene = of_field([](Graph &g, NodeId p) {
        Table table{20, 7, {}};
        for (int i = 0; i < 140; ++i) table.data.push_back(static_cast<float>(i));
        const TableId id = g.add_table(table);
        const NodeId row = g.make(Op::ToInt, Type::Int, {g.sub(g.component(p, 0), g.number(1))});
        // Columns 2, 3, 4 lie in two texels.
        const NodeId v = g.make(Op::TableRead, Type::Vec3, {row}, table_slot(id, 2));
        const NodeId f = g.make(Op::TableRead, Type::Float, {row}, table_slot(id, 6));
        return g.add(g.make(Op::Dot, {v, g.vec3(1, 100, 10000)}), g.mul(f, g.number(1000000)));
    });
    const auto from_text = values(scene, 23), from_buffer = values(scene, 23, true);
    CHECK(from_text == from_buffer);
    const auto row = [](float r) {
        return 7 * r + 2 + 100 * (7 * r + 3) + 10000 * (7 * r + 4) + 1000000 * (7 * r + 6);
    };
    CHECK(from_text[0] == row(0)); // row -1
    CHECK(from_text[1] == row(0));
    CHECK(from_text[4] == row(3));
    CHECK(from_text[22] == row(19)); // row 21
}

TEST_CASE("a chain of choices takes the arm that it should") {
    require_context();
    const auto found = values(
        of_field([](Graph &g, NodeId p) {
            const NodeId x = g.component(p, 0);
            NodeId chosen = g.number(-1);
            for (int k = 4; k >= 0; --k) { // each arm has work of its own
                const NodeId a = g.make(Op::Sqrt, {g.add(x, g.number(k))});
                const NodeId b = g.add(g.mul(a, a), g.mul(g.mul(a, a), a));
                chosen = g.make(Op::Select, {g.make(Op::Less, {x, g.number(k + 0.5)}), b, chosen});
            }
            return chosen;
        }),
        7);
    for (int x = 0; x < 5; ++x)
        CHECK(found[static_cast<std::size_t>(x)] == Approx(2 * x + std::pow(2 * x, 1.5)));
    CHECK(found[5] == -1);
    CHECK(found[6] == -1);
}

TEST_CASE("hits choose as they should") {
    require_context();
    // Rows of the picture are the cases; what is read back is paint + 10*distance.
    const auto hit = [](Graph &g, double distance, int paint) {
        return g.make(Op::MakeHit, Type::Hit,
                      {g.number(distance), g.integer(paint), g.vec3(0, 0, 0),
                       g.vec(std::array{0.0, 0.0, 0.0, 0.0})});
    };
    const Scene scene = of_field([&](Graph &g, NodeId p) {
        const NodeId cases[] = {
            g.make(Op::NearestHit, Type::Hit, {hit(g, 2, 0), hit(g, 1, 1), hit(g, 1, 2)}),
            g.make(Op::FarthestHit, Type::Hit, {hit(g, 1, 3), hit(g, 2, -1)}),
            g.make(Op::FarthestHit, Type::Hit, {hit(g, 1, 3), hit(g, 2, 4), hit(g, 3, -1)}),
            g.make(Op::FarthestHit, Type::Hit, {hit(g, 2, 5), hit(g, 2, 6)}),
            g.make(Op::HitWith, Type::Hit, {hit(g, 2, 5), g.number(7)}),
            g.make(Op::FillPaint, Type::Hit,
                   {hit(g, 1, -1), g.integer(8), g.vec3(0, 0, 0),
                    g.vec(std::array{0.0, 0.0, 0.0, 0.0})}),
            g.make(Op::FillPaint, Type::Hit,
                   {hit(g, 1, 2), g.integer(8), g.vec3(0, 0, 0),
                    g.vec(std::array{0.0, 0.0, 0.0, 0.0})})};
        NodeId chosen = g.number(0);
        for (int i = 6; i >= 0; --i) {
            const NodeId h = cases[i];
            const NodeId number =
                g.add(g.make(Op::ToFloat, Type::Float, {g.make(Op::HitPaint, Type::Int, {h})}),
                      g.mul(g.make(Op::HitDistance, {h}), g.number(10)));
            chosen = g.make(Op::Select, {g.make(Op::Less, {g.component(p, 0), g.number(i + 0.5)}),
                                         number, chosen});
        }
        return chosen;
    });
    CHECK(values(scene, 7) == std::vector<float>{11, 23, 33, 25, 75, 18, 12});
}
