// The passes after the picture; see cache.h. Nothing here waits for the CPU: the passes follow each
// other on the card, with barriers between.
//
// Why no place is ever lost and no key found half made. A place is in exactly one of three: an
// entry of the hash, the ring between Head and Tail, the hand of one invocation. Entries change by
// compare-and-swap alone: who swaps one out has it in hand, and puts it in at its next slot or its
// place into the ring. A key is written before the entry that names it, its corners before the next
// frame reads; entries of this frame are fresh, so nobody moves them. Two pixels that miss the same
// cell meet at its first slot that is not fresh: one wins, the other sees the key there.
#include "backend-glsl/cache_text.h"
#include "backend-glsl/fill.h"
#include "backend-glsl/module.h"

namespace fathom::glsl {

namespace {

constexpr const char *counts = R"(
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
)";

constexpr const char *reserve = R"(#version 420 core
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
$HASHING$COUNTS
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

$KNOWN
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
)";

constexpr const char *fill_pass = R"(
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
$VALUES    return vec4(0.0);
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
    // Between its corners the kept field's slope along x does not depend on x, and so on: the square of its steepness
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
)";

constexpr const char *sweep = R"(#version 420 core
// Gives up every cell of one field, with -1 of all, with -2 of none; and what is older than the
// largest age, which no look-up finds any more. Draw one triangle over 2^fathom_cache_bits^3 pixels in all.
uniform int fathom_cache_bits, fathom_cache_ages, fathom_cache_gone;
uniform int fathom_cache_width; // of what is drawn over
layout(r32ui) uniform uimage3D fathom_cache_hash;
layout(rgba32i) uniform iimage3D fathom_cache_keys;
layout(r32ui) uniform uimage3D fathom_cache_free;
layout(r32ui) writeonly uniform uimage3D fathom_cache_changed;
layout(r32ui) coherent uniform uimageBuffer fathom_cache_counts;
$HASHING$COUNTS
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
)";

constexpr const char *publish = R"(#version 420 core
// The last pass: what a look-up reads, from hash and keys, of the slots that changed. Draw one triangle over anything;
// its pixels share the work.
uniform int fathom_cache_bits;
uniform int fathom_cache_width, fathom_cache_height; // of what is drawn over
uniform usampler3D fathom_cache_hash;
uniform isampler3D fathom_cache_keys;
uniform usampler3D fathom_cache_changed;
layout(r32ui) readonly uniform uimageBuffer fathom_cache_counts;
layout(rg32ui) writeonly uniform uimage3D fathom_cache_index;
$HASHING
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
)";

constexpr const char *tint = R"(#version 420 core
// Misses in red, to be blended over the picture by its alpha.
uniform isampler2D fathom_cache_misses;
layout(location = 0) out vec4 fathom_color;
void main() {
    if (texelFetch(fathom_cache_misses, ivec2(gl_FragCoord.xy), 0).w < 0) discard;
    fathom_color = vec4(1.0, 0.0, 0.0, 0.8);
}
)";

std::string filled(std::string_view form) {
    Values values = cache_numbers();
    values["HASHING"] = cache_hashing();
    values["KNOWN"] = cache_known();
    values["COUNTS"] = fill(counts, values);
    return fill(form, values);
}

} // namespace

std::string cache_fill(std::span<const KeptText> fields) {
    Values values = cache_numbers();
    values["COUNT"] = std::to_string(fields.size());
    std::string cases, cells, slopes, wide;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const KeptText &field = fields[i];
        const char *rest = field.type == ir::Type::Float  ? ", 0.0, 0.0, 0.0"
                           : field.type == ir::Type::Vec3 ? ", 0.0"
                                                          : "";
        cases += "    if (which == " + std::to_string(i) + ") return vec4(" + field.function +
                 "(p)" + rest + ");\n";
        const std::string comma = i ? ", " : "";
        cells += comma + float_literal(static_cast<float>(field.cell));
        slopes += comma + float_literal(static_cast<float>(field.slope));
        wide += comma + (field.type == ir::Type::Float ? "false" : "true");
    }
    const std::string size = "[" + std::to_string(fields.size()) + "](";
    values["VALUES"] = cases;
    values["CELLS"] = "float" + size + cells + ")";
    values["SLOPES"] = "float" + size + slopes + ")";
    values["WIDE"] = "bool" + size + wide + ")";
    return fill(fill_pass, values);
}

std::string cache_reserve() { return filled(reserve); }
std::string cache_publish() { return filled(publish); }
std::string cache_sweep() { return filled(sweep); }
std::string cache_tint() { return tint; }

} // namespace fathom::glsl
