$# The colour of a place in the picture, or what fathom_mode asks of it (marcher.h).

$include encode

vec3 fathom_encode(vec3 linear, ivec2 pixel) {
    return fathom_srgb(linear) + fathom_dither(pixel);
}

// Blue for few steps, through green and yellow to red for many; magenta for an undecided ray.
vec3 fathom_heat(int steps) {
    if (fathom_end == 2) return vec3(1.0, 0.0, 1.0);
    float x = log2(1.0 + float(steps)) / log2(1.0 + float($MANY_STEPS));
    return fathom_ramp(x);
}

$if SOFT

// Highlights that would be clamped bend instead.
vec3 fathom_soft(vec3 c) {
    float rest = 1.0 - $SHOULDER;
    return mix(c, $SHOULDER + rest * (1.0 - exp(($SHOULDER - c) / rest)), greaterThan(c, vec3($SHOULDER)));
}
$end

// `place`: in pixels from the top left of the picture.
vec4 fathom_picture(vec2 place) {
$include ray
    float t = end < begin ? -1.0 : fathom_march(origin, direction, begin, end);
$if PICK
    fathom_pick = vec4(0.0, t, float(fathom_steps), 0.0);
$end
$if PASSES
    if (fathom_goes_on) {
        fathom_left = 1.0;
        return vec4(0.0);
    }
    fathom_left = fathom_end == 2 ? 0.25 : fathom_passed ? 0.125 : 0.0;
$end
    if (fathom_mode == 1) return vec4(fathom_heat(fathom_steps), 1.0);
    vec3 color = vec3(0.0);
    float fade = 1.0;
    if (t >= 0.0) {
        color = fathom_shade(origin, direction, t);
$if SOFT
        color = fathom_soft(color);
$end
$if BOXED
        fade = 0.0;
$else
        fade = smoothstep($FADE_FROM * fathom_far, fathom_far, t);
$end
    }
    if (fade > 0.0) color = mix(color, fathom_background(direction), fade);
$if PASSES
    if (fathom_goes_on) {
        fathom_left = 1.0;
        return vec4(0.0);
    }
    if (fathom_shadow_undecided) fathom_left += 0.5;
$end
    if (fathom_mode == 2)
        return vec4(float(fathom_steps), t, float(fathom_paint), fathom_end == 2 ? 2.0 : t < 0.0 ? 0.0 : 1.0);
$if COUNTED
$if PASSES
    float opaque = fathom_end == 2 ? 0.5 : fathom_close ? 0.875 : 1.0;
$else
    float opaque = fathom_end == 2 ? 0.5 : 1.0;
$end
$if CACHED
#if !defined(FATHOM_CACHE) && !defined(FATHOM_CACHE_LEARN)
    opaque = 1.0;
#endif
$end
    return vec4(fathom_mode == 3 ? color : fathom_encode(color, ivec2(place)), opaque);
$else
    return vec4(fathom_mode == 3 ? color : fathom_encode(color, ivec2(place)), 1.0);
$end
}
