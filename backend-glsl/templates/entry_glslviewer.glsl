$# glslViewer: its camera turns ours about the first view's target, once it was moved.

out vec4 fathom_color;

void main() {
    fathom_resolution = u_resolution;
$include first_view
    if (length(u_camera.xz) > 0.0) {
    vec3 back = normalize(u_camera);
$include turned_view
    }
    fathom_color = fathom_picture(vec2(gl_FragCoord.x, u_resolution.y - gl_FragCoord.y));
}
