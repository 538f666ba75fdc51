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
    bool spent() const { return left == 0 || stopped(); }
    bool stopped() const { return stop && stop->stopped(); }
    void take(std::size_t steps) {
        left -= std::min(left, steps);
        if (stop && stop->after(steps)) left = 0;
    }
    // Steps in time alone, of what has limits of its own: they are asked about, and not counted.
    void pass(std::size_t steps) {
        if (stop && stop->after(steps)) left = 0;
    }
};

// What comparisons of a border's sides by cases may take (agreement.h): each, and those of one field
// together. They count as work of the proof, too.
struct Comparisons {
    static constexpr std::size_t most_of_one = 2'500'000;
    std::size_t left = 5'000'000; // of a field
    bool in_vain = false;         // a step of the field is seen: no further one is worth it

    Work begin(const Work &all) const {
        return {std::min({most_of_one, left, all.left}), all.stop};
    }
    void end(Work &all, std::size_t steps) {
        left -= std::min(left, steps);
        all.take(steps);
    }
};

} // namespace fathom::proof
