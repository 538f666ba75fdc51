// Counted work, so that no scene keeps the proof busy without end: what is left of `--limit proof`.
// What finds none left says that it knows nothing, which is always true.
#pragma once

#include "base/stop.h"

#include <algorithm>
#include <cstddef>

namespace fathom::proof {

struct Work {
    std::size_t left = std::size_t(-1); // operations on intervals, nodes rewritten, pixels read
    Stop *stop = nullptr;               // where it is no longer wanted nothing is left
    bool spent() const { return left == 0; }
    void take(std::size_t steps) {
        left -= std::min(left, steps);
        if (stop && stop->after(steps)) left = 0;
    }
};

} // namespace fathom::proof
