// Lists of like operands as loops: the same values, in the same order, and a text that does not
// grow.
#include "tests/support/reference_eval.h"
#include "tests/unit/glsl/scenes.h"

#include "backend-glsl/emit.h"
#include "backend-glsl/reroll.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::scenes;

namespace {

// Operand i: alternately a sphere, a slab, and a sphere by way of a function that holds its number.
// Numbers are such that floats hold them.
NodeId operand(Graph &g, NodeId p, int i) {
    const double x = 0.125 * (i % 16) - 1, r = 0.0625 + 0.03125 * (i % 7);
    if (i % 3 == 0) return sphere_distance(g, p, g.vec3(x, r, -x), g.number(r));
    if (i % 3 == 1)
        return g.sub(g.make(Op::Abs, {g.sub(g.component(p, 1), g.number(x))}), g.number(r));
    const NodeId q = g.fresh_var(Type::Vec3);
    const NodeId own = sphere_distance(g, q, g.vec3(r, r, x), g.number(0.5 * r));
    const NodeId args[] = {p};
    return g.call(g.add_function({"own", {}, {q}, own}), args);
}

Scene list_of(Op op, int count, int kinds) {
    return of_field([&](Graph &g, NodeId p) {
        std::vector<NodeId> args;
        if (op == Op::Blend) args = {g.number(0.25), g.number(1)};
        for (int i = 0; i < count; ++i) args.push_back(operand(g, p, kinds == 1 ? 3 * i : i));
        return g.make(op, Type::Float, args, std::uint32_t(Profile::Smooth));
    });
}

std::size_t text_size(const Scene &scene) {
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
    CHECK_FALSE(diagnostics.has_errors());
    return output.text.size();
}

} // namespace

TEST_CASE("a loop over a list's operands has the list's values") {
    for (Op op : {Op::Blend, Op::Union, Op::Intersection})
        for (int kinds : {1, 3}) {
            const Scene scene = list_of(op, 1200, kinds);
            const std::optional<glsl::Rerolled> loops = glsl::rerolled(scene);
            REQUIRE(loops);
            const NodeId result = loops->results.at(scene.distance.index);
            REQUIRE(loops->scene.graph[result].op == Op::Loop);
            const NodeId p = scene.graph.function(scene.distance).params[0];
            for (int k = 0; k < 40; ++k) {
                const std::array<double, 3> at{0.11 * k - 2, 0.07 * k - 1.4, 0.05 * (k % 9)};
                CAPTURE(ir::info(op).name, kinds, k);
                test::Reference listed(scene), looped(loops->scene);
                CHECK(looped.evaluated(result, {{p, test::Reference::vec3(at)}}).value[0] ==
                      listed.distance(at));
            }
        }
}

TEST_CASE("the text of a long list is as long for twice the operands") {
    for (int kinds : {1, 3}) {
        const std::size_t once = text_size(list_of(Op::Blend, 1200, kinds)),
                          twice = text_size(list_of(Op::Blend, 2400, kinds));
        CAPTURE(once, twice);
        CHECK(twice < once + 64);
    }
}

TEST_CASE("a short list, and one whose operands are unlike, stay as they are") {
    CHECK_FALSE(glsl::rerolled(list_of(Op::Blend, 12, 1)));
    const Scene unlike = of_field([](Graph &g, NodeId p) {
        std::vector<NodeId> args;
        NodeId x = g.component(p, 0);
        for (int i = 0; i < 40; ++i) {
            x = g.make(i % 2 ? Op::Sin : Op::Cos, {x});
            args.push_back(x);
        }
        return g.make(Op::Union, Type::Float, args);
    });
    const std::optional<glsl::Rerolled> loops = glsl::rerolled(unlike);
    CHECK((!loops || loops->results.empty()));
}
