// By hand: what goes round a `float map(vec3)`. The same algorithm and look as Fathom's (ir/shading.h):
// enhanced sphere tracing in the scene's box, a tetrahedron's gradient, five samples of occlusion,
// one soft shadow, Phong. LO, HI: the box. LIPSCHITZ_DIVIDED: map was divided by a bound, so looks
// need |f|/|grad f|.
uniform vec2 fathom_resolution, fathom_offset;
uniform vec3 fathom_origin, fathom_right, fathom_up, fathom_forward, fathom_sun;
uniform float fathom_extent;
uniform int fathom_mode; // 0 here, always; the compiler does not know
out vec4 color;

#define ZERO min(fathom_mode, 0)
const float radius = 0.5 * length(HI - LO);
float slack, tolerance_slope;

float tolerance(float t) { return slack + tolerance_slope * t; }

vec3 corner(int i) {
    return 0.57735027 * (2.0 * vec3(((i + 3) >> 1) & 1, (i >> 1) & 1, i & 1) - 1.0);
}

#ifdef LIPSCHITZ_DIVIDED
float true_distance(vec3 p, float h, float limit, out float d) {
    vec3 g = vec3(0.0);
    d = map(p);
    if (d > limit) return d;
    for (int i = ZERO; i < 4; ++i) g += corner(i) * map(p + h * corner(i));
    return d / clamp(length(g) * 0.75 / h, 1.0 / 1024.0, 1.0);
}
#else
float true_distance(vec3 p, float h, float limit, out float d) { return d = map(p); }
#endif

vec2 clip(vec3 o, vec3 d) {
    vec3 a = (LO - o) / d, b = (HI - o) / d, lo = min(a, b), hi = max(a, b);
    return vec2(max(max(lo.x, lo.y), lo.z), min(min(hi.x, hi.y), hi.z));
}

float march(vec3 o, vec3 dir, float t, float end) {
    float before = 0.0, stride = 0.0, d = 0.0;
    int i = 0;
    for (; i < 256 && t <= end + slack; ++i) {
        float limit = tolerance(t);
        float near = true_distance(o + t * dir, limit + 50.0 * slack, limit, d);
        if (stride > before + max(d, 0.0)) {
            t += before - stride;
            stride = before;
            continue;
        }
        if (near <= limit) return t + d;
        d = max(d, 0.25 * slack);
        float next = d;
        if (stride > 0.0)
            next += 0.9 * d * max(stride + d - before, 0.0) / max(stride - d + before, 1e-3 * stride);
        float proved = max(end, t + d);
        stride = min(next, proved - t);
        before = d;
        t = min(t + stride, proved);
    }
    return i == 256 && d <= 2.0 * fathom_extent / fathom_resolution.y * t ? t : -1.0;
}

float shadow(vec3 q, vec3 l, float s, float margin, float h) {
    float before = 0.0, lit = 1.0;
    for (int i = ZERO; i < 128 && s > margin; ++i) {
        float d, near = true_distance(q + s * l, h, lit * 0.02 * s, d);
        float y = before > 0.0 ? 0.5 * near * d / before : 0.0;
        lit = min(lit, sqrt(max(near * near - y * y, 0.0)) / (0.02 * (s + y)));
        if (near <= 0.0 || lit < 1.0 / 256.0) return 0.0;
        before = d;
        s -= max(d, 0.25 * slack);
    }
    return lit * lit * (3.0 - 2.0 * lit);
}

vec3 shade(vec3 o, vec3 dir, float t) {
    vec3 p = o + t * dir, n = vec3(0.0);
    float h = tolerance(t) + 50.0 * slack, d;
    for (int i = ZERO; i < 4; ++i) n += corner(i) * map(p + h * corner(i));
    n = normalize(n);
    float open = 1.0, weight = 0.6 / 0.96875;
    for (int i = 1 + ZERO; i <= 5; ++i) {
        float x = 0.016 * radius * float(i);
        weight *= 0.5;
        open -= weight * clamp(1.0 - true_distance(p + x * n, h, x, d) / x, 0.0, 1.0);
    }
    vec3 c = vec3(0.448 * 0.18 * open);
    float facing = dot(n, fathom_sun);
    if (facing > 0.0) {
        float margin = 4.0 * tolerance(t);
        vec3 q = p + margin * n;
        float lit = shadow(q, fathom_sun, max(clip(q, fathom_sun).y, 0.0), margin, h);
        float gleam = max(-dot(2.0 * facing * n - fathom_sun, dir), 0.0);
        c += (1.0 - 0.75 * (1.0 - lit)) * (facing * 0.448 + 0.4 * pow(gleam, 32.0));
    }
    return c;
}

vec3 srgb(vec3 c) {
    c = clamp(c, 0.0, 1.0);
    return mix(1.055 * pow(c, vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}

void main() {
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y) + fathom_offset - 0.5;
    vec2 uv = (2.0 * place - fathom_resolution) / fathom_resolution.y;
    vec3 dir = normalize(fathom_forward + fathom_extent * (uv.x * fathom_right - uv.y * fathom_up));
    slack = 1e-6 * (length(fathom_origin) + radius);
    tolerance_slope = min(5e-4, fathom_extent / fathom_resolution.y);
    vec2 way = clip(fathom_origin, dir);
    float begin = max(way.x, 0.0);
    float t = way.y < begin ? -1.0 : march(fathom_origin, dir, begin, way.y);
    vec3 sky = mix(vec3(0.63, 0.66, 0.68), vec3(0.21, 0.34, 0.53), smoothstep(-0.3, 0.8, dir.y));
    color = vec4(srgb(t < 0.0 ? sky : shade(fathom_origin, dir, t)), 1.0);
}
