// Our shaders against plain tracers written by hand: by_hand/NAME.frag is the field of
// scenes/NAME.sdf as one writes it for Shadertoy, by_hand/solids.glsl what several of them are made
// of, by_hand/tracer.glsl what goes round it. Frames of both in turn on the driver at hand, once both
// meet the same solid.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>

namespace fathom::bench {

namespace {

// Where a scene is one of Curv's, written anew: the ratios of our frames to Curv's, as they were
// measured in November 2026 (llvmpipe, processor time; ours with shadows and occlusion, Curv's with
// occlusion; `march` without both). 0: it is none of Curv's.
struct Subject {
    const char *name, *what;
    double drawn_to_curv = 0, march_to_curv = 0;
    double most_differing = 5; // pixels in a thousand
};

constexpr Subject subjects[] = {
    {"blend", "blend", 1.07, 0.74},
    {"twisted_box", "twisted box", 0.92, 0.71},
    {"menger_4", "Menger sponge, 4 levels", 0.35, 0.29},
    {"gyroid", "gyroid in a ball", 1.01, 0.9},
    {"snowman", "snowman", 0.44, 0.40},
    {"abacus", "abacus", 0.52, 0.47},
    {"mandelbulb", "Mandelbulb", 2.0, 0.85, 40}, // of an estimate each tracer makes its own
    {"plato", "five regular solids", 0.85, 0.80},
    {"vase", "vase", 0.09, 0.08},
    {"kaboom", "kaboom", 0.49, 0.17},
    {"colored_spheres_64", "64 colored spheres", 1.41, 1.1},
    {"spheres_100", "100 smooth spheres"},
    {"pillars", "rows of pillars"},
    {"fbm_sphere", "sphere with 4 octaves"},
};

constexpr double most_drawn = 0.8, most_march = 0.5; // ratios to aim at

std::variant<gl::Program, gl::ProgramError> by_hand(const std::string &name, const ir::Scene &scene,
                                                    bool march_alone) {
    const std::string folder = FATHOM_SOURCE_DIR "/bench/by_hand/";
    glsl::Output output;
    output.text = "#version 330 core\n";
    if (march_alone) output.text += "#define MARCH_ALONE\n";
    for (const std::string &part :
         {std::string("solids.glsl"), name + ".frag", std::string("tracer.glsl")})
        output.text += text_of(folder + part);
    return gl::Program::build(output, scene);
}

// Whether both miss, or hit at most a hundredth of the way apart. Four numbers a pixel, of
// Mode::Numbers.
bool alike(const float *a, const float *b) {
    const bool hit = a[3] > 0;
    return hit == (b[3] > 0) && (!hit || std::fabs(a[1] - b[1]) <= 0.01f * a[1]);
}

// How many pixels in a thousand meet what the other does not meet there or in a pixel beside: two
// tracers differ along edges.
double differing(const gl::Pixels &a, const gl::Pixels &b) {
    int count = 0;
    for (int y = 0; y < a.height; ++y)
        for (int x = 0; x < a.width; ++x) {
            bool same = false;
            for (int j = std::max(y - 1, 0); j <= std::min(y + 1, a.height - 1); ++j)
                for (int i = std::max(x - 1, 0); i <= std::min(x + 1, a.width - 1); ++i)
                    same = same || alike(&a.rgba[4 * static_cast<std::size_t>(y * a.width + x)],
                                         &b.rgba[4 * static_cast<std::size_t>(j * a.width + i)]);
            count += same ? 0 : 1;
        }
    return 1000.0 * count / (a.width * a.height);
}

double mean_steps(const gl::Pixels &numbers) {
    double sum = 0;
    for (std::size_t i = 0; i < numbers.rgba.size(); i += 4)
        sum += static_cast<double>(numbers.rgba[i]);
    return 4 * sum / static_cast<double>(numbers.rgba.size());
}

void compare(Table &table, const gl::Context &context, const Subject &subject, bool march_alone) {
    const std::string file = scene_path(subject.name + std::string(".sdf"));
    const double to_curv = march_alone ? subject.march_to_curv : subject.drawn_to_curv;
    std::string what =
        fmt::format("frame 400x400, {}: {}", march_alone ? "march" : "drawn", subject.what);
    if (to_curv > 0) what += fmt::format(" (to Curv: {})", to_curv);
    const auto lacks = [&](const std::string &why) {
        table.push_back({.what = what, .missing = why});
    };
    driver::CompileOptions options;
    options.cells = driver::cells_of_pictures;
    options.unsaved = text_of(file);
    if (march_alone) *options.unsaved += "lighting(shadow_darkness: 0, ambient_occlusion: 0)\n";
    const driver::Compilation compilation = driver::compile_file(file, options);
    if (!compilation.good()) return lacks(complaint(compilation));
    const ir::Scene &scene = compilation.scene;
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(scene,
                                           {.target = glsl::Target::Glsl330,
                                            .buffers = true,
                                            .pruning = gl::can_prune(),
                                            .passes = true},
                                           diagnostics);
    if (diagnostics.has_errors()) return lacks("it cannot be emitted");
    auto ours = gl::Program::build(output, scene),
         theirs = by_hand(subject.name, scene, march_alone);
    for (const auto *program : {&ours, &theirs})
        if (const auto *error = std::get_if<gl::ProgramError>(program))
            return lacks(fmt::format("line {}: {}", error->line, error->message));

    gl::Request request;
    request.width = request.height = 400;
    const auto drawn = [&](const auto &program, gl::Mode mode = gl::Mode::Picture) {
        return gl::draw(std::get<gl::Program>(program), scene, request, mode);
    };
    const auto first = drawn(ours, gl::Mode::Numbers), second = drawn(theirs, gl::Mode::Numbers);
    if (!first || !second) return lacks("it cannot be drawn");
    if (const double share = differing(*first, *second); share > subject.most_differing)
        return lacks(fmt::format("they meet another solid in {:.3g} of 1000 pixels", share));
    // A software driver's work is the process's own, whoever else has the machine meanwhile.
    const bool software = context.describe().find("llvmpipe") != std::string::npos;
    const auto taken = [&](const auto &program) {
        const double begin = software ? processor_seconds() : seconds_now();
        drawn(program);
        return ((software ? processor_seconds() : seconds_now()) - begin) * 1e3;
    };
    double best = 1e9, best_by_hand = 1e9, spent = 0;
    for (int iteration = 0; iteration < 9 || (spent < 2500 && iteration < 120); ++iteration) {
        const double a = taken(ours), b = taken(theirs);
        best = std::min(best, a);
        best_by_hand = std::min(best_by_hand, b);
        spent += a + b;
    }
    table.push_back({.what = what,
                     .value = best,
                     .unit = software ? "ms of processor" : "ms",
                     .baseline = fmt::format("by hand (steps a ray {:.3g}, ours {:.3g})",
                                             mean_steps(*second), mean_steps(*first)),
                     .baseline_value = best_by_hand,
                     .maximum = march_alone ? most_march : most_drawn});
}

} // namespace

void measure_hand_written(Table &table) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        table.push_back({.what = "frames against tracers by hand", .missing = "no GL: " + *why});
        return;
    }
    const gl::Context &current = std::get<gl::Context>(context);
    for (const Subject &subject : subjects)
        for (const bool march_alone : {true, false}) compare(table, current, subject, march_alone);
}

} // namespace fathom::bench
