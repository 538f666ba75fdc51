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
}
