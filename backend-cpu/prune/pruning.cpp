// Cells found by place, made when first needed; and points gathered by cell, so that each tape runs
// over a batch.
#include "backend-cpu/prune/block.h"

#include <algorithm>
#include <bit>
#include <cmath>

namespace fathom::cpu {

namespace {

void remove(PruneBlock *block) {
    if (!block) return;
    for (PruneCell &cell : block->cells) remove(cell.below.load()), remove(cell.exact.load());
    delete block;
}

const PruneBlock &below(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                        const Place &place) {
    if (const PruneBlock *there = cell.below.load(std::memory_order_acquire)) return *there;
    if (!cell.claimed.exchange(true)) {
        cell.below.store(make_block(pruning, evaluator, cell, place, false),
                         std::memory_order_release);
        cell.below.notify_all();
    } else {
        cell.below.wait(nullptr, std::memory_order_acquire);
    }
    return *cell.below.load(std::memory_order_acquire);
}

// The cell whose tape, or whose one number, answers at a place. Most places lie in the block that
// the last one lay in.
const PruneCell *find(const Pruning &pruning, CellEvaluator &evaluator, const Place &place) {
    const auto shift_of = [&](int level) { // to cells of the level
        return bits_a_level * (pruning.settings.depth - level);
    };
    CellEvaluator::Last &last = evaluator.last;
    int level = 0;
    const PruneCell *cell = &pruning.root;
    if (last.block) {
        const int shift = shift_of(last.level);
        if (place.at[0] >> shift == last.at[0] && place.at[1] >> shift == last.at[1] &&
            place.at[2] >> shift == last.at[2]) {
            cell = &last.block->cells[child_at(place, last.level)];
            level = last.level + 1;
        }
    }
    for (; cell->splits; ++level) {
        const PruneBlock &block = below(pruning, evaluator, *cell, place);
        const int shift = shift_of(level);
        last = {&block, level, {place.at[0] >> shift, place.at[1] >> shift, place.at[2] >> shift}};
        cell = &block.cells[child_at(place, level)];
    }
    return cell;
}

std::uint32_t group_of(CellEvaluator &evaluator, const PruneCell *cell) {
    const std::size_t mask = evaluator.seen.size() - 1;
    std::size_t at = (reinterpret_cast<std::uintptr_t>(cell) / sizeof(PruneCell)) & mask;
    while (evaluator.seen[at].query == evaluator.query && evaluator.seen[at].cell != cell)
        at = (at + 1) & mask;
    CellEvaluator::Seen &seen = evaluator.seen[at];
    if (seen.query != evaluator.query) {
        seen = {cell, evaluator.query, static_cast<std::uint32_t>(evaluator.groups.size())};
        evaluator.groups.push_back(cell);
        evaluator.counts.push_back(0);
    }
    return seen.group;
}

} // namespace

Pruning::Pruning(const Program &p, const Inputs &inputs, const Cube &c, const PruneSettings &wanted)
    : program(p), parts(prune_program_of(program, inputs)), cube(c), settings(wanted),
      whole(whole_tape(parts)) {
    float maximum = 0;
    for (float x : cube.lo) maximum = std::max({maximum, std::fabs(x), std::fabs(x + cube.side)});
    cells = static_cast<float>(std::int32_t{1} << bits_a_level * settings.depth);
    scale = cells / cube.side;
    slack = 4e-7f * (cube.side + maximum);
    root.tape = whole.selection(parts);
    root.cost = whole.cost;
    root.shapes = whole.shapes;
    constexpr int deepest = 10; // of cells that rounding tells apart
    finest = std::max(settings.depth, std::min(settings.depth + settings.finer, deepest));
    root.splits = settings.depth > 0 && whole.cost > settings.enough;
}
Pruning::~Pruning() { remove(root.below.load()); }

CellEvaluator::CellEvaluator(const Pruning &pruning, const Inputs &inputs)
    : shortener(pruning.parts), tapes(max_boxes), scratch(make_scratch(pruning.program, inputs)),
      in(3), out(pruning.program.results.size()),
      parted(static_cast<std::size_t>(pruning.finest) + 1) {}

const PruneCell &cell_at(const Pruning &pruning, CellEvaluator &evaluator, float x, float y,
                         float z) {
    const float px = (x - pruning.cube.lo[0]) * pruning.scale,
                py = (y - pruning.cube.lo[1]) * pruning.scale,
                pz = (z - pruning.cube.lo[2]) * pruning.scale;
    const bool inside = (px >= 0) & (py >= 0) & (pz >= 0) & (px < pruning.cells) &
                        (py < pruning.cells) & (pz < pruning.cells);
    if (!inside) return pruning.root;
    return *find(pruning, evaluator,
                 {{static_cast<std::int32_t>(px), static_cast<std::int32_t>(py),
                   static_cast<std::int32_t>(pz)},
                  pruning.settings.depth});
}

namespace {

void evaluate_exactly(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                      const float *const *in, float *const *out, std::size_t n);

// The points evaluator.unknown, by the cell above, whose tape has more rows and a Cut far beyond,
// or none as the whole tape.
void evaluate_in_parent(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                        const float *const *in, float *const *out, std::size_t n) {
    const std::vector<std::uint32_t> which(
        evaluator.unknown.begin(), evaluator.unknown.begin() + static_cast<std::ptrdiff_t>(n));
    const std::size_t results = pruning.program.results.size();
    std::vector<float> numbers((3 + results) * n);
    const float *from[3];
    std::vector<float *> to;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        from[axis] = numbers.data() + axis * n;
        for (std::size_t i = 0; i < n; ++i) numbers[axis * n + i] = in[axis][which[i]];
    }
    for (std::size_t c = 0; c < results; ++c) to.push_back(numbers.data() + (3 + c) * n);
    evaluator.tally.again += n;
    evaluate_exactly(pruning, evaluator, *cell.above, from, to.data(), n);
    for (std::size_t c = 0; c < results; ++c)
        for (std::size_t i = 0; i < n; ++i) out[c][which[i]] = to[c][i];
}

void evaluate_exactly(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                      const float *const *in, float *const *out, std::size_t n) {
    if (evaluator.unknown.size() < n) evaluator.unknown.resize(n);
    const std::size_t unknown = evaluate(pruning.program, evaluator.scratch, in, out, n, cell.tape,
                                         evaluator.unknown.data());
    if (unknown > 0) evaluate_in_parent(pruning, evaluator, cell, in, out, unknown);
}

// A place inside of the cube, as finely as cells are divided.
Place finest_place(const Pruning &pruning, float x, float y, float z) {
    const float scale =
        std::ldexp(pruning.scale, bits_a_level * (pruning.finest - pruning.settings.depth));
    return {{static_cast<std::int32_t>((x - pruning.cube.lo[0]) * scale),
             static_cast<std::int32_t>((y - pruning.cube.lo[1]) * scale),
             static_cast<std::int32_t>((z - pruning.cube.lo[2]) * scale)},
            pruning.finest};
}

// The cells in it for exact values, where these points and others before have asked often enough of
// a tape that takes long. (The root has points outside of the cube.)
const PruneBlock *exact_cells(const Pruning &pruning, CellEvaluator &evaluator,
                              const PruneCell &cell, const float *const *in, std::size_t n) {
    if (cell.level == 0 || cell.level >= pruning.finest || cell.settled || n == 0 ||
        cell.cost < pruning.settings.long_to_run)
        return nullptr;
    if (const PruneBlock *there = cell.exact.load(std::memory_order_acquire)) return there;
    const auto points = static_cast<std::uint32_t>(n);
    if (cell.asked.fetch_add(points, std::memory_order_relaxed) < pruning.settings.asked_often ||
        pruning.exact_bytes.load(std::memory_order_relaxed) > pruning.settings.most_bytes ||
        cell.exact_claimed.exchange(true))
        return nullptr;
    const std::uint64_t bytes = evaluator.tally.bytes;
    const Place place = finest_place(pruning, in[0][0], in[1][0], in[2][0]);
    PruneBlock *made = make_block(pruning, evaluator, cell, place, true);
    pruning.exact_bytes += evaluator.tally.bytes - bytes;
    cell.exact.store(made, std::memory_order_release);
    return made;
}

// What a batch takes: vectors of points, and as long again to start its kernels.
float time_of(const PruneCell &cell, std::size_t n) {
    constexpr std::size_t vector = 16;
    return cell.cost * static_cast<float>((n + vector - 1) / vector + 1);
}

void evaluate_by_parts(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                       const float *const *in, float *const *out, std::size_t n);

// By the cells in it, each its points; false, and nothing, where all at once take less time.
bool by_exact_cells(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                    const PruneBlock &block, const float *const *in, float *const *out,
                    std::size_t n) {
    CellEvaluator::Parted &parted = evaluator.parted[static_cast<std::size_t>(cell.level)];
    std::array<std::uint32_t, max_boxes + 1> first{};
    parted.child.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        const Place place = finest_place(pruning, in[0][i], in[1][i], in[2][i]);
        const std::size_t child = child_at(place, cell.level);
        parted.child[i] = static_cast<std::uint8_t>(child);
        ++first[child + 1];
    }
    float time = 0;
    for (std::size_t k = 0; k < max_boxes; ++k)
        if (first[k + 1] > 0) time += time_of(block.cells[k], first[k + 1]);
    if (time >= time_of(cell, n)) return false;
    for (std::size_t k = 0; k < max_boxes; ++k) first[k + 1] += first[k];
    const std::size_t results = pruning.program.results.size();
    parted.order.resize(n), parted.in.resize(3 * n), parted.out.resize(results * n);
    parted.to.resize(results);
    std::array<std::uint32_t, max_boxes + 1> next = first;
    for (std::size_t i = 0; i < n; ++i) {
        const std::uint32_t at = next[parted.child[i]]++;
        parted.order[at] = static_cast<std::uint32_t>(i);
        for (std::size_t axis = 0; axis < 3; ++axis) parted.in[axis * n + at] = in[axis][i];
    }
    for (std::size_t k = 0; k < max_boxes; ++k) {
        const std::uint32_t count = first[k + 1] - first[k];
        if (count == 0) continue;
        const float *from[3];
        for (std::size_t axis = 0; axis < 3; ++axis)
            from[axis] = parted.in.data() + axis * n + first[k];
        for (std::size_t c = 0; c < results; ++c)
            parted.to[c] = parted.out.data() + c * n + first[k];
        evaluate_by_parts(pruning, evaluator, block.cells[k], from, parted.to.data(), count);
    }
    for (std::size_t c = 0; c < results; ++c)
        for (std::size_t i = 0; i < n; ++i) out[c][parted.order[i]] = parted.out[c * n + i];
    return true;
}

void evaluate_by_parts(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                       const float *const *in, float *const *out, std::size_t n) {
    if (const PruneBlock *block = exact_cells(pruning, evaluator, cell, in, n))
        if (by_exact_cells(pruning, evaluator, cell, *block, in, out, n)) return;
    evaluate_exactly(pruning, evaluator, cell, in, out, n);
    ++evaluator.tally.groups;
    if (&cell == &pruning.root) {
        evaluator.tally.outside += n;
        return;
    }
    evaluator.tally.near += n;
    evaluator.tally.kernels += double(cell.cost) * static_cast<double>(n);
    evaluator.tally.shapes += double(cell.shapes) * static_cast<double>(n);
}

} // namespace

void evaluate_in(const Pruning &pruning, CellEvaluator &evaluator, const PruneCell &cell,
                 const float *const *in, float *const *out, std::size_t n) {
    evaluate_by_parts(pruning, evaluator, cell, in, out, n);
}

void evaluate(const Pruning &pruning, CellEvaluator &evaluator, const float *const *in,
              float *const *out, std::size_t n, const float *limits) {
    ++evaluator.query;
    if (evaluator.seen.size() < 4 * n) evaluator.seen.assign(std::bit_ceil(4 * n), {});
    evaluator.groups.clear(), evaluator.counts.clear();
    evaluator.order.clear(), evaluator.group_of.clear();
    evaluator.bounded.assign(n, 0);
    const PruneCell *last = nullptr;
    std::uint32_t last_group = 0;
    for (std::size_t k = 0; k < n; ++k) {
        const PruneCell *cell = &cell_at(pruning, evaluator, in[0][k], in[1][k], in[2][k]);
        if (cell->far > 0) {
            if (limits && cell->far >= limits[k]) {
                out[0][k] = cell->far;
                evaluator.bounded[k] = 1;
                ++evaluator.tally.far;
                continue;
            }
            cell = cell->above;
        }
        if (cell != last) {
            last = cell;
            last_group = group_of(evaluator, cell);
        }
        ++evaluator.counts[last_group];
        evaluator.order.push_back(static_cast<std::uint32_t>(k));
        evaluator.group_of.push_back(last_group);
    }
    const std::size_t left = evaluator.order.size();
    if (left == 0) return;
    for (auto *columns : {&evaluator.in, &evaluator.out})
        for (std::vector<float> &column : *columns)
            if (column.size() < left) column.resize(left);
    evaluator.firsts.assign(1, 0);
    for (std::uint32_t count : evaluator.counts)
        evaluator.firsts.push_back(evaluator.firsts.back() + count);
    evaluator.next = evaluator.firsts;
    evaluator.place.resize(left);
    for (std::size_t i = 0; i < left; ++i) {
        evaluator.place[i] = evaluator.next[evaluator.group_of[i]]++;
        for (std::size_t axis = 0; axis < 3; ++axis)
            evaluator.in[axis][evaluator.place[i]] = in[axis][evaluator.order[i]];
    }
    std::vector<float *> results(evaluator.out.size());
    for (std::size_t g = 0; g < evaluator.groups.size(); ++g) {
        const PruneCell *cell = evaluator.groups[g];
        const std::uint32_t first = evaluator.firsts[g], count = evaluator.counts[g];
        const float *points[] = {evaluator.in[0].data() + first, evaluator.in[1].data() + first,
                                 evaluator.in[2].data() + first};
        for (std::size_t c = 0; c < results.size(); ++c)
            results[c] = evaluator.out[c].data() + first;
        evaluate_in(pruning, evaluator, *cell, points, results.data(), count);
    }
    for (std::size_t c = 0; c < results.size(); ++c)
        for (std::size_t i = 0; i < left; ++i)
            out[c][evaluator.order[i]] = evaluator.out[c][evaluator.place[i]];
}

} // namespace fathom::cpu
