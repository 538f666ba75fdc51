// Whether the framebuffer that a canvas or a target of the noise cache put together is complete.
#pragma once

#include <epoxy/gl.h>

namespace fathom::gl {

// Whether the bound framebuffer can be drawn into.
inline bool complete() {
    return glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
}

} // namespace fathom::gl
