#version 420 core
// Gives up every cell of one field, with -1 of all, with -2 of none; and what is older than the
// largest age, which no look-up finds any more. Draw one triangle over 2^fathom_cache_bits^3 pixels in all.
uniform int fathom_cache_bits, fathom_cache_ages, fathom_cache_gone;
uniform int fathom_cache_width; // of what is drawn over
layout(r32ui) uniform uimage3D fathom_cache_hash;
layout(rgba32i) uniform iimage3D fathom_cache_keys;
layout(r32ui) uniform uimage3D fathom_cache_free;
layout(r32ui) writeonly uniform uimage3D fathom_cache_changed;
layout(r32ui) coherent uniform uimageBuffer fathom_cache_counts;
$include cache_hashing
$include cache_counts
void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    ivec3 slot = fathom_cache_place(uint(pixel.x + fathom_cache_width * pixel.y));
    uint entry = imageLoad(fathom_cache_hash, slot).x;
    if (entry == $EMPTY) return;
    int field = imageLoad(fathom_cache_keys, fathom_cache_place(entry)).w & 255;
    bool old = int(entry >> $PLACE_BITS & 7u) >= fathom_cache_ages;
    if (fathom_cache_gone != -1 && field != fathom_cache_gone && !old) return;
    imageStore(fathom_cache_hash, slot, uvec4($EMPTY));
    fathom_changed(slot);
    fathom_give_back(entry);
    fathom_count($SWEPT);
}
