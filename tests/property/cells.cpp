// Bounds by cells (lipschitz.md, 6), attacked: of scenes whose shapes are steep somewhere, marched
// by cells, random balls, balls about points on the walls of cells and of boxes, at both ends of
// params and at several times, on the processor and in the shader; rays against a march at a tenth
// of the proved step; and that rays take fewer steps.
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "tests/support/shader_balls.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <fmt/format.h>

using namespace fathom;

namespace {

struct Steep {
    const char *text;
    double steps = 1; // a ray's by cells over those by one bound, at most
};
const Steep scenes[] = {
    {"import \"dfmodel\" as dfmodel\n"
     "dfmodel.blobby(40, size: [2.5, 1.5, 2.5], radius: 0.1, seed: 3)",
     0.4},
    {"import \"dfmodel\" as dfmodel\n"
     "box(2) - dfmodel.blobby(25, size: [2, 2, 2], radius: 0.1, seed: 5)"
     ".rotate(0.7, axis: [1, 2, 0.5])",
     0.8},
    {"metaballs_random(20, [1.2, 1.2, 1.2], seed: 4, radius: 0.4).scale(1.5).translate([0.3, 0, "
     "0])"},
    {"(sphere(0.5) | box(1)).displace(p => 0.03 * sin(7 * p.x)).taper(0)", 0.4},
    {"blend(torus(1, 0.3), box([2.6, 0.6, 2.6]), p => smoothstep(-0.2, 0.2, p.x))", 0.8},
    {"param k = 0.3 in 0.1..0.5\n"
     "blend(torus(1, 0.3), box([2.6, 0.6, 2.6]), p => smoothstep(-k, k, p.x)).translate(x: 0.2)"},
    {"render(time: 2)\n"
     "blend(torus(1, 0.3), box([2.6, 0.6, 2.6]), p => smoothstep(-0.2, 0.2, p.x - 0.2 * "
     "sin(time)))"},
    {"blend(torus(1, 0.3), box([2.6, 0.6, 2.6]), p => smoothstep(-0.2, 0.2, "
     "p.x)).within(ball(1.4))"},
    {"implicit(p => pow(p.x, 6) + p.y * p.y + p.z * p.z - 0.5, within: ball(2))"},
    {"box(1).distort(p => p + [0.3 * sin(9 * p.y * p.y), 0, 0], within: ball(1.5))"},
};

driver::Compilation compiled(const std::string &text, int cells) {
    driver::CompileOptions options;
    options.cells = cells;
    return driver::compile_text("scene", text + "\n", {}, options);
}

const ir::CellBounds *cells_in(const ir::Scene &scene) {
    return scene.cells.empty() ? nullptr : &scene.cells.begin()->second;
}

void around(const ir::Scene &scene, test::Point3 &lo, test::Point3 &hi) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double by = 0.3 * (scene.bounds.hi[i] - scene.bounds.lo[i]);
        lo[i] = scene.bounds.lo[i] - by, hi[i] = scene.bounds.hi[i] + by;
    }
}

// Balls about points next to the walls of cells, and of their box: how many hold another sign.
int unsafe_at_walls(const ir::Scene &scene, const ir::CellBounds &cells, double time, int count) {
    test::Sampler sampler(scene, time);
    std::vector<test::Point3> p, q;
    double size = 0;
    for (std::size_t i = 0; i < 3; ++i)
        size = std::max({size, std::fabs(cells.box.lo[i]), std::fabs(cells.box.hi[i])});
    for (int k = 0; k < count; ++k) {
        test::Point3 at = sampler.in_box(cells.box.lo, cells.box.hi);
        for (std::size_t i = 0; i < 3; ++i) {
            if (sampler.random() < 0.5) continue;
            const double side = (cells.box.hi[i] - cells.box.lo[i]) / cells.count[i];
            const double wall = std::round((at[i] - cells.box.lo[i]) / side);
            const double off = sampler.random() < 0.3 ? 0 : std::pow(10, -7 * sampler.random());
            at[i] =
                float(cells.box.lo[i] + wall * side + (sampler.random() < 0.5 ? off : -off) * side);
        }
        p.push_back(at);
    }
    const std::vector<float> d = sampler.values(p);
    for (std::size_t k = 0; k < p.size(); ++k)
        q.push_back(sampler.in_ball(p[k], std::min<double>(std::fabs(d[k]), 4 * size)));
    const std::vector<float> e = sampler.values(q);
    const double rounding = 2e-5 * std::max(1.0, size);
    int unsafe = 0;
    for (std::size_t k = 0; k < p.size(); ++k)
        unsafe +=
            (d[k] < 0) != (e[k] < 0) && std::fabs(d[k]) > rounding && std::fabs(e[k]) > rounding;
    return unsafe;
}

std::uint64_t steps_of(const ir::Scene &scene) {
    constexpr int side = 48;
    const cpu::Stage stage = cpu::prepare(scene, ir::view_of(scene, 0, 1), side, side, 0);
    cpu::PictureOptions options;
    options.mode = cpu::PictureMode::Steps;
    const cpu::Work work = cpu::render(stage, options).work;
    return work.steps;
}

} // namespace

TEST_CASE("bounds by cells keep the ball free, at walls, params' ends and all times") {
    for (const Steep &steep : scenes) {
        INFO(steep.text);
        driver::Compilation c = compiled(steep.text, 16);
        REQUIRE(c.good());
        const ir::CellBounds *cells = cells_in(c.scene);
        REQUIRE(cells);
        test::Point3 lo, hi;
        around(c.scene, lo, hi);
        const std::size_t ends = c.scene.params.empty() ? 1 : 3;
        for (std::size_t end = 0; end < ends; ++end) {
            for (ir::Param &param : c.scene.params)
                param.value[0] = end == 0 ? param.lo[0] : end == 1 ? param.hi[0] : param.initial[0];
            const test::Slopes s = test::measure(c.scene, lo, hi, 200'000, 0);
            INFO("the step is " << s.unsafe_by << " times the way");
            CHECK(s.unsafe == 0);
            for (const double time : {0.0, 0.7, 2.0})
                CHECK(unsafe_at_walls(c.scene, *cells, time, 60'000) == 0);
        }
    }
}

TEST_CASE("the measure sees bounds by cells that are too small") {
    int seen = 0, tried = 0;
    for (const Steep &steep : scenes) {
        driver::Compilation c = compiled(steep.text, 16);
        REQUIRE(c.good());
        for (auto &[shape, cells] : c.scene.cells) {
            for (double &bound : cells.lipschitz) bound *= 0.3;
            for (double &way : cells.way) way *= 2;
        }
        ir::lower(c.scene);
        test::Point3 lo, hi;
        around(c.scene, lo, hi);
        seen += test::measure(c.scene, lo, hi, 200'000, 0).unsafe > 0;
        ++tried;
    }
    CHECK(seen >= tried - 1);
}

TEST_CASE("the shader keeps the ball free by cells") {
    require_context();
    for (const Steep &steep : scenes) {
        INFO(steep.text);
        const driver::Compilation c = compiled(steep.text, 8);
        REQUIRE(c.good());
        test::Point3 lo, hi;
        around(c.scene, lo, hi);
        const test::ShaderBalls s = test::shader_balls(c.scene, lo, hi, 1 << 16);
        INFO(s.worst);
        CHECK(s.unsafe == 0);
    }
}

TEST_CASE("by cells rays land where short steps land, after fewer steps") {
    constexpr int side = 32;
    for (const Steep &steep : scenes) {
        INFO(steep.text);
        const driver::Compilation c = compiled(steep.text, 16), plain = compiled(steep.text, 0);
        REQUIRE(c.good());
        const cpu::Stage stage = cpu::prepare(c.scene, ir::view_of(c.scene, 0, 1), side, side, 0);
        std::vector<cpu::Ray> rays;
        for (int i = 0; i < side * side; ++i)
            rays.push_back(cpu::eye_ray(stage, float(i % side) + 0.5f, float(i / side) + 0.5f));
        const auto fast = cpu::cast(stage, rays), slow = cpu::cast(stage, rays, true);
        int holes = 0, undecided = 0; // at the very tip of a cone the budget may be spent
        for (std::size_t i = 0; i < rays.size(); ++i) {
            undecided += fast[i].end == cpu::RayEnd::Undecided;
            if (fast[i].end == cpu::RayEnd::Undecided || slow[i].end == cpu::RayEnd::Undecided)
                continue;
            if ((fast[i].t >= 0) == (slow[i].t >= 0) &&
                std::fabs(fast[i].t - slow[i].t) <= 0.01f * std::fabs(slow[i].t))
                continue;
            // grazing: a ray within half a pixel lands so
            std::vector<cpu::Ray> near;
            for (int k = 0; k < 16; ++k) {
                const float a = float(k) * 0.3927f;
                near.push_back(cpu::eye_ray(stage, float(i % side) + 0.5f + 0.5f * std::cos(a),
                                            float(i / side) + 0.5f + 0.5f * std::sin(a)));
            }
            bool grazing = false;
            for (const cpu::Landing &l : cpu::cast(stage, near, true))
                grazing = grazing ||
                          ((l.t >= 0) == (fast[i].t >= 0) && (l.t < 0 || fast[i].t <= l.t * 1.01f));
            holes += !grazing;
        }
        CHECK(holes == 0);
        CHECK(undecided <= side * side / 100);
        const std::uint64_t by_cells = steps_of(c.scene), by_one = steps_of(plain.scene);
        std::printf("%8.2f steps a ray, %8.2f by one bound: %.60s\n", double(by_cells) / 2304,
                    double(by_one) / 2304, steep.text);
        CHECK(double(by_cells) <= steep.steps * double(by_one));
    }
}
