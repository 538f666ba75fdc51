$# Needs cache_hashing.
// Whether the key had a place before this frame.
bool fathom_known(ivec4 key) {
    ivec3 high = key.xyz >> fathom_cache_bits & $HIGH_MASK;
    uint tag = uint(high.x | high.y << $HIGH_BITS | high.z << (2 * $HIGH_BITS));
    for (int age = 0; age < fathom_cache_ages; ++age) {
        uvec2 found = texelFetch(fathom_cache_index, fathom_cache_slot(key, age), 0).xy;
        if ((found.x & 0x7fffffffu) == tag && found.y >> $PLACE_BITS == uint(key.w | age << 8)) return true;
    }
    return false;
}
