#version 420 core
// For every pixel that missed a cell, a place is reserved. Draw one triangle over the picture. What it discards
// changed nothing; where it discards all, no pass has to follow.
uniform int fathom_cache_bits, fathom_cache_ages;
uniform uint fathom_cache_frame; // counts the frames
uniform isampler2D fathom_cache_misses;
uniform isampler2DArray fathom_cache_wishes;
uniform usampler2D fathom_cache_tally; // what the picture counted of each pixel
uniform usampler3D fathom_cache_index; // of the frame before: while places change hands the hash does not tell all
layout(r32ui) coherent uniform uimage3D fathom_cache_hash;
layout(rgba32i) coherent uniform iimage3D fathom_cache_keys;
layout(r32ui) coherent uniform uimage3D fathom_cache_free;
layout(r32ui) writeonly uniform uimage3D fathom_cache_changed;
layout(r32ui) coherent uniform uimageBuffer fathom_cache_counts;
layout(location = 0) out uvec4 fathom_reserved; // a place for each wish
$include cache_hashing
$include cache_counts
uint fathom_entry(uint place, int age, uint frame) {
    return (place & $PLACES) | uint(age) << $PLACE_BITS | (frame & 255u) << 24u;
}

int fathom_age(uint entry) {
    return int(entry >> $PLACE_BITS & 7u);
}

// Came in this frame: nobody may move it.
bool fathom_fresh(uint entry) {
    return entry != $EMPTY && entry >> 24u == (fathom_cache_frame & 255u);
}

bool fathom_is(uint entry, ivec4 key) {
    ivec4 found = imageLoad(fathom_cache_keys, fathom_cache_place(entry));
    return found.xyz == key.xyz && (found.w & 255) == key.w;
}

$include cache_known
// A free place; where there is none, that of a key which lies where this one may.
uint fathom_take(ivec4 key) {
    uint limit = imageLoad(fathom_cache_counts, $LIMIT).x;
    uint at = imageAtomicAdd(fathom_cache_counts, $HEAD, 1u);
    if (int(limit - at) > 0) return imageLoad(fathom_cache_free, fathom_cache_place(at)).x;
    imageAtomicAdd(fathom_cache_counts, $HEAD, 0xffffffffu);
    for (int age = 0; age < fathom_cache_ages; ++age) {
        ivec3 slot = fathom_cache_slot(key, age);
        uint entry = imageLoad(fathom_cache_hash, slot).x;
        if (entry == $EMPTY || fathom_fresh(entry)) continue;
        if (imageAtomicCompSwap(fathom_cache_hash, slot, entry, $EMPTY) != entry) continue;
        fathom_changed(slot);
        fathom_count($DELETED);
        return entry & $PLACES;
    }
    return $NOWHERE;
}

// The evicted go on to their next slots, evicting in turn, until one finds an empty slot or is too old.
void fathom_carry(uint entry) {
    for (int turn = 0; turn < 64 && entry != $EMPTY; ++turn) {
        int age = fathom_age(entry) + 1;
        if (age >= fathom_cache_ages) break;
        ivec4 key = imageLoad(fathom_cache_keys, fathom_cache_place(entry));
        key.w &= 255;
        uint moved = fathom_entry(entry, age, entry >> 24u);
        ivec3 slot = fathom_cache_slot(key, age);
        uint there = imageLoad(fathom_cache_hash, slot).x;
        if (fathom_fresh(there)) {
            entry = moved;
            continue;
        }
        if (imageAtomicCompSwap(fathom_cache_hash, slot, there, moved) != there) continue;
        fathom_changed(slot);
        fathom_count($EVICTED);
        entry = there;
    }
    if (entry == $EMPTY) return;
    fathom_give_back(entry);
    fathom_count($DELETED);
}

// A place for the key, or $NOWHERE where it has one, or there is none.
uint fathom_reserve(ivec4 key, inout bool changed) {
    for (int age = 0; age < fathom_cache_ages; ++age) {
        uint entry = imageLoad(fathom_cache_hash, fathom_cache_slot(key, age)).x;
        if (!fathom_fresh(entry)) break;
        if (fathom_is(entry, key)) return $NOWHERE;
    }
    changed = true;
    uint place = fathom_take(key);
    if (place == $NOWHERE) {
        fathom_count($FULL);
        return $NOWHERE;
    }
    imageStore(fathom_cache_keys, fathom_cache_place(place), key);
    memoryBarrier();
    int age = 0;
    // Every turn without success another invocation had some, so this ends; the limit is for drivers' sake.
    for (int turn = 0; turn < 1024 && age < fathom_cache_ages; ++turn) {
        ivec3 slot = fathom_cache_slot(key, age);
        uint there = imageLoad(fathom_cache_hash, slot).x;
        if (fathom_fresh(there)) {
            if (fathom_is(there, key)) {
                fathom_give_back(place);
                return $NOWHERE;
            }
            ++age;
            continue;
        }
        uint entry = fathom_entry(place, age, fathom_cache_frame);
        if (imageAtomicCompSwap(fathom_cache_hash, slot, there, entry) != there) continue;
        fathom_changed(slot);
        fathom_count($INSERTED);
        fathom_carry(there);
        return place;
    }
    fathom_give_back(place);
    fathom_count($CROWDED);
    return $NOWHERE;
}

// What the look-ups of the picture were good for, by one pixel in $SAMPLED x $SAMPLED.
void fathom_weigh(ivec2 pixel) {
    if (any(notEqual(pixel % $SAMPLED, ivec2($SAMPLED / 2)))) return;
    uvec2 counted = texelFetch(fathom_cache_tally, pixel, 0).xy;
    bool finished = (counted.y & 3u) == 0u;
    imageAtomicAdd(fathom_cache_counts, $STEPS, counted.y >> 2);
    if (counted.x > 0u) imageAtomicAdd(fathom_cache_counts, finished ? $PAID : $WASTED, counted.x);
    if (!finished) fathom_count($LEFT);
}

void main() {
    fathom_reserved = uvec4($NOWHERE);
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    fathom_weigh(pixel);
    ivec4 missed = texelFetch(fathom_cache_misses, pixel, 0);
    if (missed.w < 0) discard;
    bool changed = false, wished = false;
    for (int i = 0; i < $WISHES; ++i) {
        ivec4 key = texelFetch(fathom_cache_wishes, ivec3(pixel, i), 0);
        if (key.w < 0 || fathom_known(key)) continue;
        wished = true;
        fathom_reserved[i] = fathom_reserve(key, changed);
    }
    if (!wished) fathom_reserved[0] = fathom_reserve(missed, changed);
    if (!changed) discard;
}
