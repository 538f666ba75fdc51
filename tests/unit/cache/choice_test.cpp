// When the cache is used and when it is left, on frames whose times are made up.
#include "render-gl/cache_choice.h"

#include <catch2/catch.hpp>

#include <cmath>
#include <functional>

namespace fathom {
namespace {

// The time of all frames, over that of exact ones alone. `kept_ms` of how many kept frames there
// were since the cache knew nothing, which it does at first and after 30 exact frames; those take
// 10.
struct Run {
    double share = 0;
    int kept = 0; // of the last hundred
};
Run run(int frames, const std::function<double(int frame, int known)> &kept_ms) {
    gl::CacheChoice choice;
    double all = 0;
    int known = 0, exact = 0;
    Run result;
    for (int frame = 0; frame < frames; ++frame) {
        const bool kept = gl::keeps_next(choice);
        const double ms = kept ? kept_ms(frame, known) : 10;
        exact = kept ? 0 : exact + 1;
        known = kept ? known + 1 : exact > 30 ? 0 : known;
        gl::took(choice, kept, ms);
        all += ms;
        if (frame >= frames - 100) result.kept += kept;
    }
    result.share = all / (10.0 * frames);
    return result;
}

} // namespace

TEST_CASE("a cache that gains is used after it has learnt, and stays in use") {
    const Run r = run(1000, [](int, int known) { return known < 10 ? 14.0 : 5.0; });
    CHECK(r.kept >= 99);
    CHECK(r.share < 0.53);
    // Where it takes longer to learn, too.
    CHECK(run(2000, [](int, int known) { return known < 14 ? 12.0 : 5.0; }).kept >= 99);
}

TEST_CASE("a cache that gains nothing costs less than a twentieth") {
    for (double slow : {10.5, 12.0, 14.0}) {
        const Run r = run(2000, [&](int, int) { return slow; });
        CHECK(r.share < 1 / 0.95);
        CHECK(r.kept <= 13);
    }
}

TEST_CASE("a cache that ceases to gain is left, and taken up again when it gains anew") {
    // Turned slowly, then fast for a while, then slowly.
    const auto time = [](int frame, int) { return frame >= 300 && frame < 900 ? 13.0 : 5.0; };
    CHECK(run(900, time).kept <= 13);
    CHECK(run(2000, time).kept >= 99);
    CHECK(run(900, time).share < 0.9); // 300 frames at half the time, 600 at little more than all
}

TEST_CASE("frames of both kinds in turn do not follow from small differences") {
    int changes = 0;
    gl::CacheChoice choice;
    bool before = true;
    for (int frame = 0; frame < 3000; ++frame) {
        const bool kept = gl::keeps_next(choice);
        changes += kept != before;
        before = kept;
        gl::took(choice, kept, 10 + 0.5 * std::sin(frame * 1.7) - (kept ? 0.1 : 0.0));
    }
    CHECK(changes <= 40); // a check of the exact time and a trial each count two
}

} // namespace fathom
