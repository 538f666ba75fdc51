#include "render-gl/canvas.h"

#include "render-gl/framebuffer.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace fathom::gl {

namespace {

// A texture of that size and format in a framebuffer's attachment.
void attach(GLuint &texture, GLint format, int width, int height, GLuint framebuffer,
            GLenum attachment) {
    if (!texture) glGenTextures(1, &texture);
    const bool bytes = format == GL_RGBA8;
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, GL_RGBA,
                 bytes ? GL_UNSIGNED_BYTE : GL_FLOAT, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, texture, 0);
}

template <class T> std::vector<T> upside_down(const std::vector<T> &rows, int width, int height) {
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    std::vector<T> result(rows.size());
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        std::copy_n(rows.begin() + static_cast<std::ptrdiff_t>(
                                       (static_cast<std::size_t>(height) - 1 - y) * row),
                    row, result.begin() + static_cast<std::ptrdiff_t>(y * row));
    return result;
}

Picture read_bytes(GLuint framebuffer, int width, int height) {
    std::vector<std::uint8_t> upward(static_cast<std::size_t>(width) *
                                     static_cast<std::size_t>(height) * 4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    Picture picture{width, height, upside_down(upward, width, height)};
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4)
        picture.rgba[i] = 255; // a window has no holes
    return picture;
}

} // namespace

std::string lost_context() {
    // Where the window was made without robustness the driver says nothing, and then ends the
    // program itself.
    if (epoxy_gl_version() < 45 && !epoxy_has_gl_extension("GL_ARB_robustness")) return "";
    const GLenum status =
        epoxy_gl_version() >= 45 ? glGetGraphicsResetStatus() : glGetGraphicsResetStatusARB();
    switch (status) {
    case GL_NO_ERROR: return "";
    case GL_GUILTY_CONTEXT_RESET:
        return "the graphics driver gave up on this scene's shader and lost the window";
    default: return "the graphics driver was reset and lost the window";
    }
}

Canvas::~Canvas() {
    for (GLuint framebuffer : {framebuffer_, picks_framebuffer_, probe_framebuffer_,
                               shown_framebuffer_, before_framebuffer_})
        if (framebuffer) glDeleteFramebuffers(1, &framebuffer);
    for (GLuint texture : {sum_, picks_, probe_, shown_, before_})
        if (texture) glDeleteTextures(1, &texture);
}

bool Canvas::resize(int width, int height) {
    if (width == width_ && height == height_) return true;
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    for (GLuint *framebuffer :
         {&framebuffer_, &picks_framebuffer_, &probe_framebuffer_, &shown_framebuffer_})
        if (!*framebuffer) glGenFramebuffers(1, framebuffer);
    attach(sum_, GL_RGBA32F, width, height, framebuffer_, GL_COLOR_ATTACHMENT0);
    attach(picks_, GL_RGBA32F, width, height, framebuffer_, GL_COLOR_ATTACHMENT1);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    bool good = complete();
    attach(picks_, GL_RGBA32F, width, height, picks_framebuffer_, GL_COLOR_ATTACHMENT0);
    good &= complete();
    good &= glGetError() == GL_NO_ERROR;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    probed_ = begun_ = false;
    samples_ = 0;
    width_ = good ? width : 0;
    height_ = good ? height : 0;
    return good;
}

// A view's shader counts places from the top left of its own tile: its offset takes away where the
// tile lies.
void Canvas::draw_views(const Program &program, std::span<const TileView> views,
                        const std::vector<ir::Param> &params, int sample, bool linear, int row,
                        int rows, const Pass &pass) {
    glEnable(GL_SCISSOR_TEST);
    for (const TileView &view : views) {
        const Tile &tile = view.tile;
        const int bottom = height_ - tile.y - tile.height;
        glViewport(tile.x, bottom, tile.width, tile.height);
        const int first = std::max(tile.y, row), last = std::min(tile.y + tile.height, row + rows);
        if (first >= last) continue;
        glScissor(tile.x, height_ - last, tile.width, last - first);
        FrameInputs inputs = view.inputs;
        inputs.width = tile.width;
        inputs.height = tile.height;
        const std::array<double, 2> offset = ir::sample_offset(sample);
        inputs.offset = {offset[0] - tile.x, offset[1] + bottom};
        if (linear) inputs.mode = Mode::Linear;
        inputs.pass = pass;
        program.draw(inputs, params);
    }
    glDisable(GL_SCISSOR_TEST);
    glFinish();
}

bool Canvas::draw_passes(const Program &program, std::span<const TileView> views,
                         const std::vector<ir::Param> &params, int sample, int row, int rows,
                         const std::function<bool()> &patient) {
    if (!passes_.use({sum_, picks_, width_, height_})) return false;
    if (!begun_) {
        if (sample == 0 && row == 0) passes_.forget();
        passes_.begin(program, height_ - row - rows, rows, turns_);
    }
    begun_ = true;
    do {
        const bool good = passes_.draw(program, [&](const Pass &pass) {
            if (sample > 0) { // colours add up; what a pixel shows is told by its first sample
                glEnablei(GL_BLEND, 0);
                glBlendFunc(GL_ONE, GL_ONE);
                glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
            }
            draw_views(program, views, params, sample, true, row, rows, pass);
            glDisablei(GL_BLEND, 0);
            glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        });
        if (!good) {
            begun_ = false;
            return false;
        }
    } while (!passes_.done() && (!patient || patient()));
    begun_ = !passes_.done();
    return true;
}

bool Canvas::draw(const Program &program, int width, int height, std::span<const TileView> views,
                  const std::vector<ir::Param> &params, int sample, int row, int rows,
                  const std::function<bool()> &patient) {
    rows = std::min(rows, height - row);
    if (!resize(width, height)) return false;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_BLEND);
    if (sample == 0 && row == 0 && !begun_) {
        samples_ = 0;
        const float background[] = {0.01f, 0.01f, 0.01f, 1}, nothing[] = {0, -1, 0, 0};
        glClearBufferfv(GL_COLOR, 0, background);
        glClearBufferfv(GL_COLOR, 1, nothing);
    }
    if (program.by_passes()) {
        const bool good = draw_passes(program, views, params, sample, row, rows, patient);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
        if (!good || begun_) return good;
    } else {
        if (sample > 0) { // colours add up; what a pixel shows is told by its first sample
            glEnablei(GL_BLEND, 0);
            glBlendFunc(GL_ONE, GL_ONE);
            glColorMaski(1, GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
        }
        draw_views(program, views, params, sample, true, row, rows, {});
        glDisablei(GL_BLEND, 0);
        glColorMaski(1, GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
        glBindFramebuffer(GL_FRAMEBUFFER, 0);
    }
    if (row + rows >= height_) samples_ = sample + 1;
    return true;
}

bool Canvas::take(unsigned framebuffer, int width, int height) {
    if (!resize(width, height)) return false;
    glDisable(GL_SCISSOR_TEST);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer_);
    for (GLenum attachment : {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1}) {
        const GLenum targets[] = {
            static_cast<GLenum>(attachment == GL_COLOR_ATTACHMENT0 ? attachment : GL_NONE),
            static_cast<GLenum>(attachment == GL_COLOR_ATTACHMENT1 ? attachment : GL_NONE)};
        glReadBuffer(attachment);
        glDrawBuffers(2, targets);
        glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT,
                          GL_NEAREST);
    }
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    const GLenum both[] = {GL_COLOR_ATTACHMENT0, GL_COLOR_ATTACHMENT1};
    glDrawBuffers(2, both);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    samples_ = 1;
    return true;
}

void Canvas::keep_before() {
    if (empty()) return;
    if (!before_framebuffer_) glGenFramebuffers(1, &before_framebuffer_);
    attach(before_, GL_RGBA8, shown_width_, shown_height_, before_framebuffer_,
           GL_COLOR_ATTACHMENT0);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, before_framebuffer_);
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(0, 0, shown_width_, shown_height_, 0, 0, shown_width_, shown_height_,
                      GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (fade_) return;
    glsl::Output text;
    text.text = R"(#version 330 core
uniform sampler2D before;
uniform vec2 size;
uniform float share;
out vec4 color;
void main() {
    color = vec4(texture(before, gl_FragCoord.xy / size).rgb, share);
}
)";
    auto built = Program::build(text, {});
    if (Program *program = std::get_if<Program>(&built)) fade_ = std::move(*program);
}

bool Canvas::probe(const Program &program, std::span<const TileView> views,
                   const std::vector<ir::Param> &params) {
    if (!probed_) {
        while (glGetError() != GL_NO_ERROR) {
        }
        attach(probe_, GL_RGBA32F, width_, height_, probe_framebuffer_, GL_COLOR_ATTACHMENT1);
        const GLenum second[] = {GL_NONE, GL_COLOR_ATTACHMENT1};
        glDrawBuffers(2, second);
        glReadBuffer(GL_COLOR_ATTACHMENT1);
        probed_ = complete() && glGetError() == GL_NO_ERROR;
        if (!probed_) return false;
    }
    glBindFramebuffer(GL_FRAMEBUFFER, probe_framebuffer_);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_CULL_FACE);
    const float nothing[] = {0, 0, 0, 0};
    glClearBufferfv(GL_COLOR, 1, nothing);
    draw_views(program, views, params, 0, false, 0, height_, {});
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    return true;
}

void Canvas::finish(const PostSettings &settings) {
    if (samples_ == 0) return;
    if (shown_width_ != width_ || shown_height_ != height_) {
        attach(shown_, GL_RGBA8, width_, height_, shown_framebuffer_, GL_COLOR_ATTACHMENT0);
        const bool good = complete();
        shown_width_ = good ? width_ : 0;
        shown_height_ = good ? height_ : 0;
        if (!good) return;
    }
    post_.run(settings, sum_, samples_, picks_, probed_ ? probe_ : 0, shown_framebuffer_, width_,
              height_);
}

Pick Canvas::pick(int x, int y) const {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) return {};
    std::array<float, 4> value{};
    glBindFramebuffer(GL_READ_FRAMEBUFFER, picks_framebuffer_);
    glReadPixels(x, height_ - 1 - y, 1, 1, GL_RGBA, GL_FLOAT, value.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return {static_cast<int>(value[0]), value[1], value[2], value[3]};
}

std::vector<float> Canvas::read(unsigned framebuffer) const {
    std::vector<float> upward(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_) *
                              4);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glReadPixels(0, 0, width_, height_, GL_RGBA, GL_FLOAT, upward.data());
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    return upside_down(upward, width_, height_);
}

Picture Canvas::read_picture() const {
    return read_bytes(shown_framebuffer_, shown_width_, shown_height_);
}

void Canvas::show(int window_width, int window_height, double before, unsigned into) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, shown_framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, into);
    glDisable(GL_SCISSOR_TEST);
    bool same = shown_width_ == window_width && shown_height_ == window_height;
    glBlitFramebuffer(0, 0, shown_width_, shown_height_, 0, 0, window_width, window_height,
                      GL_COLOR_BUFFER_BIT, same ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, into);
    if (before <= 0 || !before_ || !fade_) return;
    glViewport(0, 0, window_width, window_height);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_CULL_FACE);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    fade_->use();
    glUniform1i(glGetUniformLocation(fade_->name(), "before"), 0);
    glUniform2f(glGetUniformLocation(fade_->name(), "size"), static_cast<float>(window_width),
                static_cast<float>(window_height));
    glUniform1f(glGetUniformLocation(fade_->name(), "share"), static_cast<float>(before));
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, before_);
    draw_triangle();
    glDisable(GL_BLEND);
}

void show_in_window(unsigned framebuffer, int width, int height) {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glReadBuffer(GL_COLOR_ATTACHMENT0);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_SCISSOR_TEST);
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void clear_window(int width, int height, float gray) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(gray, gray, gray, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

Picture read_window(int width, int height) { return read_bytes(0, width, height); }

} // namespace fathom::gl
