$# The entry point of a page's picture, drawn by passes into tiles. Of a ray that goes on the colour's alpha is 2.

layout(location = 0) out vec4 fathom_color;

void main() {
    if (fathom_resumed) {
        vec4 before = fathom_kept(fathom_kept_2);
        if (before.a < 1.5) {
            fathom_color = before;
            return;
        }
    }
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y);
    fathom_color = fathom_picture(place + fathom_offset - 0.5);
    if (fathom_goes_on) fathom_color = vec4(fathom_keep_2.rgb, 2.0);
}
