
// Computes and stores the corners of every cell that got a place. Draw one triangle over the picture.
uniform int fathom_cache_bits;
uniform int fathom_cache_fields[$COUNT];
uniform usampler2D fathom_cache_places; // what the pass before reserved
layout(rgba32i) uniform iimage3D fathom_cache_keys;
layout(r32f) writeonly uniform image3D fathom_cache_pool;
layout(rgba32f) writeonly uniform image3D fathom_cache_wide;

ivec3 fathom_cache_place(uint index) {
    int last = (1 << fathom_cache_bits) - 1;
    int place = int(index & $PLACES);
    return ivec3(place, place >> fathom_cache_bits, place >> (2 * fathom_cache_bits)) & last;
}

vec4 fathom_value(int which, vec3 p) {
$VALUES
    return vec4(0.0);
}

void fathom_fill(uint index) {
    ivec3 place = fathom_cache_place(index);
    ivec4 key = imageLoad(fathom_cache_keys, place);
    int which = 0;
    for (int i = 0; i < $COUNT; ++i)
        if (fathom_cache_fields[i] == key.w) which = i;
    float cell = $CELLS[which];
    vec4 corners[8];
    for (int i = 0; i < 8; ++i) {
        ivec3 corner = ivec3(i & 1, i >> 1 & 1, i >> 2);
        corners[i] = fathom_value(which, vec3(key.xyz + corner) * cell);
        if ($WIDE[which]) imageStore(fathom_cache_wide, 2 * place + corner, corners[i]);
        else imageStore(fathom_cache_pool, 2 * place + corner, corners[i]);
    }
    // Between its corners the cached field's slope along x does not depend on x, and so on: the square of its steepness
    // is convex in each of x, y and z and so greatest at a corner, where it is that of the three edges that meet there.
    // Where that is more than what is proved of the field, steps could be too long: it is computed there.
    float steep = 0.0;
    for (int i = 0; i < 8; ++i)
        steep = max(steep, length(vec3(distance(corners[i], corners[i ^ 1]), distance(corners[i], corners[i ^ 2]),
                                       distance(corners[i], corners[i ^ 4]))));
    if (!(steep <= cell * $SLOPES[which])) imageStore(fathom_cache_keys, place, ivec4(key.xyz, key.w | $REFUSED));
}

void main() {
    uvec4 places = texelFetch(fathom_cache_places, ivec2(gl_FragCoord.xy), 0);
    for (int i = 0; i < $WISHES; ++i)
        if (places[i] != $NOWHERE) fathom_fill(places[i]);
}
