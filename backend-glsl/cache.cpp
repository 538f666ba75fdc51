// See cache.h. Nothing here waits for the CPU: the passes follow each other on the card, with
// barriers between.
//
// Why no place is ever lost and no key found half made. A place is in exactly one of three: an
// entry of the hash, the ring between Head and Tail, the hand of one invocation. Entries change by
// compare-and-swap alone: who swaps one out has it in hand, and puts it in at its next slot or its
// place into the ring. A key is written before the entry that names it, its corners before the next
// frame reads; entries of this frame are fresh, so nobody moves them. Two pixels that miss the same
// cell meet at its first slot that is not fresh: one wins, the other sees the key there.
#include "backend-glsl/cache.h"

#include "backend-glsl/fill.h"
#include "backend-glsl/module.h"

namespace fathom::glsl {

namespace {

constexpr const char *hashing = R"(
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
)";

constexpr const char *look_up = R"(
// Defined by a host that runs the passes of the noise cache: then this text reads kept values alone, and a pixel that
// wants one which is absent is left to the text without the definition, which computes every field.
#ifdef FATHOM_CACHE
uniform int fathom_cache_bits = 0, fathom_cache_ages = 4;
uniform float fathom_cache_least = 1.0; // cells that are narrower than so many pixels are not looked for
uniform int fathom_cache_fields[$COUNT];
uniform usampler3D fathom_cache_index;
uniform sampler3D fathom_cache_pool;
uniform sampler3D fathom_cache_wide;

bool fathom_absent = false;             // a value was absent: this pixel is not finished
float fathom_width = 0.0;               // of a pixel, where the ray is
ivec4 fathom_miss = ivec4(0, 0, 0, -1); // the key that was absent
uint fathom_hits = 0u;
)";

constexpr const char *kept = R"(
// Whether the field's value at p is in the cache, and where in the pool.
bool fathom_kept(vec3 p, float cell, int field, out vec3 at) {
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
#ifdef FATHOM_CACHE_LEARN
// Defined where every field is computed of what the kept values left over: of all that such a pixel asks, one by chance
// is asked for. So the pixels of a frame together ask for what lies all along their rays, not for the next cell alone.
uniform int fathom_cache_bits = 0;
uniform float fathom_cache_least = 1.0;
uniform uint fathom_cache_frame = 0u;
uniform int fathom_cache_fields[$COUNT];

ivec4 fathom_wish = ivec4(0, 0, 0, -1);
uint fathom_asks = 0u, fathom_random = 0u;

void fathom_ask(vec3 p, float cell, int field) {
    vec3 q = p / cell;
    if (!all(lessThan(abs(q), vec3(float($HIGHEST << fathom_cache_bits))))) return;
    if (cell < fathom_cache_least * fathom_width) return;
    if (fathom_asks == 0u) {
        uvec2 pixel = uvec2(gl_FragCoord.xy);
        fathom_random = pixel.x * 0x9e3779b1u ^ pixel.y * 0x85ebca77u ^ fathom_cache_frame * 0xc2b2ae3du;
        fathom_random = (fathom_random ^ fathom_random >> 16u) * 0x7feb352du;
        fathom_random ^= fathom_random >> 15u;
    }
    ++fathom_asks;
    fathom_random = fathom_random * 1664525u + 1013904223u;
    // The n-th takes the place of the one before with a chance of 1/n: then all are as likely.
    if (float(fathom_random >> 8u) * float(fathom_asks) < 16777216.0) fathom_wish = ivec4(ivec3(floor(q)), field);
}
#endif
#endif
)";

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
uniform isampler2D fathom_cache_wishes;
uniform usampler3D fathom_cache_index; // of the frame before: while places change hands the hash does not tell all
layout(r32ui) coherent uniform uimage3D fathom_cache_hash;
layout(rgba32i) coherent uniform iimage3D fathom_cache_keys;
layout(r32ui) coherent uniform uimage3D fathom_cache_free;
layout(r32ui) writeonly uniform uimage3D fathom_cache_changed;
layout(r32ui) coherent uniform uimageBuffer fathom_cache_counts;
layout(location = 0) out uint fathom_reserved;
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

void main() {
    fathom_reserved = $NOWHERE;
    ivec4 missed = texelFetch(fathom_cache_misses, ivec2(gl_FragCoord.xy), 0);
    if (missed.w < 0) discard;
    ivec4 key = texelFetch(fathom_cache_wishes, ivec2(gl_FragCoord.xy), 0);
    if (key.w < 0 || fathom_known(key)) key = missed;
    bool there = false;
    for (int age = 0; age < fathom_cache_ages && !there; ++age) {
        uint entry = imageLoad(fathom_cache_hash, fathom_cache_slot(key, age)).x;
        if (!fathom_fresh(entry)) break;
        there = fathom_is(entry, key);
    }
    if (there) discard;
    uint place = fathom_take(key);
    if (place == $NOWHERE) {
        fathom_count($FULL);
        return;
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
                return;
            }
            ++age;
            continue;
        }
        uint entry = fathom_entry(place, age, fathom_cache_frame);
        if (imageAtomicCompSwap(fathom_cache_hash, slot, there, entry) != there) continue;
        fathom_changed(slot);
        fathom_count($INSERTED);
        fathom_reserved = place;
        fathom_carry(there);
        return;
    }
    fathom_give_back(place);
    fathom_count($CROWDED);
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

void main() {
    uint index = texelFetch(fathom_cache_places, ivec2(gl_FragCoord.xy), 0).x;
    if (index == $NOWHERE) return;
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

std::string whole(const std::array<int, 3> &v) {
    return "ivec3(" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
           std::to_string(v[2]) + ")";
}

std::string word(std::uint32_t value) { return std::to_string(value) + "u"; }

using Values = std::map<std::string, std::string, std::less<>>;

Values numbers() {
    std::string shifts;
    for (const auto &shift : cache_shifts) shifts += (shifts.empty() ? "" : ", ") + whole(shift);
    const auto at = [](Count count) { return std::to_string(static_cast<int>(count)); };
    return {{"AGES", std::to_string(cache_ages)},
            {"SHIFTS", shifts},
            {"FIELD_SHIFT", whole(cache_field_shift)},
            {"PLACES", word((1u << cache_place_bits) - 1)},
            {"PLACE_BITS", word(cache_place_bits)},
            {"EMPTY", word(cache_empty)},
            {"NOWHERE", word(cache_nowhere)},
            {"REFUSED", std::to_string(cache_refused)},
            {"HIGH_BITS", std::to_string(cache_high_bits)},
            {"HIGH_MASK", std::to_string((1 << cache_high_bits) - 1)},
            {"HIGHEST", std::to_string(1 << (cache_high_bits - 1))},
            {"HEAD", at(Count::Head)},
            {"TAIL", at(Count::Tail)},
            {"LIMIT", at(Count::Limit)},
            {"INSERTED", at(Count::Inserted)},
            {"EVICTED", at(Count::Evicted)},
            {"DELETED", at(Count::Deleted)},
            {"CROWDED", at(Count::Crowded)},
            {"FULL", at(Count::Full)},
            {"SWEPT", at(Count::Swept)},
            {"CHANGED", at(Count::Changed)}};
}

std::string filled(std::string_view form) {
    Values values = numbers();
    values["HASHING"] = fill(hashing, values);
    values["COUNTS"] = fill(counts, values);
    return fill(form, values);
}

const char *components_of(ir::Type type) {
    if (type == ir::Type::Vec3) return ".xyz";
    return type == ir::Type::Vec4 ? "" : ".x";
}

} // namespace

std::string cache_look_up(std::span<const KeptText> fields) {
    Values values = numbers();
    values["COUNT"] = std::to_string(fields.size());
    return fill(look_up, values) + fill(hashing, values) + fill(kept, values);
}

std::string cache_reader(const KeptText &field, std::size_t number) {
    const bool wide = field.type != ir::Type::Float;
    const std::string type = glsl_type(field.type);
    return "\n" + type + " " + field.function +
           "_kept(vec3 p) {\n#ifdef FATHOM_CACHE\n    vec3 at;\n    if (fathom_kept(p, " +
           float_literal(static_cast<float>(field.cell)) + ", fathom_cache_fields[" +
           std::to_string(number) + "], at)) return textureLod(" +
           (wide ? "fathom_cache_wide" : "fathom_cache_pool") + ", at, 0.0)" +
           components_of(field.type) + ";\n    return " + type +
           "(0.0);\n#else\n#ifdef FATHOM_CACHE_LEARN\n    fathom_ask(p, " +
           float_literal(static_cast<float>(field.cell)) + ", fathom_cache_fields[" +
           std::to_string(number) + "]);\n#endif\n    return " + field.function +
           "(p);\n#endif\n}\n";
}

std::string cache_outputs() {
    return "#ifdef FATHOM_CACHE\n"
           "layout(location = 2) out ivec4 fathom_missed;\n"
           "layout(location = 3) out uvec2 fathom_counted;\n"
           "#elif defined(FATHOM_CACHE_LEARN)\n"
           "layout(location = 2) out ivec4 fathom_wished;\n"
           "#endif\n";
}

std::string cache_output() {
    return "#ifdef FATHOM_CACHE\n"
           "    fathom_missed = fathom_miss;\n"
           "    fathom_counted = uvec2(fathom_hits, fathom_miss.w >= 0 ? 1u : fathom_absent ? 2u : "
           "0u);\n"
           "    gl_FragDepth = fathom_absent ? 1.0 : 0.0;\n"
           "#elif defined(FATHOM_CACHE_LEARN)\n"
           "    fathom_wished = fathom_wish;\n"
           "#endif\n";
}

std::string with_cache(const std::string &text, const char *defined) {
    const std::size_t line = text.find('\n') + 1; // after the version
    return text.substr(0, line) + "#define " + defined + "\n" + text.substr(line);
}

std::string cache_fill(std::span<const KeptText> fields) {
    Values values = numbers();
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
