// Whole programs made at random, through the whole compiler: what checks emits valid GLSL,
// evaluates on the tape to what the graph says, and means the same when formatted; and a function
// means the same at scene time and at field time. FATHOM_EFFORT=n tries n times as many programs.
#include "programs.h"

#include "backend-cpu/tape.h"
#include "backend-glsl/emit.h"
#include "driver/compile.h"
#include "ir/lower/lower.h"
#include "ir/passes/verify.h"
#include "lang/format.h"
#include "lang/parse.h"
#include "tests/support/agree.h"
#include "tests/support/effort.h"
#include "tests/support/reference_eval.h"

#include <catch2/catch.hpp>

#include <cstdlib>

using namespace fathom;

namespace {

driver::Compilation compile(const std::string &text) {
    return driver::compile_text("program.sdf", text, "", {});
}

std::string report(const driver::Compilation &c) {
    std::string text;
    for (const Diagnostic &d : c.diagnostics.sorted())
        if (d.severity == Severity::Error) text += to_text(d, c.sources, false);
    return text;
}

// What the bound cannot be proved of is no fault of a random program; all else is.
bool only_unproved(const driver::Compilation &c) {
    for (const Diagnostic &d : c.diagnostics.items())
        if (d.severity == Severity::Error && d.code != Code::LipschitzUnbounded &&
            d.code != Code::FieldJump && d.code != Code::FieldSingular &&
            d.code != Code::NeedsRegion && d.code != Code::LipschitzViolated &&
            d.code != Code::ParamRange)
            return false;
    return true;
}

const std::vector<std::array<double, 3>> points = {{0.31, 0.22, -0.43},
                                                   {1.23, -0.71, 0.57},
                                                   {-2.1, 1.37, 0.9},
                                                   {0.05, 2.6, -1.9},
                                                   {4.7, -0.33, 3.1}};

float tape_value(const cpu::Program &program, cpu::Scratch &scratch, const std::vector<float> &in,
                 std::size_t result) {
    std::vector<const float *> from;
    for (const float &x : in) from.push_back(&x);
    std::vector<float> out(program.results.size());
    std::vector<float *> to;
    for (float &x : out) to.push_back(&x);
    cpu::evaluate(program, scratch, from.data(), to.data(), 1);
    return out[result];
}

} // namespace

TEST_CASE("a program that checks emits valid GLSL, evaluates as the graph says, and is formatted "
          "without a change") {
    unsigned good = 0, tried = static_cast<unsigned>(test::effort(200));
    for (unsigned seed = 0; seed < tried; ++seed) {
        const std::string text = programs::scene(seed);
        INFO("seed " << seed << "\n" << text);
        driver::Compilation c = compile(text);
        INFO(report(c));
        CHECK((c.good() || only_unproved(c)));
        if (!c.good()) continue;
        ++good;
        REQUIRE(ir::verify(c.scene) == "");

        // GLSL; glslang checks each text before it is given out
        std::string emitted;
        for (glsl::Target target :
             {glsl::Target::Glsl450, glsl::Target::Es300, glsl::Target::Spirv}) {
            glsl::Options options;
            options.target = target;
            options.field_only = target == glsl::Target::Es300;
            Diagnostics diagnostics;
            glsl::Output output = glsl::emit(c.scene, options, diagnostics);
            for (const Diagnostic &d : diagnostics.items()) {
                INFO(d.message);
                for (const std::string &note : d.notes) INFO(note);
                CHECK(d.severity != Severity::Error);
            }
            if (target == glsl::Target::Es300) emitted = output.text;
        }

        // the distance, and the colours
        test::Reference reference(c.scene);
        reference.time = 0.7;
        const cpu::Program distance = cpu::compile(c.scene, c.scene.distance);
        cpu::Scratch scratch = cpu::make_scratch(distance, cpu::inputs_of(c.scene, 0.7));
        for (const std::array<double, 3> &p : points) {
            const std::vector<float> in(p.begin(), p.end());
            const float found = tape_value(distance, scratch, in, 0);
            INFO("at " << p[0] << ", " << p[1] << ", " << p[2] << ": " << found << ", not "
                       << reference.distance(p));
            CHECK(test::agree(
                found, p, [&](const std::array<double, 3> &q) { return reference.distance(q); }));
        }
        for (std::size_t s = 0; s < std::min<std::size_t>(c.scene.surfaces.size(), 3); ++s) {
            const ir::Surface &surface = c.scene.surfaces[s];
            const std::vector<ir::NodeId> params{surface.point, surface.normal, surface.extra};
            const std::vector<ir::NodeId> results{surface.diffuse};
            const cpu::Program diffuse = cpu::compile(c.scene, params, results);
            cpu::Scratch memory = cpu::make_scratch(diffuse, cpu::inputs_of(c.scene, 0.7));
            for (const std::array<double, 3> &p : points) {
                const std::vector<float> in{float(p[0]), float(p[1]), float(p[2]), 0, 1,
                                            0,           0,           0,           0, 0};
                const float found = tape_value(diffuse, memory, in, 1);
                const auto truth = [&](const std::array<double, 3> &q) {
                    return reference
                        .evaluated(surface.diffuse,
                                   {{surface.point, test::Reference::vec3(q)},
                                    {surface.normal, test::Reference::vec3({0, 1, 0})},
                                    {surface.extra, {ir::Type::Vec4, {}}}})
                        .value[1];
                };
                INFO("surface " << s << " at " << p[0] << ", " << p[1] << ", " << p[2] << ": "
                                << found << ", not " << truth(p));
                CHECK(test::agree(found, p, truth));
            }
        }

        // the formatter
        Sources sources;
        Diagnostics diagnostics;
        const SourceId id = sources.add("a.sdf", text);
        const std::string formatted = lang::format(sources, lang::parse(sources, id, diagnostics));
        const SourceId again = sources.add("b.sdf", formatted);
        CHECK(lang::format(sources, lang::parse(sources, again, diagnostics)) == formatted);
        driver::Compilation same = compile(formatted);
        INFO(formatted);
        REQUIRE(same.good());
        glsl::Options options;
        options.target = glsl::Target::Es300;
        options.field_only = true;
        Diagnostics discarded;
        CHECK(glsl::emit(same.scene, options, discarded).text == emitted);
    }
    CHECK(good * 2 > tried); // else these programs say little
}

TEST_CASE("a function means the same at scene time and at field time") {
    unsigned good = 0, tried = static_cast<unsigned>(test::effort(260));
    for (unsigned seed = 0; seed < tried; ++seed) {
        const std::string text =
            programs::function(seed) +
            "let known = f(0.3125, [1.5, -0.75, 0.25], 3)\n"
            "sphere(1).paint(p => vec3(f(p.x, [p.y, p.z, 0.25], int(p.x + 3)), known, 0))\n";
        INFO("seed " << seed << "\n" << text);
        driver::Compilation c = compile(text);
        INFO(report(c));
        CHECK(c.good());
        if (!c.good()) continue;
        ++good;
        test::Reference reference(c.scene);
        const ir::Surface &surface = c.scene.surfaces[0];
        const auto values = [&](const std::array<double, 3> &q) {
            return reference.evaluated(surface.diffuse, {{surface.point, test::Reference::vec3(q)}})
                .value;
        };
        const std::array<double, 3> p{0.3125, 1.5, -0.75};
        INFO("at scene time " << values(p)[1] << ", at field time " << values(p)[0]);
        CHECK(test::agree(values(p)[1], p,
                          [&](const std::array<double, 3> &q) { return values(q)[0]; }));
    }
    CHECK(good * 2 > tried);
}
