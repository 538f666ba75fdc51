#include "proof/present_bounds.h"

#include "ir/passes/param_reads.h"
#include "proof/prove.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::ShapeFact;
using ir::ShapeId;

namespace {

// By shape: whether it or a shape below it is proved in its own box alone, where its field is
// another one (ShapeFact::local). The box differs with the params' values.
std::vector<char> local_below(const ir::Scene &scene) {
    std::vector<char> out(scene.shapes.size(), 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
        out[i] = scene.facts[i].local;
        for (const ShapeId child : scene.shapes[ShapeId{i}].children) out[i] |= out[child.index];
    }
    return out;
}

bool reads_params(const ir::Scene &scene, ShapeId id) {
    ir::ParamReads reads(scene);
    reads.form(id);
    for (std::size_t i = 0; i < scene.params.size(); ++i)
        if (!scene.params[i].structural && reads.used(i)) return true;
    return false;
}

} // namespace

void add_present_bounds(ir::Scene &scene) {
    const std::vector<char> local = local_below(scene);
    std::vector<ShapeId> steep_ones;
    for (std::size_t i = 0; i < scene.facts.size(); ++i) {
        const ShapeFact &fact = scene.facts[i];
        if (fact.status == ir::ProofStatus::Proved && fact.lipschitz &&
            std::isfinite(fact.lipschitz_sup) && fact.lipschitz_sup > steep && !local[i])
            steep_ones.push_back(ShapeId{i});
    }
    std::ranges::stable_sort(steep_ones, std::ranges::greater{},
                             [&](ShapeId id) { return scene.facts[id.index].lipschitz_sup; });
    for (const ShapeId id : steep_ones) {
        if (scene.present_bounds.size() >= most_present_bounds) break;
        if (!reads_params(scene, id)) continue;
        ir::Param bound;
        bound.name = "bound";
        bound.has_range = bound.is_bound = true;
        bound.lo[0] = 1;
        bound.hi[0] = bound.value[0] = bound.initial[0] = unknown_bound;
        const auto index = static_cast<std::uint32_t>(scene.params.size());
        scene.params.push_back(bound);
        scene.present_bounds.push_back({id, index});
        ir::NodeId &formula = scene.facts[id.index].lipschitz;
        const ir::NodeId present = scene.graph.param(index, ir::Type::Float);
        formula = scene.graph.make(ir::Op::Min, {formula, present});
    }
}

std::optional<PresentBounds> prove_present_bounds(ir::Scene scene, BoundCache *cache, Stop *stop) {
    const std::vector<char> local_before = local_below(scene);
    Options options;
    options.times = ir::Interval(0, std::max(0.0, scene.render.time_end));
    options.test_assumptions = false;
    options.cache = cache;
    options.stop = stop;
    Diagnostics discarded; // the proof for the whole ranges has told them
    prove(scene, discarded, options);
    if (stop && stop->now()) return std::nullopt;
    const std::vector<char> local = local_below(scene);
    PresentBounds out;
    for (const ir::PresentBound &bound : scene.present_bounds) {
        const ShapeFact &fact = scene.facts[bound.shape.index];
        const bool holds = fact.status == ir::ProofStatus::Proved && fact.lipschitz &&
                           std::isfinite(fact.lipschitz_sup) && !local[bound.shape.index] &&
                           !local_before[bound.shape.index];
        out.values.push_back(holds ? std::max(1.0, fact.lipschitz_sup) : unknown_bound);
    }
    out.whole = scene.facts[scene.root.index].lipschitz_sup;
    return out;
}

} // namespace fathom::proof
