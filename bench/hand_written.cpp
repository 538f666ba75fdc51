// Our shaders against the same scenes written by hand (by_hand/*.frag, with by_hand/march.glsl
// round each): the same algorithm and look, so that only the code differs. Frames of both
// alternately on the driver at hand, once each of them draws what the other does.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/render.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>
#include <sstream>

namespace fathom::bench {

namespace {

std::string text_of(const std::string &name) {
    std::ifstream in(FATHOM_SOURCE_DIR "/bench/by_hand/" + name);
    std::ostringstream text;
    text << in.rdbuf();
    return text.str();
}

std::variant<gl::Program, gl::ProgramError> by_hand(const std::string &name,
                                                    const ir::Scene &scene) {
    glsl::Output output;
    output.text = "#version 330 core\n" + text_of(name + ".frag") + text_of("march.glsl");
    return gl::Program::build(output, scene);
}

// How many pixels in a thousand differ by what can be seen.
double differing(const gl::Pixels &a, const gl::Pixels &b) {
    std::size_t count = 0;
    for (std::size_t i = 0; i < a.rgba.size(); i += 4) {
        float maximum = 0;
        for (std::size_t c = 0; c < 3; ++c)
            maximum = std::max(maximum, std::fabs(a.rgba[i + c] - b.rgba[i + c]));
        count += maximum > 0.02f;
    }
    return 4000.0 * static_cast<double>(count) / static_cast<double>(a.rgba.size());
}

void compare(Table &table, const gl::Context &context, const std::string &what,
             const std::string &name) {
    const auto lacks = [&](const std::string &why) {
        table.push_back({.what = what, .missing = why});
    };
    const driver::Compilation compilation = compiled(name + ".sdf");
    if (!compilation.good()) return lacks(complaint(compilation));
    const ir::Scene &scene = compilation.scene;
    Diagnostics diagnostics;
    const glsl::Output output =
        glsl::emit(scene, {.target = glsl::Target::Glsl330, .buffers = true}, diagnostics);
    if (diagnostics.has_errors()) return lacks("it cannot be emitted");
    auto ours = gl::Program::build(output, scene), theirs = by_hand(name, scene);
    for (const auto *program : {&ours, &theirs})
        if (const auto *error = std::get_if<gl::ProgramError>(program))
            return lacks(fmt::format("line {}: {}", error->line, error->message));

    gl::Request request;
    request.width = 320;
    request.height = 240;
    const auto drawn = [&](const auto &program) {
        return gl::draw(std::get<gl::Program>(program), scene, request, gl::Mode::Picture);
    };
    const auto first = drawn(ours), second = drawn(theirs);
    if (!first || !second) return lacks("it cannot be drawn");
    if (const double share = differing(*first, *second); share > 5)
        return lacks(fmt::format("the pictures differ in {} of 1000 pixels", share));
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
                     .baseline = "written by hand",
                     .baseline_value = best_by_hand,
                     .maximum = 1.1});
}

} // namespace

void measure_hand_written(Table &table) {
    setenv("MESA_SHADER_CACHE_DISABLE", "true", 1);
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        table.push_back({.what = "frames against shaders by hand", .missing = "no GL: " + *why});
        return;
    }
    const gl::Context &current = std::get<gl::Context>(context);
    compare(table, current, "frame 320x240: 100 smooth spheres", "spheres_100");
    compare(table, current, "frame 320x240: Menger sponge, 4 levels", "menger_4");
    compare(table, current, "frame 320x240: twisted box", "twisted_box");
    compare(table, current, "frame 320x240: rows of pillars", "pillars");
    compare(table, current, "frame 320x240: sphere with 4 octaves", "fbm_sphere");
}

} // namespace fathom::bench
