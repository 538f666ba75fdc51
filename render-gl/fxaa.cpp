#include "render-gl/fxaa.h"

namespace fathom::gl {

// After the description in T. Lottes, "FXAA" (NVIDIA white paper, 2011), sections 1 to 3, in our
// own words and code:
// 1. Where the five pixels of a cross differ little in luma, nothing is done.
// 2. An edge runs along the direction in which second differences are the smaller; the pixel's
// neighbour across it is the
//    one to which luma changes more. Between the two lies the edge, and half way its mean luma.
// 3. Along the edge, both ways, one looks for where that mean has changed by a quarter of the step:
// the edge's ends. The
//    nearer end says how far into its stair the pixel is: so far it is moved across the edge, by
//    half a pixel less the share of the span (none, where that end turns the other way).
// 4. Single bright or dark pixels have no edge to follow: how far the pixel's luma is from that of
// its 3x3 surroundings
//    gives a least amount to move by.
// Moving is one filtered fetch.
const char *const fxaa_text = R"(
const float fxaa_least = 0.0625;   // luma differences below this are never touched,
const float fxaa_share = 0.125;    // nor below this share of the brightest
const float fxaa_lonely = 0.75;    // how much single pixels are smoothed
const int fxaa_reach = 10;

float fxaa_luma(vec3 c) {
    return dot(c, vec3(0.299, 0.587, 0.114));
}

float fxaa_luma_at(sampler2D picture, vec2 place) {
    return fxaa_luma(textureLod(picture, place, 0.0).rgb);
}

vec3 smoothed(sampler2D picture, ivec2 at) {
    vec2 pixel = 1.0 / vec2(textureSize(picture, 0));
    vec2 place = (vec2(at) + 0.5) * pixel;
    vec3 color = textureLod(picture, place, 0.0).rgb;
    float m = fxaa_luma(color);
    float n = fxaa_luma_at(picture, place + pixel * vec2(0.0, 1.0));
    float s = fxaa_luma_at(picture, place - pixel * vec2(0.0, 1.0));
    float e = fxaa_luma_at(picture, place + pixel * vec2(1.0, 0.0));
    float w = fxaa_luma_at(picture, place - pixel * vec2(1.0, 0.0));
    float most = max(m, max(max(n, s), max(e, w)));
    float range = most - min(m, min(min(n, s), min(e, w)));
    if (range < max(fxaa_least, fxaa_share * most)) return color;

    float ne = fxaa_luma_at(picture, place + pixel);
    float sw = fxaa_luma_at(picture, place - pixel);
    float nw = fxaa_luma_at(picture, place + pixel * vec2(-1.0, 1.0));
    float se = fxaa_luma_at(picture, place + pixel * vec2(1.0, -1.0));
    float up_down = abs(nw + sw - 2.0 * w) + 2.0 * abs(n + s - 2.0 * m) + abs(ne + se - 2.0 * e);
    float left_right = abs(nw + ne - 2.0 * n) + 2.0 * abs(w + e - 2.0 * m) + abs(sw + se - 2.0 * s);
    bool level = up_down >= left_right;   // the edge runs from left to right
    vec2 along = level ? vec2(pixel.x, 0.0) : vec2(0.0, pixel.y);
    vec2 across = level ? vec2(0.0, pixel.y) : vec2(pixel.x, 0.0);
    float plus = level ? n : e;
    float minus = level ? s : w;
    float step_plus = abs(plus - m);
    float step_minus = abs(minus - m);
    if (step_minus > step_plus) across = -across;
    float mean = 0.5 * (m + (step_minus > step_plus ? minus : plus));
    float enough = 0.25 * max(step_plus, step_minus);

    vec2 edge = place + 0.5 * across;
    float to_first = 0.0;
    float to_last = 0.0;
    float first = 0.0;
    float last = 0.0;
    bool found_first = false;
    bool found_last = false;
    for (int i = 0; i < fxaa_reach && !(found_first && found_last); ++i) {
        float stride = i < 4 ? 1.0 : 2.0;
        if (!found_first) {
            to_first += stride;
            first = fxaa_luma_at(picture, edge - to_first * along) - mean;
            found_first = abs(first) >= enough;
        }
        if (!found_last) {
            to_last += stride;
            last = fxaa_luma_at(picture, edge + to_last * along) - mean;
            found_last = abs(last) >= enough;
        }
    }
    float nearer = min(to_first, to_last);
    bool turns = ((to_first < to_last ? first : last) < 0.0) != (m - mean < 0.0);
    float by_edge = turns ? 0.5 - nearer / (to_first + to_last) : 0.0;

    float around = (2.0 * (n + s + e + w) + ne + nw + se + sw) / 12.0;
    float apart = smoothstep(0.0, 1.0, clamp(abs(around - m) / range, 0.0, 1.0));
    float by_point = fxaa_lonely * apart * apart;
    return textureLod(picture, place + max(by_edge, by_point) * across, 0.0).rgb;
}
)";

} // namespace fathom::gl
