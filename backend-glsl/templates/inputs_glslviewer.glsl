$# The uniforms that glslViewer sets.
$if PICTURE
uniform vec2 u_resolution;
uniform vec3 u_camera;
uniform float u_time;

$else
$if TIME
uniform float u_time;
$end
$end
