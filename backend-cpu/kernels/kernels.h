// The kernels that tapes are made of, and their compiled variants. A kernel's operand is either a
// register (one number a point) or shared (one number for all points); a variant fixes which, so
// that its loop has nothing to decide. Which shapes of the graph become which kernel is build.cpp's
// and fuse.cpp's business.
#pragma once

#include "backend-cpu/kernels/cells.h"
#include "ir/graph.h"

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace fathom::cpu {

// One name for each row of kernels.def.
enum class Kernel : std::uint8_t {
#define FATHOM_KERNEL(name, parameters, expression, ...) name,
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
};

inline constexpr std::size_t kernel_count = 0
#define FATHOM_KERNEL(name, parameters, expression, ...) +1
#include "backend-cpu/kernels/kernels.def"
#undef FATHOM_KERNEL
    ;

using Mask = std::uint32_t; // bit i: input i is shared

// Kernels of up to three inputs have a variant for every mask (but not all shared: such a step runs
// once, on the variant of registers); longer ones have none shared and those that their row lists.
const char *kernel_name(Kernel kernel);
int kernel_inputs(Kernel kernel);
int kernel_outputs(Kernel kernel);
ir::Type kernel_output_type(Kernel kernel); // of every output: Float, Int or Bool

// The variant that shares the most of `shared`; its mask is a subset.
struct Variant {
    std::uint32_t index = 0;
    Mask mask = 0;
};
Variant best_variant(Kernel kernel, Mask shared);
Kernel kernel_of_variant(std::uint32_t index);
Mask mask_of_variant(std::uint32_t index);

// One loop a variant: operands are addresses in cells, outputs first.
template <class Cell> using Loops =
    std::span<void (*const)(Cell *cells, const std::uint32_t *operands, std::size_t n)>;

// All loops compiled for one instruction set.
struct LoopSet {
    const char *name; // the instruction set
    Loops<std::uint32_t> loops;
};
std::vector<LoopSet> point_loop_sets(); // those that this processor runs, the fastest last
Loops<std::uint32_t> point_loops();     // the fastest
Loops<DualCell> gradient_loops();

// The same over ranges (ranges.h): two floats a cell, for up to 64 boxes of points at once.
struct RangeCells {
    float *lo = nullptr, *hi = nullptr;
};
using RangeLoop = void (*)(const RangeCells &cells, const std::uint32_t *operands, std::size_t n);
// Rows of balls that join what a loop carries (ball_rows.h), over boxes: as one row after the other
// with the loops of its kernels.
struct BallRangeRows {
    const float *lo[3], *hi[3]; // places
    float *carried_lo, *carried_hi;
    const float *numbers;      // four a row: the centre, the radius
    const std::uint32_t *rows; // which, `count` of them
    std::size_t count, boxes;  // boxes: a multiple of at_once
    std::size_t at_once = 8;
    bool smooth;
    float k_lo, k_hi; // the radius; of the lesser of two: 0
};
// By row, bit k: in box k the ball changes nothing, and leaves nothing of what was. `lows`: its
// lower ends, boxes a row, where wanted.
struct BallRangeFound {
    std::uint64_t *neutral, *renewed;
    std::size_t stride; // of both, in words
    float *lows;
};
struct RangeLoops {
    std::span<const RangeLoop> loops; // by variant
    // Bit k: a + margin <= b and a < b all over box k; shared ones have one number for all boxes.
    std::uint64_t (*below)(const float *a_hi, bool a_shared, const float *b_lo, bool b_shared,
                           const float *margin_hi, bool margin_shared, std::size_t n) = nullptr;
    void (*balls)(const BallRangeRows &rows, const BallRangeFound &found) = nullptr;
};
std::vector<RangeLoops> range_loop_sets(); // in the order of point_loop_sets
RangeLoops range_loops();                  // the fastest

} // namespace fathom::cpu
