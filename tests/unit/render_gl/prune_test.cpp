// Pruned loops draw the same picture to the bit, by fewer rows.
#include "tests/unit/glsl/scenes.h"
#include "tests/unit/render_gl/context.h"

#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <catch2/catch.hpp>

using namespace fathom;
using namespace fathom::scenes;

namespace {

glsl::Output emitted(const Scene &scene, bool pruning) {
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .buffers = true, .pruning = pruning}, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
    CHECK_FALSE(diagnostics.has_errors());
    return output;
}

gl::Program built(const glsl::Output &output, const Scene &scene) {
    auto program = gl::Program::build(output, scene);
    if (const auto *error = std::get_if<gl::ProgramError>(&program)) FAIL(error->message);
    return std::move(std::get<gl::Program>(program));
}

// Steps, distances and paints; then colours.
std::vector<float> drawn(const gl::Program &program, const Scene &scene, double away) {
    gl::Request request;
    request.width = 96;
    request.height = 72;
    request.view = ir::view_of(scene, 0, 96.0 / 72);
    for (double &x : request.view->origin) x *= away;
    std::vector<float> all;
    for (gl::Mode mode : {gl::Mode::Numbers, gl::Mode::Linear}) {
        const auto pixels = gl::draw(program, scene, request, mode);
        REQUIRE(pixels);
        all.insert(all.end(), pixels->rgba.begin(), pixels->rgba.end());
    }
    return all;
}

bool can_test() { return has_context() && gl::can_prune(); }

} // namespace

TEST_CASE("what is drawn by lists of rows is the same to the bit") {
    if (!can_test()) return;
    for (bool smooth : {false, true})
        for (int count : {128, 500}) {
            CAPTURE(smooth, count);
            const Scene scene = table_of_spheres(count, smooth);
            const glsl::Output output = emitted(scene, true);
            REQUIRE(output.pruning.kernels.size() == (smooth ? 2 : 1));
            // In groups that drivers write out: llvmpipe ends a shader after 65,536 turns in all.
            CHECK(output.text.find(" += 4u) for (uint ") != std::string::npos);
            const gl::Program pruned = built(output, scene),
                              plain = built(emitted(scene, false), scene);
            for (double away : {1.0, 0.5, 3.0}) // from inside of the cells, too, and from far
                CHECK(drawn(pruned, scene, away) == drawn(plain, scene, away));
            const gl::Pruning::Tally tally = pruned.pruning()->tally();
            CHECK(tally.side == 32);
            CHECK(tally.rows < 0.5 * tally.all);
            CHECK(tally.rows >= 1);
        }
}

TEST_CASE("moved rows have fresh lists without a fresh program") {
    if (!can_test()) return;
    const Scene scene = table_of_spheres(300);
    gl::Program pruned = built(emitted(scene, true), scene);
    drawn(pruned, scene, 1);
    // Each row stands where another stood: two texels a row.
    const auto shuffle = [](std::vector<float> &texels) {
        const std::vector<float> before = texels;
        const std::size_t rows = before.size() / 8;
        REQUIRE(rows == 300);
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t k = 0; k < 8; ++k)
                texels[i * 8 + k] = before[(i * 7 + 11) % rows * 8 + k];
    };
    glsl::Output fresh = emitted(scene, true), whole = emitted(scene, false);
    shuffle(fresh.tables);
    shuffle(whole.tables);
    for (glsl::PruneKernel &kernel : fresh.pruning.kernels) shuffle(kernel.tables);
    pruned.adopt(fresh);
    CHECK(drawn(pruned, scene, 1) == drawn(built(whole, scene), scene, 1));
}

TEST_CASE("loops that nothing simple bounds, or that time moves, run over all rows") {
    for (bool moving : {false, true}) {
        const Scene scene = of_field([&](Graph &graph, NodeId p) {
            Table table{200, 1, std::vector<float>(200, 0.5f)};
            const TableId rows = graph.add_table(table);
            const NodeId index = graph.fresh_var(Type::Int), least = graph.fresh_var(Type::Float);
            NodeId radius = graph.make(Op::TableRead, Type::Float, {index}, table_slot(rows, 0));
            NodeId d = graph.make(Op::Length, {p});
            if (moving)
                radius = graph.mul(radius, graph.make(Op::Sin, {graph.time()}));
            else
                d = graph.mul(d, d);
            const NodeId next = graph.make(Op::Union, {least, graph.sub(d, radius)});
            const FoldId id = graph.add_fold({graph.integer(200), index, {least}, {next}, {}, 200});
            return graph.make(Op::Fold, Type::Float, {graph.number(1e9)}, id.index);
        });
        CHECK(emitted(scene, true).pruning.kernels.empty());
    }
}
