// Whether look-ups in the noise cache pay, by the work that frames counted: the same on every card
// and every run (cache_choice.h reads the clock instead, for what no count sees). A view whose
// cells are narrower than pixels, or that leaves them behind with every frame, is drawn exactly,
// and tried again at growing intervals. Plain numbers: knows no GL.
#pragma once

namespace fathom::gl {

// Of the pixels that were weighed (glsl::Count), and whether the frame learnt anything.
struct CacheWork {
    double paid = 0, wasted = 0, left = 0, steps = 0;
    bool learnt = false;
};

// ir/passes/cost.h's, in nanoseconds a point: the cheapest of the cached fields, and the whole
// scene's field with all of them.
struct CachePrices {
    double field = 0, whole = 0;
};

// A look-up of a pixel that was finished saved the field. In one that was not it was in vain, with
// all else of that point; and such a pixel is begun twice, beside others that are not. What is
// gained has to make up for what keeping costs everywhere, a twentieth of the picture.
bool pays(const CacheWork &work, const CachePrices &prices);

// What the last frames counted, and when to try the cache again.
struct CacheWorth {
    static constexpr int learning = 12, trial = 8; // frames that do not pay, until it is left
    static constexpr int first_gap = 64, longest_gap = 1024; // exact frames before a trial
    bool exact = false;
    int frames = 0; // exact ones; or cached ones that did not pay, one after the other
    int budget = learning;
    int gap = first_gap;
};

// A cache that gives up more than a 32nd of what it has room for, frame after frame, keeps nothing
// for long: what a view learns pushes out what it learnt before. True where a larger one is wanted.
struct CacheGrowth {
    static constexpr int patience = 2, share = 32;
    int frames = 0; // one after the other
};
bool too_small(CacheGrowth &growth, double lost, double cells);

// Whether the next frame looks values up.
bool looks_up_next(const CacheWorth &worth);
// A frame was drawn without the cache.
void drew_exactly(CacheWorth &worth);
void drew_cached(CacheWorth &worth); // begins a trial, where it is one
void judged(CacheWorth &worth, const CacheWork &work, const CachePrices &prices); // a cached frame

} // namespace fathom::gl
