// Where in space which parts of a field matter: a hierarchy of cells, 64 in each, with a shorter
// tape each (shorten.h), or, far from every surface, one number. Cells are made when a point first
// wants them and depend on nothing but their place, so that pictures are the same whoever wants
// them first; any number of threads may evaluate.
//
// A value is that of the whole tape to the bit, unless the evaluator says that less will do: of a
// distance that is at least its `limit` any lower bound that is at least the limit. Far cells
// answer that with the least value that the field takes in them.
#pragma once

#include "backend-cpu/prune/shorten.h"

#include <atomic>
#include <memory>

namespace fathom::cpu {

// A cube of space. Outside of it the whole tape runs.
struct Cube {
    std::array<float, 3> lo{};
    float side = 0;
};

// How deep and how far cells are divided, and which of them may answer with a bound.
struct PruneSettings {
    bool far_cells = true; // the first result is a distance, and bounds of it may be wanted
    int depth = 4;         // levels of cells: 4^depth along an axis
    float enough = 32;     // a tape of so few kernels is short enough
    // Of a tape with more steps cells keep their numbers alone, and those of the cell above where
    // they leave hardly any out; and a quarter of the cells is made at a time. So a field of very
    // many parts that no cell takes apart takes bytes for each, not kilobytes.
    std::size_t long_tape = 10'000;
    float far = 1; // times half a cell's diagonal: from there on one number has to do
    // Where so many points were asked of a tape of so many kernels, it is divided once more, by up to
    // so many levels beyond `depth`. What is found there is exact, so no value depends on when.
    std::uint32_t asked_often = 512;
    float long_to_run = 128;
    int finer = 3;
    std::size_t most_bytes = 64 << 20; // of such cells
};

struct PruneBlock;
// A cube of space with its shortened tape, or one number where it is far from all surfaces.
struct PruneCell {
    float far = 0; // above 0: the smallest value in it; exact values come from the cell above
    float cost = 0, shapes = 0; // of its tape
    bool splits = false;
    bool settled = false; // its tape is hardly shorter than that of the cell above
    std::int8_t level = 0;
    const PruneCell *above =
        nullptr; // the cell that contains it: evaluated where a Cut leaves points unknown
    Selection tape;
    mutable std::atomic<PruneBlock *> below{nullptr};
    mutable std::atomic<bool> claimed{false};
    // Cells in it for exact values alone, once these were asked for often.
    mutable std::atomic<PruneBlock *> exact{nullptr};
    mutable std::atomic<bool> exact_claimed{false};
    mutable std::atomic<std::uint32_t> asked{0};
};

// The hierarchy of cells of one program; shared by threads.
struct Pruning {
    Pruning(const Program &program, const Inputs &inputs, const Cube &cube,
            const PruneSettings &settings);
    ~Pruning();
    Pruning(const Pruning &) = delete;
    Pruning &operator=(const Pruning &) = delete;
    const Program program;
    const PruneProgram parts;
    const Cube cube;
    const PruneSettings settings;
    const ShortTape whole;
    float slack = 0; // by which points may be outside of the cell that rounding finds for them
    float cells = 0, scale = 0; // of the finest level: along an axis, and in a unit of length
    int finest = 0;             // level of cells for exact values alone
    PruneCell root;
    mutable std::atomic<std::size_t> exact_bytes{0}; // that cells for exact values take
};

// One thread's memory.
struct CellEvaluator {
    CellEvaluator(const Pruning &pruning, const Inputs &inputs);
    Shortener shortener;
    std::vector<ShortTape> tapes; // of the cells in the making
    Scratch scratch;
    struct Tally {
        std::uint64_t far = 0, near = 0, outside = 0; // points: outside of the cube
        std::uint64_t groups = 0;
        std::uint64_t again = 0;        // points that the cell above evaluated
        double kernels = 0, shapes = 0; // of the near ones' tapes, all told
        std::uint64_t cells = 0;        // with tapes, made by this thread
        std::uint64_t bytes = 0;        // that those take
    } tally;
    struct Last { // the block that the last place lay in, inside the cell `at` of `level`
        const PruneBlock *block = nullptr;
        int level = 0;
        std::array<std::int32_t, 3> at{};
    } last;
    std::vector<std::uint8_t> bounded; // by point of the last question: it got a bound
    struct Seen { // which group a cell has: open addressing, valid where `query` is the evaluator's
        const PruneCell *cell = nullptr;
        std::uint32_t query = 0, group = 0;
    };
    std::vector<Seen> seen;
    std::uint32_t query = 0; // counts calls
    // points left, their groups, and the groups
    std::vector<std::uint32_t> order, group_of, place;
    std::vector<const PruneCell *> groups;
    std::vector<std::uint32_t> counts, firsts, next;
    std::vector<std::vector<float>> in, out;
    struct Parted { // points of a cell by the cells in it, at each level
        std::vector<std::uint8_t> child;
        std::vector<std::uint32_t> order;
        std::vector<float> in, out;
        std::vector<float *> to;
    };
    std::vector<Parted> parted;
    std::vector<std::uint32_t> unknown;
    std::vector<float> tried; // values at some places of a cell in the making
    std::vector<float *> tried_to;
};

// out[c][k]: the c-th component of the result at point k. limits: one a point, or none: all exact.
void evaluate(const Pruning &pruning, CellEvaluator &evaluator, const float *const *in,
              float *const *out, std::size_t n, const float *limits = nullptr);

// The cell at a place: the root outside of the cube. And the exact values in one that is not far.
const PruneCell &cell_at(const Pruning &pruning, CellEvaluator &evaluator, float x, float y,
                         float z);
void evaluate_in(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                 const float *const *in, float *const *out, std::size_t n);

} // namespace fathom::cpu
