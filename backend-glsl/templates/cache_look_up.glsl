$# Reading the noise cache in a picture (cache.h).

// FATHOM_CACHE is defined by a host that runs the passes of the noise cache: then this text reads cached values alone, and
// a pixel that wants one which is absent is left to the text with FATHOM_CACHE_LEARN, which computes every field.
#if defined(FATHOM_CACHE) || defined(FATHOM_CACHE_LEARN)
uniform int fathom_cache_bits = 0, fathom_cache_ages = 4;
uniform float fathom_cache_least = 1.0; // cells that are narrower than so many pixels are not looked for
uniform int fathom_cache_fields[$COUNT];
uniform usampler3D fathom_cache_index;
$include cache_hashing
#endif
#ifdef FATHOM_CACHE
uniform sampler3D fathom_cache_pool;
uniform sampler3D fathom_cache_wide;

bool fathom_absent = false;             // a value was absent: this pixel is not finished
float fathom_width = 0.0;               // of a pixel, where the ray is
ivec4 fathom_miss = ivec4(0, 0, 0, -1); // the key that was absent
uint fathom_hits = 0u;
vec4 fathom_start = vec4(0.0);

// The march at the beginning of a step. Up to the first value that it asks, both texts do the same: so the other one
// may go on from there.
void fathom_step(float t, float before, float stride, int steps) {
    if (fathom_hits == 0u) fathom_start = vec4(t, before, stride, float(steps));
}
void fathom_resume(inout float t, inout float before, inout float stride, inout int steps) {}

// Less than 0 where much of what the pixel asks is there.
float fathom_began() {
    return fathom_hits < $MANYu ? fathom_start.w : -1.0 - fathom_start.w;
}

// Whether the field's value at p is in the cache, and where in the pool.
bool fathom_cached(vec3 p, float cell, int field, out vec3 at) {
    at = vec3(0.0);
    vec3 q = p / cell;
    vec3 corner = floor(q);
    // Further out a cell's numbers do not fit, and float32 has few steps within a cell.
    bool counts = all(lessThan(abs(q), vec3(float($HIGHEST << fathom_cache_bits))));
    if (!counts || cell < fathom_cache_least * fathom_width) {
        fathom_absent = true;
        return false;
    }
    ivec4 key = ivec4(ivec3(corner), field);
    ivec3 high = key.xyz >> fathom_cache_bits & $HIGH_MASK;
    uint tag = uint(high.x | high.y << $HIGH_BITS | high.z << (2 * $HIGH_BITS));
    for (int age = 0; age < fathom_cache_ages; ++age) {
        uvec2 found = texelFetch(fathom_cache_index, fathom_cache_slot(key, age), 0).xy;
        if ((found.x & 0x7fffffffu) != tag || found.y >> $PLACE_BITS != uint(field | age << 8)) continue;
        if (found.x != tag) {
            fathom_absent = true;
            return false;
        }
        ++fathom_hits;
        at = (vec3(2 * fathom_cache_place(found.y)) + 0.5 + (q - corner)) / float(2 << fathom_cache_bits);
        return true;
    }
    fathom_absent = true;
    fathom_miss = key;
    return false;
}
#else
const bool fathom_absent = false;
float fathom_width = 0.0;
void fathom_step(float t, float before, float stride, int steps) {}
#ifdef FATHOM_CACHE_LEARN
// Defined where every field is computed of what the cached values left over: of all that such a pixel asks, $WISHES by
// chance are asked for. So the pixels of a frame together ask for what lies all along their rays, not for the next cell
// alone.
uniform uint fathom_cache_frame = 0u;
uniform sampler2D fathom_cache_starts; // where the picture of cached values first asked for one

ivec4 fathom_wishes[$WISHES], fathom_asked = ivec4(0, 0, 0, -1);
uint fathom_asks = 0u, fathom_random = 0u;
bool fathom_choosy = false; // most of it is known: asks only for what is not

void fathom_resume(inout float t, inout float before, inout float stride, inout int steps) {
    vec4 start = texelFetch(fathom_cache_starts, ivec2(gl_FragCoord.xy), 0);
    t = start.x;
    before = start.y;
    stride = start.z;
    fathom_choosy = start.w < 0.0;
    steps = int(fathom_choosy ? -1.0 - start.w : start.w);
}

$include cache_known
void fathom_ask(vec3 p, float cell, int field) {
    vec3 q = p / cell;
    if (!all(lessThan(abs(q), vec3(float($HIGHEST << fathom_cache_bits))))) return;
    if (cell < fathom_cache_least * fathom_width) return;
    ivec4 key = ivec4(ivec3(floor(q)), field);
    if (key == fathom_asked) return;
    fathom_asked = key;
    if (fathom_choosy && fathom_known(key)) return;
    if (fathom_asks == 0u) {
        uvec2 pixel = uvec2(gl_FragCoord.xy);
        fathom_random = pixel.x * 0x9e3779b1u ^ pixel.y * 0x85ebca77u ^ fathom_cache_frame * 0xc2b2ae3du;
        fathom_random = (fathom_random ^ fathom_random >> 16u) * 0x7feb352du;
        fathom_random ^= fathom_random >> 15u;
    }
    // The n-th takes the place of one of k before it with a chance of k/n: then all are as likely (a reservoir).
    uint at = fathom_asks++;
    if (at >= $WISHESu) {
        fathom_random = fathom_random * 1664525u + 1013904223u;
        at = uint(float(fathom_random >> 8u) / 16777216.0 * float(fathom_asks));
    }
    if (at < $WISHESu) fathom_wishes[at] = key;
}
#else
void fathom_resume(inout float t, inout float before, inout float stride, inout int steps) {}
#endif
#endif
