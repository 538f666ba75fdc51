$# Where a key of the noise cache lies in the hash, and where a place lies in the pool (cache.h).

const ivec3 fathom_cache_shifts[$AGES] = ivec3[]($SHIFTS);

// Where the key (cell, field) lies at that age.
ivec3 fathom_cache_slot(ivec4 key, int age) {
    int last = (1 << fathom_cache_bits) - 1;
    return (key.xyz + fathom_cache_shifts[age] + key.w * $FIELD_SHIFT) & last;
}

ivec3 fathom_cache_place(uint index) {
    int last = (1 << fathom_cache_bits) - 1;
    int place = int(index & $PLACES);
    return ivec3(place, place >> fathom_cache_bits, place >> (2 * fathom_cache_bits)) & last;
}
