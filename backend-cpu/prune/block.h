// Cells are made 64 at once, each from the tape of the cell above.
#pragma once

#include "backend-cpu/prune/pruning.h"

#include <array>

namespace fathom::cpu {

// 64 cells and their tapes, one after the other.
struct PruneBlock {
    std::array<PruneCell, max_boxes> cells;
    std::vector<std::uint32_t> steps, rows;
    std::vector<Selection::Rows> loops;
    std::vector<Step> packed; // of those that are not split further
    std::vector<std::uint32_t> operands;
};

// Along each axis a cell is four of the next level: two bits of a point's place.
inline constexpr int bits_a_level = 2;

struct Place {
    std::array<std::int32_t, 3> at; // in cells of `level`
    int level;
};

// Which of the 64 cells in the one of `level` holds a place.
inline std::size_t child_at(const Place &place, int level) {
    const int shift = bits_a_level * (place.level - level - 1);
    const std::int32_t x = place.at[0] >> shift, y = place.at[1] >> shift, z = place.at[2] >> shift;
    return static_cast<std::size_t>((x & 1) | (y & 1) << 1 | (z & 1) << 2 | (x & 2) << 2 |
                                    (y & 2) << 3 | (z & 2) << 4);
}

// The cells in the one that holds a place; `exact`: for exact values alone.
PruneBlock *make_block(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                       const Place &place, bool exact);

} // namespace fathom::cpu
