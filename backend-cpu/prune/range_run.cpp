// A tape over ranges for many boxes at once: what wins in which, and which rows of a loop matter.
#include "backend-cpu/prune/shorten.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace fathom::cpu {

namespace {

constexpr float endless = std::numeric_limits<float>::infinity();
constexpr float cut_radii = 4; // how far beyond a chain's end rows are cut off: measured
constexpr std::uint64_t everywhere = ~std::uint64_t{0};
constexpr float min_round = 1e-15f; // of smaller radii the squares are no floats any more

// Runs steps over ranges and notes what wins.
class RangeRunner {
  public:
    RangeRunner(const PruneProgram &parts, Shortener &memory, bool notes)
        : parts_(parts), program_(*parts.program), memory_(memory),
          loops_(range_loops()), cells_{memory.lo.data(), memory.hi.data()}, n_(memory.boxes),
          notes_(notes) {}

    void run(const Selection &tape) {
        std::size_t loop = 0;
        memory_.chosen.clear(), memory_.ends.clear(), memory_.iterations.clear();
        memory_.lows.clear(), memory_.loop_runs.clear(), memory_.cuts.clear();
        memory_.listed.clear();
        // Of a long tape these are the most of all that is kept: no more than is needed.
        const auto choice = [&](std::uint32_t id) { return parts_.parts[id].choice; };
        const auto minima = notes_ ? std::ranges::count(tape.steps, Choice::Least, choice) : 0;
        memory_.ends.reserve(3 * n_ * static_cast<std::size_t>(minima) + n_ * tape.loops.size());
        for (std::uint32_t id : tape.steps) {
            const Part &part = parts_.parts[id];
            Shortener::Chosen chosen;
            if (part.choice != Choice::None) prepare(part);
            if (notes_ && part.choice != Choice::None) {
                wins(id, part, chosen.wins);
                if (part.choice == Choice::Least) chosen.ends = begin_ends(part);
            }
            const Step &step = parts_.table[id];
            if (step.kind == StepKind::Loop)
                rows(step, tape, tape.loops[loop++]);
            else
                one(id);
            if (chosen.ends != Shortener::no_ends)
                copy_ends(cells_.hi, parts_.operands[step.operands], chosen.ends);
            if (notes_) memory_.chosen.push_back(chosen);
        }
    }

  private:
    bool shared(std::uint32_t address) const { return address < program_.first_register; }

    void copy_ends(const float *from, std::uint32_t address, std::size_t to) {
        if (shared(address))
            std::fill_n(memory_.ends.data() + to, n_, from[address]);
        else
            std::copy_n(from + address, n_, memory_.ends.data() + to);
    }

    std::size_t add_ends(std::size_t numbers) {
        const std::size_t begin = memory_.ends.size();
        memory_.ends.resize(begin + numbers * n_);
        return begin;
    }

    std::size_t begin_ends(const Part &part) {
        const std::size_t ends = add_ends(3);
        for (std::size_t side = 0; side < 2; ++side)
            copy_ends(cells_.lo, part.operand[side], ends + (1 + side) * n_);
        return ends;
    }

    // A joined ball's own range first: it may be what wins.
    void prepare(const Part &part) {
        if (part.ball != no_part)
            loops_.loops[part.ball](cells_, parts_.operands.data() + part.ball_operands, n_);
    }

    void wins(std::uint32_t id, const Part &part, std::uint64_t (&out)[2]) const {
        static constexpr float nothing = 0;
        const std::uint32_t a = part.operand[0], b = part.operand[1];
        const auto below = [&](std::uint32_t x, std::uint32_t y, const float *by, bool by_shared) {
            return loops_.below(cells_.hi + x, shared(x), cells_.lo + y, shared(y), by, by_shared,
                                n_);
        };
        switch (part.choice) {
        case Choice::None: break;
        case Choice::Least:
            out[0] = below(a, b, &nothing, true);
            out[1] = below(b, a, &nothing, true);
            break;
        case Choice::Greatest:
            out[0] = below(b, a, &nothing, true);
            out[1] = below(a, b, &nothing, true);
            break;
        case Choice::Blend: {
            const float *margin = cells_.hi + part.margin;
            const bool one = shared(part.margin);
            if (kernel_of_variant(parts_.table[id].target) == Kernel::BlendRound &&
                std::any_of(margin, margin + (one ? 1 : n_),
                            [](float r) { return r > 0 && r < min_round; }))
                break;
            out[0] = below(a, b, margin, one);
            out[1] = below(b, a, margin, one);
            break;
        }
        case Choice::Select: {
            const float *lo = cells_.lo + part.margin, *hi = cells_.hi + part.margin;
            const std::size_t step = shared(part.margin) ? 0 : 1;
            for (std::size_t k = 0; k < n_; ++k) {
                out[0] |= std::uint64_t{lo[k * step] > 0} << k;
                out[1] |= std::uint64_t{hi[k * step] < 1} << k;
            }
            break;
        }
        }
    }

    bool run_block(std::uint32_t block) {
        const Program::Block range = program_.blocks[block];
        for (std::uint32_t id = range.first; id < range.last; ++id) {
            prepare(parts_.parts[id]);
            if (!one(id)) return false;
        }
        return true;
    }

    bool one(std::uint32_t id) {
        const Step &step = parts_.table[id];
        const Part &part = parts_.parts[id];
        const std::uint32_t *operands = parts_.operands.data() + step.operands;
        const std::size_t n = step.once ? 1 : n_;
        switch (step.kind) {
        case StepKind::Run:
            if (part.join != no_part)
                loops_.loops[part.join](cells_, parts_.operands.data() + part.join_operands, n);
            else
                loops_.loops[step.target](cells_, operands, n);
            break;
        case StepKind::TableRead: read(step.target, operands, n); break;
        case StepKind::Image:
            for (std::size_t c = 0; c < 4; ++c)
                fill(operands[c], n, parts_.image_ranges[4 * step.target + c]);
            break;
        case StepKind::Grid: grid(program_.grids[step.target], operands, n); break;
        case StepKind::Call: run_block(step.target); break;
        case StepKind::Loop: loop(program_.loops[step.target]); break;
        case StepKind::BreakUnless:
            return std::any_of(cells_.hi + *operands, cells_.hi + *operands + n,
                               [](float x) { return x > 0; });
        }
        return true;
    }

    void begin_iteration(const Loop &loop, std::uint32_t iteration) {
        cells_.lo[loop.index] = cells_.hi[loop.index] = static_cast<float>(iteration);
    }

    void loop(const Loop &loop) {
        float count = cells_.hi[loop.count];
        if (!loop.once)
            count = *std::max_element(cells_.hi + loop.count, cells_.hi + loop.count + n_);
        const auto iterations =
            static_cast<std::uint32_t>(std::clamp(count, 0.0f, static_cast<float>(loop.max_count)));
        for (std::uint32_t iteration = 0; iteration < iterations; ++iteration) {
            begin_iteration(loop, iteration);
            if (!run_block(loop.block)) break;
        }
    }

    // The iterations of a loop of the tape itself, with what each changes.
    void rows(const Step &step, const Selection &tape, const Selection::Rows &rows) {
        const Loop &loop = program_.loops[step.target];
        Shortener::LoopRun run{static_cast<std::uint32_t>(memory_.iterations.size()),
                               static_cast<std::uint32_t>(memory_.lows.size()),
                               no_part,
                               no_part,
                               {}};
        if (rows.all) {
            memory_.loop_runs.push_back(run);
            this->loop(loop);
            return;
        }
        const RowLoop &known = parts_.loops[step.target];
        decided_.resize(known.decisions.size());
        if (rows.cut.any()) begin_below(loop.carried[0].var, rows.cut);
        const bool balls = is_balls(loop, known);
        if (balls) ball_rows(loop, known, tape.rows + rows.first, rows.count);
        for (std::uint32_t i = 0; !balls && i < rows.count; ++i) {
            for (auto &decided : decided_) decided.wins[0] = decided.wins[1] = 0;
            begin_iteration(loop, tape.rows[rows.first + i]);
            row(loop, known);
            Shortener::Iteration iteration{~std::uint64_t{0},
                                           known.renewable ? ~std::uint64_t{0} : 0};
            for (std::size_t d = 0; d < known.decisions.size(); ++d) {
                const int kept = known.decisions[d].kept;
                iteration.neutral &= decided_[d].wins[kept];
                iteration.renewed &= decided_[d].wins[1 - kept];
            }
            memory_.iterations.push_back(iteration);
        }
        if (known.minimum >= 0) {
            const Loop::Carried &minimum = loop.carried[static_cast<std::size_t>(known.minimum)];
            run.ends = add_ends(1);
            copy_ends(cells_.hi, minimum.var, run.ends);
            above(run, rows.count);
        }
        if (known.chain) cut(loop, known, rows, run);
        list(run, rows.count);
        memory_.loop_runs.push_back(run);
    }

    bool is_balls(const Loop &loop, const RowLoop &known) const {
        return loop.balls >= 0 && known.renewable && known.decisions.size() == 1 &&
               known.decisions[0].kept == 0;
    }
    // The same as row by row, all at once.
    void ball_rows(const Loop &loop, const RowLoop &known, const std::uint32_t *rows,
                   std::size_t count) {
        const BallRows &balls = program_.ball_loops[static_cast<std::size_t>(loop.balls)];
        const std::size_t first = memory_.iterations.size(), first_low = memory_.lows.size();
        const bool lows = known.minimum >= 0 || known.chain;
        memory_.iterations.resize(first + count);
        if (lows) memory_.lows.resize(first_low + count * n_);
        BallRangeRows in{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            in.lo[axis] = cells_.lo + balls.place[axis];
            in.hi[axis] = cells_.hi + balls.place[axis];
        }
        in.carried_lo = cells_.lo + balls.carried, in.carried_hi = cells_.hi + balls.carried;
        in.numbers = balls.numbers.data();
        in.rows = rows, in.count = count, in.boxes = n_;
        in.smooth = balls.smooth;
        if (balls.smooth) in.k_lo = cells_.lo[balls.k], in.k_hi = cells_.hi[balls.k];
        if (count == 0) return;
        static_assert(sizeof(Shortener::Iteration) % sizeof(std::uint64_t) == 0);
        loops_.balls(in, {&memory_.iterations[first].neutral, &memory_.iterations[first].renewed,
                          sizeof(Shortener::Iteration) / sizeof(std::uint64_t),
                          lows ? memory_.lows.data() + first_low : nullptr});
    }

    // What a chain that was cut begins with lies between the bound and what it began with. (What
    // rounding may take from a bound on the way is a part of `drop`.)
    void begin_below(std::uint32_t carried, const Cut &cut) {
        for (std::size_t k = 0; k < n_; ++k)
            cells_.lo[carried + k] = std::min(cells_.lo[carried + k], cut.start - cut.drop);
    }

    // Where a chain may be cut in each box: all rows that are beyond it in the end, by some radii.
    // Rounding: an iteration's blend is computed to 2u(k + m), u = 2^-24, where it is no operand to
    // the bit; m, the greatest size of what it gives, is that of the start and of the end's lower
    // end. The true chain and the one that begins with the bound are that much apart in each
    // iteration at most, since blends bring no two numbers farther from each other.
    void cut(const Loop &loop, const RowLoop &known, const Selection::Rows &rows,
             Shortener::LoopRun &run) {
        const Part &blend = parts_.parts[known.decisions[0].part];
        const std::uint32_t carried = loop.carried[0].var;
        if (!shared(blend.margin) || cells_.lo[blend.margin] != cells_.hi[blend.margin]) return;
        const float k = cells_.hi[blend.margin];
        if (!(k > 0)) return;
        run.cuts = static_cast<std::uint32_t>(memory_.cuts.size());
        auto &cuts = memory_.cuts.emplace_back();
        std::array<float, max_boxes> beyond{};
        for (std::size_t box = 0; box < n_; ++box) {
            const float lo = cells_.lo[carried + box], hi = cells_.hi[carried + box];
            float t = hi + cut_radii * k;
            if (rows.cut.any()) t = std::min(t, rows.cut.start + k);
            Cut &cut = cuts[box];
            cut.start = t - k - 1e-6f * (std::fabs(t) + k);
            cut.drop = k + 2.5e-7f * static_cast<float>(known.iterations) *
                               (std::max(std::fabs(lo), std::fabs(cut.start)) + k);
            beyond[box] = t;
        }
        static constexpr float nothing = 0;
        for (std::uint32_t i = 0; i < rows.count; ++i)
            if (memory_.iterations[run.first_iteration + i].neutral != everywhere)
                memory_.iterations[run.first_iteration + i].beyond =
                    loops_.below(beyond.data(), false, memory_.lows.data() + run.first_low + i * n_,
                                 false, &nothing, true, n_);
    }

    // By box, the iterations that may change something, in their order.
    void list(Shortener::LoopRun &run, std::uint32_t rows) {
        std::array<std::uint32_t, max_boxes> next{};
        const Shortener::Iteration *iterations = memory_.iterations.data() + run.first_iteration;
        for (std::uint32_t i = 0; i < rows; ++i)
            each_bit(~iterations[i].neutral, [&](std::size_t box) { ++next[box]; });
        std::uint32_t first = static_cast<std::uint32_t>(memory_.listed.size());
        run.listed[0] = first;
        for (std::size_t box = 0; box < max_boxes; ++box) {
            first += next[box];
            next[box] = run.listed[box];
            run.listed[box + 1] = first;
        }
        memory_.listed.resize(first);
        for (std::uint32_t i = 0; i < rows; ++i)
            each_bit(~iterations[i].neutral,
                     [&](std::size_t box) { memory_.listed[next[box]++] = i; });
    }
    template <class F> void each_bit(std::uint64_t bits, F &&f) const {
        if (n_ < 64) bits &= (std::uint64_t{1} << n_) - 1;
        for (; bits != 0; bits &= bits - 1) f(static_cast<std::size_t>(std::countr_zero(bits)));
    }

    // Of a minimum nothing is changed either by a row that is above it in the end.
    void above(const Shortener::LoopRun &run, std::uint32_t rows) {
        static constexpr float nothing = 0;
        const float *minimum = memory_.ends.data() + run.ends;
        for (std::uint32_t i = 0; i < rows; ++i)
            if (memory_.iterations[run.first_iteration + i].neutral != everywhere)
                memory_.iterations[run.first_iteration + i].neutral |=
                    loops_.below(minimum, false, memory_.lows.data() + run.first_low + i * n_,
                                 false, &nothing, true, n_);
    }

    void row(const Loop &loop, const RowLoop &known) {
        const Program::Block range = program_.blocks[loop.block];
        for (std::uint32_t id = range.first; id < range.last; ++id) {
            const Part &part = parts_.parts[id];
            if (part.choice != Choice::None) prepare(part);
            if (part.decision >= 0) {
                const auto d = static_cast<std::size_t>(part.decision);
                wins(id, part, decided_[d].wins);
                if (known.minimum == part.decision || known.chain) {
                    const std::uint32_t added = part.operand[1 - known.decisions[d].kept];
                    const std::size_t first = memory_.lows.size();
                    memory_.lows.resize(first + n_);
                    for (std::size_t k = 0; k < n_; ++k)
                        memory_.lows[first + k] = cells_.lo[shared(added) ? added : added + k];
                }
            }
            one(id);
        }
    }

    void fill(std::uint32_t address, std::size_t n, std::array<float, 2> range) {
        std::fill_n(cells_.lo + address, n, range[0]);
        std::fill_n(cells_.hi + address, n, range[1]);
    }

    void read(std::uint32_t index, const std::uint32_t *operands, std::size_t n) {
        const Read &read = program_.reads[index];
        const std::uint32_t rows = operands[read.columns];
        const float *data = program_.table_data.data() + read.first;
        const auto row_of = [&](float x) {
            return static_cast<int>(std::clamp(x, 0.0f, static_cast<float>(read.rows - 1)));
        };
        for (std::size_t k = 0; k < n; ++k) {
            const int first = row_of(cells_.lo[rows + k]), last = row_of(cells_.hi[rows + k]);
            for (int c = 0; c < read.columns; ++c) {
                std::array<float, 2> range =
                    parts_
                        .read_ranges[parts_.first_read_range[index] + static_cast<std::size_t>(c)];
                if (last - first < 16) {
                    range = {endless, -endless};
                    for (int row = first; row <= last; ++row) {
                        const float x = data[static_cast<std::ptrdiff_t>(row) * read.stride + c];
                        range = {std::min(range[0], x), std::max(range[1], x)};
                    }
                }
                cells_.lo[operands[c] + k] = range[0];
                cells_.hi[operands[c] + k] = range[1];
            }
        }
    }

    // Trilinear: a mean of the samples round the box, but for rounding.
    void grid(const ir::GridData &grid, const std::uint32_t *operands, std::size_t n) {
        for (std::size_t k = 0; k < n; ++k) {
            std::array<int, 3> first{}, last{};
            bool some = true;
            for (std::size_t i = 0; i < 3; ++i) {
                const auto samples = static_cast<float>(grid.size[i] - 1);
                const auto place = [&](float x) { return std::clamp(x, 0.0f, 1.0f) * samples; };
                some = some && grid.size[i] > 0;
                first[i] = static_cast<int>(place(cells_.lo[operands[i + 1] + k]) - 1e-2f);
                last[i] = static_cast<int>(place(cells_.hi[operands[i + 1] + k]) + 1.01f);
                first[i] = std::clamp(first[i], 0, std::max(grid.size[i] - 1, 0));
                last[i] = std::clamp(last[i], 0, std::max(grid.size[i] - 1, 0));
            }
            std::array<float, 2> range{0, 0};
            if (some) range = {endless, -endless};
            for (int z = first[2]; some && z <= last[2]; ++z)
                for (int y = first[1]; y <= last[1]; ++y)
                    for (int x = first[0]; x <= last[0]; ++x) {
                        const auto at =
                            (static_cast<std::size_t>(z) * static_cast<std::size_t>(grid.size[1]) +
                             static_cast<std::size_t>(y)) *
                                static_cast<std::size_t>(grid.size[0]) +
                            static_cast<std::size_t>(x);
                        range = {std::min(range[0], grid.values[at]),
                                 std::max(range[1], grid.values[at])};
                    }
            const float rounding = 1e-6f * std::max(std::fabs(range[0]), std::fabs(range[1]));
            cells_.lo[operands[0] + k] = range[0] - rounding;
            cells_.hi[operands[0] + k] = range[1] + rounding;
        }
    }

    struct Decided {
        std::uint64_t wins[2];
    };
    const PruneProgram &parts_;
    const Program &program_;
    Shortener &memory_;
    RangeLoops loops_;
    RangeCells cells_;
    std::size_t n_;
    bool notes_; // of what wins
    std::vector<Decided> decided_;
};

} // namespace

Shortener::Shortener(const PruneProgram &parts) {
    const Program &program = *parts.program;
    lo.resize(program.cells + batch_size);
    hi.resize(program.cells + batch_size);
    live.resize(parts.slot_count);
    cutoff.resize((parts.slot_count - program.first_register) * max_boxes);
    using Kind = Program::Shared::Kind;
    for (const Program::Shared &shared : program.shared) {
        double value = 0;
        switch (shared.kind) {
        case Kind::Float: value = std::bit_cast<float>(shared.bits); break;
        case Kind::Int: value = static_cast<std::int32_t>(shared.bits); break;
        case Kind::Time: value = static_cast<float>(parts.inputs.time); break;
        case Kind::Param: value = parts.inputs.params[shared.param][shared.component]; break;
        }
        const auto number = static_cast<float>(value);
        const bool exact = shared.kind == Kind::Float || std::fabs(value) <= 16777216 ||
                           (shared.kind == Kind::Param && shared.type == ir::Type::Float);
        lo[shared.address] = exact && number == number ? number : -endless;
        hi[shared.address] = exact && number == number ? number : endless;
    }
}

void enter_boxes(const PruneProgram &parts, Shortener &shortener, const Boxes &boxes) {
    const Program &program = *parts.program;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        std::copy_n(boxes.lo[axis].begin(), boxes.count,
                    shortener.lo.begin() + program.params[axis].address);
        std::copy_n(boxes.hi[axis].begin(), boxes.count,
                    shortener.hi.begin() + program.params[axis].address);
    }
    shortener.boxes = boxes.count;
}

void run_steps(const PruneProgram &parts, Shortener &shortener, const Selection &steps) {
    RangeRunner(parts, shortener, true).run(steps);
}

void take_results(const PruneProgram &parts, Shortener &shortener) {
    const Program::Slot &result = parts.program->results[0];
    for (std::size_t k = 0; k < shortener.boxes; ++k) {
        const std::size_t at = result.address + (result.shared ? 0 : k);
        shortener.result_lo[k] = shortener.lo[at];
        shortener.result_hi[k] = shortener.hi[at];
    }
}

void run_over(const PruneProgram &parts, Shortener &shortener, const Selection &from,
              const Boxes &boxes) {
    enter_boxes(parts, shortener, boxes);
    run_steps(parts, shortener, from);
    take_results(parts, shortener);
}

void run_values(const PruneProgram &parts, Shortener &shortener, const Selection &from,
                const Boxes &boxes) {
    enter_boxes(parts, shortener, boxes);
    RangeRunner(parts, shortener, false).run(from);
    take_results(parts, shortener);
}

} // namespace fathom::cpu
