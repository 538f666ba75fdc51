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
#include "backend-glsl/module.h"
#include "backend-glsl/template.h"

#include <fmt/format.h>

namespace fathom::glsl {

std::string cache_fill(std::span<const CachedText> fields) {
    Values values = cache_numbers();
    values["COUNT"] = fmt::to_string(fields.size());
    std::string cases, cells, slopes, wide;
    for (std::size_t i = 0; i < fields.size(); ++i) {
        const CachedText &field = fields[i];
        const char *rest = field.type == ir::Type::Float  ? ", 0.0, 0.0, 0.0"
                           : field.type == ir::Type::Vec3 ? ", 0.0"
                                                          : "";
        cases +=
            fmt::format("    if (which == {}) return vec4({}(p){});\n", i, field.function, rest);
        const std::string comma = i ? ", " : "";
        cells += comma + float_literal(static_cast<float>(field.cell));
        slopes += comma + float_literal(static_cast<float>(field.slope));
        wide += comma + (field.type == ir::Type::Float ? "false" : "true");
    }
    const std::string size = fmt::format("[{}](", fields.size());
    values["VALUES"] = cases;
    values["CELLS"] = "float" + size + cells + ")";
    values["SLOPES"] = "float" + size + slopes + ")";
    values["WIDE"] = "bool" + size + wide + ")";
    return expand("cache_fill", values);
}

std::string cache_reserve() { return expand("cache_reserve", cache_numbers()); }
std::string cache_publish() { return expand("cache_publish", cache_numbers()); }
std::string cache_sweep() { return expand("cache_sweep", cache_numbers()); }
std::string cache_tint() { return expand("cache_tint", {}); }

} // namespace fathom::glsl
