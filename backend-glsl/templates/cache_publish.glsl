#version 420 core
// The last pass: what a look-up reads, from hash and keys, of the slots that changed. Draw one triangle over anything;
// its pixels share the work.
uniform int fathom_cache_bits;
uniform int fathom_cache_width, fathom_cache_height; // of what is drawn over
uniform usampler3D fathom_cache_hash;
uniform isampler3D fathom_cache_keys;
uniform usampler3D fathom_cache_changed;
layout(r32ui) readonly uniform uimageBuffer fathom_cache_counts;
layout(rg32ui) writeonly uniform uimage3D fathom_cache_index;
$include cache_hashing
void fathom_publish(ivec3 slot) {
    uint entry = texelFetch(fathom_cache_hash, slot, 0).x;
    uvec2 index = uvec2($EMPTY);
    if (entry != $EMPTY) {
        ivec4 key = texelFetch(fathom_cache_keys, fathom_cache_place(entry), 0);
        ivec3 high = key.xyz >> fathom_cache_bits & $HIGH_MASK;
        index.x = uint(high.x | high.y << $HIGH_BITS | high.z << (2 * $HIGH_BITS));
        if (key.w > 255) index.x |= 0x80000000u;
        index.y = (entry & $PLACES) | uint(key.w & 255) << $PLACE_BITS | (entry >> $PLACE_BITS & 7u) << 29u;
    }
    imageStore(fathom_cache_index, slot, uvec4(index, 0u, 0u));
}

void main() {
    uint changed = imageLoad(fathom_cache_counts, $CHANGED).x;
    uint cells = 1u << (3 * fathom_cache_bits);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    uint stride = uint(fathom_cache_width * fathom_cache_height);
    for (uint i = uint(pixel.x + fathom_cache_width * pixel.y); i < min(changed, cells); i += stride) {
        uint slot = i;
        if (changed <= cells) slot = texelFetch(fathom_cache_changed, fathom_cache_place(i), 0).x;
        fathom_publish(fathom_cache_place(slot));
    }
}
