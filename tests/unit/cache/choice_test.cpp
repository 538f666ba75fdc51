// When the cache is used and when it is left, on frames whose times are made up.
#include "render-gl/cache_choice.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

namespace fathom {
namespace {

// The time of all frames, over that of exact ones alone. `cached_ms` of how many cached frames
// there were since the cache knew nothing, which it does at first and after 30 exact frames; those
// take 10.
struct Run {
    double share = 0;
    int cached = 0; // of the last hundred
};
Run run(int frames, const std::function<double(int frame, int known)> &cached_ms) {
    gl::CacheChoice choice;
    double all = 0;
    int known = 0, exact = 0;
    Run result;
    for (int frame = 0; frame < frames; ++frame) {
        const bool cached = gl::uses_cache_next(choice);
        const double ms = cached ? cached_ms(frame, known) : 10;
        exact = cached ? 0 : exact + 1;
        known = cached ? known + 1 : exact > 30 ? 0 : known;
        gl::took(choice, cached, ms);
        all += ms;
        if (frame >= frames - 100) result.cached += cached;
    }
    result.share = all / (10.0 * frames);
    return result;
}

} // namespace

TEST_CASE("a cache that gains is used after it has learnt, and stays in use") {
    const Run r = run(1000, [](int, int known) { return known < 10 ? 14.0 : 5.0; });
    CHECK(r.cached >= 99);
    CHECK(r.share < 0.53);
    // Where it takes longer to learn, too.
    CHECK(run(2000, [](int, int known) { return known < 14 ? 12.0 : 5.0; }).cached >= 99);
}

TEST_CASE("a cache that gains nothing costs less than a twentieth") {
    for (double slow : {10.5, 12.0, 14.0}) {
        const Run r = run(2000, [&](int, int) { return slow; });
        CHECK(r.share < 1 / 0.95);
        CHECK(r.cached <= 13);
    }
}

TEST_CASE("a cache that ceases to gain is left, and taken up again when it gains anew") {
    // Turned slowly, then fast for a while, then slowly.
    const auto time = [](int frame, int) { return frame >= 300 && frame < 900 ? 13.0 : 5.0; };
    CHECK(run(900, time).cached <= 13);
    CHECK(run(2000, time).cached >= 99);
    CHECK(run(900, time).share < 0.9); // 300 frames at half the time, 600 at little more than all
}

TEST_CASE("alternating frames do not follow from small differences") {
    int changes = 0;
    gl::CacheChoice choice;
    bool before = true;
    for (int frame = 0; frame < 3000; ++frame) {
        const bool cached = gl::uses_cache_next(choice);
        changes += cached != before;
        before = cached;
        gl::took(choice, cached, 10 + 0.5 * std::sin(frame * 1.7) - (cached ? 0.1 : 0.0));
    }
    CHECK(changes <= 40); // a check of the exact time and a trial each count two
}

} // namespace fathom
