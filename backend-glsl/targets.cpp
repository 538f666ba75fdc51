#include "backend-glsl/targets.h"

namespace fathom::glsl {

namespace {

constexpr TargetTraits rows[] = {
#define FATHOM_TARGET(id, ...) {__VA_ARGS__},
#include "backend-glsl/targets.def"
#undef FATHOM_TARGET
};

constexpr Target targets[] = {
#define FATHOM_TARGET(id, ...) Target::id,
#include "backend-glsl/targets.def"
#undef FATHOM_TARGET
};

} // namespace

const TargetTraits &traits_of(Target target) { return rows[static_cast<std::size_t>(target)]; }

std::span<const Target> all_targets() { return targets; }

std::optional<Target> target_by_name(std::string_view name) {
    for (const Target target : targets)
        if (name == traits_of(target).name) return target;
    return std::nullopt;
}

} // namespace fathom::glsl
