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

struct Counts {
    int rays = 0, steps = 0, plain_steps = 0;
};

// Each ray of a picture lands where a march at a tenth of the ball's step lands.
void check_rays(const ir::Scene &scene, Counts &counts) {
    constexpr int side = 40;
    const cpu::Stage stage = cpu::prepare(scene, ir::view_of(scene, 0, 1), side, side, 0);
    REQUIRE(stage.has_safe_radius);
    ir::Scene without = scene;
    without.safe_radius = {};
    const cpu::Stage plain = cpu::prepare(without, stage.view, side, side, 0);
    std::vector<cpu::Ray> rays;
    for (int y = 0; y < side; ++y)
        for (int x = 0; x < side; ++x)
            rays.push_back(cpu::eye_ray(stage, float(x) + 0.5f, float(y) + 0.5f));
    const auto fast = cpu::cast(stage, rays), slow = cpu::cast(stage, rays, true),
               ball = cpu::cast(plain, rays);
    for (std::size_t k = 0; k < rays.size(); ++k) {
        ++counts.rays, counts.steps += fast[k].steps, counts.plain_steps += ball[k].steps;
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
        INFO("pixel " << k % side << ", " << k / side << ": " << fast[k].t << " and " << slow[k].t);
        CHECK(grazing);
    }
}

} // namespace

TEST_CASE("the ball of the safe radius is free, and no ray passes a surface") {
    test::Dice dice{41};
    int curved = 0, segments = 0;
    Counts counts;
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

        check_rays(c.scene, counts);
    }
    std::printf("%d scenes, %d segments, %d rays, %.3f of the steps by balls alone\n", curved,
                segments, counts.rays, double(counts.steps) / counts.plain_steps);
    CHECK(curved > 40);
    CHECK(counts.steps < 0.8 * counts.plain_steps);
}

// Grounds of all kinds, seen from low over them, and what a long step could pass.
TEST_CASE("rays skim over what is straight, and pass nothing that stands on it") {
    test::Dice dice{47};
    int segments = 0;
    Counts counts;
    for (int i = 0; i < 40; ++i) {
        const auto pick = [&](std::initializer_list<const char *> all) {
            return std::string(
                all.begin()[std::min(int(dice.in(0, double(all.size()))), int(all.size()) - 1)]);
        };
        const std::string ground =
            pick({"plane(Y, -0.5)", "plane(Y, -0.5).paint(#668844)", "plane([0.1, 1, -0.2], -0.6)",
                  "implicit(p => 3 * p.y + 0.4 * p.x + 1.5)",
                  "plane(Y, -0.5)\nplane(Z, -6)\nplane([1, 0.2, 0.1], -7)",
                  "plane(Z).rotate(-90deg, axis: X).translate([0, -0.6, 0])",
                  "param level = -0.5 in -1..0\nplane(Y, level)",
                  "plane(Y, -0.6).displace(p => 0.1 * noise(1.5 * p))",
                  "plane(Y, -0.6).displace(p => 0.2 * sin(2 * p.x) * sin(1.7 * p.z))"});
        const std::string solid =
            pick({"sphere(0.7)", "box([0.03, 1.2, 0.03])", "box([0.05, 1, 2.5]).rotate(0.4)",
                  "torus(0.9, 0.02).rotate(1, axis: X)", "cylinder(0.3, 1)",
                  "box([0.04, 1, 0.04]).repeat([0.7, 0, 0.7], count: [3, 1, 3])",
                  "sphere(0.6).displace(p => 0.05 * noise(4 * p))"});
        const std::string text =
            ground + "\n" + solid + ".translate([" + fmt::format("{:.3f}", dice.in(-0.4, 0.4)) +
            ", 0, 0.2])\n" +
            fmt::format("camera(at: [{:.3f}, {:.3f}, 5], look_at: [0, {:.3f}, 0])\n",
                        dice.in(-3, 3), dice.in(-0.2, 1), dice.in(-0.4, 0.3));
        INFO(text);
        driver::Compilation c = driver::compile_text("scene", text, {}, {});
        REQUIRE(c.good());
        REQUIRE(c.scene.safe_radius);
        const test::Spans spans =
            test::measure_spans(c.scene, {-3, -1.5, -3}, {3, 1.5, 3}, 100'000);
        segments += spans.tried;
        CHECK(spans.cut == 0);
        CHECK(spans.shorter == 0);
        check_rays(c.scene, counts);
    }
    std::printf("%d segments, %d rays, %.3f of the steps by balls alone\n", segments, counts.rays,
                double(counts.steps) / counts.plain_steps);
    CHECK(segments > 100'000);
    CHECK(counts.steps < 0.6 * counts.plain_steps);
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
