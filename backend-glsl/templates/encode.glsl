$# From linear colours to bytes; the viewer's last pass has it too (render-gl/post.cpp).
// Linear RGB, clamped to 0..1, as sRGB.
vec3 fathom_srgb(vec3 linear) {
    vec3 c = clamp(linear, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

// What a slow gradient needs to show no bands: an ordered pattern that decides how a byte is rounded.
// `pixel`: from the top left.
float fathom_dither(ivec2 pixel) {
    int place = 0;
    for (int bit = 0; bit < 3; ++bit) place = place * 4 + (((pixel.x ^ pixel.y) >> bit & 1) * 2 + (pixel.y >> bit & 1));
    return (0.02 + 0.96 / 63.0 * float(place) - 0.5) / 255.0;
}

// 0: blue, through green and yellow to 1: red.
vec3 fathom_ramp(float x) {
    return clamp(vec3(2.0 * x - 0.6, 1.6 - abs(3.2 * x - 1.6), 1.0 - 2.2 * x), 0.0, 1.0);
}
