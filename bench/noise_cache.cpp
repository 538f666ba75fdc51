// The noise cache against exact frames, still and learnt, as the goals have it (`fathom
// bench
// --noise-cache` tells more of one scene); and what ir/passes/cost.cpp takes as measured: look-ups
// and kinds of noise, a point each. Where the CPU draws, its own time counts.
#include "bench/noise_cache.h"

#include "ir/passes/cost.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"

#include <epoxy/gl.h>

#include <cmath>
#include <fmt/format.h>

namespace fathom::bench {
namespace {

constexpr int side = 48, iterations = 32; // pixels; evaluations a pixel
constexpr double whole = 800;             // what is drawn is the middle of a picture of that size

driver::Compilation scene_of(const std::string &field, double cell) {
    return compiled_text(
        "cached.sdf",
        fmt::format("let f = cached(p => {}, cell: {})\ngdf_icosahedron(1).displace(f)\ncamera(at: "
                    "[0, 0.6, 2.6], look_at: [0, 0, 0], fov: 30deg)\n",
                    field, cell));
}

void measure_scene(Table &table, const std::string &what, const driver::Compilation &c,
                   double minimum) {
    if (!c.good()) return table.push_back({.what = what, .missing = complaint(c)});
    gl::CachedView view;
    Diagnostics diagnostics;
    if (const std::string why = view.use(c.scene, gl::usual_cache_size, diagnostics); !why.empty())
        return table.push_back({.what = what, .missing = why});
    const gl::FrameInputs inputs = middle_of(c.scene, 1);
    for (int frame = 0; frame < 60; ++frame) {
        view.draw(inputs, c.scene.params, {});
        if (view.read_tally().misses == 0) break;
    }
    const FrameTimes times = frame_times(view, c.scene, inputs);
    table.push_back({.what = what,
                     .value = 1e3 / times.cached,
                     .unit = "frames/s",
                     .baseline = "exact",
                     .baseline_value = 1e3 / times.exact,
                     .minimum = minimum});
}

// Nanoseconds, of two threads together, that `statement` takes an iteration, in a text that ends in
// functions.
double nanoseconds(const std::string &functions, const std::string &statement,
                   const glsl::Output &output, const ir::Scene &scene, int ages = 1) {
    glsl::Output measured = output;
    measured.text =
        fmt::format("{}layout(location = 0) out vec4 measured;\nvoid main() {{\n    vec3 p = "
                    "vec3(gl_FragCoord.xy * 0.013, 0.3);\n    vec4 sum = vec4(0.0);\n    for (int "
                    "iteration = 0; iteration < {}; ++iteration) {{\n        {}\n        p += "
                    "vec3(0.0137, 0.0071, 0.0193);\n    }}\n    measured = sum;\n}}\n",
                    functions, iterations, statement);
    auto built = gl::Program::build(measured, scene);
    const auto *program = std::get_if<gl::Program>(&built);
    if (!program) return NAN;
    GLuint texture = 0, framebuffer = 0;
    constexpr int size = 256;
    glGenTextures(1, &texture);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, size, size, 0, GL_RGBA, GL_FLOAT, nullptr);
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture, 0);
    glViewport(0, 0, size, size);
    std::vector<double> times;
    for (int iteration = 0; iteration < 6; ++iteration) {
        const double begin = processor_seconds();
        program->use();
        for (int unit = 0; unit < 2; ++unit)
            glUniform1i(glGetUniformLocation(program->name(),
                                             unit ? "fathom_cache_pool" : "fathom_cache_index"),
                        unit);
        glUniform1i(glGetUniformLocation(program->name(), "fathom_cache_bits"), 6);
        glUniform1i(glGetUniformLocation(program->name(), "fathom_cache_ages"), ages);
        gl::draw_triangle();
        gl::finish();
        if (iteration > 0) times.push_back(processor_seconds() - begin); // the first makes the code
    }
    glDeleteFramebuffers(1, &framebuffer);
    glDeleteTextures(1, &texture);
    return 1e9 * median(times) / (2.0 * size * size * iterations);
}

std::string before_main(const std::string &text) {
    return text.substr(0, text.find("void main()"));
}

double field_cost(const std::string &field) {
    const driver::Compilation c = scene_of(field, 0.05);
    Diagnostics diagnostics;
    glsl::Options options;
    options.target = glsl::Target::Glsl450;
    options.buffers = options.noise_cache = true;
    if (!c.good()) return NAN;
    const glsl::Output fill = glsl::emit_cache_passes(c.scene, options, diagnostics).fill;
    if (fill.text.empty()) return NAN;
    return nanoseconds(before_main(fill.text), "sum += fathom_value(0, p);", fill, c.scene);
}

// In an empty cache, so that all probes are made. What is there is mostly found by the first.
double look_up_cost(int probes) {
    const driver::Compilation c = scene_of("0.1 * fbm(2 * p, octaves: 6)", 0.05);
    Diagnostics diagnostics;
    glsl::Options options;
    options.target = glsl::Target::Glsl450;
    options.buffers = options.noise_cache = true;
    const glsl::Output picture = glsl::emit(c.scene, options, diagnostics);
    const std::size_t end = picture.text.find("_cached(vec3 p)");
    if (end == std::string::npos) return NAN;
    const std::size_t begin = picture.text.rfind(' ', end) + 1;
    const std::string name = picture.text.substr(begin, end - begin);
    std::string functions = glsl::with_cache(picture.text);
    functions = functions.substr(0, functions.find("layout(location = 0) out vec4 fathom_color"));
    gl::CacheStore store;
    store.make({});
    store.bind_textures(0);
    return nanoseconds(functions, "sum.x += " + name + "_cached(p);", picture, c.scene, probes);
}

void measure_costs(Table &table) {
    struct Cost {
        const char *what;
        double value, taken;
    };
    const double perlin =
        (field_cost("0.1 * fbm(2 * p, octaves: 9)") - field_cost("0.1 * fbm(2 * p, octaves: 4)")) /
        5;
    // One alone is not cached, so that no shader would fill cells with it.
    const std::string two = "0.1 * worley(3 * p) + 0.05 * worley(7 * p)";
    const double worley = field_cost(two + " + 0.03 * worley(11 * p)") - field_cost(two);
    const Cost costs[] = {{"  a look-up of one probe", look_up_cost(1), ir::look_up_cost},
                          {"  a look-up of four probes", look_up_cost(4), ir::look_up_cost},
                          {"  an octave of fbm", perlin, ir::octave_cost},
                          {"  Worley noise", worley, ir::worley_cost},
                          {"  spot noise, 4 a cell",
                           field_cost("0.1 * spot_noise(p, radius: 0.3, density: 4)"),
                           ir::spot_cost}};
    for (const Cost &cost : costs) {
        Row row{.what = cost.what, .value = cost.value, .unit = "ns a point"};
        row.baseline = "taken by the compiler";
        row.baseline_value = cost.taken;
        if (!std::isfinite(cost.value)) row.missing = "it cannot be built";
        table.push_back(row);
    }
}

} // namespace

driver::Compilation icosahedron() { return scene_of("0.12 * fbm(2.5 * p, octaves: 6)", 0.02); }
driver::Compilation worley_sums() {
    return scene_of("0.08 * worley(2.5 * p) + 0.04 * worley(5 * p) + 0.02 * worley(10 * p)", 0.02);
}
driver::Compilation spot_noise() {
    return scene_of("0.06 * spot_noise(p, radius: 0.25, density: 4)", 0.02);
}

gl::FrameInputs middle_of(const ir::Scene &scene, double times_as_far) {
    gl::FrameInputs inputs;
    inputs.view = ir::view_of(scene, 0, 1);
    inputs.view.origin += (1 - times_as_far) * inputs.view.focus * inputs.view.forward;
    inputs.view.focus *= times_as_far;
    inputs.view.extent *= side / whole;
    inputs.sun = ir::lights_of(scene, 0, inputs.view)[0].position;
    inputs.width = inputs.height = side;
    return inputs;
}

FrameTimes frame_times(gl::CachedView &view, const ir::Scene &scene,
                       const gl::FrameInputs &inputs) {
    const auto time = [](const auto &draw) {
        gl::finish();
        const double begin = processor_seconds();
        draw();
        gl::finish();
        return 1e3 * (processor_seconds() - begin);
    };
    std::vector<double> cached, exact;
    for (int iteration = 0; iteration < 7; ++iteration) {
        cached.push_back(time([&] { view.draw(inputs, scene.params, {}); }));
        exact.push_back(time([&] { view.draw_exactly(inputs, scene.params); }));
    }
    return {median(cached), median(exact)};
}

void measure_noise_cache(Table &table) {
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context))
        return table.push_back({.what = "noise cache, still", .missing = "no GL: " + *why});
    if (const std::string why = gl::cache_unavailable(); !why.empty())
        return table.push_back({.what = "noise cache, still", .missing = why});
    measure_costs(table);
    measure_scene(table, "noise cache, still: icosahedron, 6 octaves", icosahedron(), 1.5);
    measure_scene(table, "  Worley sums", worley_sums(), 3);
    measure_scene(table, "  spot noise", spot_noise(), 3);
    measure_scene(table, "  stone well",
                  driver::compile_file(FATHOM_SOURCE_DIR "/examples/11_well.sdf", {}), 1.5);
    measure_cache_views(table);
}

} // namespace fathom::bench
