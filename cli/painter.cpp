#include "cli/painter.h"

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/preview.h"
#include "render-gl/pruning.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

// The scene's own view, gone around what it looks at, about the vertical.
ir::View view_of(const ir::Scene &scene, const Moment &moment, double aspect) {
    ir::View view = ir::view_of(scene, moment.time, aspect);
    if (moment.turned == 0) return view;
    const double c = std::cos(moment.turned), s = std::sin(moment.turned);
    const auto turned = [&](const glm::dvec3 &v) {
        return glm::dvec3{c * v.x + s * v.z, v.y, c * v.z - s * v.x};
    };
    const glm::dvec3 target = view.origin + view.focus * view.forward;
    view.origin = target + turned(view.origin - target);
    view.right = turned(view.right);
    view.up = turned(view.up);
    view.forward = turned(view.forward);
    return view;
}

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
                                      const RenderCommand &command, const Moment &moment,
                                      const std::function<void(double)> &progress,
                                      std::string &status) {
    gl::FrameInputs inputs;
    const double aspect = static_cast<double>(command.width) / command.height;
    inputs.view = view_of(scene, moment, aspect);
    inputs.sun =
        ir::lights_of(scene, moment.time, ir::view_of(scene, moment.time, aspect))[0].position;
    inputs.width = command.width;
    inputs.height = command.height;
    inputs.time = moment.time;
    inputs.mode = gl::Mode::Linear;
    std::optional<gl::Pixels> sum;
    const int samples = std::max(command.samples, 1);
    for (int k = 0; k < samples; ++k) {
        inputs.offset = ir::sample_offset(k);
        const bool drawn = k == 0 && command.frames.numbers.empty()
                               ? draw_still(view, scene, inputs, progress)
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

Painted painted(gl::Pixels pixels) {
    Painted made{picture_of_linear(pixels.width, pixels.height, pixels.rgba),
                 {},
                 std::move(pixels.rgba),
                 pixels.rays,
                 pixels.undecided,
                 pixels.undecided_shadows};
    for (std::size_t i = 3; i < made.linear.size(); i += 4) made.linear[i] = 1; // it is opaque
    return made;
}

// The picture by the CPU, of one moment: `samples` of them from `first` on.
std::optional<cpu::Picture> trace(const ir::Scene &scene, const RenderCommand &command,
                                  const Moment &moment, double time, cpu::PictureOptions options,
                                  const std::function<void(double)> &progress, std::string &status,
                                  Terminal &terminal) {
    const double aspect = static_cast<double>(command.width) / command.height;
    Moment now = moment;
    now.time = time;
    cpu::Stage stage =
        cpu::prepare(scene, view_of(scene, now, aspect), command.width, command.height, time);
    // As by GL: a light that the scene leaves to the view stays where it is as the camera turns.
    stage.lights = ir::lights_of(scene, time, ir::view_of(scene, time, aspect));
    Preview preview;
    if (terminal.interactive() && command.progress == ProgressFormat::Bar)
        preview.size = preview_size(options.region->width, options.region->height);
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
    if (!made.complete) return std::nullopt;
    if (stage.pruning && made.work.near > 0)
        status = fmt::format("pruned: {:.0f} shapes to {:.0f} a cell", cpu::shapes_of(scene),
                             made.work.near_shapes / static_cast<double>(made.work.near));
    return made;
}

Painted painted(cpu::Picture made) {
    return {{made.width, made.height, std::move(made.rgba)},
            std::move(made.sums),
            std::move(made.linear),
            made.work.rays,
            made.work.undecided,
            made.work.undecided_shadows};
}

// With an open shutter each sample has a moment of its own.
std::optional<Painted> trace_open(const ir::Scene &scene, const RenderCommand &command,
                                  const Moment &moment, cpu::PictureOptions options,
                                  const std::function<void(double)> &progress, std::string &status,
                                  Terminal &terminal) {
    const int first = options.first_sample, samples = options.samples;
    options.samples = 1;
    options.sums = options.linear = true;
    std::optional<Painted> sum;
    for (int k = 0; k < samples; ++k) {
        options.first_sample = first + k;
        std::optional<cpu::Picture> made = trace(
            scene, command, moment, time_of_sample(moment, first + k), options,
            [&](double share) { progress((k + share) / samples); }, status, terminal);
        if (!made) return std::nullopt;
        Painted one = painted(std::move(*made));
        if (sum) {
            for (std::size_t i = 0; i < one.sums.size(); ++i) sum->sums[i] += one.sums[i];
            for (std::size_t i = 3; i < one.linear.size(); i += 4) sum->linear[i] += one.linear[i];
            sum->rays += one.rays;
            sum->undecided += one.undecided;
            sum->undecided_shadows += one.undecided_shadows;
        } else {
            sum = std::move(one);
        }
    }
    for (std::size_t i = 0; 4 * i < sum->linear.size(); ++i) {
        for (std::size_t c = 0; c < 3; ++c)
            sum->linear[4 * i + c] = static_cast<float>(sum->sums[3 * i + c] / samples);
        sum->linear[4 * i + 3] /= static_cast<float>(samples);
    }
    const auto row = 4 * static_cast<std::size_t>(sum->picture.width);
    for (int y = 0; y < sum->picture.height; ++y) {
        const std::size_t first = row * static_cast<std::size_t>(y);
        cpu::encode_linear(std::span(sum->linear).subspan(first, row), options.region->x,
                           options.region->y + y, std::span(sum->picture.rgba).subspan(first, row));
    }
    return sum;
}

} // namespace

std::string_view maker_of(const Painter &painter) {
    return painter.cache ? "gl by cached values" : painter.program ? "gl" : "cpu";
}

int samples_of(const RenderCommand &command) {
    return command.samples == 0 && is_sums_name(command.out) ? 1 : command.samples;
}

bool needs_cpu(const RenderCommand &command) {
    return command.region || command.tile || is_sums_name(command.out) || command.shutter > 0 ||
           command.alpha;
}

Exit begin(Painter &painter, const RenderCommand &command, Terminal &terminal) {
    if (command.backend == Backend::Cpu || (command.backend == Backend::Auto && needs_cpu(command)))
        return done;
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
    return done;
}

Exit build(Painter &painter, const driver::Compilation &compilation, const RenderCommand &command,
           Terminal &terminal) {
    if (!painter.context) return done;
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

std::optional<Painted> paint(const Painter &painter, const ir::Scene &scene,
                             const RenderCommand &command, const cpu::Tile &region, bool sums,
                             const Moment &moment, const std::function<void(double)> &progress,
                             std::string &status, Terminal &terminal) {
    if (painter.cache) {
        std::optional<gl::Pixels> pixels =
            draw_cached(*painter.cache, scene, command, moment, progress, status);
        if (!pixels) return std::nullopt;
        return painted(std::move(*pixels));
    }
    if (painter.program) {
        gl::Request request;
        request.width = command.width;
        request.height = command.height;
        request.samples = command.samples;
        request.time = moment.time;
        request.view = view_of(scene, moment, static_cast<double>(command.width) / command.height);
        request.progress = [&](double share) { return progress(share), !Interrupts::noticed(); };
        std::optional<gl::Pixels> pixels =
            gl::draw(*painter.program, scene, request, gl::Mode::Linear);
        if (!pixels) return std::nullopt;
        return painted(std::move(*pixels));
    }
    cpu::PictureOptions options;
    options.alpha = command.alpha;
    options.linear = picture_format(command.out) == PictureFormat::Exr;
    options.first_sample = command.first_sample;
    options.samples = samples_of(command);
    options.region = region;
    options.sums = sums;
    options.jobs = static_cast<unsigned>(command.jobs);
    if (moment.open > 0)
        return trace_open(scene, command, moment, options, progress, status, terminal);
    std::optional<cpu::Picture> made =
        trace(scene, command, moment, moment.time, options, progress, status, terminal);
    if (!made) return std::nullopt;
    return painted(std::move(*made));
}

} // namespace fathom::cli
