$# The entry point of a picture whose uniforms a host sets.

$if LOCATIONS
layout(location = 0) out vec4 fathom_color;
$else
out vec4 fathom_color;
$end
$if CACHED
$include cache_outputs
$end

$if PASSES
uniform bool fathom_listed; // what is drawn is a list of places in the picture, in pixels from its top left
uniform sampler2D fathom_places;

$end
void main() {
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y) + fathom_offset - 0.5;
$if PASSES
    if (fathom_listed) place = texelFetch(fathom_places, ivec2(gl_FragCoord.xy), 0).xy;
$end
    fathom_color = fathom_picture(place);
$if CACHED
$include cache_output
$end
$if PASSES
$# Mesa's llvmpipe ends all loops of a shader after 65,536 turns and says nothing; from then on none turns twice.
    int turns = 0;
    for (int i = $ZERO; i < 2; ++i) ++turns;
    if (turns < 2) {
#ifdef FATHOM_BEGINS
        fathom_left = 1.0; // the ray begins anew, in passes of fewer steps
        fathom_color = vec4(0.0);
#else
        if (fathom_left < 0.9) fathom_left = 0.25; // what it met last is undecided
#endif
    }
$end
}
