$# The entry point of a page's picture, drawn by passes into tiles. Of a ray that goes on the colour's alpha is 2.

layout(location = 0) out vec4 fathom_color;
uniform vec2 fathom_tile; // the lower left of what is drawn, in pixels of the picture

void main() {
    if (fathom_resumed) {
        vec4 before = fathom_kept(fathom_kept_2);
        if (before.a < 1.5) {
            fathom_color = before;
            return;
        }
    }
    vec2 place = fathom_tile + gl_FragCoord.xy;
    fathom_color = fathom_picture(vec2(place.x, fathom_resolution.y - place.y) + fathom_offset - 0.5);
    if (fathom_goes_on) fathom_color = vec4(fathom_keep_2.rgb, 2.0);
}
