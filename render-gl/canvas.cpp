#include "render-gl/canvas.h"

#include <epoxy/gl.h>

#include <algorithm>

namespace fathom::gl {

int context_version() { return epoxy_gl_version(); }

Canvas::~Canvas() {
    if (framebuffer_) glDeleteFramebuffers(1, &framebuffer_);
    if (texture_) glDeleteTextures(1, &texture_);
}

bool Canvas::resize(int width, int height) {
    if (width == width_ && height == height_) return true;
    while (glGetError() != GL_NO_ERROR) {} // what was wrong before is not ours to report
    if (!texture_) glGenTextures(1, &texture_);
    if (!framebuffer_) glGenFramebuffers(1, &framebuffer_);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_, 0);
    bool good = glGetError() == GL_NO_ERROR && glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    width_ = good ? width : 0;
    height_ = good ? height : 0;
    return good;
}

bool Canvas::draw(const Program &program, const FrameInputs &inputs, const std::vector<ir::Param> &params) {
    if (!resize(inputs.width, inputs.height)) return false;
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer_);
    glViewport(0, 0, width_, height_);
    glDisable(GL_DEPTH_TEST);
    glDisable(GL_BLEND);
    glDisable(GL_SCISSOR_TEST);
    glDisable(GL_CULL_FACE);
    program.draw(inputs, params);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glFinish();
    return true;
}

void Canvas::show(int window_width, int window_height) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer_);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDisable(GL_SCISSOR_TEST);
    bool same = width_ == window_width && height_ == window_height;
    glBlitFramebuffer(0, 0, width_, height_, 0, 0, window_width, window_height, GL_COLOR_BUFFER_BIT,
                      same ? GL_NEAREST : GL_LINEAR);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
}

void clear_window(int width, int height, float gray) {
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    glViewport(0, 0, width, height);
    glDisable(GL_SCISSOR_TEST);
    glClearColor(gray, gray, gray, 1);
    glClear(GL_COLOR_BUFFER_BIT);
}

Picture read_window(int width, int height) {
    const std::size_t row = static_cast<std::size_t>(width) * 4;
    std::vector<std::uint8_t> upward(row * static_cast<std::size_t>(height));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, 0);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, width, height, GL_RGBA, GL_UNSIGNED_BYTE, upward.data());
    Picture picture{width, height, std::vector<std::uint8_t>(upward.size())};
    for (std::size_t y = 0; y < static_cast<std::size_t>(height); ++y)
        std::copy_n(upward.begin() + static_cast<std::ptrdiff_t>((static_cast<std::size_t>(height) - 1 - y) * row), row,
                    picture.rgba.begin() + static_cast<std::ptrdiff_t>(y * row));
    for (std::size_t i = 3; i < picture.rgba.size(); i += 4) picture.rgba[i] = 255; // a window has no holes
    return picture;
}

} // namespace fathom::gl
