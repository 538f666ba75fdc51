// What is proved of the fields that the noise cache may keep: how steep they are and how far their
// values lie apart, wherever they are asked. So the error of interpolation has a bound, and a kept
// field is not steeper than the field that it stands for (docs/noise-cache.md).
#include "typecheck/proof/prover.h"

#include "ir/cost.h"

#include <cmath>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;
using ir::rounding::up;

void Prover::report_not_kept(ir::CacheId id) {
    const ir::Function &field = graph.function(graph.cache(id).field);
    const auto say = [&](const std::string &why) {
        diagnostics.add(Code::NotKept, field.origin, "this field is computed all the same: " + why);
    };
    switch (ir::kept(scene, id)) {
    case ir::Kept::Yes: return;
    case ir::Kept::Cheap:
        say("that takes about " + number_text(ir::cost_of(graph, field.result)) +
            " ns a point, a look-up in the noise cache " + number_text(ir::look_up_cost));
        return;
    case ir::Kept::Moving: say("it moves with `time`, so that no value stays right"); return;
    case ir::Kept::Steep:
        say("no bound of its slope holds everywhere, so a kept value could be off by anything");
        return;
    }
}

void Prover::know_caches() {
    scene.caches.assign(graph.cache_count(), {});
    for (std::size_t i = 0; i < graph.cache_count(); ++i) {
        const ir::FunctionId field = graph.cache(ir::CacheId{i}).field;
        const ir::Type type = graph[graph.function(field).result].type;
        const NodeId whole =
            graph.make(Op::Cached, type, {graph.point()}, static_cast<std::uint32_t>(i));
        double slopes = 0, spans = 0; // squared
        for (int c = 0; c < ir::components(type); ++c) {
            Budget budget;
            budget.instructions = options.field_instructions / 4;
            const NodeId part = type == ir::Type::Float ? whole : graph.component(whole, c);
            const FieldBound bound =
                bound_field(flattening, ranges, part, {Cell{}, nullptr}, budget);
            const double span =
                bound.value.finite() ? bound.value.hi - bound.value.lo : ir::rounding::infinity;
            slopes = up(slopes + up(bound.lipschitz * bound.lipschitz));
            spans = up(spans + up(span * span));
        }
        scene.caches[i] = {up(std::sqrt(slopes)), up(std::sqrt(spans))};
        report_not_kept(ir::CacheId{i});
    }
}

} // namespace fathom::proof
