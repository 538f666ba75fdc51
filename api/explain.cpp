#include "api/impl.h"

#include "backend-cpu/trace/march.h"
#include "backend-glsl/emit.h"
#include "proof/prove.h"

namespace fathom::v1 {

Explanation translated(proof::Explanation from, const Sources &sources) {
    Explanation to{std::move(from.operation),
                   std::move(from.rule),
                   from.factor,
                   from.lipschitz,
                   from.share,
                   std::move(from.region),
                   place_of(from.place, sources),
                   from.worst,
                   {}};
    for (proof::Explanation &child : from.children)
        to.children.push_back(translated(std::move(child), sources));
    return to;
}

std::optional<Explanation> explain(const Scene &scene) {
    return guarded(
        [&] {
            return std::optional(
                translated(proof::explain(ir_of(scene)), scene.impl().compilation->sources));
        },
        [](const Diagnostic &) { return std::optional<Explanation>(); });
}

Pruning pruning(const Scene &scene) {
    return guarded(
        [&] {
            const float shapes = cpu::shapes_of(ir_of(scene));
            return Pruning{shapes, shapes >= cpu::prune_from, glsl::prunable_rows(ir_of(scene))};
        },
        [](const Diagnostic &) { return Pruning(); });
}

} // namespace fathom::v1
