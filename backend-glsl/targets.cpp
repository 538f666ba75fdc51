#include "backend-glsl/targets.h"

#include <cstddef>

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

} // namespace fathom::glsl
