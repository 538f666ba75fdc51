// Rays from the eye where a scene has cells (pruning.h): the same walks as march.cpp's, cell by
// cell. A ray goes on alone through far cells, whose one number answers at once; in a cell with a
// tape it waits for the others of its tile, and the tape runs over all that wait. In which order
// cells come changes no ray's walk.
#pragma once

#include "backend-cpu/trace/ray.h"

namespace fathom::cpu {

// One thread's memory for it: nothing is allocated once it has grown to a tile.
struct CellMarch {
    std::vector<Walk> walks;
    struct Stop { // a cell with a tape, and who waits there: a list through `next`
        const PruneCell *cell = nullptr;
        std::uint32_t first = 0, count = 0;
    };
    std::vector<Stop> stops;
    std::vector<std::uint32_t> next;  // by ray
    std::vector<std::uint32_t> queue; // stops where someone waits, in the order in which they came
    struct Seen {                     // which stop a cell has: open addressing
        const PruneCell *cell = nullptr;
        std::uint32_t turn = 0, stop = 0;
    };
    std::vector<Seen> seen;
    std::uint32_t turn = 0;
    std::vector<std::uint32_t> here; // the rays whose cell's tape is run
    std::vector<Crossing> crossings;
};

// By march() where the worker has cells.
void march_by_cells(Worker &worker, std::span<const RayState> rays, std::span<Landing> landings);

} // namespace fathom::cpu
