$# Hashes and noises, ports of ir/noise.h; see there for what they are and why their constants are
$# these.

$helper fathom_scramble
uint fathom_scramble(uint h) {
    h ^= h >> 16u;
    h *= 0x7feb352du;
    h ^= h >> 15u;
    h *= 0x846ca68bu;
    h ^= h >> 16u;
    return h;
}

float fathom_unit(uint h) {
    return float(h >> 8u) * (1.0 / 16777216.0);
}

$helper fathom_hash_more needs fathom_scramble
uint fathom_hash_more(uint h, uint word) {
    return fathom_scramble((h ^ word) + 0x9e3779b9u);
}

$helper fathom_hash:int needs fathom_hash_more
float fathom_hash(int x) {
    uint h = 1u;
    h = fathom_hash_more(h, uint(x));
    return fathom_unit(h);
}

$helper fathom_hash:float needs fathom_hash_more
float fathom_hash(float x) {
    uint h = 1u;
    h = fathom_hash_more(h, floatBitsToUint(x) * uint(x != 0.0));
    return fathom_unit(h);
}

$helper fathom_hash:vec2 needs fathom_hash_more
float fathom_hash(vec2 x) {
    uint h = 2u;
    h = fathom_hash_more(h, floatBitsToUint(x.x) * uint(x.x != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.y) * uint(x.y != 0.0));
    return fathom_unit(h);
}

$helper fathom_hash:vec3 needs fathom_hash_more
float fathom_hash(vec3 x) {
    uint h = 3u;
    h = fathom_hash_more(h, floatBitsToUint(x.x) * uint(x.x != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.y) * uint(x.y != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.z) * uint(x.z != 0.0));
    return fathom_unit(h);
}

$helper fathom_hash:vec4 needs fathom_hash_more
float fathom_hash(vec4 x) {
    uint h = 4u;
    h = fathom_hash_more(h, floatBitsToUint(x.x) * uint(x.x != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.y) * uint(x.y != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.z) * uint(x.z != 0.0));
    h = fathom_hash_more(h, floatBitsToUint(x.w) * uint(x.w != 0.0));
    return fathom_unit(h);
}

$helper fathom_lattice needs fathom_scramble
uint fathom_hash_lattice(uvec3 p, uint salt) {
    uint h = (p.x ^ salt) * 0x9e3779b1u;
    h = ((h ^ (h >> 15u)) + p.y) * 0x85ebca77u;
    h = ((h ^ (h >> 13u)) + p.z) * 0xc2b2ae3du;
    return fathom_scramble(h);
}

uvec3 fathom_lattice(vec3 whole) {
    return uvec3(ivec3(mix(vec3(0.0), whole, lessThanEqual(abs(whole), vec3(1073741824.0)))));
}

vec3 fathom_fade(vec3 t) {
    return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

$helper fathom_edge_gradient needs fathom_lattice
float fathom_edge_gradient(uint h, vec3 p) {
    uint k = h >> 28u;
    float u = mix(p.y, p.x, k < 8u);
    float v = mix(mix(p.z, p.x, (k | 2u) == 14u), p.y, k < 4u);
    return mix(-u, u, (k & 1u) == 0u) + mix(-v, v, (k & 2u) == 0u);
}

$helper fathom_perlin needs fathom_edge_gradient
float fathom_perlin_corner(uvec3 cell, vec3 p, uvec3 corner) {
    return fathom_edge_gradient(fathom_hash_lattice(cell + corner, 0u), p - vec3(corner));
}

float fathom_perlin(vec3 p) {
    vec3 whole = floor(p);
    uvec3 cell = fathom_lattice(whole);
    vec3 x = p - whole;
    vec3 u = fathom_fade(x);
    float a = mix(fathom_perlin_corner(cell, x, uvec3(0u)), fathom_perlin_corner(cell, x, uvec3(1u, 0u, 0u)), u.x);
    float b = mix(fathom_perlin_corner(cell, x, uvec3(0u, 1u, 0u)), fathom_perlin_corner(cell, x, uvec3(1u, 1u, 0u)), u.x);
    float c = mix(fathom_perlin_corner(cell, x, uvec3(0u, 0u, 1u)), fathom_perlin_corner(cell, x, uvec3(1u, 0u, 1u)), u.x);
    float d = mix(fathom_perlin_corner(cell, x, uvec3(0u, 1u, 1u)), fathom_perlin_corner(cell, x, uvec3(1u)), u.x);
    return mix(mix(a, b, u.y), mix(c, d, u.y), u.z);
}

$helper fathom_value_noise needs fathom_lattice
float fathom_value_corner(uvec3 cell) {
    return fathom_unit(fathom_hash_lattice(cell, 0x68e31da4u));
}

float fathom_value_noise(vec3 p) {
    vec3 whole = floor(p);
    uvec3 cell = fathom_lattice(whole);
    vec3 u = fathom_fade(p - whole);
    float a = mix(fathom_value_corner(cell), fathom_value_corner(cell + uvec3(1u, 0u, 0u)), u.x);
    float b = mix(fathom_value_corner(cell + uvec3(0u, 1u, 0u)), fathom_value_corner(cell + uvec3(1u, 1u, 0u)), u.x);
    float c = mix(fathom_value_corner(cell + uvec3(0u, 0u, 1u)), fathom_value_corner(cell + uvec3(1u, 0u, 1u)), u.x);
    float d = mix(fathom_value_corner(cell + uvec3(0u, 1u, 1u)), fathom_value_corner(cell + uvec3(1u)), u.x);
    return mix(mix(a, b, u.y), mix(c, d, u.y), u.z);
}

$helper fathom_simplex needs fathom_edge_gradient
float fathom_simplex_corner(uvec3 cell, vec3 p) {
    float t = max(0.5 - (p.x * p.x + p.y * p.y + p.z * p.z), 0.0);
    return t * t * t * t * fathom_edge_gradient(fathom_hash_lattice(cell, 0xb5297a4du), p);
}

float fathom_simplex(vec3 p) {
    float s = (p.x + p.y + p.z) * (1.0 / 3.0);
    vec3 whole = floor(p + s);
    float t = (whole.x + whole.y + whole.z) * (1.0 / 6.0);
    vec3 x = p - (whole - t);
    bool xy = x.x >= x.y, yz = x.y >= x.z, xz = x.x >= x.z;
    ivec3 rank = ivec3(int(xy) + int(xz), int(!xy) + int(yz), int(!xz) + int(!yz));
    vec3 first = vec3(equal(rank, ivec3(2)));
    vec3 second = vec3(greaterThanEqual(rank, ivec3(1)));
    uvec3 cell = fathom_lattice(whole);
    return 76.0 * (fathom_simplex_corner(cell, x) +
                   fathom_simplex_corner(cell + uvec3(first), x - first + (1.0 / 6.0)) +
                   fathom_simplex_corner(cell + uvec3(second), x - second + (1.0 / 3.0)) +
                   fathom_simplex_corner(cell + uvec3(1u), x - 1.0 + 0.5));
}

$helper fathom_worley_point needs fathom_lattice
vec3 fathom_worley_point(uint h) {
    return vec3((float(h & 2047u) + 0.5) * (1.0 / 2048.0), (float((h >> 11u) & 2047u) + 0.5) * (1.0 / 2048.0),
                (float(h >> 22u) + 0.5) * (1.0 / 1024.0));
}

$helper fathom_worley needs fathom_worley_point
float fathom_worley(vec3 p) {
    vec3 whole = floor(p);
    uvec3 cell = fathom_lattice(whole);
    vec3 x = p - whole;
    float least = 1.0;
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                uint h = fathom_hash_lattice(cell + uvec3(uint(i), uint(j), uint(k)), 0x1b56c4e9u);
                vec3 d = x - (vec3(float(i), float(j), float(k)) + fathom_worley_point(h));
                least = min(least, d.x * d.x + d.y * d.y + d.z * d.z);
            }
    return sqrt(least);
}

$# A cell's spots, at most eight, are written out: as a loop's turns they would add up with the march's
$# to more than llvmpipe grants a shader (iterations_together).
$helper fathom_spot_noise needs fathom_worley_point fathom_hash_more
float fathom_spot(vec3 x, vec3 corner, inout uint h, bool there) {
    h = fathom_hash_more(h, 1u);
    vec3 d = x - (corner + fathom_worley_point(h));
    float t = max(1.0 - (d.x * d.x + d.y * d.y + d.z * d.z), 0.0);
    h = fathom_hash_more(h, 2u);
    return mix(0.0, (fathom_unit(h) * 2.0 - 1.0) * (t * t * t), there);
}

float fathom_spot_noise(vec3 p, float radius, float density) {
    float n = clamp(density, 0.0, 8.0);
    vec3 q = p / max(radius, 1e-6);
    vec3 whole = floor(q);
    uvec3 cell = fathom_lattice(whole);
    vec3 x = q - whole;
    float sum = 0.0;
    for (int k = -1; k <= 1; ++k)
        for (int j = -1; j <= 1; ++j)
            for (int i = -1; i <= 1; ++i) {
                uint h = fathom_hash_lattice(cell + uvec3(uint(i), uint(j), uint(k)), 0x3c6ef372u);
                int count = int(floor(n + fathom_unit(h)));
                vec3 corner = vec3(float(i), float(j), float(k));
                sum += fathom_spot(x, corner, h, count > 0);
                sum += fathom_spot(x, corner, h, count > 1);
                if (count > 2) {
                    sum += fathom_spot(x, corner, h, true);
                    sum += fathom_spot(x, corner, h, count > 3);
                }
                if (count > 4) {
                    sum += fathom_spot(x, corner, h, true);
                    sum += fathom_spot(x, corner, h, count > 5);
                    sum += fathom_spot(x, corner, h, count > 6);
                    sum += fathom_spot(x, corner, h, count > 7);
                }
            }
    return sum / sqrt(max(n, 1.0));
}
