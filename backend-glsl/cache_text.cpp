// See cache_text.h.
#include "backend-glsl/cache_text.h"

#include "backend-glsl/template.h"

#include <fmt/format.h>

namespace fathom::glsl {

namespace {

std::string whole(const std::array<int, 3> &v) {
    return fmt::format("ivec3({}, {}, {})", v[0], v[1], v[2]);
}

std::string word(std::uint32_t value) { return fmt::format("{}u", value); }

} // namespace

Values cache_numbers() {
    std::string shifts;
    for (const auto &shift : cache_shifts) shifts += (shifts.empty() ? "" : ", ") + whole(shift);
    const auto at = [](Count count) { return fmt::to_string(static_cast<int>(count)); };
    return {{"AGES", fmt::to_string(cache_ages)},
            {"SHIFTS", shifts},
            {"FIELD_SHIFT", whole(cache_field_shift)},
            {"PLACES", word((1u << cache_place_bits) - 1)},
            {"PLACE_BITS", word(cache_place_bits)},
            {"EMPTY", word(cache_empty)},
            {"NOWHERE", word(cache_nowhere)},
            {"REFUSED", fmt::to_string(cache_refused)},
            {"HIGH_BITS", fmt::to_string(cache_high_bits)},
            {"HIGH_MASK", fmt::to_string((1 << cache_high_bits) - 1)},
            {"HIGHEST", fmt::to_string(1 << (cache_high_bits - 1))},
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
            {"SAMPLED", fmt::to_string(cache_sampled)},
            {"WISHES", fmt::to_string(cache_wishes)},
            {"MANY", fmt::to_string(cache_many)}};
}

} // namespace fathom::glsl
