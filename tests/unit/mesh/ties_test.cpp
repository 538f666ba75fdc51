// Numbers of a tape that change alike, against sampled values; and what no corner of a cell shows.
#include "driver/compile.h"
#include "mesh/mend.h"
#include "mesh/nearest.h"
#include "mesh/slopes.h"
#include "tests/support/mesh_checks.h"

#include <catch2/catch.hpp>

#include <bit>
#include <cmath>
#include <fmt/format.h>
#include <random>

using namespace fathom;

namespace {

ir::Scene tied_scene(const std::string &text) {
    const driver::Compilation c = driver::compile_text("mesh.sdf", text, "", {});
    REQUIRE(c.good());
    return c.scene;
}

// What a number of the tape is at each of some points, no more than a batch of them: its floats.
std::vector<float> floats_of(mesh::Evaluator &evaluator, const mesh::Level &level,
                             const mesh::Points &points) {
    const mesh::Field &field = evaluator.field;
    cpu::Selection steps = field.whole->selection(field.parts);
    steps.steps = steps.steps.subspan(0, level.where.step + 1);
    steps.packed = {};
    std::vector<float> out(points.size());
    const float *in[] = {points.at[0].data(), points.at[1].data(), points.at[2].data()};
    float *to[] = {out.data()};
    cpu::evaluate(field.program, evaluator.values, in, to, points.size(), steps, nullptr);
    for (std::size_t k = 0; k < points.size(); ++k)
        out[k] = std::bit_cast<float>(evaluator.values.cells[level.where.address + k]);
    return out;
}

// Two flush parts, turned by the same angle in one turn and in two, somewhere.
std::string flush_pair(std::mt19937 &dice) {
    std::uniform_real_distribution<double> some(0.2, 1.2), place(-0.5, 0.5);
    const double first = some(dice), second = some(dice);
    const std::string axis =
        fmt::format("[{:.3f}, {:.3f}, {:.3f}]", place(dice), some(dice), place(dice));
    const std::string move = dice() % 2 ? fmt::format(".translate(x: {:.3f})", place(dice)) : "";
    return fmt::format("(box(2) - box({0:.3f})){1}.rotate({2:.5f}, axis: {4}) | "
                       "box({0:.3f}){1}.rotate({3:.5f}, axis: {4}).rotate({5:.5f}, axis: {4})",
                       some(dice), move, first + second, first, axis, second);
}

} // namespace

TEST_CASE("numbers that are said to be tied are, wherever they are sampled") {
    constexpr int scenes = 12, boxes_of_each = 8;
    constexpr std::size_t samples = 64;
    std::size_t asked = 0, narrow = 0;
    std::mt19937 dice(11);
    std::uniform_real_distribution<float> place(-0.8f, 0.8f), share(0, 1), size(0.005f, 0.2f);
    for (int n = 0; n < scenes; ++n) {
        const std::string text = flush_pair(dice);
        INFO(text);
        const mesh::Field field(tied_scene(text), 0, {});
        mesh::Evaluator evaluator(field);
        cpu::Boxes boxes;
        for (int b = 0; b < boxes_of_each; ++b) {
            mesh::Point lo{}, hi{};
            for (std::size_t i = 0; i < 3; ++i) lo[i] = place(dice), hi[i] = lo[i] + size(dice);
            mesh::Points points;
            for (std::size_t k = 0; k < samples; ++k) {
                mesh::Point p{};
                for (std::size_t i = 0; i < 3; ++i) // the corners first
                    p[i] = k < 8 ? (k >> i & 1 ? hi[i] : lo[i])
                                 : std::min(hi[i], lo[i] + share(dice) * (hi[i] - lo[i]));
                points.add(p);
            }
            const std::vector<mesh::Level> levels =
                mesh::levels_in(evaluator, *field.whole, boxes, lo, hi);
            std::vector<std::vector<float>> values;
            for (const mesh::Level &level : levels)
                values.push_back(floats_of(evaluator, level, points));
            for (std::size_t x = 0; x < levels.size(); ++x)
                for (std::size_t y = 0; y < levels.size(); ++y) {
                    if (x == y) continue;
                    const mesh::Tie tie = mesh::tie_of(levels[x], levels[y], lo, hi);
                    std::size_t outside = 0;
                    for (std::size_t k = 0; k < samples; ++k) {
                        const double left = values[y][k] - tie.share * values[x][k];
                        outside += !(left >= tie.lo && left <= tie.hi);
                    }
                    CHECK(outside == 0);
                    ++asked;
                    narrow += tie.width() < 1e-5;
                }
        }
    }
    CHECK(asked > 1000);
    CHECK(narrow > 100); // flush parts are tied within some ulps
}

TEST_CASE("sharp tips that no corner of a cell shows are drawn, and certified") {
    struct Case {
        const char *text;
        std::array<double, 3> tip;
    };
    for (const auto &[text, tip] : std::vector<Case>{
             {"tetrahedron(1)", {0.57735, 0.57735, 0.57735}},
             {"cone(0.2, 3)", {0, 1.5, 0}},
             {"cone(0.2, 3).rotate(0.3, axis: Z)", {-1.5 * std::sin(0.3), 1.5 * std::cos(0.3), 0}},
         })
        for (const int resolution : {12, 24, 48}) {
            INFO(text << " at " << resolution);
            mesh::Settings settings;
            settings.resolution = resolution;
            const mesh::Mended made = mesh::make_certified_mesh(tied_scene(text), settings);
            REQUIRE(made.made.failure == mesh::Failure::None);
            CHECK(made.certificate.certified());
            const auto near = mesh::TriangleTree(made.made.mesh).nearest(tip, 10);
            REQUIRE(near);
            const mesh::Lattice &lattice = made.made.octree.lattice;
            CHECK(near->distance <= lattice.side(lattice.level));
        }
}
