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

// A sample of a pixel beside its first one.
struct Further {
    std::size_t pixel;
    int sample, samples; // which, of how many
};

// Of linear RGBA, rows from the top, by pixel. Those in `close` are of things that lie close to a ray.
std::vector<Further> further_samples(int width, int height, std::span<const float> rgba,
                                     std::span<const std::uint8_t> close) {
    const std::vector<std::uint8_t> rough = rough_pixels(width, height, rgba);
    std::vector<Further> out;
    for (std::size_t i = 0; i < rough.size(); ++i) {
        const int samples =
            ir::shading::rough_samples[std::max<std::size_t>(close[i] ? 2 : 0, rough[i])];
        for (int k = 1; k < samples; ++k) out.push_back({i, k, samples});
    }
    return out;
}

// Where samples are seen, packed row by row: drivers shade pixels in groups, and those of a group
// that nothing is wanted of take as long.
class PlacesTexture {
  public:
    PlacesTexture(int width, int height) : width_(width) {
        glGenTextures(1, &texture_);
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glTexImage2D(GL_TEXTURE_2D, 0, GL_RG32F, width, height, 0, GL_RG, GL_FLOAT, nullptr);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
        glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    }
    ~PlacesTexture() { glDeleteTextures(1, &texture_); }
    PlacesTexture(const PlacesTexture &) = delete;
    PlacesTexture &operator=(const PlacesTexture &) = delete;
    GLuint texture() const { return texture_; }

    // At most as many as it holds, of a picture as wide as it is. How many rows they take.
    int fill(std::span<const Further> samples) const {
        const auto width = static_cast<std::size_t>(width_);
        const std::size_t rows = (samples.size() + width - 1) / width;
        std::vector<float> places(2 * rows * width, 0.0f);
        for (std::size_t i = 0; i < samples.size(); ++i) {
            const std::array<double, 2> offset = ir::sample_offset(samples[i].sample);
            places[2 * i] =
                static_cast<float>(samples[i].pixel % width) + static_cast<float>(offset[0]);
            places[2 * i + 1] =
                static_cast<float>(samples[i].pixel / width) + static_cast<float>(offset[1]);
        }
        glActiveTexture(GL_TEXTURE0);
        glBindTexture(GL_TEXTURE_2D, texture_);
        glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, width_, static_cast<GLsizei>(rows), GL_RG, GL_FLOAT,
                        places.data());
        return static_cast<int>(rows);
    }

  private:
    int width_;
    GLuint texture_ = 0;
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
    const auto went = [&](double progress) {
        stopped = request.progress && !request.progress(progress);
    };
    const auto clear = [&] {
        target.bind();
        glDisable(GL_SCISSOR_TEST);
        glClearColor(0, 0, 0, 0);
        glClear(GL_COLOR_BUFFER_BIT);
    };
    const auto read = [&](int count) {
        target.bind();
        glReadPixels(0, 0, width, count, GL_RGBA, GL_FLOAT, upward.data());
    };
    const int samples = std::max(request.samples, 1);
    const double first_part = smooth ? 0.5 : 1; // of the progress
    std::vector<std::uint8_t> close(smooth ? pixels.rgba.size() / 4 : 0);
    for (int top = 0; top < height && !stopped && good; top += rows) {
        const int count = std::min(rows, height - top), bottom = height - top - count;
        clear();
        for (int k = 0; k < samples && !stopped && good; ++k) {
            const std::array<double, 2> offset = ir::sample_offset(k);
            inputs.offset = {offset[0], offset[1] - bottom};
            good = draw_sample(program, scene, target, passes, inputs, count, request.turns, {});
            glFinish(); // so that progress is true, and no strip waits behind many others
            went(first_part * std::min((top + count * (k + 1.0) / samples) / height, 1.0));
        }
        read(count);
        for (int y = 0; y < count; ++y)
            for (int x = 0; x < width; ++x) {
                const float *sum = upward.data() + row * static_cast<std::size_t>(count - 1 - y) +
                                   4 * static_cast<std::size_t>(x);
                const std::size_t pixel =
                    static_cast<std::size_t>(top + y) * static_cast<std::size_t>(width) +
                    static_cast<std::size_t>(x);
                if (smooth) close[pixel] = sum[3] > 0.75f && sum[3] < 1;
                float *rgba = pixels.rgba.data() + 4 * pixel;
                for (std::size_t c = 0; c < 4; ++c) rgba[c] = sum[c] / static_cast<float>(samples);
                if (mode == Mode::Linear && rgba[3] > 0.75f) rgba[3] = 1; // some ray was close
                pixels.rays += static_cast<std::uint64_t>(samples);
            }
    }
    if (smooth && !stopped && good) {
        const std::vector<Further> further = further_samples(width, height, pixels.rgba, close);
        const PlacesTexture places(width, rows);
        const std::size_t most = static_cast<std::size_t>(width) * static_cast<std::size_t>(rows);
        for (std::size_t i = 0; i < further.size() && !stopped && good; i += most) {
            const std::span<const Further> now =
                std::span(further).subspan(i, std::min(most, further.size() - i));
            const int count = places.fill(now);
            std::vector<std::uint8_t> marked(row / 4 * static_cast<std::size_t>(count), 0);
            std::fill_n(marked.begin(), now.size(), std::uint8_t{255});
            inputs.places = places.texture();
            clear();
            good =
                draw_sample(program, scene, target, passes, inputs, count, request.turns, marked);
            read(count);
            for (std::size_t k = 0; k < now.size(); ++k)
                for (std::size_t c = 0; c < 3; ++c)
                    pixels.rgba[4 * now[k].pixel + c] += upward[4 * k + c];
            went(0.5 +
                 0.5 * static_cast<double>(i + now.size()) / static_cast<double>(further.size()));
        }
        for (const Further &one : further)
            if (one.sample + 1 == one.samples)
                for (std::size_t c = 0; c < 3; ++c)
                    pixels.rgba[4 * one.pixel + c] /= static_cast<float>(one.samples);
        pixels.rays += further.size();
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
