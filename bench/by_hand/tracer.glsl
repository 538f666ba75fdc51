// What goes round a `float map(vec3)`: a plain tracer, as one writes it for Shadertoy. Sphere
// tracing from the eye, the gradient by a tetrahedron, five samples of occlusion along the normal,
// one light without shadows, Phong.
//   REACH     how far from the origin the scene reaches: rays end behind it
//   STEP      by what map is multiplied where it is too steep, found by trying
//   COLORED   there is a vec3 albedo(vec3), linear
// fathom_mode 2: (steps, t, 0, 1 for a hit), as numbers.
uniform vec2 fathom_resolution, fathom_offset;
uniform vec3 fathom_origin, fathom_right, fathom_up, fathom_forward, fathom_sun;
uniform float fathom_extent;
uniform int fathom_mode; // the compiler does not know that it is above -1
out vec4 color;

#define ZERO min(fathom_mode, 0)
#ifndef STEP
#define STEP 1.0
#endif
#ifndef COLORED
vec3 albedo(vec3 p) { return vec3(0.45); }
#endif

vec3 normal(vec3 p, float h) {
    vec3 n = vec3(0.0);
    for (int i = ZERO; i < 4; ++i) {
        vec3 e = 0.5773 * (2.0 * vec3(((i + 3) >> 1) & 1, (i >> 1) & 1, i & 1) - 1.0);
        n += e * map(p + h * e);
    }
    return normalize(n);
}

float occlusion(vec3 p, vec3 n) {
    float sum = 0.0, weight = 1.0;
    for (int i = 1 + ZERO; i <= 5; ++i) {
        float away = 0.03 * float(i);
        sum += weight * clamp(1.0 - map(p + away * n) / away, 0.0, 1.0);
        weight *= 0.5;
    }
    return sum / 1.9375;
}

vec3 shade(vec3 p, vec3 direction, float h) {
    vec3 n = normal(p, h), a = albedo(p);
    float open = 1.0;
#ifndef MARCH_ALONE
    open -= 0.6 * occlusion(p, n);
#endif
    float facing = max(dot(n, fathom_sun), 0.0);
    float gleam = max(dot(reflect(direction, n), fathom_sun), 0.0);
    return a * (0.2 * open + 0.8 * facing) + 0.3 * pow(gleam, 32.0);
}

void main() {
    vec2 place = vec2(gl_FragCoord.x, fathom_resolution.y - gl_FragCoord.y) + fathom_offset - 0.5;
    vec2 uv = (2.0 * place - fathom_resolution) / fathom_resolution.y;
    vec3 direction = normalize(fathom_forward + fathom_extent * (uv.x * fathom_right - uv.y * fathom_up));
    float t = 0.0, end = length(fathom_origin) + REACH;
    bool hit = false;
    int steps = 0;
    for (; steps < 512 && t < end; ++steps) {
        float d = STEP * map(fathom_origin + t * direction);
        hit = d < 5e-4 * t;
        if (hit) break;
        t += d;
    }
    vec3 c = mix(vec3(0.63, 0.66, 0.68), vec3(0.21, 0.34, 0.53), smoothstep(-0.3, 0.8, direction.y));
    if (hit) c = shade(fathom_origin + t * direction, direction, 5e-4 * t);
    color = vec4(pow(c, vec3(1.0 / 2.2)), 1.0);
    if (fathom_mode == 2) color = vec4(float(steps), t, 0.0, hit ? 1.0 : 0.0);
}
