// Ranges of what stands still, by pieces of one number that it reads: `4*t*(1 - t)` reads t twice,
// and intervals take the two for any two numbers of its range.
#include "proof/machine.h"

#include <algorithm>

namespace fathom::proof {

namespace {

constexpr std::size_t most_instructions = 400, most_inputs = 6;
constexpr int pieces = 32;

// What others are computed from: params, the time, and what makes a range of a time without end.
bool is_input(const Instruction &instruction) {
    constexpr ir::OpSet inputs{Op::Param, Op::Time, Op::Fract, Op::Mod, Op::Sin, Op::Cos};
    return inputs[instruction.op] && instruction.type == ir::Type::Float &&
           instruction.form == Form::Plain;
}

} // namespace

void Machine::narrow_still() {
    if (tape_.once.size() > most_instructions) return;
    const std::vector<Interval> found = value_;
    std::vector<Interval> least = value_;
    const auto each_value = [&](const Instruction &instruction, const auto &what) {
        const std::uint32_t first = tape_.first[instruction.out];
        for (std::uint32_t at = first; at < first + tape_.size[instruction.out]; ++at) what(at);
    };
    const std::size_t before = work_;
    std::size_t inputs = 0;
    for (std::size_t k = 0; k < tape_.once.size() && inputs < most_inputs; ++k) {
        const Interval whole = found[tape_.first[tape_.once[k].out]];
        if (!is_input(tape_.once[k]) || !whole.finite() || !(whole.lo < whole.hi)) continue;
        ++inputs;
        std::vector<Interval> all(value_.size(), Interval(infinity_, -infinity_));
        double lo = whole.lo;
        for (int piece = 1; piece <= pieces; ++piece) {
            const double way = double(piece) / pieces,
                         hi = piece == pieces ? whole.hi : whole.lo + way * (whole.hi - whole.lo);
            for (std::size_t i = 0; i < tape_.once.size(); ++i, ++work_) {
                step(tape_.once[i]);
                if (i == k) value_[tape_.first[tape_.once[k].out]] = Interval(lo, hi);
            }
            for (const Instruction &instruction : tape_.once)
                each_value(instruction,
                           [&](std::uint32_t at) { all[at] = hull(all[at], value_[at]); });
            lo = hi;
        }
        for (const Instruction &instruction : tape_.once)
            each_value(instruction,
                       [&](std::uint32_t at) { least[at] = meet(least[at], all[at]); });
    }
    if (inputs == 0) return;
    for (const Instruction &instruction : tape_.once) {
        step(instruction);
        each_value(instruction,
                   [&](std::uint32_t at) { value_[at] = meet(value_[at], least[at]); });
    }
    ranges_.work->take(work_ - before);
}

} // namespace fathom::proof
