// Frames on a card: how long its driver takes to compile and link each scene's shader, and how long
// a frame takes then, as a table in Markdown.
#include "bench/measure.h"

#include "backend-glsl/emit.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"
#include "render-gl/render.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fmt/format.h>

namespace fathom::bench {

namespace {

std::string row_of(const std::string &file, const FrameOptions &options) {
    driver::CompileOptions for_pictures;
    for_pictures.cells = driver::cells_of_pictures;
    const driver::Compilation compilation = driver::compile_file(file, for_pictures);
    if (!compilation.good()) return complaint(compilation);
    const ir::Scene &scene = compilation.scene;
    Diagnostics diagnostics;
    const glsl::Output output = glsl::emit(scene,
                                           {.target = glsl::Target::Glsl330,
                                            .buffers = true,
                                            .pruning = gl::can_prune(),
                                            .passes = true},
                                           diagnostics);
    if (diagnostics.has_errors()) return "it cannot be emitted";
    double begin = seconds_now();
    const auto built = gl::Program::build(output, scene);
    gl::finish();
    const double link = seconds_now() - begin;
    if (const auto *error = std::get_if<gl::ProgramError>(&built)) return error->message;
    gl::Request request;
    request.width = options.width;
    request.height = options.height;
    std::vector<double> times;
    std::uint64_t undecided = 0;
    for (int i = 0; i < options.frames + 1; ++i) { // the first makes what the driver put off
        begin = seconds_now();
        const auto pixels =
            gl::draw(std::get<gl::Program>(built), scene, request, gl::Mode::Picture);
        times.push_back(seconds_now() - begin);
        if (!pixels) return "it cannot be drawn";
        undecided = pixels->undecided;
    }
    const double first = times.front();
    times.erase(times.begin());
    return fmt::format("{:.0f} | {:.3g} | {:.0f} | {:.3g} | {}",
                       static_cast<double>(output.text.size()) / 1024, link, first * 1e3,
                       median(times) * 1e3, undecided);
}

} // namespace

int measure_frames(const FrameOptions &options) {
    auto context = gl::Context::make();
    if (const auto *why = std::get_if<std::string>(&context)) {
        std::fprintf(stderr, "fathom-bench: no GL: %s\n", why->c_str());
        return 3;
    }
    std::vector<std::string> files = options.files;
    if (files.empty())
        for (const auto &entry : std::filesystem::directory_iterator(FATHOM_SOURCE_DIR "/examples"))
            if (entry.path().extension() == ".sdf") files.push_back(entry.path().string());
    std::sort(files.begin(), files.end());
    std::printf("%s, %dx%d\n\n", std::get<gl::Context>(context).describe().c_str(), options.width,
                options.height);
    std::printf("| scene | shader, KB | link, s | first frame, ms | frame, ms | undecided rays |\n"
                "| --- | --- | --- | --- | --- | --- |\n");
    for (const std::string &file : files) {
        const std::string row = row_of(file, options);
        std::printf("| %s | %s |\n", std::filesystem::path(file).stem().c_str(), row.c_str());
        std::fflush(stdout);
    }
    return 0;
}

} // namespace fathom::bench
