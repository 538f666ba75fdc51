// What is proved of the fields that the noise cache may keep: how steep they are and how far their
// values lie apart, wherever they are read. So the error of interpolation has a bound. The shapes
// that read such a field are proved with what is known of it everywhere and not with what its text
// says where they lie: the cached field, which is interpolated, is as steep as the former allows
// and may be steeper than the latter (docs/noise-cache.md).
#include "proof/prover.h"

#include "ir/passes/cost.h"

#include <cmath>
#include <unordered_set>

namespace fathom::proof {

using ir::NodeId;
using ir::Op;
using ir::rounding::up;

void Prover::report_not_cached(ir::CacheId id) {
    const ir::Function &field = graph.function(graph.cache(id).field);
    const auto say = [&](const std::string &why) {
        diagnostics.add(Code::NotCached, field.origin,
                        "this field is computed all the same: " + why);
    };
    switch (ir::cached(scene, id)) {
    case ir::Cacheable::Yes: return;
    case ir::Cacheable::Cheap:
        say("that takes about " + number_text(ir::cost_of(graph, field.result)) +
            " ns a point, a look-up in the noise cache " + number_text(ir::look_up_cost));
        return;
    case ir::Cacheable::Ridged:
        say("at the ridges of Worley noise cells are steeper than the noise and are not cached; "
            "alone, at " +
            number_text(ir::cost_of(graph, field.result)) +
            " ns a point, it is too cheap for the others to pay");
        return;
    case ir::Cacheable::Moving: say("it moves with `time`, so that no value stays right"); return;
    case ir::Cacheable::Steep:
        say("no bound of its slope holds everywhere, so a cached value could be off by anything");
        return;
    }
}

// Between the corners of a cell a field is at most sqrt(3) times as steep as it is: where it has a
// ridge, the edges along x, y and z may each be as steep as the field. A cell that is steeper than
// what is stated of the field is not cached. Of most noise that is none, since what is proved of it
// is far more than it has; but Worley noise is the distance to a point and nearly everywhere as
// steep as proved, so cells by its ridges would all go: what reads it is allowed this much more.
constexpr double ridge_allowance = 1.15;

void Prover::know_caches() {
    scene.caches.assign(graph.cache_count(), {});
    ranges.caches.assign(graph.cache_count(), {});
    flattening.cached.assign(graph.cache_count(), false);
    for (std::size_t i = 0; i < graph.cache_count(); ++i) {
        const ir::FunctionId field = graph.cache(ir::CacheId{i}).field;
        const NodeId result = graph.function(field).result;
        const ir::Type type = graph[result].type;
        const NodeId whole =
            graph.make(Op::Cached, type, {graph.point()}, static_cast<std::uint32_t>(i));
        Ranges::Cached &known = ranges.caches[i];
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
            known.values[static_cast<std::size_t>(c)] = bound.value;
        }
        known.slope = up(std::sqrt(slopes));
        if (ir::reads_worley(graph, result)) known.slope = up(known.slope * ridge_allowance);
        scene.caches[i] = {known.slope, up(std::sqrt(spans))};
        known.cached = ir::cached(scene, ir::CacheId{i}) == ir::Cacheable::Yes;
        flattening.cached[i] = known.cached;
        report_not_cached(ir::CacheId{i});
    }
}

} // namespace fathom::proof
