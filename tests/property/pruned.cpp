// Cells against whole tapes on real scenes: the examples, the scenes of the measures, random ones,
// thousands of shapes. Exact values are the same to the bit, distance and hit; bounds are never
// above; and no ray of a pruned march passes what a plain march with the whole tape hits.
#include "backend-cpu/prune/pruning.h"
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "ir/passes/operations.h"
#include "programs.h"
#include "random_scenes.h"
#include "tests/support/effort.h"

#include <bit>
#include <catch2/catch.hpp>
#include <cmath>
#include <filesystem>

using namespace fathom;
namespace fs = std::filesystem;

namespace {

std::vector<fs::path> scenes() {
    std::vector<fs::path> files;
    for (const char *folder : {"examples", "bench/scenes"})
        for (const fs::directory_entry &entry :
             fs::directory_iterator(fs::path(FATHOM_SOURCE_DIR) / folder))
            if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

// Half of the points anywhere in and round the cube, half of them near surfaces.
std::array<std::vector<float>, 3> points_in(const ir::Scene &scene, const cpu::Program &distance,
                                            const cpu::Cube &cube, std::size_t n) {
    test::Dice dice{n};
    std::array<std::vector<float>, 3> all, out;
    const std::size_t tries = 4 * n;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (std::size_t i = 0; i < tries; ++i)
            all[axis].push_back(cube.lo[axis] + cube.side * float(dice.in(-0.05, 1.05)));
    std::vector<float> d(tries);
    cpu::Scratch scratch = cpu::make_scratch(distance, cpu::inputs_of(scene, 0.25));
    const float *in[] = {all[0].data(), all[1].data(), all[2].data()};
    float *to[] = {d.data()};
    cpu::evaluate(distance, scratch, in, to, tries);
    for (std::size_t i = 0; i < tries && out[0].size() < n; ++i)
        if (std::fabs(d[i]) < 0.03f * cube.side || i >= tries / 2)
            for (std::size_t axis = 0; axis < 3; ++axis) out[axis].push_back(all[axis][i]);
    return out;
}

struct Wrong {
    std::size_t exact = 0, bounds = 0, points = 0;
    double shapes = 0, again = 0; // of the points: whose cell did not know the value
};

// A function of the scene in cells against the tape of a picture that is not pruned.
Wrong compare(const ir::Scene &scene, ir::FunctionId function, const cpu::Cube &cube,
              bool far_cells, std::size_t n) {
    const cpu::Program program = cpu::compile(scene, function, cpu::Choices::Apart),
                       joined = cpu::compile(scene, function),
                       distance = cpu::compile(scene, scene.distance);
    const cpu::Inputs inputs = cpu::inputs_of(scene, 0.25);
    cpu::PruneSettings settings;
    settings.far_cells = far_cells;
    settings.enough = 4;
    settings.depth = 3;
    const cpu::Pruning pruning(program, inputs, cube, settings);
    cpu::CellEvaluator evaluator(pruning, inputs);
    const auto points = points_in(scene, distance, cube, n);
    const std::size_t count = points[0].size();
    const float *in[] = {points[0].data(), points[1].data(), points[2].data()};
    std::vector<std::vector<float>> whole(program.results.size(), std::vector<float>(count)),
        pruned = whole;
    std::vector<float *> to, pruned_to;
    for (std::size_t c = 0; c < whole.size(); ++c)
        to.push_back(whole[c].data()), pruned_to.push_back(pruned[c].data());
    cpu::Scratch scratch = cpu::make_scratch(joined, inputs);
    cpu::evaluate(joined, scratch, in, to.data(), count);
    cpu::evaluate(pruning, evaluator, in, pruned_to.data(), count);
    Wrong wrong;
    wrong.points = count;
    for (std::size_t c = 0; c < whole.size(); ++c)
        for (std::size_t k = 0; k < count; ++k) {
            const bool number =
                whole[c][k] == whole[c][k] || program.results[c].type != ir::Type::Float;
            wrong.exact += number && std::bit_cast<std::uint32_t>(whole[c][k]) !=
                                         std::bit_cast<std::uint32_t>(pruned[c][k]);
        }
    wrong.shapes =
        evaluator.tally.shapes / double(std::max<std::uint64_t>(evaluator.tally.near, 1));
    wrong.again = double(evaluator.tally.again) / double(count);
    if (!far_cells) return wrong;
    const std::vector<float> limits(count, 0.001f * cube.side);
    cpu::evaluate(pruning, evaluator, in, pruned_to.data(), count, limits.data());
    for (std::size_t k = 0; k < count; ++k)
        wrong.bounds +=
            pruned[0][k] > whole[0][k] || (pruned[0][k] < whole[0][k] && pruned[0][k] < limits[k]);
    return wrong;
}

cpu::Cube cube_of(const ir::Scene &scene) {
    cpu::Cube cube{{-3, -3, -3}, 6};
    if (scene.bounds.empty() || !scene.bounds.finite()) return cube;
    double side = 1e-3;
    for (std::size_t i = 0; i < 3; ++i)
        side = std::max(side, 1.3 * (scene.bounds.hi[i] - scene.bounds.lo[i]));
    cube.side = float(side);
    for (std::size_t i = 0; i < 3; ++i)
        cube.lo[i] = float((scene.bounds.hi[i] + scene.bounds.lo[i] - side) / 2);
    return cube;
}

// False: more than a picture could cost.
bool check(const ir::Scene &scene, std::size_t n) {
    if (ir::operations(scene.graph, scene.graph.function(scene.distance).result) > 1e5)
        return false;
    const cpu::Cube cube = cube_of(scene);
    const Wrong d = compare(scene, scene.distance, cube, true, n);
    CHECK(d.points >= n / 2);
    CHECK(d.exact == 0);
    CHECK(d.bounds == 0);
    const Wrong h = compare(scene, scene.hit, cube, false, n / 4);
    CHECK(h.exact == 0);
    return true;
}

} // namespace

TEST_CASE("cells say what whole scenes say: examples and measures") {
    for (const fs::path &file : scenes()) {
        driver::Compilation c = driver::compile_file(file, {});
        INFO(file.filename().string());
        REQUIRE(c.good());
        check(c.scene, 4000);
    }
}

TEST_CASE("cells say what whole scenes say: random scenes") {
    const auto scenes = static_cast<unsigned>(test::effort(50)),
               programs = static_cast<unsigned>(test::effort(20));
    int checked = 0;
    for (std::uint64_t seed = 1; seed <= scenes; ++seed) {
        const std::string text = test::text_of(*test::RandomScene(seed).solid(4));
        INFO(seed << ": " << text);
        driver::Compilation c = driver::compile_text("random.sdf", text, {}, {});
        if (c.diagnostics.has_errors()) continue;
        checked += check(c.scene, 1000);
    }
    CHECK(checked > int(scenes) * 2 / 5);
    int programs_checked = 0;
    for (unsigned seed = 1; seed <= programs; ++seed) {
        INFO(seed);
        driver::Compilation c = driver::compile_text("random.sdf", programs::scene(seed), {}, {});
        if (c.diagnostics.has_errors()) continue;
        programs_checked += check(c.scene, 500);
    }
    CHECK(programs_checked > int(programs) / 6);
}

TEST_CASE("of two thousand unlike shapes a cell keeps a few") {
    test::Dice dice{7};
    std::string text;
    const auto place = [&] {
        char words[80];
        std::snprintf(words, sizeof words, ".translate([%.3f, %.3f, %.3f])\n", dice.in(-10, 10),
                      dice.in(-10, 10), dice.in(-10, 10));
        return std::string(words);
    };
    const char *kinds[] = {"sphere(0.2)",
                           "box([0.3, 0.2, 0.4])",
                           "torus(0.25, 0.06)",
                           "cylinder(0.2, 0.3).rotate(30deg, axis: Z)",
                           "(box([0.4, 0.4, 0.4]) - sphere(0.25))",
                           "smooth_union(0.1) { sphere(0.2); box([0.5, 0.1, 0.1]) }"};
    for (int i = 0; i < 2000; ++i) {
        char scale[40];
        std::snprintf(scale, sizeof scale, ".scale(%.3f)", dice.in(0.7, 1.3));
        text += std::string(kinds[i % 6]) + scale + place();
    }
    driver::Compilation c = driver::compile_text("shapes.sdf", text, {}, {});
    REQUIRE(c.good());
    check(c.scene, 2000);
    CHECK(cpu::shapes_of(c.scene) >= 2000);
    const Wrong d = compare(c.scene, c.scene.distance, cube_of(c.scene), false, 2000);
    CHECK(d.shapes < 100);
}

// Grazing rays as in examples.cpp.
TEST_CASE("no ray of a pruned march passes a surface") {
    constexpr int width = 40, height = 30;
    for (const char *name : {"examples/02_csg.sdf", "examples/07_tree.sdf", "examples/10_city.sdf",
                             "examples/primitives.sdf", "examples/tiled_garden.sdf",
                             "examples/08_rocky_icosahedron.sdf", "bench/scenes/spheres_100.sdf",
                             "bench/scenes/colored_spheres_256.sdf"}) {
        driver::Compilation c = driver::compile_file(fs::path(FATHOM_SOURCE_DIR) / name, {});
        INFO(name);
        REQUIRE(c.good());
        const ir::View view = ir::view_of(c.scene, 0, double(width) / height);
        const cpu::Stage pruned = cpu::prepare(c.scene, view, width, height, 0, cpu::Prune::Always),
                         whole = cpu::prepare(c.scene, view, width, height, 0, cpu::Prune::Never);
        REQUIRE(pruned.pruning);
        REQUIRE(!whole.pruning);
        std::vector<cpu::Ray> rays;
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                rays.push_back(cpu::eye_ray(whole, float(x) + 0.5f, float(y) + 0.5f));
        const std::vector<cpu::Landing> fast = cpu::cast(pruned, rays),
                                        slow = cpu::cast(whole, rays, true);
        int holes = 0;
        for (std::size_t i = 0; i < rays.size(); ++i) {
            if ((fast[i].t >= 0) == (slow[i].t >= 0)) continue;
            std::vector<cpu::Ray> near;
            for (int k = 0; k < 16; ++k) {
                const float a = float(k) * 0.3927f;
                near.push_back(cpu::eye_ray(whole,
                                            float(int(i) % width) + 0.5f + 0.5f * std::cos(a),
                                            float(int(i) / width) + 0.5f + 0.5f * std::sin(a)));
            }
            bool grazing = false;
            for (const cpu::Landing &l : cpu::cast(whole, near, true))
                grazing = grazing || (l.t >= 0) == (fast[i].t >= 0);
            holes += !grazing;
        }
        CHECK(holes == 0);
    }
}

// Rays wait for each other cell by cell; what each finds does not depend on the others, nor on
// which cells were there before it. One scene whose field is divided by its bound, one not.
TEST_CASE("a ray lands alike alone and among others") {
    constexpr int width = 40, height = 30;
    for (const char *name : {"examples/07_tree.sdf", "bench/scenes/spheres_100.sdf",
                             "examples/08_rocky_icosahedron.sdf"}) {
        driver::Compilation c = driver::compile_file(fs::path(FATHOM_SOURCE_DIR) / name, {});
        INFO(name);
        REQUIRE(c.good());
        const ir::View view = ir::view_of(c.scene, 0, double(width) / height);
        const cpu::Stage stage = cpu::prepare(c.scene, view, width, height, 0, cpu::Prune::Always);
        std::vector<cpu::Ray> rays;
        for (int i = 0; i < width * height; ++i)
            rays.push_back(cpu::eye_ray(stage, float(i % width) + 0.5f, float(i / width) + 0.5f));
        const std::vector<cpu::Landing> together = cpu::cast(stage, rays);
        int different = 0, hits = 0;
        for (std::size_t i = rays.size(); i-- > 0;) {
            const cpu::Landing alone = cpu::cast(stage, std::span(rays).subspan(i, 1))[0];
            different += alone.t != together[i].t || alone.steps != together[i].steps;
            hits += alone.t >= 0;
        }
        CHECK(different == 0);
        CHECK(hits > 50);
    }
}

// Blended balls in an order in which each is near the ones before it: what was blended before is
// forgotten where a ball comes that is nearer by more than the radius, and only there. In the last
// scene balls come nearer by less than that, row by row.
TEST_CASE("long chains of blends are forgotten only where nothing is left of them") {
    const auto shell = [](int n, double k, const char *where) {
        char text[600];
        std::snprintf(text, sizeof text, R"(smooth_union(%g) {
  for i in 0..%d {
    let y = 1 - (2 * i + 1) / %d
    let ring = sqrt(1 - y * y)
    let angle = 2.39996323 * i
    sphere(%g + %g * (i %% 20)).translate(%s)
  }
}
)",
                      k, n, n, 1 / std::sqrt(n), 0.02 / std::sqrt(n), where);
        return std::string(text);
    };
    const char *spiral = "[ring * cos(angle), y, ring * sin(angle)]",
               *helix = "[ring * cos(20 * y), y, ring * sin(20 * y)]";
    double again = 0;
    for (int n : {700, 3000})
        for (double radii : {0.2, 1.0, 5.0})
            for (const char *where : {spiral, helix}) {
                if (n > 700 && radii != 1 && test::effort(1) == 1) continue; // weekly
                const std::string text = shell(n, radii / std::sqrt(n), where);
                INFO(text);
                driver::Compilation c = driver::compile_text("shell.sdf", text, {}, {});
                REQUIRE(c.good());
                CHECK(check(c.scene, 6000));
                const Wrong d = compare(c.scene, c.scene.distance, cube_of(c.scene), false, 6000);
                again += d.again;
                CHECK(d.again < 2);
                if (where == spiral && radii <= 1) CHECK(d.shapes < 0.06 * n);
            }
    CHECK(again > 0);
}
