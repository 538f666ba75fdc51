#define REACH 1.2
#define STEP 0.4
// Improved Perlin noise with an integer hash, the same numbers as the library's.
float gradient(uvec3 cell, vec3 p, uvec3 at) {
    cell += at;
    p -= vec3(at);
    uint h = cell.x * 0x9e3779b1u;
    h = ((h ^ (h >> 15)) + cell.y) * 0x85ebca77u;
    h = ((h ^ (h >> 13)) + cell.z) * 0xc2b2ae3du;
    h = (h ^ (h >> 16)) * 0x7feb352du;
    h = (h ^ (h >> 15)) * 0x846ca68bu;
    h = (h ^ (h >> 16)) >> 28;
    float u = h < 8u ? p.x : p.y, v = h < 4u ? p.y : h == 12u || h == 14u ? p.x : p.z;
    return ((h & 1u) == 0u ? u : -u) + ((h & 2u) == 0u ? v : -v);
}

float noise(vec3 p) {
    vec3 whole = floor(p), f = p - whole, u = f * f * f * (f * (f * 6.0 - 15.0) + 10.0);
    uvec3 c = uvec3(ivec3(whole));
    vec4 low = vec4(gradient(c, f, uvec3(0, 0, 0)), gradient(c, f, uvec3(0, 1, 0)),
                    gradient(c, f, uvec3(0, 0, 1)), gradient(c, f, uvec3(0, 1, 1)));
    vec4 high = vec4(gradient(c, f, uvec3(1, 0, 0)), gradient(c, f, uvec3(1, 1, 0)),
                     gradient(c, f, uvec3(1, 0, 1)), gradient(c, f, uvec3(1, 1, 1)));
    vec4 x = mix(low, high, u.x);
    vec2 y = mix(x.xz, x.yw, u.y);
    return mix(y.x, y.y, u.z);
}

// Four octaves push the sphere out by up to 0.1943; farther out the shell says enough.
float map(vec3 p) {
    float d = length(p) - 1.0, shell = d - 0.19433;
    if (shell > 0.1) return shell;
    vec3 q = mat3(0.7297214, 0.6821145, -0.047185767, -0.57400304, 0.64863783, 0.49978942, 0.37152007,
                  -0.33762226, 0.8648607) * (3.0 * p);
    float sum = 0.0, a = 0.1;
    for (int i = 0; i < 4; ++i, q *= 2.0, a *= 0.5) sum += a * noise(q + float(i) * vec3(5.3, 1.7, 3.1));
    return d - sum;
}
