#version 420 core
// Misses in red, to be blended over the picture by its alpha.
uniform isampler2D fathom_cache_misses;
layout(location = 0) out vec4 fathom_color;
void main() {
    if (texelFetch(fathom_cache_misses, ivec2(gl_FragCoord.xy), 0).w < 0) discard;
    fathom_color = vec4(1.0, 0.0, 0.0, 0.8);
}
