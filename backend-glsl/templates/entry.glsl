$# The entry point of a picture whose uniforms a host sets.

$if LOCATIONS
layout(location = 0) out vec4 fathom_color;
$else
out vec4 fathom_color;
$end
$if CACHED
$include cache_outputs
$end

void main() {
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y);
    fathom_color = fathom_picture(place + fathom_offset - 0.5);
$if CACHED
$include cache_output
$end
$if PASSES
#ifdef FATHOM_BEGINS
$# Mesa's llvmpipe ends all loops of a shader after 65,536 turns and says nothing; from then on none turns twice.
    int turns = 0;
    for (int i = $ZERO; i < 2; ++i) ++turns;
    if (turns < 2) { // the ray begins anew, in passes of fewer steps
        fathom_left = 1.0;
        fathom_color = vec4(0.0);
    }
#endif
$end
}
