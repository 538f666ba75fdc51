$# What the passes count, and the list of changed slots. Needs cache_hashing.

void fathom_count(int which) {
    imageAtomicAdd(fathom_cache_counts, which, 1u);
}

// A slot got another entry: publish it. Where there are more than the list has room for, all are.
void fathom_changed(ivec3 slot) {
    uint at = imageAtomicAdd(fathom_cache_counts, $CHANGED, 1u);
    if (at >> (3 * fathom_cache_bits) != 0u) return;
    int index = slot.x | slot.y << fathom_cache_bits | slot.z << (2 * fathom_cache_bits);
    imageStore(fathom_cache_changed, fathom_cache_place(at), uvec4(uint(index)));
}

void fathom_give_back(uint entry) {
    uint at = imageAtomicAdd(fathom_cache_counts, $TAIL, 1u);
    imageStore(fathom_cache_free, fathom_cache_place(at), uvec4(entry & $PLACES));
}
