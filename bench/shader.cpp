// How large the shader of a union of many coloured shapes is, and how long the GL at hand takes to
// link it.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/render.h"

#include <cstdlib>

namespace fathom::bench {

namespace {

// A loop over very many shapes whose body computes from the iteration's number: its shader has the
// loop, so that its text is as long for 10,000 iterations as for 100.
void measure_long_loop(Table &table) {
    std::string wrong;
    double bytes = 0;
    auto emit = [&](const char *count) {
        driver::CompileOptions options;
        options.overrides = {{"count", count}};
        const driver::Compilation spheres =
            driver::compile_file(scene_path("spheres_10000.sdf"), options);
        if (!spheres.good()) {
            wrong = "it does not compile: " + complaint(spheres);
            return;
        }
        Diagnostics diagnostics;
        bytes = static_cast<double>(glsl::emit(spheres.scene, {}, diagnostics).text.size());
        if (diagnostics.has_errors()) wrong = "it cannot be emitted";
    };
    emit("100");
    const double few = bytes, begin = processor_seconds();
    emit("10000");
    const double took = processor_seconds() - begin;
    const std::string what = "loop over 10,000 spheres, text to GLSL";
    if (!wrong.empty()) {
        table.push_back({.what = what, .missing = wrong});
        return;
    }
    table.push_back({.what = what, .value = took, .unit = "s", .maximum = 1});
    table.push_back({.what = "loop over 10,000 spheres, GLSL",
                     .value = bytes / 1024,
                     .unit = "KB",
                     .baseline = "for 100 spheres",
                     .baseline_value = few / 1024,
                     .maximum = 1.01}); // the count has more digits
}

} // namespace

void measure_shader(Table &table) {
    measure_long_loop(table);
    const driver::Compilation spheres = compiled("colored_spheres_256.sdf");
    const std::string size = "256 coloured spheres, GLSL",
                      link = "256 coloured spheres, GL compiles and links";
    if (!spheres.good()) {
        table.push_back({.what = size, .missing = complaint(spheres)});
        return;
    }
    Diagnostics diagnostics;
    const glsl::Output text =
        glsl::emit(spheres.scene, {}, diagnostics); // as `fathom compile` writes it
    glsl::Options options;
    options.target = glsl::Target::Glsl330; // as `fathom render` and the viewer draw it
    options.buffers = true;
    const glsl::Output drawn = glsl::emit(spheres.scene, options, diagnostics);
    if (diagnostics.has_errors()) {
        table.push_back({.what = size, .missing = "it cannot be emitted"});
        return;
    }
    table.push_back({.what = size,
                     .value = static_cast<double>(text.text.size()) / 1024,
                     .unit = "KB",
                     .maximum = 64});

    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1); // else the second run would measure the disk
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        table.push_back({.what = link, .missing = "no GL: " + *why});
        return;
    }
    auto program = std::variant<gl::Program, gl::ProgramError>(gl::ProgramError{});
    const double linking = seconds([&] { program = gl::Program::build(drawn, spheres.scene); });
    if (const auto *error = std::get_if<gl::ProgramError>(&program)) {
        table.push_back({.what = link, .missing = error->message});
        return;
    }
    table.push_back({.what = link, .value = linking, .unit = "s", .maximum = 1});
    // Drivers may leave work for the first time that a program draws: Mesa's llvmpipe makes its
    // machine code then.
    gl::Request request;
    request.width = request.height = 16;
    const double drawing = seconds([&] {
        gl::draw(std::get<gl::Program>(program), spheres.scene, request, gl::Mode::Linear);
    });
    table.push_back({.what = "  and draws a first picture, 16x16", .value = drawing, .unit = "s"});
}

} // namespace fathom::bench
