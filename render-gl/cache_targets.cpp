// See cache_targets.h.
#include "render-gl/cache_targets.h"

#include "backend-glsl/cache.h"
#include "render-gl/framebuffer.h"

#include <epoxy/gl.h>

namespace fathom::gl {
namespace {

constexpr GLenum wish_attachment(int i) { return GL_COLOR_ATTACHMENT2 + static_cast<GLenum>(i); }

GLuint layers(GLint format, int width, int height, int count) {
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D_ARRAY, name);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, format, width, height, count, 0, GL_RGBA_INTEGER, GL_INT,
                 nullptr);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D_ARRAY, GL_TEXTURE_MAX_LEVEL, 0);
    return name;
}

} // namespace

unsigned target_2d(int format, int width, int height, unsigned framebuffer, unsigned attachment) {
    const GLenum layout = format == GL_RGBA32F    ? GL_RGBA
                          : format == GL_R8       ? GL_RED
                          : format == GL_RGBA32I  ? GL_RGBA_INTEGER
                          : format == GL_RGBA32UI ? GL_RGBA_INTEGER
                                                  : GL_RG_INTEGER;
    const GLenum type = format == GL_RGBA32F || format == GL_R8 ? GL_FLOAT
                        : format == GL_RGBA32I                  ? GL_INT
                                                                : GL_UNSIGNED_INT;
    GLuint name = 0;
    glGenTextures(1, &name);
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, name);
    glTexImage2D(GL_TEXTURE_2D, 0, format, width, height, 0, layout, type, nullptr);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAX_LEVEL, 0);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_FRAMEBUFFER, attachment, GL_TEXTURE_2D, name, 0);
    return name;
}

void CacheTargets::release() {
    for (GLuint *framebuffer : {&picture, &rest, &reserved}) {
        if (*framebuffer) glDeleteFramebuffers(1, framebuffer);
        *framebuffer = 0;
    }
    for (GLuint *texture : {&color, &picks, &misses, &tally, &starts, &wishes, &places}) {
        if (*texture) glDeleteTextures(1, texture);
        *texture = 0;
    }
    if (depth_) glDeleteRenderbuffers(1, &depth_);
    depth_ = 0;
    width = height = 0;
}

void CacheTargets::draw_into(bool counted) const {
    const GLenum outputs[] = {GL_COLOR_ATTACHMENT0,
                              static_cast<GLenum>(pick_ ? GL_COLOR_ATTACHMENT1 : GL_NONE),
                              GL_COLOR_ATTACHMENT2, GL_COLOR_ATTACHMENT3, GL_COLOR_ATTACHMENT4};
    glDrawBuffers(counted ? 5 : 2, outputs);
}

void CacheTargets::clear_counts() const {
    glBindFramebuffer(GL_FRAMEBUFFER, picture);
    draw_into(true);
    const GLint none[] = {0, 0, 0, -1};
    const GLuint computed[] = {0, static_cast<GLuint>(glsl::PixelState::Computed), 0, 0};
    glClearBufferiv(GL_COLOR, 2, none);
    glClearBufferuiv(GL_COLOR, 3, computed);
}

bool CacheTargets::make() {
    for (GLuint *framebuffer : {&picture, &rest, &reserved}) glGenFramebuffers(1, framebuffer);
    color = target_2d(GL_RGBA32F, width, height, picture, GL_COLOR_ATTACHMENT0);
    if (pick_) picks = target_2d(GL_RGBA32F, width, height, picture, GL_COLOR_ATTACHMENT1);
    misses = target_2d(GL_RGBA32I, width, height, picture, GL_COLOR_ATTACHMENT2);
    tally = target_2d(GL_RG32UI, width, height, picture, GL_COLOR_ATTACHMENT3);
    starts = target_2d(GL_RGBA32F, width, height, picture, GL_COLOR_ATTACHMENT4);
    glGenRenderbuffers(1, &depth_);
    glBindRenderbuffer(GL_RENDERBUFFER, depth_);
    glRenderbufferStorage(GL_RENDERBUFFER, GL_DEPTH_COMPONENT24, width, height);
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    draw_into(true);
    if (!complete()) return false;

    wishes = layers(GL_RGBA32I, width, height, glsl::cache_wishes);
    glBindFramebuffer(GL_FRAMEBUFFER, rest);
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, color, 0);
    if (pick_)
        glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT1, GL_TEXTURE_2D, picks, 0);
    GLenum outputs[2 + glsl::cache_wishes] = {
        GL_COLOR_ATTACHMENT0, static_cast<GLenum>(pick_ ? GL_COLOR_ATTACHMENT1 : GL_NONE)};
    for (int i = 0; i < glsl::cache_wishes; ++i) {
        outputs[2 + i] = wish_attachment(i);
        glFramebufferTextureLayer(GL_FRAMEBUFFER, wish_attachment(i), wishes, 0, i);
    }
    glFramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_);
    glDrawBuffers(2 + glsl::cache_wishes, outputs);
    if (!complete()) return false;

    places = target_2d(GL_RGBA32UI, width, height, reserved, GL_COLOR_ATTACHMENT0);
    return complete();
}

bool CacheTargets::resize(int new_width, int new_height, bool pick) {
    if (picture && new_width == width && new_height == height && pick == pick_) return true;
    release();
    pick_ = pick;
    width = new_width;
    height = new_height;
    while (glGetError() != GL_NO_ERROR) {
    } // what was wrong before is not ours to report
    const bool made = make();
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    const bool good = made && glGetError() == GL_NO_ERROR;
    if (!good) release();
    return good;
}

} // namespace fathom::gl
