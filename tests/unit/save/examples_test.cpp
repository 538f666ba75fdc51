// Every example goes out to a save file and comes back the same: the marched distance at random
// points, the picture, the parameters and all settings. What a plain 0.3 reader cannot see is said.
#include "tests/unit/save/support.h"

#include "backend-cpu/tape.h"
#include "backend-cpu/trace/march.h"
#include "driver/compile.h"

#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fmt/format.h>
#include <random>

using namespace save_test;

namespace {

// 1e-6, and what the compiler widens a guard's box by: a file has a shape's paint below its
// transforms, and so the guard of what is painted within a region (minimal_surfaces: 1.3e-6).
constexpr double max_field = 1.5e-6;
// What is scaled by a vector is shaded by differences of its field, which show the rounding
// (night_city: 3.4e-6).
constexpr double max_stretched = 4e-6;
double most(const std::string &imported) {
    const bool stretched = imported.find(".scale([") != std::string::npos ||
                           imported.find(".scale(1 / (vec3(") != std::string::npos;
    return stretched ? max_stretched : max_field;
}
constexpr int picture_width = 60, picture_height = 45, asked_points = 1000;

using Coordinates = std::array<std::vector<float>, 3>;

Coordinates random_points(const ir::Scene &scene) {
    std::mt19937 random(7);
    Coordinates made;
    for (int i = 0; i < asked_points; ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            const double lo = std::max(scene.bounds.empty() ? -2 : scene.bounds.lo[k] - 0.5, -8.0),
                         hi = std::min(scene.bounds.empty() ? 2 : scene.bounds.hi[k] + 0.5, 8.0);
            made[k].push_back(static_cast<float>(lo + (hi - lo) * (random() / 4294967296.0)));
        }
    return made;
}

std::vector<float> shaded(const ir::Scene &scene, const Coordinates &at, double time) {
    const cpu::Program program = cpu::compile(scene, scene.shaded);
    cpu::Scratch scratch = cpu::make_scratch(program, cpu::inputs_of(scene, time));
    std::vector<float> result(at[0].size());
    const float *in[] = {at[0].data(), at[1].data(), at[2].data()};
    float *out[] = {result.data()};
    cpu::evaluate(program, scratch, in, out, result.size());
    return result;
}

// The largest difference of two scenes' fields, which no bound divides (a bound as a formula of
// params may be another one of another text); of those above 1, which are no more
// exact than float32 has them, as a part of the distance.
double field_difference(const ir::Scene &a, const ir::Scene &b, double time) {
    const Coordinates at = random_points(a);
    const std::vector<float> x = shaded(a, at, time), y = shaded(b, at, time);
    double worst = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        const double off =
            std::abs(double(x[i]) - double(y[i])) / std::max(1.0, std::abs(double(x[i])));
        if (!(off <= worst)) worst = off;
    }
    return worst;
}

ir::View view_of(const ir::Scene &scene, double time) {
    return ir::view_of(scene, time, static_cast<double>(picture_width) / picture_height);
}

std::vector<std::uint8_t> picture(const ir::Scene &scene, const ir::View &view, double time) {
    return cpu::render(cpu::prepare(scene, view, picture_width, picture_height, time), {}).rgba;
}

// Of 100 pixels; each scene seen by its own view, or both by one.
double picture_difference(const ir::Scene &a, const ir::Scene &b, double time,
                          const std::optional<ir::View> &view = {}) {
    const std::vector<std::uint8_t> x = picture(a, view.value_or(view_of(a, time)), time),
                                    y = picture(b, view.value_or(view_of(b, time)), time);
    int differ = 0;
    for (std::size_t i = 0; i < x.size(); i += 4) {
        int maximum = 0;
        for (std::size_t c = i; c < i + 3; ++c) maximum = std::max(maximum, std::abs(x[c] - y[c]));
        differ += maximum > 1;
    }
    return 100.0 * differ / (picture_width * picture_height);
}

struct Trip {
    std::string yaml, exported, labelled, imported, errors, sdf;
    driver::Compilation back;
};

Trip there_and_back(const driver::Compilation &first, const driver::CompileOptions &options) {
    Trip trip;
    Diagnostics diagnostics;
    trip.yaml = save::export_yaml(first.scene, diagnostics);
    for (const Diagnostic &d : diagnostics.items()) {
        if (d.severity == Severity::Note)
            trip.labelled += d.message + "\n";
        else
            trip.exported += d.message + "\n";
    }
    const Imported imported = import_text(trip.yaml);
    trip.imported = imported.said();
    trip.sdf = imported.result.sdf;
    trip.back = driver::compile_text("back.sdf", trip.sdf, FATHOM_SOURCE_DIR "/examples", options);
    for (const Diagnostic &d : trip.back.diagnostics.items())
        // a param that decided what shapes there are, or that nothing read before either
        if (d.severity != Severity::Note && d.code != Code::UnusedParam)
            trip.errors += to_text(d, trip.back.sources, false).substr(0, 600) + "\n";
    return trip;
}

// Parameters moved off their values, each a third of the way up: what follows them has to come back
// too.
std::vector<driver::Override> moved_params(const ir::Scene &scene) {
    std::vector<driver::Override> moved;
    for (const ir::Param &param : scene.params)
        if (param.has_range && param.type == ir::Type::Float && !param.structural)
            moved.push_back(
                {param.name, fmt::to_string(param.lo[0] + (param.hi[0] - param.lo[0]) / 3)});
    return moved;
}

} // namespace

TEST_CASE("every example comes back from a save file with its field and its picture",
          "[save][examples]") {
    std::vector<std::filesystem::path> files;
    for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
        if (entry.path().extension() == ".sdf") files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    CHECK(files.size() >= 40);
    std::size_t moving = 0, following = 0;
    for (const std::filesystem::path &file : files) {
        const std::string name = file.stem().string();
        CAPTURE(name);
        const driver::Compilation first = driver::compile_file(file, {});
        REQUIRE(first.good());
        const Trip trip = there_and_back(first, {});
        CAPTURE(trip.labelled);
        // the only thing that a file cannot hold: the other scenes that a loop's count stands for
        CHECK(trip.exported == (name == "folded_fractal"
                                    ? "`detail` decides what shapes there are: the file has those "
                                      "of its present value\n"
                                    : ""));
        CHECK(trip.imported == "");
        CHECK(trip.errors == "");
        if (!trip.back.good()) continue;
        CHECK(field_difference(first.scene, trip.back.scene, 0) <= most(trip.sdf));
        CHECK(picture_difference(first.scene, trip.back.scene, 0) <= 0.5);

        const ir::Scene &a = first.scene, &b = trip.back.scene;
        CHECK(a.params.size() == b.params.size());
        for (std::size_t i = 0; i < a.params.size() && i < b.params.size(); ++i) {
            CHECK(a.params[i].name == b.params[i].name);
            CHECK(a.params[i].label == b.params[i].label);
            CHECK(a.params[i].type == b.params[i].type);
            CHECK(a.params[i].value == b.params[i].value);
            CHECK(a.params[i].lo == b.params[i].lo);
            CHECK(a.params[i].hi == b.params[i].hi);
        }
        CHECK(a.render.far == b.render.far);
        CHECK(a.render.epsilon == b.render.epsilon);
        CHECK(a.render.max_steps == b.render.max_steps);
        CHECK(a.render.time_end == b.render.time_end);
        CHECK(a.graph.cache_count() == b.graph.cache_count());
        if (trip.labelled.find("motion") != std::string::npos) {
            ++moving;
            CHECK(field_difference(a, b, 1.3) <= most(trip.sdf));
        }
        driver::CompileOptions options;
        options.overrides = moved_params(a);
        if (options.overrides.empty()) continue;
        ++following;
        const driver::Compilation there = driver::compile_file(file, options),
                                  back = driver::compile_text(
                                      "back.sdf", trip.sdf, FATHOM_SOURCE_DIR "/examples", options);
        REQUIRE(there.good());
        REQUIRE(back.good());
        CHECK(field_difference(there.scene, back.scene, 0.7) <= most(trip.sdf));
    }
    CHECK(moving >= 4);
    CHECK(following >= 8);
}

// A param, the time and a copy's number in every place where the language takes a number.
TEST_CASE("numbers that follow something come back following it", "[save][examples]") {
    const std::string head = "param a = 0.6 in 0.2..1.2 \"How much\"\nparam n = 3 in 1..6\n"
                             "param on = true\nparam tint: color = #336699\n"
                             "param v = [0.5, 0.25, 1] in [0, 0, 0]..[1, 1, 2]\n";
    for (const char *text : {
             "sphere(a)",
             "box([a, 1, 2 * a]).translate([a, 0, -a])",
             "box(v + 0.1)",
             "torus(1, 0.2 * a).rotate(a, axis: X)",
             "box([1, 2, 3]).rotate(0.7 * time, axis: [1, 2, 3])",
             "box([1, 2, 3]).rotate(a * time + 0.5).rotate(a, axis: Z).translate(y: a)",
             "box([1, 2, 3]).rotate_euler([a, 0.2, 0.3 * a])",
             "box(1).scale(a)",
             "box(1).scale([a, 1, 1 + a])",
             "box(1).translate(sin(time) * v)",
             "sphere(1).offset(0.2 * a)",
             "box(2).shell(0.2 * a)",
             "box([1, 3, 1]).twist(a)",
             "box([1, 3, 1]).bend(0.4 * a)",
             "cylinder(1, 2).taper(a)",
             "box(2).elongate([a, 0, 0])",
             "box(2).mirror(X).translate(x: a)",
             "box(1).hyperize(2)",
             "sphere(0.4).repeat([1.6, 0, 1.5], count: [3, 1, 2]).translate(x: a)",
             "sphere(0.3).translate(x: 1).repeat_polar(5).translate(x: a)",
             "box(0.5).repeat([1.5, 0, 1.5], count: [3, 1, 3], copies: (s, id) => s.scale(0.5 + "
             "0.2 * id.x * a))",
             "box(0.4).translate(x: 1).repeat_polar(5, copies: (s, id) => s.rotate(a * id.x, axis: "
             "X))",
             "box(0.5).repeat([2, 0, 2], copies: (s, id) => s.rotate(hash(id) + time))",
             "box(0.5).repeat([2, 0, 2], copies: (s, id) => s.scale([1, 1 + saturate(0.1 * id.x), "
             "1]).translate(y: value_noise(0.3 * id)))",
             "sphere(0.2).repeat([0.8, 0, 0], count: [2, 1, 1], copies: (s, i) => s.scale(0.5 + "
             "0.3 * i.x)).repeat([0, 0, 3], count: [1, 1, 2], copies: (s, j) => s.translate(y: 0.2 "
             "* j.z * a))",
             "smooth_union(a, sphere(1), box(1).translate(x: 1))",
             "chamfer_difference(0.3 * a) { sphere(1)\nbox(1).translate(x: 1) }",
             "columns_union(0.4 * a, 3) { sphere(1)\nbox(1).translate(x: 1) }",
             "blend(sphere(1), box(1), a / 2)",
             "pseudonorm_blend(sphere(1), box(1).translate(x: 0.5), 2 + a)",
             "groove(sphere(1), box(1).translate(x: 1), width: 0.2 * a, depth: 0.1)",
             "implicit(p => length(p) - a, within: ball(2))",
             "implicit(p => if on { length(p) - a } else { length(p) - 1 })",
             "sphere(1).displace(p => 0.1 * a * sin(5 * p.x + time))",
             "let f = cached(p => a * 0.2 * noise(3 * p), cell: 0.05)\nsphere(1).displace(f)",
             "circle(a).extrude(1 + a)",
             "(rectangle([a, 1]) - circle(0.2 * a).translate([0.1, a / 4])).extrude(1, twist: 1, "
             "taper: 0.5)",
             "polygon([[0, -1], [1, 0], [0, 1]]).revolve()",
             "(star(5, 1, 0.5) | circle(0.3).scale([2, "
             "1])).rotate(20deg).revolve(1.5)",
             "metaballs([[0, 0, 0], [0.5, 0, 0]], radius: 0.6).translate(x: a)",
             "tubes([[0, 0, 0], [1, 0, 0], [1, a, 0]], radius: 0.1)",
             "heightfield(q => 0.2 * a * sin(4 * q.x + time), size: [2, 2], depth: 0.5)",
             "gdf_icosahedron(a, exponent: 20)",
             "gdf([[1, 2, 3], [0, 1, 0], [1, 0, 0]], radius: a)",
             "import \"dfmodel\" as dfmodel\ndfmodel.gdf_pair(dfmodel.dodecahedron, dfmodel.cube, "
             "1.5, -0.5, radius: 0.5 + a / 2)\ncamera(at: [3, 2, 5])",
             "import \"dfmodel\" as dfmodel\ndfmodel.gdf_pair(dfmodel.dodecahedron, "
             "dfmodel.ac_icosahedron, 1.5, -0.5)\ncamera(at: [3, 2, 5])",
             "gdf_dodecahedron(0.8) & gdf_truncated_icosahedron(1, exponent: 9).rotate(a)",
             "for i in 0..4 { sphere(0.2 + 0.1 * a).translate(x: i * a) }",
             "sphere(1).paint(tint)",
             "sphere(1).paint(material(diffuse: p => mix(red, tint, a * saturate(p.x)), exponent: "
             "20 + a))",
             "sphere(1)\nlight(at: [3 * cos(time), 2, a], color: tint, intensity: "
             "2)\nlighting(ambient: a, shadow_darkness: a)",
             "sphere(1)\ncamera(at: [4 * cos(time), 2, 4 * sin(time)], look_at: [0, a, 0], fov: "
             "40deg)",
             "sphere(1)\nsun(direction: [cos(time), 1, 0])\nbackground(d => mix(tint, white, a * "
             "saturate(d.y)))\nrender(far: 40, epsilon: 0.001, time: 20)",
         }) {
        CAPTURE(text);
        const std::string import_line = "import \"dfmodel\" as dfmodel\n";
        const std::string scene =
            std::string(text).starts_with("import")
                ? import_line + head + std::string(text).substr(import_line.size())
                : head + text;
        const driver::Compilation first = driver::compile_text("a.sdf", scene, "", {});
        for (const Diagnostic &d : first.diagnostics.items())
            if (d.severity == Severity::Error) UNSCOPED_INFO(d.message);
        CHECK(first.good());
        if (!first.good()) continue;
        const Trip trip = there_and_back(first, {});
        CAPTURE(trip.sdf);
        CHECK(trip.exported == "");
        CHECK(trip.imported == "");
        CHECK(trip.errors == "");
        if (!trip.back.good()) continue;
        CHECK(field_difference(first.scene, trip.back.scene, 0) <= most(trip.sdf));
        CHECK(field_difference(first.scene, trip.back.scene, 0.9) <= most(trip.sdf));
        CHECK(picture_difference(first.scene, trip.back.scene, 0.9) <= 0.5);
        driver::CompileOptions options;
        options.overrides = {{"a", "0.9"}, {"v", "[0.2, 0.9, 1.5]"}, {"tint", "#aa2200"}};
        const driver::Compilation there = driver::compile_text("a.sdf", scene, "", options),
                                  back = driver::compile_text("b.sdf", trip.sdf, "", options);
        for (const std::string &error : back.usage_errors) UNSCOPED_INFO(error);
        REQUIRE(there.good());
        REQUIRE(back.good());
        CHECK(field_difference(there.scene, back.scene, 0.4) <= most(trip.sdf));
        // A file has a camera always: that of the params' values when it was written.
        CHECK(picture_difference(there.scene, back.scene, 0.4, view_of(back.scene, 0.4)) <= 0.5);
    }
}

TEST_CASE("regions and flat repetitions come back proved, and follow what they followed",
          "[save][examples]") {
    const std::string head = "param a = 0.6 in 0.2..1.2\ncamera(at: [3, 2, 5])\n";
    for (const char *text : {
             "box(1).within(ball(3))",
             "circle(1).extrude(1, twist: 30deg).within(ball(1.2 + a))",
             "gyroid(1, 0.2).within(aabb([-a, -1, -1], [1, a, 1]))",
             "(box(1).paint(red) | sphere(0.5).translate(x: 1)).within(ball(1) - tube(Y, 0.3 * a))",
             "plane(Y, 0).twist(1, axis: X).within(ball(1, at: [0, 0.3 * sin(time), 0]))",
             "implicit(p => length(p) - 1, within: aabb([-1, -a, -1], [1, 1, a]) - ball(0.3))",
             "box([1, 3, 1]).distort(p => [p.x + 0.2 * sin(2 * p.y), p.y, p.z], within: tube(Y, "
             "a))",
             "box(1).hyperize(1.5, within: ball(a))",
             "sphere(0.4).repeat([1, 1, 1]).within(ball(2)).bend(0.2)",
             "for i in 0..3 { box(0.8).within(ball(0.4 + 0.1 * i)).translate(x: i) }",
             "box(0.8).repeat([1, 0, 1], count: [3, 1, 3], copies: (s, id) => s.within(ball(0.45 + "
             "0.05 * id.x * a)))",
             "circle(0.3).translate(x: 1).repeat_polar(5).extrude(0.3)",
             "rectangle([0.4, 0.2]).rotate(a * 0 + 20deg).repeat([0.8, 0], count: [3, "
             "1]).extrude(a)",
             "circle(0.2 * a).repeat([0.9, 1]).extrude(0.3) & box(3)",
             "rectangle([0.8, 0.3]).translate([0.6, 0.3]).rotate(10deg).reflect([1, "
             "0.5]).extrude(a)",
             "rectangle([0.8, 0.3]).translate([0.6, 0.3]).mirror(Y).revolve(1)",
             "xor { circle(0.5)\ncircle(a).translate(x: 0.4) }.extrude(0.4)",
         }) {
        CAPTURE(text);
        const driver::Compilation first = driver::compile_text("a.sdf", head + text, "", {});
        for (const Diagnostic &d : first.diagnostics.items())
            if (d.severity == Severity::Error) UNSCOPED_INFO(d.message);
        REQUIRE(first.good());
        const Trip trip = there_and_back(first, {});
        CAPTURE(trip.sdf);
        CHECK(trip.exported == "");
        CHECK(trip.imported == "");
        CHECK(trip.errors == "");
        if (!trip.back.good()) continue;
        const auto status = [](const ir::Scene &scene) {
            return scene.facts[scene.root.index].status;
        };
        CHECK(status(first.scene) == ir::ProofStatus::Proved);
        CHECK(status(trip.back.scene) == ir::ProofStatus::Proved);
        Diagnostics again;
        CHECK(save::export_yaml(trip.back.scene, again) == trip.yaml);
        driver::CompileOptions options;
        options.overrides = {{"a", "0.9"}};
        const driver::Compilation there = driver::compile_text("a.sdf", head + text, "", options),
                                  back = driver::compile_text("b.sdf", trip.sdf, "", options);
        REQUIRE(there.good());
        REQUIRE(back.good());
        CHECK(field_difference(there.scene, back.scene, 0.4) <= most(trip.sdf));
        CHECK(picture_difference(there.scene, back.scene, 0.4) <= 0.5);
    }
}

TEST_CASE("an export says what version 0.3 does not read, and what is lost", "[save][examples]") {
    const auto trip_of = [](const char *text) {
        driver::Compilation first =
            driver::compile_text("a.sdf", text, FATHOM_SOURCE_DIR "/examples/parts", {});
        for (const Diagnostic &d : first.diagnostics.items())
            if (d.severity == Severity::Error) UNSCOPED_INFO(d.message);
        REQUIRE(first.good());
        return there_and_back(first, {});
    };
    const std::string labelled = "under labelled keys, which version 0.3 does not have: ";
    CHECK(trip_of("box([1, 3, 1]).twist(0.7, axis: X)\nlight(at: [3, 3, 3])\n"
                  "sphere(1).paint(p => if p.x > 0 { red } else { blue }).translate(x: 3)\n")
              .labelled ==
          labelled + "1 light, `Axis` of 1 `Twist` node, `Paint` of 1 `Generic` node\n");
    CHECK(trip_of("sphere(0.4).repeat([1, 0, 1], count: [3, 1, 3])").labelled ==
          labelled + "`Count` of 1 `Repetition` node\n");
    CHECK(trip_of("box(1).rotate(30deg)").labelled == "");
    // what is a function now, and may be proved no more
    CHECK(
        trip_of("circle(0.5).elongate([0.5, 0]).extrude(0.3)").labelled ==
        "the save format has no words for flat shapes: it is written as a function of the point\n" +
            labelled + "1 `Field` node\n");
    CHECK(trip_of("let im = image(\"tiles.png\")\nsphere(1)\nbackground(d => im(d.xy).rgb)")
              .exported ==
          "the save format has no words for this background: it reads an image, or "
          "loops too often\n");
    CHECK(trip_of("let im = image(\"tiles.png\")\nsphere(1)\n"
                  "light(at: [3, 3, im([time, 0]).r])")
              .exported == "the save format has no words for where a light is: it reads an image, "
                           "or loops too often\n");
}
