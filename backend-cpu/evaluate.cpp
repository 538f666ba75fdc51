// Runs a tape over batches of points: floats through point_loops, dual numbers through
// gradient_loops, by one interpreter that knows cells and no numbers.
#include "backend-cpu/kernels/ball_rows.h"
#include "backend-cpu/kernels/dual.h"
#include "backend-cpu/kernels/sample.h"
#include "backend-cpu/tape.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>

namespace fathom::cpu {

namespace {

inline void store_word(Word &cell, std::int32_t x) { cell = static_cast<Word>(x); }
inline void store_word(DualCell &cell, std::int32_t x) { store(cell, x); }
inline std::int32_t int_at(const Word &cell) { return static_cast<std::int32_t>(cell); }
inline std::int32_t int_at(const DualCell &cell) { return load<std::int32_t>(cell); }
inline float number_at(const Word &cell) { return std::bit_cast<float>(cell); }
inline Dual number_at(const DualCell &cell) { return load<Dual>(cell); }
inline void store_number(Word &cell, float x) { cell = std::bit_cast<Word>(x); }
inline void store_number(DualCell &cell, Dual x) { store(cell, x); }

template <class Cell> class Runner {
  public:
    using Number = decltype(number_at(std::declval<const Cell &>()));

    // unknown: by point, set where a Cut leaves it so.
    Runner(const Program &program, Loops<Cell> loops, Cell *cells, std::size_t n,
           std::uint8_t *unknown = nullptr)
        : program_(program), loops_(loops), cells_(cells), n_(n), unknown_(unknown) {}

    // False: the loop that this block is the body of is done.
    bool run(std::uint32_t block) const {
        const Program::Block range = program_.blocks[block];
        const std::uint32_t *operands = program_.operands.data();
        const auto *loops = loops_.data(); // not read anew after each call
        Cell *cells = cells_;
        const std::size_t n = n_;
        for (const Step *step = program_.steps.data() + range.first,
                        *last = program_.steps.data() + range.last;
             step != last; ++step)
            if (step->kind == StepKind::Run)
                loops[step->target](cells, operands + step->operands, step->once ? 1 : n);
            else if (!one(*step, operands + step->operands))
                return false;
        return true;
    }

    void run(const Selection &selection) const {
        const Selection::Rows *rows = selection.loops.data();
        const auto *loops = loops_.data();
        Cell *cells = cells_;
        const std::size_t n = n_;
        if (!selection.packed.empty()) {
            const std::uint32_t *operands = selection.packed_operands;
            for (const Step &step : selection.packed)
                if (step.kind == StepKind::Run)
                    loops[step.target](cells, operands + step.operands, step.once ? 1 : n);
                else
                    other(step, operands + step.operands, selection, rows);
            return;
        }
        const std::uint32_t *operands = selection.operands;
        for (const std::uint32_t id : selection.steps) {
            const Step &step = selection.table[id];
            if (step.kind == StepKind::Run)
                loops[step.target](cells, operands + step.operands, step.once ? 1 : n);
            else
                other(step, operands + step.operands, selection, rows);
        }
    }

  private:
    // A selection's step that is no kernel; `rows`: of the loops from here on.
    void other(const Step &step, const std::uint32_t *operands, const Selection &selection,
               const Selection::Rows *&rows) const {
        if (step.kind != StepKind::Loop) {
            one(step, operands);
            return;
        }
        const Loop &loop = program_.loops[step.target];
        if (rows->all)
            this->loop(loop);
        else
            iterations(loop, selection.rows + rows->first, *rows);
        ++rows;
    }

    bool one(const Step &step, const std::uint32_t *operands) const {
        const std::size_t n = step.once ? 1 : n_;
        switch (step.kind) {
        case StepKind::Run: loops_[step.target](cells_, operands, n); break;
        case StepKind::TableRead: read(program_.reads[step.target], operands, n); break;
        case StepKind::Image: image(program_.images[step.target], operands, n); break;
        case StepKind::Grid: grid(program_.grids[step.target], operands, n); break;
        case StepKind::Call: run(step.target); break;
        case StepKind::Loop: loop(program_.loops[step.target]); break;
        case StepKind::BreakUnless:
            return !std::all_of(cells_ + *operands, cells_ + *operands + n,
                                [](const Cell &c) { return !int_at(c); });
        }
        return true;
    }

    // Turns of a loop of balls, a pack at a time; rows: which, or the first `count`.
    void balls(const BallRows &balls, const std::uint32_t *rows, std::size_t count,
               const Cut &cut = {}) const {
        if constexpr (std::is_same_v<Cell, Word>) {
            const BallPoints points{cells_ + balls.carried, cells_ + balls.place[0],
                                    cells_ + balls.place[1], cells_ + balls.place[2], n_};
            const BallLoops loops = ball_loops();
            alignas(64) float drop[batch_size];
            if (cut.any()) begin_cut(balls, cut, drop);
            const auto run = [&](const float *numbers, std::size_t n) {
                if (cut.any())
                    loops.smooth_dropping(points, numbers, n, number_at(cells_[balls.k]), drop);
                else if (balls.smooth)
                    loops.smooth(points, numbers, n, number_at(cells_[balls.k]));
                else
                    loops.minimum(points, numbers, n);
            };
            if (!rows) return run(balls.numbers.data(), count);
            constexpr std::size_t maximum = 128;
            alignas(64) float pack[4 * maximum];
            for (std::size_t first = 0; first < count; first += maximum) {
                const std::size_t n = std::min(maximum, count - first);
                for (std::size_t i = 0; i < n; ++i)
                    std::memcpy(pack + 4 * i,
                                balls.numbers.data() + 4 * std::size_t{rows[first + i]},
                                4 * sizeof(float));
                run(pack, n);
            }
            if (cut.any())
                for (std::size_t k = 0; k < n_; ++k) unknown_[k] |= drop[k] < cut.drop;
        }
    }
    // Where the chain begins with less than the bound it begins with what is true.
    void begin_cut(const BallRows &balls, const Cut &cut, float *drop) const {
        if constexpr (std::is_same_v<Cell, Word>)
            for (std::size_t k = 0; k < n_; ++k) {
                Cell &carried = cells_[balls.carried + k];
                const bool known = number_at(carried) <= cut.start;
                drop[k] = known ? cut.drop : -cut.drop;
                if (!known) store_number(carried, cut.start);
            }
    }
    bool is_balls(const Loop &loop) const {
        return std::is_same_v<Cell, Word> && loop.balls >= 0 && n_ % 16 == 0;
    }

    void iterations(const Loop &loop, const std::uint32_t *rows,
                    const Selection::Rows &which) const {
        if (is_balls(loop))
            return balls(program_.ball_loops[static_cast<std::size_t>(loop.balls)], rows,
                         which.count, which.cut);
        for (std::size_t i = 0; i < which.count; ++i) {
            store_word(cells_[loop.index], static_cast<std::int32_t>(rows[i]));
            run(loop.block);
        }
    }

    void loop(const Loop &loop) const {
        std::int32_t count = int_at(cells_[loop.count]);
        if (!loop.once)
            for (std::size_t k = 1; k < n_; ++k)
                count = std::max(count, int_at(cells_[loop.count + k]));
        count = std::min(count, loop.max_count);
        if (is_balls(loop))
            return balls(program_.ball_loops[static_cast<std::size_t>(loop.balls)], nullptr,
                         static_cast<std::size_t>(std::max(count, 0)));
        for (std::int32_t iteration = 0; iteration < count; ++iteration) {
            store_word(cells_[loop.index], iteration);
            if (!run(loop.block)) break;
        }
    }

    void read(const Read &read, const std::uint32_t *operands, std::size_t n) const {
        const Cell *rows = cells_ + operands[read.columns];
        const float *data = program_.table_data.data() + read.first;
        for (std::size_t k = 0; k < n; ++k) {
            int row = inside(int_at(rows[k]), read.rows);
            const float *from = data + static_cast<std::ptrdiff_t>(row) * read.stride;
            for (int c = 0; c < read.columns; ++c)
                store_number(cells_[operands[c] + k], Number(from[c]));
        }
    }

    void image(const ir::ImageData &image, const std::uint32_t *operands, std::size_t n) const {
        for (std::size_t k = 0; k < n; ++k) {
            auto rgba = sample_image(image, number_at(cells_[operands[4] + k]),
                                     number_at(cells_[operands[5] + k]));
            for (std::size_t c = 0; c < 4; ++c) store_number(cells_[operands[c] + k], rgba[c]);
        }
    }

    void grid(const ir::GridData &grid, const std::uint32_t *operands, std::size_t n) const {
        for (std::size_t k = 0; k < n; ++k)
            store_number(cells_[operands[0] + k],
                         sample_grid(grid, number_at(cells_[operands[1] + k]),
                                     number_at(cells_[operands[2] + k]),
                                     number_at(cells_[operands[3] + k])));
    }

    const Program &program_;
    Loops<Cell> loops_;
    Cell *cells_;
    std::size_t n_;
    std::uint8_t *unknown_;
};

template <class Cell> void fill_shared(const Program &program, const Inputs &inputs, Cell *cells) {
    using Kind = Program::Shared::Kind;
    using Number = typename Runner<Cell>::Number;
    for (const Program::Shared &shared : program.shared) {
        Cell &cell = cells[shared.address];
        switch (shared.kind) {
        case Kind::Float: store_number(cell, Number(std::bit_cast<float>(shared.bits))); break;
        case Kind::Int: store_word(cell, static_cast<std::int32_t>(shared.bits)); break;
        case Kind::Time: store_number(cell, Number(static_cast<float>(inputs.time))); break;
        case Kind::Param: {
            double value = inputs.params[shared.param][shared.component];
            if (shared.type == ir::Type::Float)
                store_number(cell, Number(static_cast<float>(value)));
            else
                store_word(cell, ir::sem::saturate(value));
            break;
        }
        }
    }
}

template <class Cell, class S> S make(const Program &program, const Inputs &inputs) {
    constexpr std::size_t line = 64;
    S scratch;
    scratch.memory.resize(program.cells + line / sizeof(Cell));
    auto past = reinterpret_cast<std::uintptr_t>(scratch.memory.data()) % line;
    scratch.cells = scratch.memory.data() + (line - past) % line / sizeof(Cell);
    fill_shared(program, inputs, scratch.cells);
    return scratch;
}

// Batches are filled up with their last point to whole vectors, so that no loop needs a slow end.
std::size_t whole(std::size_t n) { return (n + 15) / 16 * 16; }

} // namespace

Inputs inputs_of(const ir::Scene &scene, double time) {
    Inputs inputs;
    inputs.time = time;
    for (const ir::Param &param : scene.params) inputs.params.push_back(param.value);
    return inputs;
}

Scratch make_scratch(const Program &program, const Inputs &inputs) {
    return make<Word, Scratch>(program, inputs);
}

GradientScratch make_gradient_scratch(const Program &program, const Inputs &inputs) {
    return make<DualCell, GradientScratch>(program, inputs);
}

namespace {

template <class Run> void in_batches(const Program &program, Scratch &scratch,
                                     const float *const *in, float *const *out, std::size_t n,
                                     Run &&run) {
    const Loops<Word> loops = point_loops();
    for (std::size_t first = 0; first < n; first += batch_size) {
        std::size_t count = std::min(batch_size, n - first), all = whole(count);
        for (std::size_t c = 0; c < program.params.size(); ++c) {
            Word *to = scratch.cells + program.params[c].address;
            std::memcpy(to, in[c] + first, count * sizeof(Word));
            std::fill(to + count, to + all, to[count - 1]);
        }
        run(scratch.cells, loops, first, count, all);
        for (std::size_t c = 0; c < program.results.size(); ++c) {
            const Word *from = scratch.cells + program.results[c].address;
            if (program.results[c].shared)
                std::fill(out[c] + first, out[c] + first + count, std::bit_cast<float>(*from));
            else
                std::memcpy(out[c] + first, from, count * sizeof(Word));
        }
    }
}

} // namespace

void evaluate(const Program &program, Scratch &scratch, const float *const *in, float *const *out,
              std::size_t n) {
    const auto root = static_cast<std::uint32_t>(program.blocks.size() - 1);
    in_batches(program, scratch, in, out, n,
               [&](Word *cells, Loops<Word> loops, std::size_t, std::size_t, std::size_t all) {
                   Runner<Word>(program, loops, cells, all).run(root);
               });
}

std::size_t evaluate(const Program &program, Scratch &scratch, const float *const *in,
                     float *const *out, std::size_t n, const Selection &selection,
                     std::uint32_t *unknown) {
    bool cuts = false;
    for (const Selection::Rows &rows : selection.loops) cuts = cuts || rows.cut.any();
    std::size_t open = 0;
    in_batches(
        program, scratch, in, out, n,
        [&](Word *cells, Loops<Word> loops, std::size_t first, std::size_t count, std::size_t all) {
            std::uint8_t marks[batch_size];
            if (cuts) std::fill_n(marks, all, std::uint8_t{0});
            Runner<Word>(program, loops, cells, all, marks).run(selection);
            for (std::size_t k = 0; cuts && k < count; ++k)
                if (marks[k]) unknown[open++] = static_cast<std::uint32_t>(first + k);
        });
    return open;
}

namespace {

template <class Run> void gradients_in_batches(const Program &program, GradientScratch &scratch,
                                               const float *const *in, float *const *out,
                                               std::size_t n, Run &&run) {
    DualCell *cells = scratch.cells;
    const Loops<DualCell> loops = gradient_loops();
    for (std::size_t first = 0; first < n; first += batch_size) {
        std::size_t count = std::min(batch_size, n - first);
        for (std::size_t c = 0; c < program.params.size(); ++c) {
            DualCell *to = cells + program.params[c].address;
            for (std::size_t k = 0; k < count; ++k) {
                float x = in[c][first + k];
                if (program.params[c].type == ir::Type::Float)
                    store(to[k], Dual(x, c == 0 ? 1.0f : 0.0f, c == 1 ? 1.0f : 0.0f,
                                      c == 2 ? 1.0f : 0.0f));
                else
                    store(to[k], std::bit_cast<std::int32_t>(x));
            }
        }
        run(Runner<DualCell>(program, loops, cells, count));
        const Program::Slot result = program.results[0];
        for (std::size_t k = 0; k < count; ++k) {
            Dual value = load<Dual>(cells[result.address + (result.shared ? 0 : k)]);
            out[0][first + k] = value.value;
            out[1][first + k] = value.dx;
            out[2][first + k] = value.dy;
            out[3][first + k] = value.dz;
        }
    }
}

} // namespace

void evaluate_gradient(const Program &program, GradientScratch &scratch, const float *const *in,
                       float *const *out, std::size_t n) {
    const auto root = static_cast<std::uint32_t>(program.blocks.size() - 1);
    gradients_in_batches(program, scratch, in, out, n,
                         [&](const Runner<DualCell> &runner) { runner.run(root); });
}

void evaluate_gradient(const Program &program, GradientScratch &scratch, const float *const *in,
                       float *const *out, std::size_t n, const Selection &selection) {
    gradients_in_batches(program, scratch, in, out, n,
                         [&](const Runner<DualCell> &runner) { runner.run(selection); });
}

std::string dump(const Program &program) {
    std::string text;
    for (std::size_t b = 0; b < program.blocks.size(); ++b) {
        text += fmt::format("block {}\n", b);
        for (std::uint32_t i = program.blocks[b].first; i < program.blocks[b].last; ++i) {
            const Step &step = program.steps[i];
            std::size_t operands = 0;
            switch (step.kind) {
            case StepKind::Run: {
                Kernel kernel = kernel_of_variant(step.target);
                text += std::string("  ") + kernel_name(kernel);
                operands = static_cast<std::size_t>(kernel_inputs(kernel) + kernel_outputs(kernel));
                break;
            }
            case StepKind::TableRead:
                text += "  table read";
                operands = static_cast<std::size_t>(program.reads[step.target].columns) + 1;
                break;
            case StepKind::Image:
                text += "  image";
                operands = 6;
                break;
            case StepKind::Grid:
                text += "  grid";
                operands = 4;
                break;
            case StepKind::Call: text += fmt::format("  call {}", step.target); break;
            case StepKind::Loop:
                text += fmt::format("  loop {}", program.loops[step.target].block);
                break;
            case StepKind::BreakUnless:
                text += "  break unless";
                operands = 1;
                break;
            }
            if (step.once) text += " once";
            for (std::size_t o = 0; o < operands; ++o)
                text += fmt::format(" {}", program.operands[step.operands + o]);
            text += "\n";
        }
    }
    return text;
}

} // namespace fathom::cpu
