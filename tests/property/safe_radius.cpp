// The rule of curvature in whole scenes (lipschitz.md, 4): random shapes displaced by noise
// and waves, alone, moved, and in unions. Segments that it says are free are free, rays land where
// a march at a tenth of the ball's step lands, and the shader's safe radius is the processor's.
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"
#include "random_scenes.h"
#include "tests/support/shader_balls.h"
#include "tests/support/spans.h"

#include <catch2/catch.hpp>
#include <fmt/format.h>

#include <cstdio>

using namespace fathom;

namespace {

std::string rough_scene(test::Dice &dice) {
    const auto pick = [&](std::initializer_list<const char *> all) {
        return std::string(
            all.begin()[std::min(int(dice.in(0, double(all.size()))), int(all.size()) - 1)]);
    };
    const double size = dice.in(0.6, 1.4);
    const std::string shape =
        pick({"sphere({0:.3f})", "sphere({0:.3f})", "box({0:.3f}).offset({0:.3f} / 2)",
              "(sphere({0:.3f}) | sphere(0.8 * {0:.3f}).translate([{0:.3f}, 0.2, 0]))",
              "rounded_box([3, 2, 2.5] * {0:.3f}, radius: 0.7 * {0:.3f})",
              "torus({0:.3f}, 0.6 * {0:.3f})", "cylinder({0:.3f}, {0:.3f}).offset(0.6 * {0:.3f})"});
    const std::string by =
        pick({"fbm({1:.3f} * p, octaves: {2})", "fbm({1:.3f} * p, octaves: {2})",
              "fbm({1:.3f} * p, octaves: {2}, alpha: 1.8)", "noise({1:.3f} * p)",
              "(value_noise({1:.3f} * p) - 0.5)", "sin({1:.3f} * p.x) * cos({1:.3f} * p.y)",
              "(noise({1:.3f} * p) + 0.3 * sin(3 * {1:.3f} * p.z))"});
    const double often = dice.in(1, 5);
    const int octaves = 1 + std::min(int(dice.in(0, 4)), 3);
    const double high = size * dice.in(0.03, 0.12);
    std::string text = shape + ".displace(p => {3:.4f} * " + by + ")";
    const std::string where =
        pick({"", ".translate([0.4, -0.2, 0.3])", ".rotate(0.8, axis: [0.4, 1, 0.2])",
              ".paint(#884422)", ".translate([0, 0.5, 0]).rotate(1, axis: X)"});
    const std::string with = pick({"", "", "\nbox([4, 0.2, 4]).translate([0, -1, 0])",
                                   "\nsphere(0.5).translate([1.5, 0, 0])"});
    return fmt::format(fmt::runtime(text + where + with), size, often, octaves, high) + "\n";
}

// By the second number in place of the first.
ir::Scene by_reach(ir::Scene scene) {
    ir::Graph &g = scene.graph;
    const ir::NodeId p = g.fresh_var(ir::Type::Vec3);
    const ir::NodeId both =
        g.make(ir::Op::Call, ir::Type::Vec2, std::array{p}, scene.safe_radius.index);
    scene.distance = g.add_function({"reach_alone", {}, {p}, g.component(both, 1)});
    return scene;
}

} // namespace

TEST_CASE("the ball of the safe radius is free, and no ray passes a surface") {
    test::Dice dice{41};
    int curved = 0, segments = 0, cast = 0, steps = 0, plain_steps = 0;
    for (int i = 0; i < 60; ++i) {
        const std::string text = rough_scene(dice);
        INFO(text);
        driver::Compilation c = driver::compile_text("scene", text, {}, {});
        REQUIRE(c.good());
        if (!c.scene.safe_radius) continue;
        ++curved;
        test::Point3 lo = c.scene.bounds.lo, hi = c.scene.bounds.hi;
        const test::Spans spans = test::measure_spans(c.scene, lo, hi, 100'000);
        segments += spans.tried;
        CHECK(spans.cut == 0);
        CHECK(spans.shorter == 0);

        constexpr int side = 40;
        const cpu::Stage stage = cpu::prepare(c.scene, ir::view_of(c.scene, 0, 1), side, side, 0);
        REQUIRE(stage.has_safe_radius);
        ir::Scene without = c.scene;
        without.safe_radius = {};
        const cpu::Stage plain = cpu::prepare(without, stage.view, side, side, 0);
        std::vector<cpu::Ray> rays;
        for (int y = 0; y < side; ++y)
            for (int x = 0; x < side; ++x)
                rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
        const auto fast = cpu::cast(stage, rays), slow = cpu::cast(stage, rays, true),
                   ball = cpu::cast(plain, rays);
        for (std::size_t k = 0; k < rays.size(); ++k) {
            ++cast, steps += fast[k].steps, plain_steps += ball[k].steps;
            if (slow[k].t < 0 && fast[k].t < 0) continue;
            // Grazing: within a pixel of one that lands otherwise.
            if ((slow[k].t >= 0) == (fast[k].t >= 0) && fast[k].t <= slow[k].t + 0.01f * slow[k].t)
                continue;
            std::vector<cpu::Ray> near;
            for (int j = 0; j < 16; ++j) {
                const float a = float(j) * 0.3927f;
                near.push_back(cpu::eye_ray(stage, float(k % side) + 0.5f + 0.5f * std::cos(a),
                                            float(k / side) + 0.5f + 0.5f * std::sin(a)));
            }
            bool grazing = false;
            for (const cpu::Landing &l : cpu::cast(stage, near, true))
                grazing = grazing ||
                          ((l.t >= 0) == (fast[k].t >= 0) && (l.t < 0 || fast[k].t <= l.t * 1.01f));
            INFO("pixel " << k % side << ", " << k / side << ": " << fast[k].t << " and "
                          << slow[k].t);
            CHECK(grazing);
        }
    }
    std::printf("%d scenes, %d segments, %d rays, %.3f of the steps by balls alone\n", curved,
                segments, cast, double(steps) / plain_steps);
    CHECK(curved > 40);
    CHECK(steps < 0.8 * plain_steps);
}

// Algebraic surfaces, by bounds in cells: a heart, on which the field has a threefold root along a
// curve, a quartic, a sextic, and one with a parameter. What lies inside is found by looking at
// each ray in a thousand places.
TEST_CASE("rays find surfaces on which a user-defined field is flat") {
    const char *texts[] = {
        R"(let a = p => p.x * p.x + 2.25 * p.z * p.z + p.y * p.y - 1
implicit(p => a(p) * a(p) * a(p) - (p.x * p.x + 0.1125 * p.z * p.z) * p.y * p.y * p.y,
         within: aabb(-[1.4, 1.4, 1.4], [1.4, 1.4, 1.4])))",
        R"(implicit(p => dot(p, p) * dot(p, p) * dot(p, p) - 2 * p.x * p.x * p.y * p.y - 0.3, within: ball(1.8)))",
        R"(implicit(p => p.x * p.x * p.x * p.x + p.y * p.y * p.y * p.y + p.z * p.z * p.z * p.z -
              dot(p, p) + 0.3, within: aabb(-[1.5, 1.5, 1.5], [1.5, 1.5, 1.5])))",
        R"(param w: float = 0.5 in 0.2..0.8
implicit(p => pow(p.x * p.x + p.y * p.y - w, 3) + 4 * p.z * p.z * p.z * p.z, within: ball(2)).rotate(0.4, axis: X))"};
    for (const std::string text : texts) {
        INFO(text);
        driver::Compilation c = driver::compile_text("scene", text, {}, {});
        REQUIRE(c.good());
        CHECK(c.scene.safe_radius);
        const test::Spans spans =
            test::measure_spans(c.scene, c.scene.bounds.lo, c.scene.bounds.hi, 100'000);
        CHECK(spans.cut == 0);
        CHECK(spans.shorter == 0);
        constexpr int side = 40, places = 1000;
        const cpu::Stage stage = cpu::prepare(c.scene, ir::view_of(c.scene, 0, 1), side, side, 0);
        std::vector<cpu::Ray> rays;
        for (int i = 0; i < side * side; ++i)
            rays.push_back(cpu::eye_ray(stage, float(i % side) + 0.5f, float(i / side) + 0.5f));
        const auto found = cpu::cast(stage, rays);
        test::Sampler sampler(c.scene);
        const double far = 2.2 * stage.frame.radius + std::sqrt(3.0) * stage.view.focus;
        int holes = 0, inside = 0;
        for (std::size_t k = 0; k < rays.size(); ++k) {
            std::vector<test::Point3> points;
            for (int i = 0; i < places; ++i) {
                const double t = far * i / places;
                test::Point3 p;
                for (std::size_t a = 0; a < 3; ++a)
                    p[a] = rays[k].origin[a] + t * rays[k].direction[a];
                points.push_back(p);
            }
            const std::vector<float> values = sampler.values(points);
            int run = 0;
            for (int i = 0; i < places && run < 5; ++i) {
                run = values[std::size_t(i)] < 0 ? run + 1 : 0;
                if (run < 5) continue;
                ++inside;
                const double t = far * i / places; // well inside
                holes += found[k].t < 0 || found[k].t > t;
            }
        }
        CHECK(inside > 15);
        CHECK(holes == 0);
    }
}

TEST_CASE("the shader has the safe radius of the processor") {
    require_context();
    test::Dice dice{43};
    for (int i = 0; i < 8; ++i) {
        const std::string text = rough_scene(dice);
        INFO(text);
        driver::Compilation c = driver::compile_text("scene", text, {}, {});
        REQUIRE(c.good());
        if (!c.scene.safe_radius) continue;
        const ir::Scene scene = by_reach(c.scene);
        test::Sampler sampler(scene);
        std::vector<test::Point3> points;
        for (int k = 0; k < 4096; ++k)
            points.push_back(sampler.in_box(c.scene.bounds.lo, c.scene.bounds.hi));
        const std::vector<float> known = sampler.values(points),
                                 found = test::in_shader(scene, points, 1024);
        int off = 0;
        for (std::size_t k = 0; k < points.size(); ++k) {
            // A root near 0 is as far off as the root of what its square is off.
            const double minimum = std::min(double(known[k]), double(found[k]));
            off += std::fabs(known[k] - found[k]) > 1e-4 + 3e-6 / std::max(minimum, 3e-3);
        }
        // Where an octave's turn comes at all, a last digit may decide.
        CHECK(off <= 4);
    }
}
