// Bounds that follow params: at values all over the ranges, between and on the ends of pieces, the
// marched field is nowhere steeper than 1, and where a param is harmless it costs nothing.
#include "backend-cpu/tape.h"
#include "driver/compile.h"
#include "ir/passes/operations.h"
#include "ir/view.h"
#include "random_scenes.h"
#include "tests/support/slopes.h"

#include <array>
#include <catch2/catch.hpp>
#include <cmath>

using namespace fathom;

namespace {

struct Case {
    const char *name, *text;
    double free; // a value of the param `a` at which the bound is at most `most`; below 0: of none
    double most = 1.001;
};
const Case cases[] = {
    {"displaced", "param a = 0.0 in 0..20\nsphere(6).displace(p => a * sin(p.x))\n", 0},
    {"both signs",
     "param a = 0.5 in -3..5\nsphere(2).displace(p => a * sin(2 * p.x) * cos(p.y) / 3)\n", 0},
    {"a frequency", "param a = 1.0 in 0.5..9\nsphere(2).displace(p => 0.3 * sin(a * p.x))\n", 0.5,
     1.5},
    {"a frequency from none on",
     "param a = 3 in 0..20\nsphere(6).displace(p => 5 * sin(a * p.x))\n", 0},
    {"a frequency where the text puts it",
     "param a = 0.3 in -10..20\nsphere(6).displace(p => 5 * sin(a * p.x))\n", 0.3, 2.501},
    {"a field",
     "param a = 0.1 in 0..4\n"
     "implicit(p => length(p) - 1 + a * sin(3 * p.y) / 3, within: ball(2))\n",
     0},
    {"two params",
     "param a = 0.1 in 0..4\nparam b = 1.0 in 0..3\n"
     "sphere(2).displace(p => a * sin(b * p.x) * 0.5)\n",
     0},
    {"a whole number", "param a = 1 in 0..12\nsphere(2).displace(p => 0.2 * a * sin(p.x))\n", 0},
    {"a power", "param a = 0.2 in 0..2\nsphere(2).displace(p => a ^ 3 * sin(p.x))\n", 0, 1.1},
    {"an exponent of the point",
     "param a = 0.5 in 0.1..3\n"
     "implicit(p => length(p) + exp(a * p.x) * 0.1 - 1, within: ball(2))\n",
     -1},
    {"in a loop",
     "param a = 0.2 in 0..2\nfn f(p: vec3) -> float {\n  var s = 0.0\n"
     "  for i in 0..3 { s = s + a * sin(p.x * (i + 1)) / 3 }\n  s\n}\n"
     "sphere(2).displace(p => f(p))\n",
     0, 1.51},
};

// The steepest of many pairs of points, near and far, in and round the shape.
double steepest(const ir::Scene &scene, test::Dice &dice, double time = 0) {
    const cpu::Program program = cpu::compile(scene, scene.distance);
    cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(scene, time));
    constexpr std::size_t pairs = 4000;
    std::array<std::vector<float>, 3> points;
    const double size = 1.3 * ir::frame_of(scene, ir::view_of(scene, 0, 1), 100).radius;
    for (std::size_t i = 0; i < pairs; ++i) {
        const double apart = size * std::pow(10.0, -1 - 2 * dice.next());
        for (auto &axis : points) {
            const double x = dice.in(-size, size);
            axis.push_back(float(x)), axis.push_back(float(x + apart * dice.in(-1, 1)));
        }
    }
    std::vector<float> values(2 * pairs);
    const float *in[] = {points[0].data(), points[1].data(), points[2].data()};
    float *out[] = {values.data()};
    cpu::evaluate(program, scratch, in, out, 2 * pairs);
    double most = 0;
    for (std::size_t i = 0; i < 2 * pairs; i += 2) {
        double run = 0;
        for (const auto &axis : points) run += std::pow(double(axis[i]) - double(axis[i + 1]), 2);
        most =
            std::max(most, (std::fabs(values[i] - values[i + 1]) - 4e-6 * size) / std::sqrt(run));
    }
    return most;
}

} // namespace

TEST_CASE("bounds that follow params hold at every value, and cost nothing at a harmless one") {
    test::Dice dice{5};
    for (const Case &c : cases) {
        INFO(c.name);
        driver::Compilation made = driver::compile_text("params.sdf", c.text, {}, {});
        REQUIRE(made.good());
        ir::Scene &scene = made.scene;
        bool follows = false;
        for (const ir::ShapeFact &fact : scene.facts)
            follows |= fact.lipschitz && scene.graph.reads(fact.lipschitz).params;
        CHECK(follows);
        for (int i = 0; i <= 48; ++i) {
            for (ir::Param &param : scene.params) {
                double value =
                    param.lo[0] + (param.hi[0] - param.lo[0]) *
                                      (&param == scene.params.data() ? i / 48.0 : dice.next());
                if (param.type == ir::Type::Int) value = std::round(value);
                param.value[0] = value;
            }
            INFO("at " << scene.params[0].value[0]);
            CHECK(steepest(scene, dice) <= 1.0005);
        }
        if (c.free < 0) continue;
        scene.params[0].value[0] = c.free;
        double bound = 0;
        for (const ir::ShapeFact &fact : scene.facts)
            if (fact.lipschitz) bound = std::max(bound, ir::value_of(scene, fact.lipschitz, 0)[0]);
        CHECK(bound <= c.most);
    }
}

TEST_CASE("sliders that multiply cost what they do together") {
    struct Product {
        const char *name, *text;
        double (*slope)(const std::array<double, 3> &); // for values of the params, at most
        double most;                                    // the formula to that, on the average
    };
    const Product products[] = {
        {"height and frequency",
         "param a = 0.1 in 0..2\nparam b = 3 in 0..20\n"
         "implicit(p => p.y - a * sin(b * p.x) * cos(b * p.z), within: ball(4))\n",
         [](const std::array<double, 3> &v) { return std::hypot(1, v[0] * v[1]); }, 1.6},
        {"three of them",
         "param a = 0.1 in 0..2\nparam b = 3.0 in 1..20\nparam c = 0.2 in -1..1\n"
         "implicit(p => length(p) - 2 - a * c * sin(b * p.x), within: ball(4))\n",
         [](const std::array<double, 3> &v) { return 1 + v[0] * v[1] * std::fabs(v[2]); }, 1.2},
        {"of both signs",
         "param a = -0.1 in -2..3\nparam b = 0.5 in -4..5\n"
         "sphere(2).displace(p => a * b * sin(p.x))\n",
         [](const std::array<double, 3> &v) { return 1 + std::fabs(v[0] * v[1]); }, 1.01},
        {"two frequencies",
         "param a = 0.5 in 0.25..8\nparam b = 0.5 in 0.25..8\n"
         "implicit(p => length(p) - 2 - sin(a * p.x) * sin(b * p.y) / 4, within: ball(4))\n",
         [](const std::array<double, 3> &v) { return 1 + std::max(v[0], v[1]) / 4; }, 1.2},
    };
    test::Dice dice{9};
    for (const Product &c : products) {
        INFO(c.name);
        driver::Compilation made = driver::compile_text("params.sdf", c.text, {}, {});
        REQUIRE(made.good());
        ir::Scene &scene = made.scene;
        double formulas = 0, slopes = 0;
        for (int i = 0; i < 200; ++i) {
            std::array<double, 3> values{};
            for (std::size_t k = 0; k < scene.params.size(); ++k) {
                ir::Param &param = scene.params[k];
                const double way = i % 7 == int(k) ? 0 : i % 7 == int(k) + 3 ? 1 : dice.next();
                values[k] = param.lo[0] + (param.hi[0] - param.lo[0]) * way;
                if (param.type == ir::Type::Int) values[k] = std::round(values[k]);
                param.value[0] = values[k];
                INFO(param.name << " = " << values[k]);
            }
            double bound = 1;
            for (const ir::ShapeFact &fact : scene.facts)
                if (fact.lipschitz)
                    bound = std::max(bound, ir::value_of(scene, fact.lipschitz, 0)[0]);
            formulas += bound, slopes += c.slope(values);
            if (i < 60) CHECK(steepest(scene, dice) <= 1.0005);
        }
        CHECK(formulas <= c.most * slopes);
    }
}

TEST_CASE("bounds for the present values hold in what is lowered for the whole ranges") {
    std::vector<std::pair<std::string, std::string>> scenes;
    for (const Case &c : cases) scenes.emplace_back(c.name, c.text);
    const std::string sliders = "param a = 0.3 in 0..4\nparam b = 1 in 0.2..9\n"
                                "param c = 0.5 in 0..1\nparam n = 2 in 0..5\n",
                      waves = "displace(p => a * c * sin(b * p.x) * cos(b * p.y) / 3)";
    for (const auto &[name, shape] : std::initializer_list<std::pair<const char *, std::string>>{
             {"three at once", "sphere(2)." + waves},
             {"in a row", "sphere(0.4)." + waves + ".repeat([1.5 + c, 2, 0], count: [3, 2, 1])"},
             {"in a ring", "sphere(0.4)." + waves + ".translate([2, 0, 0]).repeat_polar(5)"},
             {"blended",
              "blend(sphere(2), box([2, 1, 2]), p => smoothstep(-c - 0.1, c + 0.1, b * p.x))"},
             {"twisted", "box([1, 3, 1])." + waves + ".twist(c)"},
             {"tapered", "box([1, 3, 1]).taper(0.2 + c)." + waves},
             {"bent", "box([3, 0.5, 1]).bend(0.4 * c)." + waves + " | sphere(1)." + waves},
             {"distorted", "box(1).distort(p => p + 0.1 * a * vec3(sin(b * p.y), 0, 0))"},
             {"in a ball",
              "implicit(p => length(p) - 1 + a * c * sin(b * p.x), within: ball(1.5 + c))"},
             {"scaled", "sphere(1)." + waves + ".scale(0.5 + c)"},
             {"cut", "sphere(2)." + waves + " - box(c + 0.5)." + waves},
             {"with time",
              "sphere(2).displace(p => a * c * sin(b * p.x + time) / 3)\nrender(time: 9)"},
             {"a whole number", "sphere(2).displace(p => 0.1 * n * a * sin(b * p.x))"}})
        scenes.emplace_back(name, sliders + shape + "\n");
    test::Dice dice{6};
    int nearer = 0;
    for (const auto &[name, text] : scenes) {
        INFO(name);
        driver::CompileOptions options;
        options.present_bounds = true;
        driver::Compilation made = driver::compile_text("params.sdf", text, {}, options);
        for (const Diagnostic &d : made.diagnostics.items()) INFO(d.message);
        REQUIRE(made.good());
        ir::Scene &scene = made.scene;
        proof::BoundCache cache;
        for (int i = 0; i < 6; ++i) {
            for (ir::Param &param : scene.params) {
                if (param.is_bound) continue;
                const double way = i == 0 ? 0 : i == 1 ? 1 : dice.next();
                const double value = param.lo[0] + (param.hi[0] - param.lo[0]) * way;
                param.value[0] = param.type == ir::Type::Int ? std::round(value) : value;
                INFO(param.name << " = " << param.value[0]);
            }
            const auto proved = driver::prove_present_bounds(scene, cache, {});
            REQUIRE(proved);
            REQUIRE(proved->values.size() == scene.present_bounds.size());
            for (std::size_t k = 0; k < proved->values.size(); ++k) {
                const ir::PresentBound &bound = scene.present_bounds[k];
                scene.params[bound.param].value[0] = proved->values[k];
                nearer += proved->values[k] < 0.7 * scene.facts[bound.shape.index].lipschitz_sup;
            }
            CHECK(steepest(scene, dice, name == "with time" ? dice.in(0, 9) : 0) <= 1.0005);
        }
    }
    CHECK(nearer > 50);
}

TEST_CASE("bounds that follow the time hold at every moment, and cost nothing at a harmless one") {
    struct Moving {
        const char *name, *text;
        double free, most; // a time at which the bound is at most `most`
        double sup;        // what it is at most at all
    };
    const Moving moving[] = {
        {"a sine", "sphere(2).displace(p => sin(time) * sin(3 * p.x))\n", 0, 1.001, 4.01},
        {"a fraction",
         "implicit(p => length(p) - 1 - 0.2 * fract(time) * sin(5 * p.x), within: ball(2))\n", 2,
         1.001, 2.01},
        {"a scale",
         "fn size() = 1 + 0.8 * sin(2 * time)\n"
         "implicit(p => length(p) - 1 - 0.1 * noise(3 * p * size()), within: ball(2))\n",
         0, 2.5, 3.1},
        {"in a loop",
         "fn f(p: vec3) -> float {\n  var s = 0.0\n"
         "  for i in 0..3 { s = s + fract(time) * sin(p.x * (i + 1)) / 3 }\n  s\n}\n"
         "sphere(2).displace(p => f(p))\n",
         1, 1.251, 3.01},
        {"what grows", "sphere(1).displace(p => 0.01 * time * sin(10 * p.x))\nrender(time: 30)\n",
         0, 1.001, 4.01},
        {"what gets finer",
         "sphere(1).displace(p => 0.1 * sin((1 + time) * p.x))\nrender(time: 30)\n", 0, 1.6, 4.2},
        {"two that move",
         "implicit(p => length(p) - 1 + 0.2 * sin(time) * sin(4 * p.x * (1 + fract(time / 3))),\n"
         "    within: ball(2))\n",
         0, 1.001, 2.7},
    };
    test::Dice dice{8};
    for (const Moving &c : moving) {
        INFO(c.name);
        const driver::Compilation made = driver::compile_text("time.sdf", c.text, {}, {});
        REQUIRE(made.good());
        bool follows = false;
        double bound = 0, sup = 0;
        for (const ir::ShapeFact &fact : made.scene.facts) {
            if (!fact.lipschitz) continue;
            follows |= made.scene.graph.reads(fact.lipschitz).time;
            bound = std::max(bound, ir::value_of(made.scene, fact.lipschitz, c.free)[0]);
            sup = std::max(sup, fact.lipschitz_sup);
        }
        CHECK(follows);
        CHECK(bound <= c.most);
        CHECK(sup <= c.sup);
        for (int i = 0; i <= 60; ++i) {
            const double time = std::min(0.137 * i + (i > 40 ? 100 * dice.next() : 0),
                                         made.scene.render.time_end); // proved so far
            INFO("at " << time);
            CHECK(steepest(made.scene, dice, time) <= 1.0005);
        }
    }
}

TEST_CASE("noise by hand times a slider and time is proved within three times what is seen") {
    const std::string text = R"(
param amplitude = 1.0 in 0..1
render(time: 1)
fn hash1(n: float) -> float = fract(sin(n) * 43758.5453)
fn noise(x: vec3) -> float {
  let i = floor(x)
  var f = fract(x)
  f = f * f * (3 - 2 * f)
  let n = dot(i, vec3(1, 57, 113))
  mix(mix(mix(hash1(n), hash1(n + 1), f.x), mix(hash1(n + 57), hash1(n + 58), f.x), f.y),
      mix(mix(hash1(n + 113), hash1(n + 114), f.x), mix(hash1(n + 170), hash1(n + 171), f.x), f.y), f.z)
}
fn octaves(point: vec3) -> float {
  let m = mat3([0, 0.8, 0.6], [-0.8, 0.36, -0.48], [-0.6, -0.48, 0.64])
  var p = m * point
  var sum = 0.5 * noise(p)
  p = p * 2.32
  sum += 0.25 * noise(p)
  p = p * 3.03
  sum + 0.125 * noise(p)
}
implicit(p => length(p) - 1.2 + time * amplitude * (1 - octaves(3.4 * p)), within: ball(2.4))
)";
    struct Moment {
        const char *amplitude;
        double time;
        bool alone; // proved for that moment, as a frame is; else for all
    };
    for (const auto &[amplitude, time, alone] : {Moment{"1", 1, false},
                                                 {"0", 1, true},
                                                 {"1", 0, true},
                                                 {"0.2", 0.5, true},
                                                 {"0.7", 1, true}}) {
        driver::CompileOptions options;
        options.overrides = {{"amplitude", amplitude}};
        if (alone) options.times = {time, time};
        const driver::Compilation made = driver::compile_text("explosion.sdf", text, {}, options);
        REQUIRE(made.good());
        const test::Slopes s =
            test::measure(made.scene, {-1.4, -1.4, -1.4}, {1.4, 1.4, 1.4}, 30'000, 30'000, time);
        INFO("amplitude " << amplitude << ", time " << time << ": " << 1 / s.steepest);
        CHECK(s.unsafe == 0);
        CHECK(s.steepest > 1.0 / 3);
    }
}
