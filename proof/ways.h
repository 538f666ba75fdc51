// One way in which the choices of a tape go: which side each `min`, `abs`, `if` and step takes,
// where a cell leaves that open. Over the points of a cell that go one way the field is smooth, and
// its gradient is that of this way alone; beside kinks the hull of both sides' gradients may be far
// longer than either (docs/lipschitz.md, 2.6). Knows nothing of instructions.
#pragma once

#include "ir/interval.h"

#include <cstdint>
#include <vector>

namespace fathom::proof {

using ir::Interval;

struct Ways {
    // Of the choices met in one run, numbered as they come, those that were open.
    struct Decision {
        std::uint32_t site = 0;
        int way = 0, many = 2;
    };
    std::vector<Decision> taken;
    std::size_t next = 0;        // of `taken`, in this run
    std::uint32_t sites = 0;     // met in this run
    bool again = false;          // the second run of a way, with what was learnt in the first
    bool impossible = false;     // no point of the cell goes this way
    std::vector<Interval> known; // by component of the tape: of the points that go this way
    std::vector<std::pair<std::uint32_t, std::uint32_t>> ordered; // components: first <= second

    // The way of the next choice; -1 where it is not open. `only`: the one that is left, or -1.
    int way(bool open, int many, int only = -1);
    void start(bool second); // another run
    bool to_next();          // false where that was the last way
};

} // namespace fathom::proof
