// Pruned loops draw the same picture to the bit, by fewer rows; rays land the same through far
// cells.
#include "tests/support/gl_context.h"
#include "tests/support/reference_eval.h"
#include "tests/unit/glsl/scenes.h"

#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <functional>
#include <random>
#include <tuple>

using namespace fathom;
using namespace fathom::scenes;

namespace {

glsl::Output emitted(const Scene &scene, bool pruning, bool far_cells = false) {
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(scene,
                                     {.target = glsl::Target::Glsl330,
                                      .buffers = true,
                                      .pruning = pruning,
                                      .far_cells = far_cells},
                                     diagnostics);
    for (const Diagnostic &d : diagnostics.items()) UNSCOPED_INFO(d.message);
    CHECK_FALSE(diagnostics.has_errors());
    return output;
}

gl::Program built(const glsl::Output &output, const Scene &scene) {
    auto program = gl::Program::build(output, scene);
    if (const auto *error = std::get_if<gl::ProgramError>(&program)) FAIL(error->message);
    return std::move(std::get<gl::Program>(program));
}

std::vector<float> drawn(const gl::Program &program, const Scene &scene, double away, gl::Mode mode,
                         double time = 0) {
    gl::Request request;
    request.width = 96;
    request.height = 72;
    request.time = time;
    request.view = ir::view_of(scene, time, 96.0 / 72);
    request.view->origin *= away;
    const auto pixels = gl::draw(program, scene, request, mode);
    REQUIRE(pixels);
    return pixels->rgba;
}

// Steps, distances and paints; then colours.
std::vector<float> drawn(const gl::Program &program, const Scene &scene, double away) {
    std::vector<float> all = drawn(program, scene, away, gl::Mode::Numbers);
    const std::vector<float> colors = drawn(program, scene, away, gl::Mode::Linear);
    all.insert(all.end(), colors.begin(), colors.end());
    return all;
}

// Steps, distances, paints and, where nothing casts a shadow, colours to the bit. Of a shadow's edge
// the driver rounds the gradient otherwise in another text: seldom, and by less than a byte shows.
void check_alike(const gl::Program &a, const gl::Program &b, const Scene &scene, double away,
                 bool shadows) {
    CHECK(drawn(a, scene, away, gl::Mode::Numbers) == drawn(b, scene, away, gl::Mode::Numbers));
    const auto one = drawn(a, scene, away, gl::Mode::Linear),
               other = drawn(b, scene, away, gl::Mode::Linear);
    if (!shadows) {
        CHECK(one == other);
        return;
    }
    REQUIRE(one.size() == other.size());
    float most = 0;
    std::size_t apart = 0;
    for (std::size_t i = 0; i < one.size(); ++i) {
        most = std::max(most, std::abs(one[i] - other[i]));
        apart += std::abs(one[i] - other[i]) >= 1e-6f;
    }
    CHECK(most < 1e-3f); // a quarter of a byte's step
    CHECK(apart <= one.size() / 1000);
}

// Of two pictures of the same: by pixel the largest difference of a colour, in descending order;
// and the rays' ends that lie farther apart than the march's tolerance allows.
struct Apart {
    std::vector<float> colors{};
    int ends = 0, hits = 0;
};
Apart apart(const gl::Program &a, const gl::Program &b, const Scene &scene, double away,
            double time = 0) {
    Apart result;
    const auto ends_a = drawn(a, scene, away, gl::Mode::Numbers, time),
               ends_b = drawn(b, scene, away, gl::Mode::Numbers, time);
    const auto colors_a = drawn(a, scene, away, gl::Mode::Linear, time),
               colors_b = drawn(b, scene, away, gl::Mode::Linear, time);
    for (std::size_t i = 0; i < ends_a.size(); i += 4) {
        const float t = ends_a[i + 1], u = ends_b[i + 1];
        result.hits += t >= 0;
        result.ends += (t < 0) != (u < 0) || std::abs(t - u) > 0.01f * std::max(t, 0.1f);
        float maximum = 0;
        for (std::size_t k = 0; k < 3; ++k)
            maximum = std::max(maximum, std::abs(colors_a[i + k] - colors_b[i + k]));
        result.colors.push_back(maximum);
    }
    std::ranges::sort(result.colors, std::greater<>());
    return result;
}

void require_pruning() {
    require_context();
    REQUIRE(gl::can_prune());
}

} // namespace

TEST_CASE("what is drawn by lists of rows is the same") {
    require_pruning();
    for (const auto &[smooth, shadows, count] :
         {std::tuple{false, true, 128}, std::tuple{false, false, 500}, std::tuple{false, true, 160},
          std::tuple{true, false, 128}, std::tuple{true, false, 500},
          std::tuple{true, true, 160}}) {
        // Without lists llvmpipe has no turns left for the shadows of 500 rows in one draw.
        CAPTURE(smooth, shadows, count);
        Scene scene = table_of_spheres(count, smooth);
        if (!shadows) scene.lighting.shadow_darkness = scene.graph.number(0);
        const glsl::Output output = emitted(scene, true);
        REQUIRE(output.pruning.kernels.size() == (smooth ? 2 : 1));
        // In groups that drivers write out: llvmpipe ends a shader after 65,536 iterations in
        // all.
        CHECK(output.text.find(" += 4u) for (uint ") != std::string::npos);
        const gl::Program pruned = built(output, scene),
                          plain = built(emitted(scene, false), scene);
        for (double away : {1.0, 0.5, 3.0}) // from inside of the cells, too, and from far
            check_alike(pruned, plain, scene, away, shadows);
        const gl::Pruning::Tally tally = pruned.pruning()->tally();
        CHECK(tally.side == 32);
        CHECK(tally.rows < 0.5 * tally.all);
        CHECK(tally.rows >= 1);
    }
}

TEST_CASE("rays land where they did, through far cells that promise no more than there is") {
    require_pruning();
    for (bool smooth : {false, true}) {
        CAPTURE(smooth);
        const Scene scene = table_of_spheres(300, smooth);
        const glsl::Output output = emitted(scene, true, true);
        REQUIRE_FALSE(output.pruning.far.text.empty());
        const gl::Program pruned = built(output, scene), plain = built(emitted(scene, true), scene);
        for (double away : {1.0, 0.5, 3.0}) {
            CAPTURE(away);
            const Apart found = apart(pruned, plain, scene, away);
            CHECK(found.hits > 90);
            CHECK(found.ends <= 2);          // within the tolerance of what they pass
            CHECK(found.colors[20] < 0.02f); // a shadow's edge, a normal in another place
        }

        const std::vector<float> far = pruned.pruning()->far_cells();
        const auto side = static_cast<std::size_t>(pruned.pruning()->tally().side);
        REQUIRE(far.size() == side * side * side);
        CHECK(std::ranges::count_if(far, [](float f) { return f > 0; }) > 0.5 * double(far.size()));
        test::Reference reference(scene);
        std::mt19937 random(5);
        std::uniform_real_distribution<double> part(0, 1);
        for (int tries = 0; tries < 3000; ++tries) {
            const std::size_t cell = random() % far.size();
            const std::array<std::size_t, 3> index{cell % side, cell / side % side,
                                                   cell / (side * side)};
            std::array<double, 3> p{};
            double from_center = 0, half_diagonal = 0;
            for (std::size_t i = 0; i < 3; ++i) {
                const double size =
                    (output.pruning.hi[i] - output.pruning.lo[i]) / static_cast<double>(side);
                const double at = part(random);
                p[i] = output.pruning.lo[i] + (static_cast<double>(index[i]) + at) * size;
                from_center += (at - 0.5) * (at - 0.5) * size * size;
                half_diagonal += 0.25 * size * size;
            }
            if (far[cell] == 0) continue;
            CHECK(far[cell] > std::sqrt(half_diagonal));
            CHECK(far[cell] - std::sqrt(from_center) <= reference.distance(p));
        }
    }
}

TEST_CASE("far cells follow the time, by the rows' old lists") {
    require_pruning();
    Scene scene = table_of_spheres(200);
    Graph &g = scene.graph;
    // A ball that goes through the others, beside their loop.
    const Function rows = g.function(scene.distance);
    const NodeId p = rows.params[0], zero = g.number(0),
                 x = g.mul(g.number(3), g.make(Op::Sin, {g.time()}));
    const NodeId ball =
        sphere_distance(g, p, g.make(Op::Make, Type::Vec3, {x, zero, zero}), g.number(0.5));
    scene.distance = g.add_function({"scene", {}, {p}, g.make(Op::Union, {rows.result, ball})});
    const glsl::Output output = emitted(scene, true, true);
    CHECK(output.pruning.far.reads_time);
    const gl::Program pruned = built(output, scene), plain = built(emitted(scene, true), scene);
    for (double time : {0.0, 0.5, 1.6}) {
        CAPTURE(time);
        const Apart found = apart(pruned, plain, scene, 1, time);
        CHECK(found.ends <= 2); // within the tolerance of what they pass
        CHECK(found.colors[20] < 0.02f);
    }
}

TEST_CASE("a ground that goes on beyond the cells is drawn, lit and shaded as it was") {
    require_pruning();
    for (bool smooth : {false, true}) {
        CAPTURE(smooth);
        Scene scene = table_of_spheres(300, smooth);
        Graph &g = scene.graph;
        const Function rows = g.function(scene.distance), row_hits = g.function(scene.hit);
        const auto ground = [&](NodeId p) {
            return g.make(Op::Add, {g.component(p, 1), g.number(2.3)});
        };
        const auto ground_hit = [&](NodeId p) {
            return g.make(Op::MakeHit, Type::Hit,
                          {ground(p), g.integer(-1), p, g.vec(std::array{0.0, 0.0, 0.0, 0.0})});
        };
        const NodeId p = rows.params[0], q = row_hits.params[0];
        scene.distance =
            g.add_function({"scene", {}, {p}, g.make(Op::Union, {rows.result, ground(p)})});
        scene.hit =
            g.add_function({"scene_hit",
                            {},
                            {q},
                            g.make(Op::NearestHit, Type::Hit, {row_hits.result, ground_hit(q)})});
        scene.endless = g.add_function({"endless", {}, {p}, ground(p)});
        scene.endless_hit = g.add_function({"endless_hit", {}, {q}, ground_hit(q)});
        scene.facts[scene.root.index].bounds = Box::everything();
        Light sun; // low, so that the rows' shadow leaves the cells
        sun.directional = true;
        sun.position = g.vec3(0.8, 0.4, 0.3);
        sun.color = g.vec3(1, 1, 1);
        scene.lights.push_back(sun);
        const gl::Program pruned = built(emitted(scene, true, true), scene),
                          plain = built(emitted(scene, false), scene);
        for (double away : {1.0, 0.5, 3.0}) {
            CAPTURE(away);
            const Apart found = apart(pruned, plain, scene, away);
            CHECK(found.hits > 1000);
            CHECK(found.ends <= found.hits / 500); // at the horizon rays run out of steps
            CHECK(found.colors[static_cast<std::size_t>(found.hits / 200)] < 0.02f);
        }
    }
}

TEST_CASE("moved rows have fresh lists without a fresh program") {
    require_pruning();
    const Scene scene = table_of_spheres(300);
    gl::Program pruned = built(emitted(scene, true), scene),
                far = built(emitted(scene, true, true), scene);
    drawn(pruned, scene, 1);
    drawn(far, scene, 1);
    // Each row stands where another stood: two texels a row.
    const auto shuffle = [](std::vector<float> &texels) {
        const std::vector<float> before = texels;
        const std::size_t rows = before.size() / 8;
        REQUIRE(rows == 300);
        for (std::size_t i = 0; i < rows; ++i)
            for (std::size_t k = 0; k < 8; ++k)
                texels[i * 8 + k] = before[(i * 7 + 11) % rows * 8 + k];
    };
    const auto shuffled = [&](glsl::Output output) {
        shuffle(output.tables);
        for (glsl::PruneKernel &kernel : output.pruning.kernels) shuffle(kernel.tables);
        if (!output.pruning.far.text.empty()) shuffle(output.pruning.far.tables);
        return output;
    };
    pruned.adopt(shuffled(emitted(scene, true)));
    const gl::Program whole = built(shuffled(emitted(scene, false)), scene);
    CHECK(drawn(pruned, scene, 1) == drawn(whole, scene, 1));
    far.adopt(shuffled(emitted(scene, true, true)));
    const Apart found = apart(far, whole, scene, 1);
    CHECK(found.ends == 0);
    CHECK(found.colors[20] < 0.02f);
}

TEST_CASE("rows that move have the lists of their time") {
    require_pruning();
    const auto made = [](bool steep) {
        return of_field([&](Graph &graph, NodeId p) {
            Table table{200, 1, {}};
            for (int i = 0; i < 200; ++i) table.data.push_back(static_cast<float>(0.01 * i - 1));
            const TableId rows = graph.add_table(table);
            const NodeId index = graph.fresh_var(Type::Int), minimum = graph.fresh_var(Type::Float);
            const NodeId x = graph.make(Op::TableRead, Type::Float, {index}, table_slot(rows, 0)),
                         phase = graph.add(graph.time(), graph.mul(x, graph.number(20))),
                         y = graph.mul(graph.number(0.8), graph.make(Op::Sin, {phase}));
            NodeId d = graph.make(Op::Length, {graph.sub(p, graph.make(Op::Make, Type::Vec3,
                                                                       {x, y, graph.number(0)}))});
            if (steep) d = graph.mul(d, d);
            const NodeId next = graph.make(Op::Union, {minimum, graph.sub(d, graph.number(0.02))});
            const LoopId id =
                graph.add_loop({graph.integer(200), index, {minimum}, {next}, {}, 200});
            return graph.make(Op::Loop, Type::Float, {graph.number(1e9)}, id.index);
        });
    };
    const Scene scene = made(false);
    const gl::Program pruned = built(emitted(scene, true), scene),
                      plain = built(emitted(scene, false), scene);
    std::vector<float> before;
    for (double time : {0.0, 0.4, 2.0}) {
        CAPTURE(time);
        const std::vector<float> now = drawn(pruned, scene, 1, gl::Mode::Numbers, time);
        CHECK(now == drawn(plain, scene, 1, gl::Mode::Numbers, time));
        CHECK(now != before);
        before = now;
    }
    CHECK(pruned.pruning()->tally().rows < 0.5 * pruned.pruning()->tally().all);
    // Nothing simple bounds a square's slope: such loops run over all rows.
    CHECK(emitted(made(true), true).pruning.kernels.empty());
}
