#include "render-gl/cache_choice.h"

#include <algorithm>

namespace fathom::gl {
namespace {

using State = CacheChoice::State;

void enter(CacheChoice &choice, State state) {
    choice.state = state;
    choice.frames = choice.slower = 0;
}

} // namespace

bool uses_cache_next(const CacheChoice &choice) {
    switch (choice.state) {
    case State::Learning:
        // At the end of it the exact frame is the measure, where there is none yet.
        return choice.frames < choice.budget || choice.exact_ms > 0;
    case State::Cached: return choice.since_exact < CacheChoice::check_every;
    case State::Exact: return choice.frames >= choice.gap;
    }
    return false;
}

void took(CacheChoice &choice, bool cached, double milliseconds) {
    if (cached) {
        choice.cached_ms = milliseconds;
        ++choice.since_exact;
    } else {
        // Smoothed where frames follow one another; the first after many cached ones counts alone.
        const bool fresh = choice.exact_ms == 0 || choice.since_exact > 0;
        choice.exact_ms = fresh ? milliseconds : 0.75 * choice.exact_ms + 0.25 * milliseconds;
        choice.since_exact = 0;
    }
    if (cached || choice.state == State::Exact) ++choice.frames;
    const bool better = choice.cached_ms > 0 && choice.cached_ms <= choice.exact_ms;
    switch (choice.state) {
    case State::Learning:
        if (cached && better && choice.exact_ms > 0) return enter(choice, State::Cached);
        if (choice.frames < choice.budget || choice.exact_ms == 0) return;
        if (!cached && better) return enter(choice, State::Cached);
        return enter(choice, State::Exact);
    case State::Cached:
        choice.slower = better ? 0 : choice.slower + 1;
        if (better) choice.gap = CacheChoice::first_gap;
        if (choice.slower >= CacheChoice::patience) enter(choice, State::Exact);
        return;
    case State::Exact:
        if (!cached) return;
        enter(choice, State::Learning);
        choice.budget = CacheChoice::trial;
        choice.frames = 1;
        choice.gap = std::min(2 * choice.gap, CacheChoice::longest_gap);
        return;
    }
}

} // namespace fathom::gl
