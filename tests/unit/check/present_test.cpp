// What is drawn once is proved for the params' present values and its time: a range costs nothing
// where it is harmless, and what is proved there holds there.
#include "compiled.h"

#include "backend-cpu/tape.h"
#include "backend-cpu/trace/march.h"

#include <algorithm>
#include <catch2/catch.hpp>

#include <cmath>
#include <random>

using namespace fathom;

namespace {

driver::Compilation at(const std::string &text, std::vector<driver::Override> values, double time) {
    driver::CompileOptions options;
    options.overrides = std::move(values);
    options.times = {time, time};
    return driver::compile_text("scene.sdf", text, ".", options);
}

cpu::Picture drawn(const driver::Compilation &made, cpu::PictureMode mode) {
    const ir::View view = ir::look_at({3, 2, 5}, {0, 0, 0}, 0.4, false);
    const cpu::Stage stage = cpu::prepare(made.scene, view, 64, 64, 0);
    cpu::PictureOptions options;
    options.mode = mode;
    return cpu::render(stage, options);
}

// The steepest marched slope between random points that are near each other.
double steepest(const ir::Scene &scene, double time) {
    const cpu::Program program = cpu::compile(scene, scene.distance);
    cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(scene, time));
    constexpr std::size_t count = 4096;
    std::mt19937 random(1);
    std::uniform_real_distribution<float> place(-2, 2), way(-0.02f, 0.02f);
    std::array<std::vector<float>, 3> a, b;
    std::vector<float> from(count), to(count);
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < count; ++k) {
            a[i].push_back(place(random));
            b[i].push_back(a[i].back() + way(random));
        }
    const auto evaluate = [&](const std::array<std::vector<float>, 3> &p, std::vector<float> &d) {
        const float *in[] = {p[0].data(), p[1].data(), p[2].data()};
        float *out[] = {d.data()};
        cpu::evaluate(program, scratch, in, out, count);
    };
    evaluate(a, from);
    evaluate(b, to);
    double most = 0;
    for (std::size_t k = 0; k < count; ++k) {
        const double apart = std::hypot(a[0][k] - b[0][k], a[1][k] - b[1][k], a[2][k] - b[2][k]);
        if (apart > 2e-3) most = std::max(most, std::abs(from[k] - to[k]) / apart);
    }
    return most;
}

struct Harmless {
    std::string with, plain; // with: params and time in it stand where they change nothing
};
const std::vector<Harmless> harmless{
    {"param a = 0.0 in 0.0..20.0\n"
     "sphere(1).displace(p => a * sin(p.x) * sin(p.y) * sin(p.z))",
     "sphere(1)"},
    {"param a = 0.0 in 0.0..4.0\nbox([1, 3, 1]).twist(a)", "box([1, 3, 1])"},
    {"param a = 0.0 in 0.0..0.3\nbox([0.5, 2, 0.5]).bend(a)", "box([0.5, 2, 0.5])"},
    {"param a = 1.0 in 0.05..1.0\ncylinder(0.6, 2).taper(a)", "cylinder(0.6, 2)"},
    {"sphere(1).displace(p => sin(time) * sin(4 * p.x))", "sphere(1)"},
    {"param a = 1.0 in 1.0..9.0\nimplicit(p => a * (length(p) - 1), within: ball(2))",
     "implicit(p => length(p) - 1, within: ball(2))"},
    {"param a = [0, 0, 0] in [-9, -9, -9]..[9, 9, 9]\nsphere(1).displace(p => sin(dot(a, p)))",
     "sphere(1)"},
};

double steepest(const driver::Compilation &made) { // the bound for all that its ranges allow
    double most = 0;
    for (const ir::ShapeFact &fact : made.scene.facts)
        if (std::isfinite(fact.lipschitz_sup)) most = std::max(most, fact.lipschitz_sup);
    return most;
}

} // namespace

TEST_CASE("a range costs no step where the present value is harmless") {
    for (const Harmless &scene : harmless) {
        INFO(scene.with);
        const driver::Compilation present = at(scene.with, {}, 0), plain = at(scene.plain, {}, 0);
        const driver::Compilation whole = test::compiled(scene.with);
        REQUIRE(present.good());
        REQUIRE(plain.good());
        REQUIRE(whole.good());
        const auto steps = [](const driver::Compilation &made) {
            return static_cast<double>(drawn(made, cpu::PictureMode::Steps).work.steps);
        };
        CHECK(steps(present) <= 1.05 * steps(plain));
        // so the scene is one of this test's kind
        CHECK(steepest(whole) >= 1.05 * steepest(present));
        const cpu::Picture one = drawn(present, cpu::PictureMode::Color),
                           other = drawn(plain, cpu::PictureMode::Color);
        std::size_t differ = 0;
        for (std::size_t i = 0; i < one.rgba.size(); ++i)
            differ += std::abs(int(one.rgba[i]) - int(other.rgba[i])) > 2;
        CHECK(differ <= one.rgba.size() / 200);
    }
}

TEST_CASE("what is proved at present values holds there") {
    for (const Harmless &scene : harmless)
        for (const double time : {0.0, 0.7, 1.5707963, 100.1}) {
            INFO(scene.with << " at " << time);
            const driver::Compilation made = at(scene.with, {}, time);
            REQUIRE(made.good());
            CHECK(steepest(made.scene, time) <= 1 + 1e-3);
        }
    for (const char *value : {"0.1", "3", "20"}) {
        const driver::Compilation made = at(harmless[0].with, {{"a", value}}, 0);
        REQUIRE(made.good());
        INFO("a = " << value);
        CHECK(steepest(made.scene, 0) <= 1 + 1e-3);
    }
}

TEST_CASE("a range that fails somewhere is no fault of the value that is drawn") {
    const std::string text = "param r = 1.0 in -1.0..2.0\nsphere(r)\n";
    CHECK(test::compiled(text).diagnostics.has_errors());
    CHECK(at(text, {}, 0).good());
    CHECK(at(text, {{"r", "-0.5"}}, 0).diagnostics.has_errors());
    // A time that stands where a size is none is a failure there alone.
    const std::string moving = "sphere(1 - 0.5 * time)\n";
    CHECK(test::compiled(moving).diagnostics.has_errors());
    CHECK(at(moving, {}, 1).good());
    CHECK(at(moving, {}, 3).diagnostics.has_errors());
}

TEST_CASE("the solid does not depend on what the proof is for") {
    // The ends of this taper are the proved extent: of the range, whatever is drawn.
    const std::string text = "param a = 1.0 in 1.0..3.0\nbox([1, a, 1]).taper(0.3)\n";
    const driver::Compilation present = at(text, {}, 0), whole = test::compiled(text);
    REQUIRE(present.good());
    REQUIRE(whole.good());
    const cpu::Picture one = drawn(present, cpu::PictureMode::Color),
                       other = drawn(whole, cpu::PictureMode::Color);
    std::size_t differ = 0;
    for (std::size_t i = 3; i < one.rgba.size(); i += 4) differ += one.rgba[i] != other.rgba[i];
    CHECK(differ <= 4);
}

TEST_CASE("a param whose range is refused, and its present value not, builds the scene anew") {
    // a ball cut at a height: its arms meet for each, and that is not seen for all at once
    const std::string cut = "implicit(p => {\n"
                            "  let q = [length(p.xz), p.y]\n"
                            "  let w = sqrt(1 - h * h)\n"
                            "  let s = max((h - 1) * q.x * q.x + w * w * (h + 1 - 2 * q.y), "
                            "h * q.x - w * q.y)\n"
                            "  if s < 0 { length(q) - 1 } else if q.x < w { h - q.y } "
                            "else { length(q - [w, h]) }\n"
                            "}, within: ball(2))",
                      beside = "\nparam r = 0.5 in 0.2..2\nsphere(r).translate(x: 3)\n",
                      text = "param h = 0.3 in 0.2..0.4\n" + cut + beside;
    driver::CompileOptions options;
    const auto compiled = [&](const std::string &of) {
        return driver::compile_text("scene.sdf", of, ".", options);
    };
    const auto codes = [](const driver::Compilation &made) {
        std::vector<Code> out;
        for (const Diagnostic &d : made.diagnostics.items()) out.push_back(d.code);
        return out;
    };

    using driver::Phase;
    std::vector<Phase> phases;
    options.entered = [&](Phase phase) { phases.push_back(phase); };
    const auto slider = compiled(text), number = compiled("let h = 0.3\n" + cut + beside);
    CHECK(phases == std::vector{Phase::Check, Phase::Prove, Phase::Check, Phase::Prove,
                                Phase::Lower, Phase::Done, Phase::Check, Phase::Prove, Phase::Lower,
                                Phase::Done});
    options.entered = {};
    REQUIRE(slider.good());
    REQUIRE(number.good());
    CHECK(codes(slider) == std::vector{Code::RangeUnproved});
    CHECK(codes(number).empty());
    const Diagnostic &said = slider.diagnostics.items()[0];
    CHECK(said.message.find("`h`") != std::string::npos);
    CHECK(fathom::text(slider.sources, said.primary.span) == "s < 0");
    REQUIRE(slider.scene.params.size() == 2);
    CHECK(slider.scene.params[0].structural);
    CHECK_FALSE(slider.scene.params[1].structural); // the other stays a number of the shader
    for (const char *value : {"0.2", "0.25", "0.4"}) {
        options.overrides = {{"h", value}};
        const auto moved = compiled(text);
        INFO(value);
        REQUIRE(moved.good());
        CHECK(steepest(moved.scene, 0) <= 1.001);
        CHECK(moved.scene.params[0].value[0] == Approx(std::stod(value)));
    }

    options = {};
    options.strict_proof = true;
    CHECK(codes(compiled(text)) == std::vector{Code::LipschitzUnbounded});
    options.times = {0, 0}; // what is drawn once has no ranges
    CHECK(compiled(text).good());
    options.strict_proof = false;
    CHECK(codes(compiled(text)).empty());

    // both attempts together take no more than the limits allow
    options = {};
    CHECK(slider.proof_steps > number.proof_steps);
    CHECK(slider.evaluations > number.evaluations);
    options.limits.proof = number.proof_steps;
    CHECK_FALSE(compiled(text).good());

    // refused at each value, or for something else: as it was
    options = {};
    CHECK(codes(compiled("param h = 0.3 in 0.2..0.4\n"
                         "implicit(p => if p.x > h { 1 } else { -1 }, within: ball(2))\n")) ==
          std::vector{Code::FieldJump});
    CHECK(std::ranges::count(codes(compiled(text + "sphere(-1)\n")), Code::RangeUnproved) == 0);
    CHECK_FALSE(compiled(text + "sphere(-1)\n").good());

    // the ends of a taper are asked of the proof for whole ranges, so the solid would be another
    const auto asked = compiled(text + "cylinder(0.5, 4 * h).taper(0.5).translate(x: -3)\n");
    CHECK_FALSE(asked.good());
    CHECK(codes(asked).front() == Code::LipschitzUnbounded);
}

TEST_CASE(
    "a whole number whose range ends at none is a float, and stays whole where that is said") {
    const auto type_of = [](const std::string &param) {
        const driver::Compilation made = driver::compile_text(
            "scene.sdf", "let whole = 4\nlet part = 2.5\n" + param + "\nsphere(k + 20)\n", ".", {});
        return made.good() ? std::string(ir::type_name(made.scene.params[0].type)) : "refused";
    };
    for (const char *range : {"0..tau", "-pi..pi", "-0.5..1", "0..part", "0..whole / 8", "-1..0.5"})
        CHECK(type_of(std::string("param k = 0 in ") + range) == "float");
    for (const char *range : {"-3..3", "0..whole", "0..len([1, 2])"})
        CHECK(type_of(std::string("param k = 0 in ") + range) == "int");
    CHECK(type_of("param k: int = 0 in 0..7") == "int");
    CHECK(type_of("param k: int = 0 in 0..tau") == "refused");
    CHECK(type_of("param k: float = 0 in 0..7") == "float");
}

TEST_CASE(
    "a blend's width that is 0 at the least is no degenerate range; a radius that is, is one") {
    const auto reports = [](const std::string &text) {
        return driver::compile_text("scene.sdf", text, ".", {}).diagnostics.items().size();
    };
    for (const char *k : {"0.5 + 0.5 * sin(time)", "0.25 * (1 + cos(3 * time))", "1 - sin(a)"})
        CHECK(reports("param a = 0 in 0..tau\nsmooth_union(" + std::string(k) +
                      ", sphere(1), sphere(1).translate(x: a))") == 0);
    CHECK(reports("sphere(1 + sin(time))") == 1);
    CHECK(reports("smooth_union(0.4 + 0.5 * sin(time), sphere(1), box(1))") == 1);
}
