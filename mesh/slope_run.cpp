#include "mesh/slope_run.h"

#include <algorithm>
#include <cmath>

namespace fathom::mesh {
namespace {

using cpu::Kernel;

// Where a number is 0 one of its alternatives is.
Zeros zeros_of_alternatives(const Alternatives &alternatives, const Varying &number,
                            const Point &lo, const Point &hi) {
    Zeros zeros{true, {}};
    for (const Alternative &alternative : alternatives.all) {
        Varying one = number;
        one.slope = alternative.slope;
        const Linear sheet = linear_of(one, alternative.middle, lo, hi);
        double most = sheet.off; // that it may be, less its middle
        for (std::size_t i = 0; i < 3; ++i)
            most += std::fabs(sheet.slope[i]) * (double(hi[i]) - lo[i]);
        if (std::fabs(sheet.value) > most) continue;
        if (!is_steady(sheet)) return {};
        zeros.sheets.push_back(sheet);
    }
    return zeros;
}

// Runs a tape's steps one by one.
struct SlopeRunner {
    Evaluator &evaluator;
    const SlopeQuestion &question;
    const SeeNumber &see;
    Slopes slopes;
    const cpu::Selection tape;
    std::vector<Varying> in{};
    std::vector<Zeros> their{};
    std::vector<Operand> of{}; // a kernel's inputs
    std::vector<Chosen>
        chosen{}; // … by alternatives, where one of them has several or the kernel chooses
    std::array<double, 3> reach{};    // from the middle of the box
    std::uint32_t ids = 0;            // that are given
    double left = evaluator.followed; // steps of loops

    const cpu::PruneProgram &parts() const { return evaluator.field.parts; }
    const cpu::Program &program() const { return evaluator.field.program; }

    std::uint32_t new_id(const Zeros &zeros) {
        if (question.zeros) slopes.memory.by_id.push_back(zeros);
        return ++ids;
    }

    void enter() {
        const Point middle = middle_point(question.lo, question.hi);
        for (std::size_t i = 0; i < 3; ++i)
            reach[i] =
                std::max(double(question.hi[i]) - middle[i], double(middle[i]) - question.lo[i]);
        if (question.zeros) slopes.memory.by_id.assign(1, {});
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const std::size_t slot = slopes.slot(program().params[axis].address);
            slopes.forget(slot);
            Varying &input = slopes.number(slot);
            input.known = true;
            input.slope[axis] = {1, 1};
            input.slope[3] = {question.along[axis], question.along[axis]};
            input.id = new_id({});
        }
    }

    // How many steps an iteration of a block takes at most; none where not all of it can be followed.
    std::optional<double> length_of(const cpu::Program::Block &block) const {
        double length = 0;
        for (std::uint32_t id = block.first; id < block.last; ++id) {
            const cpu::Step &step = parts().table[id];
            if (step.kind == cpu::StepKind::BreakUnless || step.kind == cpu::StepKind::Call)
                return std::nullopt;
            ++length;
        }
        return length;
    }

    // Follows a loop whose count is one number, while there are steps left. `rows`: some of its
    // iterations, of a loop of the tape itself.
    bool follow(const cpu::Loop &loop, const cpu::Selection::Rows &rows) {
        cpu::Shortener &ranges = evaluator.ranges;
        const cpu::Program::Block &block = program().blocks[loop.block];
        const auto length = length_of(block);
        if (loop.breaks || !loop.once || rows.cut.any() || !length ||
            ranges.lo[loop.count] != ranges.hi[loop.count])
            return false;
        const double count =
            rows.all ? std::clamp(ranges.hi[loop.count], 0.0f, static_cast<float>(loop.max_count))
                     : rows.count;
        if (count * *length > left) return false;
        left -= count * *length;
        for (std::uint32_t i = 0; i < static_cast<std::uint32_t>(count); ++i) {
            ranges.lo[loop.index] = ranges.hi[loop.index] =
                static_cast<float>(rows.all ? i : tape.rows[rows.first + i]);
            for (std::uint32_t id = block.first; id < block.last; ++id)
                if (parts().table[id].kind == cpu::StepKind::Loop)
                    run_loop(id, {0, 0, true, {}});
                else
                    run_step(id, {});
        }
        return true;
    }

    void run_loop(std::uint32_t id, const cpu::Selection::Rows &rows) {
        if (follow(program().loops[parts().table[id].target], rows)) return;
        run_ranges(id, {&rows, 1});
        forget(id);
        blame(id, std::nullopt);
    }

    // Nothing is known of what a step writes.
    void forget(std::uint32_t id) {
        const cpu::Part &part = parts().parts[id];
        for (std::uint32_t n = 0; n < part.writes; ++n)
            slopes.forget(parts().slots[part.first_slot + n]);
    }

    // Says of what a step writes and is not known why: since an input is not, or by the step itself.
    void blame(std::uint32_t id, const std::optional<Missing> &of_inputs) {
        const cpu::Step &step = parts().table[id];
        const cpu::Part &part = parts().parts[id];
        Missing own{step.kind, {}};
        if (step.kind == cpu::StepKind::Run) own.kernel = cpu::kernel_of_variant(step.target);
        for (std::uint32_t n = 0; n < part.writes; ++n) {
            const std::size_t slot = parts().slots[part.first_slot + n];
            if (!slopes.number(slot).known)
                slopes.memory.slots[slot].missing = of_inputs.value_or(own);
        }
    }

    std::optional<Missing> missing_of_inputs(std::uint32_t id) const {
        const cpu::Step &step = parts().table[id];
        const cpu::Part &part = parts().parts[id];
        for (std::uint32_t n = part.writes; n < part.operands; ++n)
            if (const auto of = slopes.missing_at(parts().operands[step.operands + n])) return of;
        return std::nullopt;
    }

    // The ranges alone. `loops`: the rows of a loop.
    void run_ranges(const std::uint32_t &id, std::span<const cpu::Selection::Rows> loops) {
        cpu::Selection here = tape;
        here.steps = {&id, 1};
        here.loops = loops;
        cpu::run_steps(parts(), evaluator.ranges, here);
    }

    // `number`: of the step in the tape, where what it gives is to be seen.
    void run_step(std::uint32_t id, std::optional<std::size_t> number) {
        const cpu::Step &step = parts().table[id];
        const cpu::Part &part = parts().parts[id];
        const std::uint32_t *operands = parts().operands.data() + step.operands;
        const bool waves = step.kind == cpu::StepKind::Run &&
                           cpu::kernel_of_variant(step.target) == Kernel::SinCos;
        const bool plain =
            step.kind == cpu::StepKind::Run && !step.once && part.writes == (waves ? 2u : 1u);
        std::array<Varying, 2> made;
        if (plain) take_operands(step, part, waves, made);
        const std::optional<Missing> missing = missing_of_inputs(id);
        run_ranges(id, {});
        forget(id);
        // One number all over the box, as the copy of a repetition, or a row: it does not change.
        const bool runs =
            (step.kind == cpu::StepKind::Run || step.kind == cpu::StepKind::TableRead) &&
            !step.once;
        for (std::uint32_t n = 0; runs && n < std::min(part.writes, part.operands); ++n)
            if (const std::uint32_t to = operands[n]; !slopes.shared(to))
                slopes.number(slopes.slot(to)).known =
                    evaluator.ranges.lo[to] == evaluator.ranges.hi[to];
        for (std::uint32_t n = 0; plain && n < part.writes; ++n)
            if (!slopes.shared(operands[n])) put(step, operands[n], waves, made[n], number);
        blame(id, missing);
    }

    // What a kernel gives, by what its inputs are before it runs.
    void take_operands(const cpu::Step &step, const cpu::Part &part, bool waves,
                       std::array<Varying, 2> &made) {
        const std::uint32_t *operands = parts().operands.data() + step.operands;
        in.clear(), of.clear(), their.clear();
        for (std::uint32_t n = part.writes; n < part.operands; ++n)
            slopes.read(operands[n], in.emplace_back());
        if (waves)
            made = {wave_of(in[0], false), wave_of(in[0], true)};
        else
            made[0] = through(cpu::kernel_of_variant(step.target), in);
        for (const Varying &one : in) {
            made[0].jumps = made[0].jumps || (one.jumps && one.range.lo < one.range.hi);
            made[0].beyond += one.beyond;
        }
        if (waves) made[1].jumps = made[0].jumps, made[1].beyond = made[0].beyond;
        if (!question.zeros) return;
        their.reserve(in.size());
        for (std::uint32_t n = part.writes; n < part.operands; ++n) {
            their.push_back(slopes.zeros_at(operands[n]));
            of.push_back({operands[n], &in[n - part.writes], &their.back()});
        }
        take_alternatives(cpu::kernel_of_variant(step.target), operands + part.writes);
    }

    // What alternatives its inputs have, where what it gives may have several.
    void take_alternatives(Kernel kernel, const std::uint32_t *operands) {
        chosen.clear();
        bool several = chooses(kernel) || kernel == Kernel::Distance3;
        for (const Varying &one : in) several = several || one.several;
        if (!several) return;
        for (std::size_t n = 0; n < in.size(); ++n)
            chosen.push_back({&in[n], slopes.alternatives_at(operands[n], in[n])});
    }

    // The slopes of a number lie within those of its alternatives.
    void put_alternatives(Kernel kernel, SlopeMemory::Slot &slot, Varying &made) {
        slot.alternatives = {};
        if (chosen.empty()) return;
        const auto see_zeros = [&](const Alternatives &of) {
            if (!of.known) return;
            const Zeros zeros = zeros_of_alternatives(of, made, question.lo, question.hi);
            if (zeros.known &&
                (!slot.zeros.known || zeros.sheets.size() < slot.zeros.sheets.size()))
                slot.zeros = zeros;
        };
        if (kernel == Kernel::Distance3)
            for (const Alternatives &part : differences_of(chosen)) see_zeros(part);
        slot.alternatives = alternatives_of(kernel, chosen, reach);
        made.several = slot.alternatives.known;
        if (!slot.alternatives.known || !made.known) return;
        for (std::size_t i = 0; i < directions; ++i) {
            Interval all = slot.alternatives.all[0].slope[i];
            for (const Alternative &alternative : slot.alternatives.all)
                all = hull(all, alternative.slope[i]);
            made.slope[i] = {std::max(made.slope[i].lo, all.lo),
                             std::min(made.slope[i].hi, all.hi)};
        }
        see_zeros(slot.alternatives);
    }

    void put(const cpu::Step &step, std::uint32_t to, bool waves, Varying &made,
             std::optional<std::size_t> number) {
        const cpu::Shortener &ranges = evaluator.ranges;
        SlopeMemory::Slot &slot = slopes.memory.slots[slopes.slot(to)];
        if (question.zeros && !waves) {
            std::optional<Linear> itself;
            if (made.known && !made.jumps)
                itself = linear_of(made, {ranges.lo[to + 1], ranges.hi[to + 1]}, question.lo,
                                   question.hi);
            slot.zeros =
                zeros_of(cpu::kernel_of_variant(step.target), of, itself, slopes.memory.by_id);
            put_alternatives(cpu::kernel_of_variant(step.target), slot, made);
        }
        if (!made.known) return;
        if (made.id == 0) made.id = new_id(question.zeros ? slopes.zeros_at(to) : Zeros{});
        slot.number = made;
        if (see && number) see({*number, to}, made);
    }

    void run() {
        enter();
        std::size_t loops = 0; // before the step at hand: they have rows of their own
        for (std::size_t k = 0; k < tape.steps.size(); ++k)
            if (parts().table[tape.steps[k]].kind == cpu::StepKind::Loop)
                run_loop(tape.steps[k], tape.loops[loops++]);
            else
                run_step(tape.steps[k], k);
    }
};

} // namespace

void Slopes::forget(std::size_t slot) const {
    SlopeMemory::Slot &of = memory.slots[slot];
    of.run = memory.run;
    of.number = {};
    of.zeros.known = false;
    of.zeros.sheets.clear();
    of.alternatives = {};
    of.missing.reset();
}

std::optional<Missing> Slopes::missing_at(std::uint32_t address) const {
    if (shared(address)) return std::nullopt;
    const SlopeMemory::Slot &of = memory.slots[slot(address)];
    return of.run == memory.run && !of.number.known ? of.missing : std::nullopt;
}

void Slopes::read(std::uint32_t address, Varying &found) const {
    if (shared(address))
        found.known = true;
    else if (const SlopeMemory::Slot &of = memory.slots[slot(address)]; of.run == memory.run)
        found = of.number;
    // Of its floats and of the real number.
    found.range = {ranges.lo[address] - found.error, ranges.hi[address] + found.error};
    found.known = found.known && std::isfinite(found.range.lo) && std::isfinite(found.range.hi);
}

Zeros Slopes::zeros_at(std::uint32_t address) const {
    if (ranges.lo[address] > 0 || ranges.hi[address] < 0) return {true, {}};
    if (!with_zeros || shared(address)) return {};
    const SlopeMemory::Slot &of = memory.slots[slot(address)];
    return of.run == memory.run ? of.zeros : Zeros{};
}

Alternatives Slopes::alternatives_at(std::uint32_t address, const Varying &number) const {
    if (!shared(address))
        if (const SlopeMemory::Slot &of = memory.slots[slot(address)];
            of.run == memory.run && of.alternatives.known)
            return of.alternatives;
    return shared(address) ? single(number, {ranges.lo[address], ranges.hi[address]})
                           : single(number, {ranges.lo[address + 1], ranges.hi[address + 1]});
}

Linear linear_of(const Varying &number, Interval middle, const Point &lo, const Point &hi) {
    const Point at = middle_point(lo, hi);
    const double rounding = 0.5 * (middle.hi - middle.lo) + 2 * (number.error + 2 * number.beyond);
    Linear linear{0.5 * (middle.lo + middle.hi), rounding, rounding, {}, {}};
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval slope = number.slope[i];
        const double reach = std::max(double(hi[i]) - at[i], double(at[i]) - lo[i]);
        linear.slope[i] = 0.5 * (slope.lo + slope.hi);
        linear.spread[i] = 0.5 * (slope.hi - slope.lo) * (1 + 1e-9) + 1e-9 * size(slope);
        linear.off += 0.5 * (slope.hi - slope.lo) * reach;
    }
    linear.off *= 1 + 1e-9;
    return linear;
}

Slopes slopes_over(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                   const SlopeQuestion &question, const SeeNumber &see) {
    const Field &field = evaluator.field;
    const Point &lo = question.lo, &hi = question.hi, middle = middle_point(lo, hi);
    boxes.count = 16; // of which the first is looked at, and the second: its middle
    for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t k = 0; k < boxes.count; ++k) {
            boxes.lo[i][k] = k == 1 ? middle[i] : lo[i];
            boxes.hi[i][k] = k == 1 ? middle[i] : hi[i];
        }
    cpu::enter_boxes(field.parts, evaluator.ranges, boxes);
    if (!evaluator.slopes) evaluator.slopes = std::make_shared<SlopeMemory>();
    SlopeMemory &memory = *evaluator.slopes;
    memory.slots.resize(field.parts.slot_count);
    ++memory.run;
    SlopeRunner runner{evaluator, question, see,
                       Slopes{field.parts, evaluator.ranges, memory, question.zeros},
                       tape.selection(field.parts)};
    runner.run();
    return runner.slopes;
}

} // namespace fathom::mesh
