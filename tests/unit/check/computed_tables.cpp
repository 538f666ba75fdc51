// A loop over shapes is a table, and where its rows follow from the loop's number the text of a
// shader holds a formula in the table's place: as long for ten thousand shapes as for a hundred.
#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <fmt/format.h>

using namespace fathom;

namespace {

driver::Compilation good(const std::string &text) {
    driver::Compilation c = driver::compile_text("loop.sdf", text, "", {});
    for (const Diagnostic &d : c.diagnostics.items()) UNSCOPED_INFO(d.message);
    REQUIRE(c.good());
    return c;
}

std::size_t length_of(const driver::Compilation &c, glsl::Target target) {
    glsl::Options options;
    options.target = target;
    Diagnostics diagnostics;
    glsl::Output output = glsl::emit(c.scene, options, diagnostics);
    CHECK(!diagnostics.has_errors());
    return glsl::traits_of(target).form == glsl::Form::SpirV ? output.words.size()
                                                             : output.text.size();
}

std::string with(std::string text, int count) {
    for (std::size_t at; (at = text.find('#')) != text.npos;)
        text.replace(at, 1, fmt::to_string(count));
    return text;
}

// Every formula of every table gives its data.
int checked_formulas(const ir::Scene &scene) {
    int count = 0;
    for (std::size_t t = 0; t < scene.graph.table_count(); ++t) {
        const ir::Table &table = scene.graph.table(ir::TableId{t});
        for (const auto &[column, formula] : table.computed) {
            ++count;
            test::Reference reference(scene);
            double worst = 0, largest = 0;
            for (int row = 0; row < table.rows; ++row) {
                const ir::Constant value =
                    reference.call(formula, {{ir::Type::Int, {double(row)}}});
                for (int i = 0; i < ir::components(value.type); ++i) {
                    const double data =
                        table.data[static_cast<std::size_t>(row * table.stride + column + i)];
                    worst =
                        std::max(worst, std::abs(data - value.value[static_cast<std::size_t>(i)]));
                    largest = std::max(largest, std::abs(data));
                }
            }
            CHECK(worst <= 2e-5 * largest);
        }
    }
    return count;
}

// Whether the text for a thousand iterations is longer than that for three hundred.
bool grows(const std::string &text) {
    return length_of(good(with(text, 1000)), glsl::Target::Es300) >
           length_of(good(with(text, 300)), glsl::Target::Es300) + 1000;
}

} // namespace

TEST_CASE("the text of a loop over ten thousand spheres does not grow with their number") {
    const std::string loop =
        "for i in 0..# {\n"
        "  let a = i * 0.1\n"
        "  sphere(0.1 + 0.05 * sin(i)).translate([cos(a) * a, 0.01 * i, sin(a) * a])\n"
        "    .paint(hsv(i / #, 0.5, 1))\n"
        "}";
    const driver::Compilation few = good(with(loop, 100)), many = good(with(loop, 10000));
    CHECK(checked_formulas(many.scene) >= 3);
    for (glsl::Target target : glsl::all_targets()) {
        CAPTURE(glsl::traits_of(target).name);
        CHECK(length_of(many, target) < length_of(few, target) + 100);
    }
}

TEST_CASE("what a body may compute from its iteration") {
    CHECK(!grows("for i in 0..# { box([1, 1 + i % 7, 1]).rotate(i * 137.5deg).translate(x: i) }"));
    CHECK(
        !grows("for i in 0..# { for j in 0..10 { sphere(0.3).translate([i, 0.1 * i * j, j]) } }"));
    CHECK(!grows(
        "for i in 0..10 { for j in 0..# { sphere(0.3).translate([i, hash(i + 10 * j), j]) } }"));
    CHECK(!grows("for i in 0..# { sphere(0.3).translate([i % 10, 0, int(i / 10)]) }"));
    CHECK(!grows("for i in 0..# { sphere(0.3).translate([i % 10, 0, floor(i / 10)]) }"));
    CHECK(!grows("fn place(i) { var p = [i, 0, 0]; p.z += cos(0.3 * i); p }\n"
                 "fn ball(i) = sphere(0.4).translate(place(i))\n"
                 "union { for i in range(5, #, 3) { ball(i) } }.rotate(20deg)"));
    CHECK(!grows("for t in range(0.5, #, 0.1) { sphere(0.3).translate([t, t * t, sin(t)]) }"));
    CHECK(!grows("for i in 0..# { sphere(0.3).translate(x: i) | box(0.2).translate([i, 1, 0]) }"));
    CHECK(!grows(
        "smooth_union(0.1) { for i in 0..# { capsule([i + 1, 0.5, 0], [i, sin(i), 1], 0.2) } }"));
}

TEST_CASE("a formula that float32 would miss is not taken") {
    // the border of a floor, a hash of rounded numbers, ever larger angles
    CHECK(grows("for i in 0..# { sphere(0.3).translate([i, floor(i * 0.1), 0]) }"));
    CHECK(grows("for i in 0..# { sphere(0.3).translate([i, hash(i * 0.1), 0]) }"));
    CHECK(grows("for i in 0..# { sphere(0.3).translate([i, 9 * sin(0.37 * (1.0 * i) ^ 4), 0]) }"));
    // data
    CHECK(grows("let a = [for i in 0..# { 0.1 + 0.2 * hash(i) }]\nfor x in a { "
                "sphere(x).translate(y: x) }"));
}

TEST_CASE("equal data is one table") {
    const driver::Compilation c =
        good("let a = [for i in 0..30 { 0.1 + 0.2 * hash(i) }]\n"
             "fn f(p: vec3) { var d = 9.0; for x in a { d = min(d, length(p) - x) }; d }\n"
             "fn g(p: vec3) { var d = 9.0; for x in a { d = min(d, length(p.xy) - x) }; d }\n"
             "implicit(p => f(p), within: ball(2))\nimplicit(p => g(p), within: ball(2))");
    CHECK(c.scene.graph.table_count() == 1);
}
