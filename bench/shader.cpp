// How large the shader of a union of many coloured shapes is, and how long the GL at hand takes to
// link it.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/render.h"

#include <cstdlib>

namespace fathom::bench {

void measure_shader(Table &table) {
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
                     .most = 64});

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
    table.push_back({.what = link, .value = linking, .unit = "s", .most = 1});
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
