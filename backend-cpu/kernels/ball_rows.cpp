// Finds the loops that are rows of balls, and chooses the instruction set.
#include "backend-cpu/kernels/ball_rows.h"

#include "backend-cpu/kernels/kernels.h"

#include <algorithm>
#include <bit>
#include <optional>

namespace fathom::cpu {

namespace {

// The number that an address has in each row: a table's column, or what all points share.
std::optional<std::vector<float>> numbers_at(const Program &program, const Loop &loop,
                                             std::uint32_t address) {
    const auto rows = static_cast<std::size_t>(loop.max_count);
    const Program::Block body = program.blocks[loop.block];
    for (std::uint32_t i = body.first; i + 1 < body.last; ++i) {
        const Read &read = program.reads[program.steps[i].target];
        const std::uint32_t *out = program.operands.data() + program.steps[i].operands;
        const std::uint32_t *column = std::find(out, out + read.columns, address);
        if (column == out + read.columns) continue;
        std::vector<float> numbers;
        for (std::size_t row = 0; row < rows; ++row) {
            const std::size_t at = std::min(row, static_cast<std::size_t>(read.rows - 1));
            numbers.push_back(
                program.table_data[read.first + at * static_cast<std::size_t>(read.stride) +
                                   static_cast<std::size_t>(column - out)]);
        }
        return numbers;
    }
    for (const Program::Shared &shared : program.shared)
        if (shared.address == address && shared.kind == Program::Shared::Kind::Float)
            return std::vector<float>(rows, std::bit_cast<float>(shared.bits));
    return {};
}

std::optional<BallRows> ball_rows(const Program &program, const Loop &loop) {
    const Program::Block body = program.blocks[loop.block];
    if (loop.breaks || loop.carried.size() != 1 || body.first == body.last || loop.max_count < 1)
        return {};
    for (std::uint32_t i = body.first; i + 1 < body.last; ++i) {
        const Step &step = program.steps[i];
        if (step.kind != StepKind::TableRead || !step.once) return {};
        const Read &read = program.reads[step.target];
        if (program.operands[step.operands + static_cast<std::uint32_t>(read.columns)] !=
                loop.index ||
            read.rows < 1)
            return {};
    }
    const Step &last = program.steps[body.last - 1];
    if (last.kind != StepKind::Run || last.once) return {};
    const Kernel kernel = kernel_of_variant(last.target);
    const bool smooth = kernel == Kernel::SmoothBall;
    const Mask shared = smooth ? 0b111110000 : 0b11110000;
    if ((!smooth && kernel != Kernel::MinBall) || mask_of_variant(last.target) != shared) return {};
    const std::uint32_t *o =
        program.operands.data() + last.operands; // out, a, x, y, z, centre, r[, k]
    const Loop::Carried &carried = loop.carried[0];
    if (o[0] != o[1] || o[0] != carried.var || o[0] != carried.next) return {};
    for (int i = 0; i < 4; ++i)
        if (o[1 + i] < program.first_register) return {};
    BallRows rows{smooth, o[1], {o[2], o[3], o[4]}, smooth ? o[9] : 0, {}};
    if (smooth)
        for (std::uint32_t i = body.first; i + 1 < body.last; ++i) { // k is no column
            const Step &step = program.steps[i];
            const std::uint32_t *out = program.operands.data() + step.operands;
            if (std::find(out, out + program.reads[step.target].columns, o[9]) !=
                out + program.reads[step.target].columns)
                return {};
        }
    rows.numbers.resize(4 * static_cast<std::size_t>(loop.max_count));
    for (std::size_t c = 0; c < 4; ++c) {
        const auto numbers = numbers_at(program, loop, o[5 + c]);
        if (!numbers) return {};
        for (std::size_t row = 0; row < numbers->size(); ++row)
            rows.numbers[4 * row + c] = (*numbers)[row];
    }
    return rows;
}

} // namespace

void find_ball_loops(Program &program) {
    for (Loop &loop : program.loops)
        if (auto rows = ball_rows(program, loop)) {
            loop.balls = static_cast<std::int32_t>(program.ball_loops.size());
            program.ball_loops.push_back(std::move(*rows));
        }
}

namespace base {
BallLoops ball_loops();
}
#ifdef FATHOM_WIDE
namespace avx2 {
BallLoops ball_loops();
}
namespace avx512 {
BallLoops ball_loops();
}
#endif

std::vector<BallLoops> ball_loop_sets() {
    std::vector<BallLoops> sets;
    for (const LoopSet &set : point_loop_sets()) {
        const std::string name = set.name;
        if (name == "base") sets.push_back(base::ball_loops());
#ifdef FATHOM_WIDE
        if (name == "avx2") sets.push_back(avx2::ball_loops());
        if (name == "avx512") sets.push_back(avx512::ball_loops());
#endif
    }
    return sets;
}
BallLoops ball_loops() {
    static const BallLoops fastest = ball_loop_sets().back();
    return fastest;
}

} // namespace fathom::cpu
