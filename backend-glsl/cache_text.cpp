// See cache_text.h.
#include "backend-glsl/cache_text.h"

#include "backend-glsl/fill.h"

namespace fathom::glsl {

namespace {

constexpr const char *hashing_text = R"(
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

constexpr const char *known_text = R"(// Whether the key had a place before this frame.
bool fathom_known(ivec4 key) {
    ivec3 high = key.xyz >> fathom_cache_bits & $HIGH_MASK;
    uint tag = uint(high.x | high.y << $HIGH_BITS | high.z << (2 * $HIGH_BITS));
    for (int age = 0; age < fathom_cache_ages; ++age) {
        uvec2 found = texelFetch(fathom_cache_index, fathom_cache_slot(key, age), 0).xy;
        if ((found.x & 0x7fffffffu) == tag && found.y >> $PLACE_BITS == uint(key.w | age << 8)) return true;
    }
    return false;
}
)";

std::string whole(const std::array<int, 3> &v) {
    return "ivec3(" + std::to_string(v[0]) + ", " + std::to_string(v[1]) + ", " +
           std::to_string(v[2]) + ")";
}

std::string word(std::uint32_t value) { return std::to_string(value) + "u"; }

} // namespace

Values cache_numbers() {
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
            {"CHANGED", at(Count::Changed)},
            {"PAID", at(Count::Paid)},
            {"WASTED", at(Count::Wasted)},
            {"LEFT", at(Count::Left)},
            {"STEPS", at(Count::Steps)},
            {"SAMPLED", std::to_string(cache_sampled)},
            {"WISHES", std::to_string(cache_wishes)},
            {"MANY", std::to_string(cache_many)}};
}

std::string cache_hashing() { return fill(hashing_text, cache_numbers()); }
std::string cache_known() { return fill(known_text, cache_numbers()); }

} // namespace fathom::glsl
