#include "cli/painter.h"

#include "cli/interrupt.h"
#include "cli/outputs.h"
#include "cli/preview.h"

#include <algorithm>
#include <fmt/format.h>

namespace fathom::cli {
namespace {

// What is drawn so far, tile by tile: other threads draw into the rest of the picture meanwhile.
struct Preview {
    PreviewSize size;
    v1::Region region;
    std::vector<std::uint8_t> rgba;
    void take(const v1::Region &part, const std::vector<std::uint8_t> &from) {
        rgba.resize(from.size());
        for (int y = part.y; y < part.y + part.height; ++y) {
            const std::ptrdiff_t first =
                4 * (static_cast<std::ptrdiff_t>(y) * region.width + part.x);
            std::copy_n(from.begin() + first, 4 * part.width, rgba.begin() + first);
        }
    }
};

v1::PictureOptions options_of(const RenderCommand &command, const Moment &moment) {
    v1::PictureOptions options;
    options.width = command.width;
    options.height = command.height;
    options.time = moment.time;
    options.shutter = moment.open;
    options.turned = moment.turned;
    options.linear = picture_format(command.out) == PictureFormat::Exr;
    return options;
}

} // namespace

std::string_view maker_of(const v1::GlPainter &gl) {
    return gl.is_cached() ? "gl by cached values" : gl.is_open() ? "gl" : "cpu";
}

int samples_of(const RenderCommand &command) {
    return command.samples == 0 && is_sums_name(command.out) ? 1 : command.samples;
}

bool needs_cpu(const RenderCommand &command) {
    return command.region || command.tile || is_sums_name(command.out) || command.shutter > 0 ||
           command.alpha;
}

Exit begin(v1::GlPainter &gl, const RenderCommand &command, Terminal &terminal) {
    if (command.backend == Backend::Cpu || (command.backend == Backend::Auto && needs_cpu(command)))
        return done;
    if (const std::string why = gl.open(); !why.empty()) {
        if (command.backend == Backend::Auto) return done;
        terminal.say(fmt::format("fathom: no picture by GL: {}; --backend cpu needs none", why));
        return device_error;
    }
    if (command.backend == Backend::Auto && gl.is_software() && !command.cache) {
        gl = v1::GlPainter(); // the processor draws quicker by itself
        return done;
    }
    if (std::max(command.width, command.height) <= gl.largest_side()) return done;
    if (command.backend == Backend::Auto) {
        gl = v1::GlPainter();
        return done;
    }
    terminal.say(
        fmt::format("fathom: this GL draws at most {0}x{0} pixels; --backend cpu draws any size",
                    gl.largest_side()));
    return device_error;
}

Exit use(v1::GlPainter &gl, const v1::CompileResult &result, const RenderCommand &command,
         Terminal &terminal) {
    if (!gl.is_open()) return done;
    v1::GlOptions options;
    options.max_steps = command.max_steps;
    options.noise_cache = command.cache;
    options.still = command.frames.numbers.empty();
    const std::vector<v1::Diagnostic> said = gl.use(*result.scene, options);
    print_diagnostics(said, 0, result.texts, terminal);
    if (has_errors(said)) return scene_error;
    if (const std::string why = gl.exact_because(); !why.empty())
        terminal.say(fmt::format("fathom: drawn exactly: {}", why));
    return done;
}

v1::Picture paint(v1::GlPainter &gl, const v1::Scene &scene, const RenderCommand &command,
                  const v1::Region &region, bool sums, const Moment &moment,
                  const std::function<void(double)> &progress, Terminal &terminal) {
    v1::PictureOptions options = options_of(command, moment);
    options.progress = [&](double share) { return progress(share), !Interrupts::noticed(); };
    if (gl.is_open()) {
        options.samples = command.samples;
        return gl.draw(options);
    }
    options.samples = samples_of(command);
    options.first_sample = command.first_sample;
    options.region = region;
    options.sums = sums;
    options.alpha = command.alpha;
    options.max_steps = command.max_steps;
    options.threads = static_cast<unsigned>(command.jobs);
    Preview preview;
    if (terminal.interactive() && command.progress == ProgressFormat::Bar)
        preview = {preview_size(region.width, region.height), region, {}};
    if (preview.size.rows > 0)
        options.drawn = [&](const v1::Region &part, const std::vector<std::uint8_t> &rgba) {
            preview.take(part, rgba);
            terminal.preview(preview.size.rows, [&] {
                return preview_lines(preview.rgba, region.width, region.height, preview.size);
            });
        };
    return v1::draw(scene, options);
}

} // namespace fathom::cli
