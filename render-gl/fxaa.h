// Fast approximate anti-aliasing as one GLSL function, vec3 smoothed(sampler2D picture, ivec2 at):
// for a picture of one sample a pixel, sRGB coded, filtered linearly, with clamped edges. Knows
// nothing of where the picture comes from.
#pragma once

namespace fathom::gl {

extern const char *const fxaa_text;

} // namespace fathom::gl
