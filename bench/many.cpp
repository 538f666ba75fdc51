// What scenes of hundreds to ten thousands of shapes cost by GL: how long the driver links them,
// and a frame where each cell of space has a list of the rows that can matter in it, against all
// rows.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <random>

namespace fathom::bench {

namespace {

std::string formatted(const char *form, double a, double b = 0, double c = 0, double d = 0) {
    char text[160];
    std::snprintf(text, sizeof text, form, a, b, c, d);
    return text;
}

// `count` spheres by chance near a shell with room for them, one by one.
std::string shell_text(int count, bool blended) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> part(-1, 1);
    const double radius = std::sqrt(count / 1000.0);
    std::string text = blended ? "smooth_union(0.05) {\n" : "union {\n";
    for (int i = 0; i < count; ++i) {
        const double height = part(random), turn = 3.14159265 * part(random),
                     ring = std::sqrt(1 - height * height);
        text += formatted("  sphere(%.4f).translate([%.5f, %.5f, %.5f])\n",
                          0.06 + 0.02 * part(random), radius * ring * std::cos(turn),
                          radius * height, radius * ring * std::sin(turn));
    }
    return text + "}\ncamera(at: [2, 1.6, 3] * " + formatted("%.4f", radius) + ", fov: 45deg)\n";
}

// Shapes of several kinds alternately, blended in that order: not one loop over like shapes.
std::string unlike_text(int count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> part(0, 1);
    std::string text = "smooth_union(0.1) {\n";
    for (int i = 0; i < count; ++i) {
        const double a = 0.2 + 0.3 * part(random), b = 0.2 + 0.3 * part(random);
        switch (std::uniform_int_distribution<int>(0, 3)(random)) {
        case 0: text += formatted("  sphere(%.4f)", a); break;
        case 1: text += formatted("  box([%.4f, %.4f, %.4f])", a, b, a); break;
        case 2: text += formatted("  cylinder(%.4f, %.4f)", a, b); break;
        case 3: text += formatted("  torus(%.4f, %.4f)", a, b / 3); break;
        }
        text += formatted(".translate([%.4f, %.4f, %.4f])\n", i % 45 - 22.0, part(random),
                          i / 45 - 22.0);
    }
    return text + "}\n";
}

struct Drawn {
    double link = 0, frame = 0, lists = 0; // ms; of the processor, where GL is software
    std::string missing{};
};

Drawn draw(const ir::Scene &scene, bool pruning, bool frames) {
    Drawn result;
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .buffers = true, .pruning = pruning}, diagnostics);
    if (diagnostics.has_errors()) return {.missing = "it cannot be emitted"};
    const auto now = [] { return gl::is_software() ? processor_seconds() : seconds_now(); };
    double begin = now();
    const auto program = gl::Program::build(output, scene);
    result.link = (now() - begin) * 1e3;
    if (const auto *error = std::get_if<gl::ProgramError>(&program))
        return {.missing = error->message};
    if (!frames) return result;
    gl::Request request;
    request.width = 200;
    request.height = 150;
    const auto frame = [&] {
        begin = now();
        gl::draw(std::get<gl::Program>(program), scene, request, gl::Mode::Linear);
        return (now() - begin) * 1e3;
    };
    frame(); // makes the machine code, and the lists
    result.frame = std::min(frame(), frame());
    if (gl::Pruning *lists = std::get<gl::Program>(program).pruning()) {
        begin = now();
        lists->remake(scene.params, 0);
        gl::finish();
        result.lists = (now() - begin) * 1e3;
    }
    return result;
}

void measure_link(Table &table, const std::string &what, const std::string &text) {
    const driver::Compilation compilation = compiled_text("many.sdf", text);
    Drawn best{.missing = complaint(compilation)};
    if (compilation.good()) {
        best = draw(compilation.scene, false, false);
        for (int i = 0; i < 4; ++i)
            best.link = std::min(best.link, draw(compilation.scene, false, false).link);
    }
    if (best.missing.empty())
        table.push_back({.what = what, .value = best.link, .unit = "ms", .maximum = 150});
    else
        table.push_back({.what = what, .missing = best.missing});
}

void measure_frame(Table &table, const std::string &what, const std::string &text, double times) {
    const driver::Compilation compilation = compiled_text("many.sdf", text);
    std::string missing = complaint(compilation);
    if (missing.empty() && !gl::can_prune()) missing = "this GL is older than 4.3";
    Drawn pruned, plain;
    if (missing.empty()) {
        pruned = draw(compilation.scene, true, true);
        plain = draw(compilation.scene, false, true);
        missing = pruned.missing + plain.missing;
    }
    if (!missing.empty()) return table.push_back({.what = what, .missing = missing});
    table.push_back({.what = what,
                     .value = pruned.frame,
                     .unit = "ms",
                     .baseline = "all rows everywhere",
                     .baseline_value = plain.frame,
                     .maximum = 1 / times});
    table.push_back({.what = "  and making the lists, once", .value = pruned.lists, .unit = "ms"});
}

} // namespace

void measure_instances(Table &table) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        table.push_back({.what = "many shapes by GL", .missing = "no GL: " + *why});
        return;
    }
    measure_link(table, "GL links 200 blended spheres, one by one", shell_text(200, true));
    measure_link(table, "GL links 200 blended spheres of a loop",
                 "smooth_union(0.1) {\n  for i in 0..200 {\n    let y = 1 - (2 * i + 1) / 200\n"
                 "    sphere(0.1).translate([sqrt(1 - y * y) * cos(2.4 * i), y, "
                 "sqrt(1 - y * y) * sin(2.4 * i)])\n  }\n}\n");
    measure_link(table, "GL links 2,000 unlike shapes, blended", unlike_text(2000));
    measure_frame(table, "frame 200x150: 1,000 spheres", shell_text(1000, false), 50);
    measure_frame(table, "frame 200x150: 1,000 spheres over a ground",
                  "plane(Y, -1.3)\n" + shell_text(1000, false), 50);
    measure_frame(table, "frame 200x150: 1,000 blended spheres", shell_text(1000, true), 50);
    measure_frame(table, "frame 200x150: 10,000 blended spheres", shell_text(10000, true), 100);
}

} // namespace fathom::bench
