// Cameras, frames and the values of closed expressions.
#include "ir/view.h"
#include "tests/unit/glsl/scenes.h"

#include <catch2/catch.hpp>

#include <glm/geometric.hpp>
#include <set>

using namespace fathom;
using namespace fathom::scenes;

namespace {

using glm::dot;

void check_frame(const View &v) {
    CHECK(dot(v.right, v.right) == Approx(1));
    CHECK(dot(v.up, v.up) == Approx(1));
    CHECK(dot(v.forward, v.forward) == Approx(1));
    CHECK(dot(v.right, v.up) == Approx(0).margin(1e-12));
    CHECK(dot(v.right, v.forward) == Approx(0).margin(1e-12));
    CHECK(dot(glm::cross(v.right, v.up), v.forward) == Approx(-1)); // right-handed
}

} // namespace

TEST_CASE("a view is a right-handed frame, also straight up and down") {
    for (glm::dvec3 from : {glm::dvec3{3, 2, 5}, glm::dvec3{0, 4, 0}, glm::dvec3{0, -4, 0},
                            glm::dvec3{0, 0, 0}, glm::dvec3{-1e6, 1, 1}})
        check_frame(look_at(from, {0, 0, 0}, 1, false));
    CHECK(look_at({0, 4, 0}, {0, 0, 0}, 1, false).right[0] ==
          Approx(1)); // a map: x to the right, -z up
    CHECK(look_at({0, 4, 0}, {0, 0, 0}, 1, false).up[2] == Approx(-1));
}

TEST_CASE("without a camera the finite parts' box just fits, in wide and in tall pictures") {
    Scene scene = sphere();
    scene.bounds = scene.extent = {{1, 2, 3}, {3, 4, 5}};
    for (double aspect : {0.5, 1.0, 2.0}) {
        const View view = view_of(scene, 0, aspect);
        CHECK(view.forward[0] / view.forward[2] == Approx(3.0 / 5));
        CHECK(view.forward[1] / view.forward[2] == Approx(3.0 / 5));
        const glm::dvec3 middle = glm::dvec3(2, 3, 4) - view.origin;
        CHECK(glm::dot(middle, view.forward) == Approx(view.focus));
        double left = 0, right = 0, down = 0, up = 0; // 1: the picture's edge
        for (int corner = 0; corner < 8; ++corner) {
            const glm::dvec3 at{corner & 1 ? 3 : 1, corner & 2 ? 4 : 2, corner & 4 ? 5 : 3};
            const glm::dvec3 from = at - view.origin;
            const double seen = view.extent * glm::dot(from, view.forward),
                         x = glm::dot(from, view.right) / (seen * std::min(aspect, 4.0 / 3)),
                         y = glm::dot(from, view.up) / seen;
            left = std::min(left, x), right = std::max(right, x);
            down = std::min(down, y), up = std::max(up, y);
        }
        // Nine tenths of the height, or of the width, and as much room on both sides of it. Between the
        // widths that it is known for, a little less.
        const bool by_width = right - left > up - down;
        const double within = aspect < 1 ? 0.03 : 1e-6;
        CHECK((by_width ? right : up) == Approx(0.9).epsilon(within));
        CHECK((by_width ? left : down) == Approx(-0.9).epsilon(within));
        CHECK(std::max({-left, right, -down, up}) <= 0.9 + 1e-6);
    }
}

TEST_CASE("closed expressions have values: params, time, functions, loops, tables") {
    Scene scene;
    Graph &g = scene.graph;
    Param size;
    size.value = {3, 0, 0, 0};
    scene.params.push_back(size);
    const NodeId n = g.param(0, Type::Float);
    CHECK(value_of(scene, g.add(g.time(), n), 2.5)[0] == 5.5);
    const NodeId x = g.fresh_var(Type::Float);
    const FunctionId square = g.add_function({"square", {}, {x}, g.mul(x, x)});
    CHECK(value_of(scene, g.call(square, {&n, 1}), 0)[0] == 9);

    // The sum of a table's rows below the limit, by a loop in which the limit is a variable of an
    // outer loop.
    const TableId table = g.add_table({4, 1, {1, 10, 100, 1000}});
    const NodeId sum = g.fresh_var(Type::Float), i = g.fresh_var(Type::Int);
    const NodeId outer = g.fresh_var(Type::Float), j = g.fresh_var(Type::Int);
    const NodeId row = g.make(Op::TableRead, Type::Float, {i}, table_slot(table, 0));
    const LoopId inner_loop = g.add_loop({j, i, {sum}, {g.add(sum, row)}, {}, 4});
    const NodeId inner =
        g.make(Op::LoopResult, Type::Float,
               {g.make(Op::Loop, Type::Float, {g.number(0)}, inner_loop.index)}, 0);
    const LoopId outer_loop = g.add_loop({g.integer(4), j, {outer}, {g.add(outer, inner)}, {}, 4});
    const NodeId all = g.make(Op::LoopResult, Type::Float,
                              {g.make(Op::Loop, Type::Float, {g.number(0)}, outer_loop.index)}, 0);
    CHECK(value_of(scene, all, 0)[0] == 0 + 1 + 11 + 111);
    CHECK(value_of(scene, {}, 0)[0] == 0);
}

TEST_CASE("samples of a pixel begin in its middle, lie in it and differ") {
    CHECK(sample_offset(0) == std::array{0.5, 0.5});
    std::set<std::array<double, 2>> seen;
    double x = 0, y = 0;
    for (int k = 0; k < 64; ++k) {
        const auto at = sample_offset(k);
        CHECK((at[0] >= 0 && at[0] < 1 && at[1] >= 0 && at[1] < 1));
        seen.insert(at);
        x += at[0] / 64, y += at[1] / 64;
    }
    CHECK(seen.size() == 64);
    CHECK(x == Approx(0.5).margin(0.02));
    CHECK(y == Approx(0.5).margin(0.02));
}

TEST_CASE("rays are held in a box only where everything is finite") {
    Scene scene = sphere();
    const View view = view_of(scene, 0, 1);
    CHECK(frame_of(scene, view, 100).boxed);
    CHECK(frame_of(scene, view, 100).lo[0] < -1);
    scene.facts[scene.root.index].bounds = Box::everything();
    CHECK_FALSE(frame_of(scene, view, 100).boxed);
    scene.unit_slope = true;
    CHECK(frame_of(scene, view, 100).unit_slope);
    scene.unit_slope = false;
    CHECK_FALSE(frame_of(scene, view, 100).unit_slope);
    scene.render.far = 7;
    CHECK(frame_of(scene, view, 100).far == 7);
}

TEST_CASE("without a light a sun shines from the upper left behind the camera") {
    Scene scene = sphere();
    const View view = view_of(scene, 0, 1);
    const auto lights = lights_of(scene, 0, view);
    REQUIRE(lights.size() == 1);
    CHECK(lights[0].directional);
    CHECK(dot(lights[0].position, view.right) < 0);
    CHECK(dot(lights[0].position, view.up) > 0);
    CHECK(dot(lights[0].position, view.forward) < 0);
    scene.lights.push_back({false, scene.graph.vec3(1, 2, 3), scene.graph.vec3(1, 1, 1)});
    CHECK(lights_of(scene, 0, view)[0].position == glm::dvec3{1, 2, 3});
}
