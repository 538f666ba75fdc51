// What canvases and the noise cache's targets ask of the framebuffer they have put together.
#pragma once

#include <epoxy/gl.h>

namespace fathom::gl {

inline bool complete() {
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

} // namespace fathom::gl
