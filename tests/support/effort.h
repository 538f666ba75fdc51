// How many cases the tests of random scenes, texts and points try, and which.
#pragma once

#include <cstdlib>

namespace fathom::test {

// `usual` times FATHOM_EFFORT, a whole number of at least 1 (1 where it is not set). The usual
// number is what every change waits for; the weekly script tries twelve times as many.
inline int effort(int usual) {
    const char *given = std::getenv("FATHOM_EFFORT");
    const int times = given ? std::atoi(given) : 1;
    return usual * (times < 1 ? 1 : times);
}

// FATHOM_SEED, 1 where it is not set: others are other cases.
inline int seed() {
    const char *given = std::getenv("FATHOM_SEED");
    return given ? std::atoi(given) : 1;
}

} // namespace fathom::test
