#include "render-gl/render.h"

#include "render-gl/pruning.h"

#include <epoxy/gl.h>

#include <algorithm>
#include <fmt/format.h>

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
        glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
        complete_ = glGetError() == GL_NO_ERROR &&
                    glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
        glViewport(0, 0, width, height);
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

  private:
    GLuint texture_ = 0, framebuffer_ = 0;
    GLint before_ = 0;
    GLint viewport_[4]{};
    bool complete_ = false;
};

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
    const int width = request.width, height = request.height,
              samples = std::max(request.samples, 1);
    if (width <= 0 || height <= 0 || std::max(width, height) > largest_side()) return std::nullopt;
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    const Target target(width, height);
    if (!target.complete()) return std::nullopt;

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

    glDisable(GL_DEPTH_TEST);
    glClearColor(0, 0, 0, 0);
    glClear(GL_COLOR_BUFFER_BIT);
    glEnable(GL_BLEND); // samples are added up
    glBlendFunc(GL_ONE, GL_ONE);
    glEnable(GL_SCISSOR_TEST);
    const int rows = std::max((height + strips - 1) / strips, 8);
    bool stopped = false;
    for (int top = 0; top < height && !stopped; top += rows) {
        const int count = std::min(rows, height - top);
        glScissor(0, height - top - count, width, count);
        for (int k = 0; k < samples && !stopped; ++k) {
            inputs.offset = ir::sample_offset(k);
            program.draw(inputs, scene.params);
            glFinish(); // so that progress is true, and no strip waits behind many others
            const double done = (top + count * (k + 1.0) / samples) / height;
            stopped = request.progress && !request.progress(std::min(done, 1.0));
        }
    }
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    if (stopped || glGetError() != GL_NO_ERROR) return std::nullopt;

    Pixels pixels{width, height, {}};
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    std::vector<float> upward(row * static_cast<std::size_t>(height));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_FLOAT, upward.data());
    pixels.rgba.resize(upward.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        for (std::size_t x = 0; x < row; ++x)
            pixels.rgba[y * row + x] =
                upward[(static_cast<std::size_t>(height) - 1 - y) * row + x] /
                static_cast<float>(samples);
    return pixels;
}

std::optional<Picture> render(const ir::Scene &scene, const Request &request,
                              Diagnostics &diagnostics) {
    const glsl::Output output = glsl::emit(
        scene, {.target = glsl::Target::Glsl330, .buffers = true, .pruning = can_prune()},
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
