// Whether the next frame of a moving picture is drawn through the noise cache or exactly: by what
// frames of both kinds took. A cache that gains nothing (cells that every frame leaves behind,
// fields that are cheap on this card, cells that are refused) is left, and tried again at growing
// intervals, so that all trials together cost little. Plain numbers: knows no GL and no clock.
#pragma once

namespace fathom::gl {

struct CacheChoice {
    // A cache that knows nothing is slower than none; it is given this many frames to learn.
    static constexpr int learning = 16, trial = 12;
    static constexpr int first_gap = 128, longest_gap = 1024; // exact frames between two trials
    static constexpr int patience = 6;      // slower frames one after the other, until it is left
    static constexpr int check_every = 256; // cached frames, until an exact one is measured anew

    enum class State { Learning, Cached, Exact };
    State state = State::Learning;
    double exact_ms = 0;  // of the last exact frames; 0: not known
    double cached_ms = 0; // of the last cached frame
    int frames = 0;       // in this state
    int budget = learning;
    int slower = 0;
    int gap = first_gap;
    int since_exact = 0; // cached frames
};

bool uses_cache_next(const CacheChoice &choice);
// A frame was drawn, cached or not (whatever was wanted), and took so long.
void took(CacheChoice &choice, bool cached, double milliseconds);
// Another scene: what was measured says nothing of it.
inline void start_again(CacheChoice &choice) { choice = {}; }

} // namespace fathom::gl
