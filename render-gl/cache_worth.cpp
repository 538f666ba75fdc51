#include "render-gl/cache_worth.h"

#include "ir/passes/cost.h"

#include <algorithm>

namespace fathom::gl {
namespace {

// Measured on llvmpipe (docs/noise-cache.md): a pixel that is left costs about so many evaluations
// more, since its neighbours wait while it is computed; a step of the march brings about five with
// it: gradients, shadows, occlusion.
constexpr double left_evaluations = 96, evaluations_a_step = 5, min_gain = 0.05;

} // namespace

bool pays(const CacheWork &work, const CachePrices &prices) {
    const double gain = work.paid * (prices.field - ir::look_up_cost) -
                        work.wasted * (prices.whole - prices.field + ir::look_up_cost) -
                        work.left * left_evaluations * prices.whole;
    return gain > min_gain * evaluations_a_step * work.steps * prices.whole;
}

bool too_small(CacheGrowth &growth, double lost, double cells) {
    growth.frames = CacheGrowth::share * lost > cells ? growth.frames + 1 : 0;
    return growth.frames >= CacheGrowth::patience;
}

bool looks_up_next(const CacheWorth &worth) { return !worth.exact || worth.frames >= worth.gap; }

void drew_exactly(CacheWorth &worth) {
    if (worth.exact) ++worth.frames;
}

void drew_cached(CacheWorth &worth) {
    if (!worth.exact) return;
    worth.exact = false;
    worth.frames = 0;
    worth.budget = CacheWorth::trial;
    worth.gap = std::min(2 * worth.gap, CacheWorth::longest_gap);
}

void judged(CacheWorth &worth, const CacheWork &work, const CachePrices &prices) {
    if (worth.exact) return;
    if (pays(work, prices)) {
        worth.frames = 0;
        worth.budget = CacheWorth::learning;
        worth.gap = CacheWorth::first_gap;
        return;
    }
    // Where nothing was learnt the next frame will be no better.
    if (++worth.frames < worth.budget && work.learnt) return;
    worth.exact = true;
    worth.frames = 0;
}

} // namespace fathom::gl
