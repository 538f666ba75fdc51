#define REACH 1.75
#define STEP 0.3

vec4 hash1(vec4 n) { return fract(sin(n) * 43758.5453); }

float value(vec3 p) {
    vec3 i = floor(p), f = fract(p), u = f * f * (3.0 - 2.0 * f);
    float n = dot(i, vec3(1.0, 57.0, 21.0));
    vec4 a = hash1(n + vec4(0.0, 57.0, 21.0, 78.0)), b = hash1(n + vec4(1.0, 58.0, 22.0, 79.0));
    vec4 x = mix(a, b, u.x);
    vec2 y = mix(x.xz, x.yw, u.y);
    return mix(y.x, y.y, u.z);
}

float map(vec3 p) {
    float fire = 0.5 * value(3.4 * p) + 0.25 * value(6.9 * p) + 0.125 * value(14.1 * p);
    return length(p) - 1.0 - 0.8 * fire;
}
