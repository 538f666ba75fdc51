// See block.h.
#include "backend-cpu/prune/block.h"

#include "backend-cpu/prune/pack.h"

#include <algorithm>
#include <cmath>
#include <memory>

namespace fathom::cpu {

namespace {

// The boxes of the cells inside the cell of `level` that holds a place, by eighths and their
// eighths: the bits of their number are x, y, z of the finer, x, y, z of the coarser ones.
Boxes boxes_inside(const Pruning &pruning, const Place &place, int level) {
    Boxes boxes;
    boxes.count = max_boxes;
    const float side = std::ldexp(pruning.cube.side, -bits_a_level * (level + 1));
    const int shift = bits_a_level * (place.level - level);
    for (std::size_t k = 0; k < max_boxes; ++k)
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::int32_t first = (place.at[axis] >> shift) << bits_a_level;
            const auto at = static_cast<float>(
                first + static_cast<std::int32_t>((k >> axis & 1) | (k >> axis >> 2 & 2)));
            boxes.lo[axis][k] = pruning.cube.lo[axis] + at * side - pruning.slack;
            boxes.hi[axis][k] = pruning.cube.lo[axis] + (at + 1) * side + pruning.slack;
        }
    return boxes;
}

// Some of the boxes.
Boxes part_of(const Boxes &boxes, std::size_t first, std::size_t count) {
    Boxes part;
    part.count = count;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(boxes.lo[axis].begin() + first, count, part.lo[axis].begin());
        std::copy_n(boxes.hi[axis].begin() + first, count, part.hi[axis].begin());
    }
    return part;
}

constexpr std::size_t tried_points = 16;

// At how many of these points a box's tape with a Cut gives no value. A chain of blends that comes
// nearer row by row, by less than their radius, forgets nothing.
std::size_t unknown_of(const Pruning &pruning, CellEvaluator &evaluator, const Boxes &boxes,
                       std::size_t box, const ShortTape &tape) {
    constexpr std::size_t n = tried_points;
    float in[3][n];
    for (std::size_t i = 0; i < n; ++i) { // 2 x 2 x 4
        const float way[] = {static_cast<float>(i & 1) * 0.8f + 0.1f,
                             static_cast<float>(i >> 1 & 1) * 0.8f + 0.1f,
                             static_cast<float>(i >> 2) * 0.3f + 0.05f};
        for (std::size_t axis = 0; axis < 3; ++axis)
            in[axis][i] =
                boxes.lo[axis][box] + way[axis] * (boxes.hi[axis][box] - boxes.lo[axis][box]);
    }
    const std::size_t results = pruning.program.results.size();
    evaluator.tried.resize(results * n);
    evaluator.tried_to.resize(results);
    for (std::size_t c = 0; c < results; ++c)
        evaluator.tried_to[c] = evaluator.tried.data() + c * n;
    const float *from[] = {in[0], in[1], in[2]};
    std::uint32_t unknown[n];
    return evaluate(pruning.program, evaluator.scratch, from, evaluator.tried_to.data(), n,
                    tape.selection(pruning.parts), unknown);
}

bool is_far(const Pruning &pruning, const CellEvaluator &evaluator, std::size_t box, bool exact,
            float half_diagonal) {
    return pruning.settings.far_cells && !exact &&
           evaluator.shortener.result_lo[box] >= pruning.settings.far * half_diagonal;
}

// The tapes of the boxes that are not far, from that of `from`, into evaluator.tapes. A Cut by which
// too many points of a box are unknown is taken back.
void shorten_all(const Pruning &pruning, CellEvaluator &evaluator, const Boxes &boxes,
                 const PruneCell &from, bool exact, float half_diagonal) {
    run_over(pruning.parts, evaluator.shortener, from.tape, boxes);
    std::uint64_t near = 0, again = 0;
    for (std::size_t k = 0; k < boxes.count; ++k)
        if (!is_far(pruning, evaluator, k, exact, half_diagonal)) near |= std::uint64_t{1} << k;
    std::vector<ShortTape> &tapes = evaluator.tapes;
    shorten(pruning.parts, evaluator.shortener, from.tape, near, near, tapes);
    for (std::size_t k = 0; k < boxes.count; ++k)
        if ((near >> k & 1) != 0 && tapes[k].cut &&
            unknown_of(pruning, evaluator, boxes, k, tapes[k]) > tried_points / 2)
            again |= std::uint64_t{1} << k;
    if (again != 0) shorten(pruning.parts, evaluator.shortener, from.tape, again, 0, tapes);
}

bool has_cut(const Selection &tape) {
    return std::ranges::any_of(tape.loops, [](const auto &rows) { return rows.cut.any(); });
}

// The cells of a block, their tapes made from that of `from`, all of them for exact values alone
// where the block is. Gives how many of them have a Cut by which too many of their points are unknown.
int fill(const Pruning &pruning, CellEvaluator &evaluator, const Boxes &boxes,
         const PruneCell &cell, const PruneCell &from, bool exact, PruneBlock &block) {
    const int level = cell.level;
    const std::size_t at_once =
        from.tape.steps.size() > pruning.settings.long_tape ? max_boxes / 4 : max_boxes;
    std::array<bool, max_boxes> as_above{};
    const float half_diagonal =
        0.8660254f * std::ldexp(pruning.cube.side, -bits_a_level * (level + 1));
    struct Piece {
        std::size_t steps, loops, packed;
    };
    std::array<Piece, max_boxes + 1> pieces{};
    int unknown = 0;
    std::vector<ShortTape> &tapes = evaluator.tapes;
    Packer packer(pruning.parts);
    for (std::size_t k = 0; k < max_boxes; ++k) {
        const std::size_t box = k % at_once; // of those that were run over
        if (box == 0)
            shorten_all(pruning, evaluator, part_of(boxes, k, at_once), from, exact, half_diagonal);
        ShortTape &tape = tapes[box];
        PruneCell &made = block.cells[k];
        made.above = &cell;
        made.level = static_cast<std::int8_t>(level + 1);
        pieces[k] = {block.steps.size(), block.loops.size(), block.packed.size()};
        if (is_far(pruning, evaluator, box, exact, half_diagonal)) {
            // where exact values are wanted, the cell above computes them
            made.far = evaluator.shortener.result_lo[box];
            continue;
        }
        if (!tape.cut && has_cut(tape.selection(pruning.parts)))
            unknown += unknown_of(pruning, evaluator, boxes, k, tape) > 1;
        const bool is_long = tape.steps.size() > pruning.settings.long_tape;
        as_above[k] = is_long && !tape.cut && tape.cost >= 0.8f * from.cost;
        if (as_above[k]) {
            made.cost = from.cost;
            made.shapes = from.shapes;
            made.splits = !exact && level < 1 && pruning.settings.depth > 1;
            made.settled = true;
            ++evaluator.tally.cells;
            continue;
        }
        for (Selection::Rows &rows : tape.loops)
            rows.first += static_cast<std::uint32_t>(block.rows.size());
        block.steps.insert(block.steps.end(), tape.steps.begin(), tape.steps.end());
        block.loops.insert(block.loops.end(), tape.loops.begin(), tape.loops.end());
        block.rows.insert(block.rows.end(), tape.rows.begin(), tape.rows.end());
        made.cost = tape.cost;
        made.shapes = tape.shapes;
        // where cells get smaller and tapes hardly shorter, the shapes are closer than their blends
        made.settled = level >= 1 && tape.cost >= 0.8f * cell.cost;
        made.splits = !exact && level + 1 < pruning.settings.depth &&
                      tape.cost > pruning.settings.enough && !made.settled;
        if (!made.splits && !is_long) packer.pack(tape, block.packed, block.operands);
        ++evaluator.tally.cells;
    }
    if (at_once < max_boxes) std::vector<float>().swap(evaluator.shortener.ends);
    pieces[max_boxes] = {block.steps.size(), block.loops.size(), block.packed.size()};
    for (std::size_t k = 0; k < max_boxes; ++k) {
        const Piece &first = pieces[k], &end = pieces[k + 1];
        Selection &tape_of = block.cells[k].tape;
        if (as_above[k]) {
            tape_of = from.tape;
            continue;
        }
        tape_of.table = pruning.parts.table.data();
        tape_of.operands = pruning.parts.operands.data();
        tape_of.steps = std::span(block.steps).subspan(first.steps, end.steps - first.steps);
        tape_of.loops = std::span(block.loops).subspan(first.loops, end.loops - first.loops);
        tape_of.rows = block.rows.data();
        tape_of.packed = std::span(block.packed).subspan(first.packed, end.packed - first.packed);
        tape_of.packed_operands = block.operands.data();
    }
    evaluator.tally.bytes +=
        sizeof(PruneBlock) + 4 * (block.steps.size() + block.rows.size() + block.operands.size()) +
        sizeof(Step) * block.packed.size() + sizeof(Selection::Rows) * block.loops.size();
    return unknown;
}

} // namespace

PruneBlock *make_block(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                       const Place &place, bool exact) {
    constexpr int too_many = max_boxes / 8;
    const Boxes boxes = boxes_inside(pruning, place, cell.level);
    auto block = std::make_unique<PruneBlock>();
    if (fill(pruning, evaluator, boxes, cell, cell, exact, *block) < too_many)
        return block.release();
    const PruneCell *from = &cell; // whose Cut is too near for what is in it: without one
    while (has_cut(from->tape)) from = from->above;
    block = std::make_unique<PruneBlock>();
    fill(pruning, evaluator, boxes, cell, *from, exact, *block);
    return block.release();
}

} // namespace fathom::cpu
