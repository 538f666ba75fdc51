#include "render-gl/render.h"

#include "ir/shading.h"
#include "render-gl/pruning.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <span>

namespace fathom::gl {

namespace {

constexpr int strips = 32; // a picture; between two of them `progress` is called

// A float texture to draw into, and what was bound before.
class Target {
  public:
    Target(int width, int height) {
        glGetIntegerv(GL_FRAMEBUFFER_BINDING, &before_);
        glGetIntegerv(GL_VIEWPORT, viewport_);
        glGenTextures(1, &texture_);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA32F, width, height, 0, GL_RGBA, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glGenFramebuffers(1, &framebuffer_);
        bind();
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
        complete_ = glGetError() == GL_NO_ERROR &&
                    glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    }
    ~Target() {
        glBindFramebuffer(GL_FRAMEBUFFER, static_cast<GLuint>(before_));
        glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
        glDeleteFramebuffers(1, &framebuffer_);
        glDeleteTextures(1, &texture_);
    }
    Target(const Target &) = delete;
    Target &operator=(const Target &) = delete;
    bool complete() const { return complete_; }
    void bind() const { glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_); }
    GLuint texture() const { return texture_; }

  private:
    GLuint texture_ = 0, framebuffer_ = 0;
    GLint before_ = 0;
    GLint viewport_[4]{};
    bool complete_ = false;
};

// One sample of a strip, whose lowest row is the picture's `bottom`. False: no memory.
// `only`: the pixels of it that are drawn, where the program draws by passes; all without.
bool draw_sample(const Program &program, const ir::Scene &scene, const Target &target,
                 Passes &passes, FrameInputs inputs, int rows, int turns,
                 std::span<const std::uint8_t> only) {
    const auto once = [&](const Pass &pass) {
        inputs.pass = pass;
        glViewport(0, 0, inputs.width, rows);
        glScissor(0, 0, inputs.width, rows);
        glEnable(GL_SCISSOR_TEST);
        glEnablei(GL_BLEND, 0); // samples are added up
        glBlendFunc(GL_ONE, GL_ONE);
        program.draw(inputs, scene.params);
    };
    if (!program.by_passes()) {
        target.bind();
        once({});
        return true;
    }
    passes.begin(program, 0, rows, turns, only);
    while (!passes.done())
        if (!passes.draw(program, once)) return false;
    return true;
}

} // namespace

void finish() { glFinish(); }

int largest_side() {
    GLint texture = 0, viewport[2] = {0, 0};
    glGetIntegerv(GL_MAX_TEXTURE_SIZE, &texture);
    glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport);
    return std::min({texture, viewport[0], viewport[1]});
}

std::optional<Pixels> draw(const Program &program, const ir::Scene &scene, const Request &request,
                           Mode mode) {
    const int width = request.width, height = request.height;
    const bool smooth = request.samples == 0 && mode == Mode::Linear;
    if (width <= 0 || height <= 0 || std::max(width, height) > largest_side()) return std::nullopt;
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    // What passes keep of their rays is as large as what is drawn at once: a strip.
    const int rows = std::min(std::max((height + strips - 1) / strips, 8), height);
    const Target target(width, rows);
    if (!target.complete()) return std::nullopt;
    Passes passes;
    if (program.by_passes() && !passes.use({target.texture(), 0, width, rows})) return std::nullopt;

    FrameInputs inputs;
    inputs.view = request.view
                      ? *request.view
                      : ir::view_of(scene, request.time, static_cast<double>(width) / height);
    inputs.sun =
        ir::lights_of(scene, request.time,
                      ir::view_of(scene, request.time, static_cast<double>(width) / height))[0]
            .position;
    inputs.width = width;
    inputs.height = height;
    inputs.time = request.time;
    inputs.mode = mode;

    Pixels pixels{width, height, {}};
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    pixels.rgba.resize(row * static_cast<std::size_t>(height));
    std::vector<float> upward(row * static_cast<std::size_t>(rows));
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    bool stopped = false, good = true;
    // Draws samples `first` to `last` strip by strip, of the pixels in `only` (rows from the top) or
    // of all, while progress goes from `begin` to `end`; `take` gets each pixel's sum.
    const auto draw_samples = [&](int first, int last, std::span<const std::uint8_t> only,
                                  double begin, double end, const auto &take) {
        std::vector<std::uint8_t> marked;
        for (int top = 0; top < height && !stopped && good; top += rows) {
            const int count = std::min(rows, height - top), bottom = height - top - count;
            const auto pixel = [&](int y, int x) {
                return static_cast<std::size_t>(top + y) * static_cast<std::size_t>(width) +
                       static_cast<std::size_t>(x);
            };
            if (!only.empty()) {
                marked.clear();
                for (int y = count - 1; y >= 0; --y)
                    for (int x = 0; x < width; ++x) marked.push_back(only[pixel(y, x)] ? 255 : 0);
                if (std::ranges::find(marked, 255) == marked.end()) continue;
            }
            target.bind();
            glDisable(GL_SCISSOR_TEST);
            glClearColor(0, 0, 0, 0);
            glClear(GL_COLOR_BUFFER_BIT);
            for (int k = first; k < last && !stopped && good; ++k) {
                const std::array<double, 2> offset = ir::sample_offset(k);
                inputs.offset = {offset[0], offset[1] - bottom};
                good = draw_sample(program, scene, target, passes, inputs, count, request.turns,
                                   marked);
                glFinish(); // so that progress is true, and no strip waits behind many others
                const double done = (top + count * (k - first + 1.0) / (last - first)) / height;
                stopped = request.progress &&
                          !request.progress(begin + std::min(done, 1.0) * (end - begin));
            }
            target.bind();
            glReadPixels(0, 0, width, count, GL_RGBA, GL_FLOAT, upward.data());
            for (int y = 0; y < count; ++y)
                for (int x = 0; x < width; ++x)
                    take(pixel(y, x), upward.data() +
                                          row * static_cast<std::size_t>(count - 1 - y) +
                                          4 * static_cast<std::size_t>(x));
        }
    };
    const int samples = std::max(request.samples, 1);
    std::vector<std::uint8_t> close(smooth ? pixels.rgba.size() / 4 : 0);
    draw_samples(0, samples, {}, 0, smooth ? 0.5 : 1, [&](std::size_t pixel, const float *sum) {
        if (smooth) close[pixel] = sum[3] > 0.75f && sum[3] < 1;
        for (std::size_t c = 0; c < 4; ++c)
            pixels.rgba[4 * pixel + c] = sum[c] / static_cast<float>(samples);
        if (mode == Mode::Linear && pixels.rgba[4 * pixel + 3] > 0.75f) // some ray was close
            pixels.rgba[4 * pixel + 3] = 1;
        pixels.rays += static_cast<std::uint64_t>(samples);
    });
    if (smooth && !stopped && good) {
        std::vector<std::uint8_t> rough = rough_pixels(width, height, pixels.rgba);
        for (std::size_t i = 0; i < rough.size(); ++i) rough[i] |= close[i];
        constexpr int most = ir::shading::rough_samples;
        draw_samples(1, most, rough, 0.5, 1, [&](std::size_t pixel, const float *sum) {
            if (!rough[pixel]) return;
            for (std::size_t c = 0; c < 3; ++c)
                pixels.rgba[4 * pixel + c] = (pixels.rgba[4 * pixel + c] + sum[c]) / most;
            pixels.rays += most - 1;
        });
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    if (stopped || !good || glGetError() != GL_NO_ERROR) return std::nullopt;
    pixels.undecided = passes.undecided().rays;
    pixels.undecided_shadows = passes.undecided().shadows;
    pixels.passed = passes.undecided().passed;
    return pixels;
}

std::optional<Picture> render(const ir::Scene &scene, const Request &request,
                              Diagnostics &diagnostics) {
    const glsl::Output output = glsl::emit(
        scene,
        {.target = glsl::Target::Glsl330, .buffers = true, .pruning = can_prune(), .passes = true},
        diagnostics);
    if (output.text.empty()) return std::nullopt;
    const auto built = Program::build(output, scene);
    if (const auto *error = std::get_if<ProgramError>(&built)) {
        Diagnostic &d = diagnostics.add(
            Code::ShaderInvalid, {}, "the graphics driver refuses the shader: " + error->message);
        if (error->line > 0)
            d.note(fmt::format("line {} of the shader: {}", error->line, error->source_line));
        return std::nullopt;
    }
    const auto pixels = draw(std::get<Program>(built), scene, request, Mode::Linear);
    if (!pixels) return std::nullopt;
    return picture_of_linear(pixels->width, pixels->height, pixels->rgba);
}

} // namespace fathom::gl
