// Images and grids on every evaluator: the same samples by the same rule, which is written down
// here once more.
#include "backend-cpu/tape.h"
#include "tests/conformance/questions.h"
#include "tests/unit/glsl/scenes.h"
#include "tests/unit/render_gl/harness.h"

#include <cmath>

using namespace fathom;
using namespace fathom::conformance;
using ir::NodeId;
using ir::Op;
using ir::Type;

namespace {

constexpr int width = 5, height = 3; // odd, and not square: a flip or an exchange shows
constexpr int size_x = 4, size_y = 3, size_z = 2;

void add_data(ir::Scene &scene) {
    Random random{7};
    ir::ImageData image{"image", width, height, {}};
    for (int i = 0; i < width * height * 4; ++i)
        image.rgba.push_back(static_cast<float>(random.between(0, 1)));
    scene.images.push_back(image);
    ir::GridData grid{"grid", {size_x, size_y, size_z}, {}};
    for (int i = 0; i < size_x * size_y * size_z; ++i)
        grid.values.push_back(static_cast<float>(random.between(-1, 1)));
    scene.grids.push_back(grid);
}

// The first row of the file is the upper edge, v = 1; between the texels' middles the mean by the
// nearness of the four.
double image_by_rule(const ir::ImageData &image, double u, double v, int channel) {
    const auto texel = [&](double column, double row) {
        const auto turned = [](double i, int n) {
            return static_cast<int>(i - n * std::floor(i / n));
        };
        return double(image.rgba[static_cast<std::size_t>(
            (turned(row, height) * width + turned(column, width)) * 4 + channel)]);
    };
    const double x = u * width - 0.5, y = (1 - v) * height - 0.5, left = std::floor(x),
                 top = std::floor(y);
    double sum = 0;
    for (double column : {left, left + 1})
        for (double row : {top, top + 1})
            sum += (1 - std::abs(x - column)) * (1 - std::abs(y - row)) * texel(column, row);
    return sum;
}

// The first and last samples stand on the faces; beyond, the nearest counts. x runs fastest.
double grid_by_rule(const ir::GridData &grid, double px, double py, double pz) {
    const double x = std::clamp(px, 0.0, 1.0) * (size_x - 1),
                 y = std::clamp(py, 0.0, 1.0) * (size_y - 1),
                 z = std::clamp(pz, 0.0, 1.0) * (size_z - 1);
    double sum = 0;
    for (int k = 0; k < size_z; ++k)
        for (int j = 0; j < size_y; ++j)
            for (int i = 0; i < size_x; ++i) {
                const auto near = [](double a, double b) {
                    return std::max(0.0, 1 - std::abs(a - b));
                };
                sum += near(x, i) * near(y, j) * near(z, k) *
                       double(grid.values[static_cast<std::size_t>((k * size_y + j) * size_x + i)]);
            }
    return sum;
}

struct Asked {
    std::vector<std::array<float, 3>> points;
    std::vector<std::array<double, 5>> wanted; // four channels, the grid's value
};

Asked asked(const ir::Scene &scene) {
    Asked out;
    Random random{3};
    for (int i = 0; i < 301; ++i) {
        std::array<float, 3> p;
        for (float &x : p) x = static_cast<float>(random.between(-2, 3));
        if (i < 40) // on texels' middles and edges, and where images meet
            p = {static_cast<float>(i % 11) / 10, static_cast<float>(i % 7) / 6,
                 static_cast<float>(i % 3) / 2};
        std::array<double, 5> want{};
        for (int c = 0; c < 4; ++c)
            want[static_cast<std::size_t>(c)] = image_by_rule(scene.images[0], p[0], p[1], c);
        want[4] = grid_by_rule(scene.grids[0], p[0], p[1], p[2]);
        out.points.push_back(p);
        out.wanted.push_back(want);
    }
    return out;
}

std::vector<NodeId> readings(ir::Graph &g, NodeId p) {
    const NodeId texel = g.make(Op::Image, Type::Vec4, {g.swizzle(p, std::array{0, 1})}, 0);
    std::vector<NodeId> all;
    for (int c = 0; c < 4; ++c) all.push_back(g.component(texel, c));
    all.push_back(g.make(Op::Grid, Type::Float, {p}, 0));
    return all;
}

} // namespace

TEST_CASE("images and grids: the tape samples by the rule") {
    ir::Scene scene;
    add_data(scene);
    const Asked ask = asked(scene);
    const NodeId p = scene.graph.fresh_var(Type::Vec3);
    const std::vector<NodeId> results = readings(scene.graph, p);
    const cpu::Program program = cpu::compile(scene, std::span(&p, 1), results);
    cpu::Scratch scratch = cpu::make_scratch(program, {});
    const std::size_t n = ask.points.size();
    std::vector<std::vector<float>> in(3, std::vector<float>(n)), out(5, std::vector<float>(n));
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 3; ++k) in[k][i] = ask.points[i][k];
    const float *from[] = {in[0].data(), in[1].data(), in[2].data()};
    float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data(), out[4].data()};
    cpu::evaluate(program, scratch, from, to, n);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 5; ++k)
            worst = std::max(worst, std::abs(out[k][i] - ask.wanted[i][k]));
    CHECK(worst < 1e-5);
}

TEST_CASE("images and grids: a coordinate may be the same for all points") {
    const Asked ask = [] {
        ir::Scene scene;
        add_data(scene);
        return asked(scene);
    }();
    const std::array<float, 3> held{0.3f, 0.6f, 0.8f};
    for (int which = 1; which < 8; ++which) { // a bit for each coordinate that is held
        ir::Scene scene;
        add_data(scene);
        ir::Graph &g = scene.graph;
        const NodeId p = g.fresh_var(Type::Vec3);
        std::vector<NodeId> parts;
        for (int k = 0; k < 3; ++k)
            parts.push_back(which >> k & 1 ? g.number(held[static_cast<std::size_t>(k)])
                                           : g.component(p, k));
        const std::vector<NodeId> results = readings(g, g.make(Op::Make, Type::Vec3, parts));
        const cpu::Program program = cpu::compile(scene, std::span(&p, 1), results);
        cpu::Scratch scratch = cpu::make_scratch(program, {});
        const std::size_t n = ask.points.size();
        std::vector<std::vector<float>> in(3, std::vector<float>(n)), out(5, std::vector<float>(n));
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t k = 0; k < 3; ++k) in[k][i] = ask.points[i][k];
        const float *from[] = {in[0].data(), in[1].data(), in[2].data()};
        float *to[] = {out[0].data(), out[1].data(), out[2].data(), out[3].data(), out[4].data()};
        cpu::evaluate(program, scratch, from, to, n);
        double worst = 0;
        for (std::size_t i = 0; i < n; ++i) {
            std::array<double, 3> at{};
            for (std::size_t k = 0; k < 3; ++k)
                at[k] = which >> k & 1 ? double(held[k]) : double(ask.points[i][k]);
            for (int c = 0; c < 4; ++c)
                worst = std::max(worst, std::abs(double(out[static_cast<std::size_t>(c)][i]) -
                                                 image_by_rule(scene.images[0], at[0], at[1], c)));
            worst = std::max(worst, std::abs(double(out[4][i]) -
                                             grid_by_rule(scene.grids[0], at[0], at[1], at[2])));
        }
        INFO("held: " << which);
        CHECK(worst < 1e-5);
    }
}

TEST_CASE("images and grids: a shader samples by the rule") {
    require_context();
    ir::Scene data;
    add_data(data);
    const Asked ask = asked(data);
    ir::Table table{static_cast<int>(ask.points.size()), 3, {}};
    for (const auto &p : ask.points) table.data.insert(table.data.end(), p.begin(), p.end());
    ir::Scene scene = scenes::of_field([&](ir::Graph &g, NodeId at) {
        const NodeId row = g.make(Op::ToInt, Type::Int, {g.component(at, 0)});
        const NodeId p =
            g.make(Op::TableRead, Type::Vec3, {row}, ir::table_slot(g.add_table(table), 0));
        const std::vector<NodeId> all = readings(g, p);
        NodeId chosen = all.back();
        for (int i = 3; i >= 0; --i)
            chosen = g.make(Op::Select, {g.make(Op::Less, {g.component(at, 1), g.number(i + 0.5)}),
                                         all[static_cast<std::size_t>(i)], chosen});
        return chosen;
    });
    add_data(scene);
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .field_only = true, .buffers = true}, diagnostics);
    REQUIRE_FALSE(diagnostics.has_errors());
    const auto n = ask.points.size();
    const std::vector<float> found = run_shader(output, static_cast<int>(n), 5, &scene);
    double worst = 0;
    for (std::size_t i = 0; i < n; ++i)
        for (std::size_t k = 0; k < 5; ++k)
            worst = std::max(worst, std::abs(double(found[k * n + i]) - ask.wanted[i][k]));
    CHECK(worst < 1e-5);
}
