#include "render-gl/kept_state.h"

#include <epoxy/gl.h>

namespace fathom::gl {
namespace {

void enable(GLenum what, bool on) {
    if (on)
        glEnable(what);
    else
        glDisable(what);
}

} // namespace

KeptState::KeptState() {
    const bool desktop = epoxy_is_desktop_gl();
    for (const auto &[what, value] :
         {std::pair{GL_DRAW_FRAMEBUFFER_BINDING, &draw_},
          std::pair{GL_READ_FRAMEBUFFER_BINDING, &read_},
          std::pair{GL_RENDERBUFFER_BINDING, &renderbuffer_},
          std::pair{GL_CURRENT_PROGRAM, &program_}, std::pair{GL_VERTEX_ARRAY_BINDING, &vertices_},
          std::pair{GL_ACTIVE_TEXTURE, &unit_}, std::pair{GL_PIXEL_PACK_BUFFER_BINDING, &pack_},
          std::pair{GL_PIXEL_UNPACK_BUFFER_BINDING, &unpack_},
          std::pair{GL_DEPTH_FUNC, &depth_func_}, std::pair{GL_VIEWPORT, viewport_.data()}})
        glGetIntegerv(static_cast<GLenum>(what), value);
    glGetBooleanv(GL_DEPTH_WRITEMASK, &depth_mask_);
    glGetBooleanv(GL_COLOR_WRITEMASK, color_mask_.data());

    std::vector<GLenum> off{GL_BLEND,        GL_CULL_FACE,         GL_DEPTH_TEST,
                            GL_SCISSOR_TEST, GL_STENCIL_TEST,      GL_SAMPLE_ALPHA_TO_COVERAGE,
                            GL_DITHER,       GL_RASTERIZER_DISCARD};
    if (desktop) off.insert(off.end(), {GL_COLOR_LOGIC_OP, GL_FRAMEBUFFER_SRGB});
    for (const GLenum what : off) {
        enabled_.emplace_back(what, glIsEnabled(what) == GL_TRUE);
        glDisable(what);
    }
    std::vector<std::pair<GLenum, GLint>> rows{
        {GL_UNPACK_ALIGNMENT, 4},   {GL_UNPACK_ROW_LENGTH, 0},  {GL_UNPACK_SKIP_ROWS, 0},
        {GL_UNPACK_SKIP_PIXELS, 0}, {GL_UNPACK_SKIP_IMAGES, 0}, {GL_UNPACK_IMAGE_HEIGHT, 0},
        {GL_PACK_ALIGNMENT, 4},     {GL_PACK_ROW_LENGTH, 0},    {GL_PACK_SKIP_ROWS, 0},
        {GL_PACK_SKIP_PIXELS, 0}};
    if (desktop) rows.insert(rows.end(), {{GL_UNPACK_SWAP_BYTES, 0}, {GL_PACK_SWAP_BYTES, 0}});
    for (const auto &[what, value] : rows) {
        GLint before = 0;
        glGetIntegerv(what, &before);
        pixels_.emplace_back(what, before);
        glPixelStorei(what, value);
    }
    glBindBuffer(GL_PIXEL_PACK_BUFFER, 0);
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, 0);
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    if (desktop) {
        std::array<GLint, 2> modes{}; // of front and back; a core context has one for both
        glGetIntegerv(GL_POLYGON_MODE, modes.data());
        polygons_ = modes[0];
        glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    }
    GLint units = 0;
    glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &units);
    for (GLuint unit = 0; unit < static_cast<GLuint>(units); ++unit) glBindSampler(unit, 0);
}

KeptState::~KeptState() {
    for (const auto &[what, on] : enabled_) enable(what, on);
    for (const auto &[what, value] : pixels_) glPixelStorei(what, value);
    if (polygons_ != 0) glPolygonMode(GL_FRONT_AND_BACK, static_cast<GLenum>(polygons_));
    glColorMask(color_mask_[0], color_mask_[1], color_mask_[2], color_mask_[3]);
    glDepthMask(depth_mask_);
    glDepthFunc(static_cast<GLenum>(depth_func_));
    glViewport(viewport_[0], viewport_[1], viewport_[2], viewport_[3]);
    glBindBuffer(GL_PIXEL_PACK_BUFFER, static_cast<GLuint>(pack_));
    glBindBuffer(GL_PIXEL_UNPACK_BUFFER, static_cast<GLuint>(unpack_));
    glActiveTexture(static_cast<GLenum>(unit_));
    glBindVertexArray(static_cast<GLuint>(vertices_));
    glUseProgram(static_cast<GLuint>(program_));
    glBindRenderbuffer(GL_RENDERBUFFER, static_cast<GLuint>(renderbuffer_));
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glBindFramebuffer(GL_READ_FRAMEBUFFER, static_cast<GLuint>(read_));
}

void KeptState::draw_over(int width, int height) const {
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glViewport(0, 0, width, height);
}

void KeptState::copy_over(unsigned framebuffer, int width, int height) const {
    glBindFramebuffer(GL_READ_FRAMEBUFFER, framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, static_cast<GLuint>(draw_));
    glBlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
}

} // namespace fathom::gl
