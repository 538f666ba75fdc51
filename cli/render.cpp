// fathom render: pictures without a window, by GL or by the CPU. Every picture is whole before its
// file appears.
#include "render-gl/render.h"
#include "backend-cpu/trace/march.h"
#include "base/picture.h"
#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/preview.h"
#include "driver/image.h"
#include "render-gl/cache_passes.h"
#include "render-gl/context.h"
#include "render-gl/pruning.h"

#include <fmt/format.h>

namespace fathom::cli {
namespace {

// What makes the pictures of one command: the program is built once, for however many frames.
struct Painter {
    std::optional<gl::Context> context; // none: the CPU
    std::optional<gl::Program> program;
    std::unique_ptr<gl::CachedView> cache; // with --cache, where it can be had
};

// A still picture is drawn through the cache until less than a twentieth of it misses, or a frame
// learnt less than a quarter of what was missing, or look-ups do not pay; what the last frame
// misses is computed. Where the first one, which computes all, wishes for more cells than pixels
// miss, few of them share any: learning them takes longer than computing this picture, so that was
// it.
constexpr int max_learning_frames = 6;

bool draw_still(gl::CachedView &view, const ir::Scene &scene, const gl::FrameInputs &inputs,
                const std::function<void(double)> &progress) {
    const auto pixels =
        static_cast<std::uint64_t>(inputs.width) * static_cast<std::uint64_t>(inputs.height);
    std::uint64_t before = 0;
    for (int frame = 0; frame < max_learning_frames; ++frame) {
        if (!view.draw(inputs, scene.params, {})) return false;
        const std::uint64_t misses = view.read_tally().misses;
        progress((frame + 1.0) / max_learning_frames);
        if (!view.looked_up() || 20 * misses <= pixels) break;
        const gl::CacheCounts counts = view.store().read_counts();
        const std::uint64_t cells =
            std::uint64_t{counts.inserted} + counts.crowded + std::uint64_t{counts.full};
        if (frame == 0 ? cells > misses : 4 * misses > 3 * before) break;
        before = misses;
    }
    return true;
}

std::string cached_share(const gl::CachedView &view) {
    const double all = static_cast<double>(view.width()) * view.height();
    const gl::CacheTally tally = view.read_tally();
    const double computed = static_cast<double>(tally.computed);
    if (!view.looked_up()) return "drawn exactly: cached values do not pay in this view";
    if (computed < all && tally.hits > 0)
        return fmt::format("{:.1f} % by cached values", 100 - 100 * computed / all);
    return tally.misses > 0 ? "drawn exactly: its pixels share too few cached values to learn them"
                            : "drawn exactly: cells are narrower than pixels";
}

std::optional<gl::Pixels> draw_cached(gl::CachedView &view, const ir::Scene &scene,
                                      const RenderCommand &command, double time,
                                      const std::function<void(double)> &progress,
                                      std::string &status) {
    gl::FrameInputs inputs;
    const double aspect = static_cast<double>(command.width) / command.height;
    inputs.view = ir::view_of(scene, time, aspect);
    inputs.sun = ir::lights_of(scene, time, inputs.view)[0].position;
    inputs.width = command.width;
    inputs.height = command.height;
    inputs.time = time;
    inputs.mode = gl::Mode::Linear;
    std::optional<gl::Pixels> sum;
    const int samples = std::max(command.samples, 1);
    for (int k = 0; k < samples; ++k) {
        inputs.offset = ir::sample_offset(k);
        const bool drawn = k == 0 && !command.frames ? draw_still(view, scene, inputs, progress)
                                                     : view.draw(inputs, scene.params, {});
        if (!drawn) return std::nullopt;
        gl::Pixels pixels = view.read_pixels();
        if (sum) {
            for (std::size_t i = 0; i < sum->rgba.size(); ++i) sum->rgba[i] += pixels.rgba[i];
            sum->undecided += pixels.undecided;
        } else {
            sum = std::move(pixels);
        }
    }
    for (float &value : sum->rgba) value /= static_cast<float>(samples);
    sum->rays = static_cast<std::uint64_t>(samples) * sum->rgba.size() / 4;
    status = cached_share(view);
    return sum;
}

// `out` with the frame's number in place of its `#`s, or before its extension where it has none.
std::string frame_name(const std::string &out, int frame) {
    std::size_t last = out.find_last_of('#');
    if (last != out.npos) {
        std::size_t before = out.find_last_not_of('#', last);
        std::size_t first = before == out.npos ? 0 : before + 1;
        return fmt::format("{}{:0{}}{}", out.substr(0, first), frame, last + 1 - first,
                           out.substr(last + 1));
    }
    std::filesystem::path path(out);
    path.replace_filename(
        fmt::format("{}_{:04}{}", path.stem().string(), frame, path.extension().string()));
    return path.string();
}

Exit prepare_gl(Painter &painter, const driver::Compilation &compilation,
                const RenderCommand &command, Terminal &terminal) {
    auto context = gl::Context::make();
    if (const std::string *why = std::get_if<std::string>(&context)) {
        if (command.backend == Backend::Auto) return done;
        terminal.say(fmt::format("fathom: no picture by GL: {}; --backend cpu needs none", *why));
        return device_error;
    }
    painter.context = std::move(std::get<gl::Context>(context));
    if (std::max(command.width, command.height) > gl::largest_side()) {
        if (command.backend == Backend::Auto) {
            painter.context.reset();
            return done;
        }
        terminal.say(fmt::format(
            "fathom: this GL draws at most {0}x{0} pixels; --backend cpu draws any size",
            gl::largest_side()));
        return device_error;
    }
    Diagnostics diagnostics;
    glsl::Options options;
    options.target = glsl::Target::Glsl330;
    options.passes = true;
    options.buffers = true;
    options.pruning = gl::can_prune();
    glsl::Output output = glsl::emit(compilation.scene, options, diagnostics);
    print_diagnostics(diagnostics, compilation.sources, terminal);
    if (diagnostics.has_errors()) return scene_error;
    auto program = gl::Program::build(output, compilation.scene);
    if (const auto *error = std::get_if<gl::ProgramError>(&program)) {
        Diagnostics refused;
        Diagnostic &diagnostic = refused.add(
            Code::ShaderInvalid, {}, "the graphics driver refuses the shader: " + error->message);
        if (error->line > 0)
            diagnostic.note(
                fmt::format("line {} of the shader: {}", error->line, error->source_line));
        print_diagnostics(refused, compilation.sources, terminal);
        return scene_error;
    }
    painter.program = std::move(std::get<gl::Program>(program));
    if (command.cache) {
        auto view = std::make_unique<gl::CachedView>();
        const std::string why = view->use(compilation.scene, gl::usual_cache_size, diagnostics);
        if (why.empty())
            painter.cache = std::move(view);
        else
            terminal.say(fmt::format("fathom: drawn exactly: {}", why));
    }
    return done;
}

// What is drawn so far, tile by tile: other threads draw into the rest of the picture meanwhile.
struct Preview {
    PreviewSize size;
    std::vector<std::uint8_t> rgba;
    void take(const cpu::Tile &tile, const cpu::Picture &from) {
        rgba.resize(from.rgba.size());
        for (int y = tile.y; y < tile.y + tile.height; ++y) {
            const std::ptrdiff_t first = 4 * (static_cast<std::ptrdiff_t>(y) * from.width + tile.x);
            std::copy_n(from.rgba.begin() + first, 4 * tile.width, rgba.begin() + first);
        }
    }
};

// A picture, and how many of its rays ended neither in a hit nor in a miss.
struct Painted {
    Picture picture;
    std::uint64_t rays = 0, undecided = 0, undecided_shadows = 0;
};

Painted painted(const gl::Pixels &pixels) {
    return {picture_of_linear(pixels.width, pixels.height, pixels.rgba), pixels.rays,
            pixels.undecided, pixels.undecided_shadows};
}

std::optional<Painted> paint(const Painter &painter, const ir::Scene &scene,
                             const RenderCommand &command, double time,
                             const std::function<void(double)> &progress, std::string &status,
                             Terminal &terminal) {
    if (painter.cache) {
        std::optional<gl::Pixels> pixels =
            draw_cached(*painter.cache, scene, command, time, progress, status);
        if (!pixels) return std::nullopt;
        return painted(*pixels);
    }
    if (painter.program) {
        gl::Request request;
        request.width = command.width;
        request.height = command.height;
        request.samples = command.samples;
        request.time = time;
        request.progress = [&](double share) { return progress(share), !Interrupts::noticed(); };
        std::optional<gl::Pixels> pixels =
            gl::draw(*painter.program, scene, request, gl::Mode::Linear);
        if (!pixels) return std::nullopt;
        return painted(*pixels);
    }
    double aspect = static_cast<double>(command.width) / command.height;
    cpu::Stage stage =
        cpu::prepare(scene, ir::view_of(scene, time, aspect), command.width, command.height, time);
    cpu::PictureOptions options;
    options.samples = command.samples;
    Preview preview;
    if (terminal.interactive()) preview.size = preview_size(command.width, command.height);
    cpu::Picture made = cpu::render(
        stage, options, [&](double share, const cpu::Tile &tile, const cpu::Picture &so_far) {
            if (preview.size.rows > 0) {
                preview.take(tile, so_far);
                terminal.preview(preview.size.rows, [&] {
                    return preview_lines(preview.rgba, so_far.width, so_far.height, preview.size);
                });
            }
            progress(share);
            return !Interrupts::noticed();
        });
    if (stage.pruning && made.work.near > 0)
        status = fmt::format("pruned: {:.0f} shapes to {:.0f} a cell", cpu::shapes_of(scene),
                             made.work.near_shapes / static_cast<double>(made.work.near));
    return Painted{{made.width, made.height, std::move(made.rgba)},
                   made.work.rays,
                   made.work.undecided,
                   made.work.undecided_shadows};
}

// Says what was left undecided. Whether that is an error.
bool is_undecided(const Painted &painted, const std::string &out, const RenderCommand &command,
                  Terminal &terminal) {
    if (painted.undecided + painted.undecided_shadows == 0) return false;
    std::string what;
    if (painted.undecided > 0)
        what = fmt::format("{} of {} rays stay undecided and show what they are nearest to",
                           painted.undecided, painted.rays);
    if (painted.undecided_shadows > 0)
        what += fmt::format("{}{} shadow rays stay undecided and darken by what they met so far",
                            what.empty() ? "" : "; ", painted.undecided_shadows);
    terminal.say(fmt::format("fathom: {}: {}; --max-steps N gives them more steps{}", out, what,
                             command.strict ? ". Nothing is written (--strict)" : ""));
    return command.strict;
}

std::string encoded(const Picture &picture, const std::string &out, int quality) {
    return picture_format(out) == PictureFormat::Jpeg
               ? driver::encode_jpeg(picture.width, picture.height, picture.rgba, quality)
               : encode_png(picture);
}

} // namespace

Exit run(const RenderCommand &command, Terminal &terminal) {
    const std::pair<int, int> frames = command.frames.value_or(std::pair(0, 1));
    const int first = frames.first, last = frames.second;
    const auto out_of = [&](int frame) {
        return command.frames ? frame_name(command.out, frame) : command.out;
    };
    if (overwrites(command.scene.file, out_of(first), terminal) ||
        misnamed(out_of(first), Content::Picture, terminal))
        return usage_error;
    for (int frame = first; frame < last; ++frame)
        if (unwritable(out_of(frame), terminal)) return device_error;
    const auto time_of = [&](int frame) {
        return command.time + (command.frames ? frame / command.frame_rate : 0);
    };
    driver::Compilation compilation = driver::compile_file(
        command.scene.file, compile_options(command.scene, time_of(first), time_of(last - 1)));
    Exit exit = report(compilation, command.scene, terminal);
    if (exit != done) return exit;
    if (command.max_steps > 0) compilation.scene.render.max_steps = command.max_steps;
    for (int frame = first; frame < last; ++frame)
        if (overwrites(compilation, out_of(frame), terminal)) return usage_error;
    if (!in_proved_time(compilation.scene, time_of(first), time_of(last - 1), terminal))
        return usage_error;
    Painter painter;
    if (command.backend != Backend::Cpu) exit = prepare_gl(painter, compilation, command, terminal);
    if (exit != done) return exit;

    const Interrupts interrupts;
    for (int frame = first; frame < last; ++frame) {
        const std::string out = out_of(frame);
        const double time = time_of(frame);
        std::string status; // what is worth knowing of how it was drawn
        std::optional<Painted> made = paint(
            painter, compilation.scene, command, time,
            [&](double share) { terminal.progress(out, (frame - first + share) / (last - first)); },
            status, terminal);
        if (Interrupts::noticed()) { // nothing of this picture is written
            terminal.finish_progress();
            terminal.flush();
            Interrupts::obey();
        }
        // `--cached` is answered by what became of it.
        if (!status.empty() && (terminal.interactive() || (command.cache && !command.frames)))
            terminal.say(out + ": " + status);
        if (!made) {
            terminal.say(fmt::format("fathom: there is no memory for a picture of {}x{}",
                                     command.width, command.height));
            return device_error;
        }
        if (is_undecided(*made, out, command, terminal)) return scene_error;
        exit = write_result(out, encoded(made->picture, out, command.quality), terminal);
        if (exit != done) return exit;
    }
    terminal.finish_progress();
    return done;
}

} // namespace fathom::cli
