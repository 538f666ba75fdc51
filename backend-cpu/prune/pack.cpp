// See pack.h. Of a straight tape each write of a register is a value of its own, and a copy is the
// value that it copies; the values are then given registers anew, in order. Those that loops and
// calls inside the tape use stay as they are, for their bodies are shared by all tapes.
#include "backend-cpu/prune/pack.h"

#include <algorithm>
#include <limits>

namespace fathom::cpu {

namespace {

constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
constexpr std::uint32_t unused = 0, forever = none; // last uses; steps are counted from 1

} // namespace

Packer::Packer(const PruneProgram &parts)
    : parts_(parts), program_(*parts.program), pinned_(program_.registers),
      result_(program_.registers), taken_(program_.registers), holds_(program_.registers) {
    for (const Program::Slot &slot : program_.results)
        if (is_register(slot.address)) result_[register_of(slot.address)] = 1;
}

bool Packer::is_register(std::uint32_t address) const { return address >= program_.first_register; }

std::uint32_t Packer::register_of(std::uint32_t address) const {
    return (address - static_cast<std::uint32_t>(program_.first_register)) /
           static_cast<std::uint32_t>(batch_size);
}

// From one register to another, for all points.
bool Packer::is_copy(std::uint32_t id) const {
    const Step &step = parts_.table[id];
    if (step.kind != StepKind::Run || step.once || mask_of_variant(step.target) != 0) return false;
    const Kernel kernel = kernel_of_variant(step.target);
    if (kernel != Kernel::CopyF && kernel != Kernel::CopyI) return false;
    const std::uint32_t *operands = parts_.operands.data() + step.operands;
    return is_register(operands[0]) && !pinned_[register_of(operands[0])] &&
           is_register(operands[1]) && !pinned_[register_of(operands[1])];
}

void Packer::pin(const ShortTape &tape) {
    std::ranges::fill(pinned_, 0);
    const auto first = static_cast<std::uint32_t>(program_.first_register);
    for (const std::uint32_t id : tape.steps) {
        const StepKind kind = parts_.table[id].kind;
        if (kind != StepKind::Loop && kind != StepKind::Call) continue;
        const Part &part = parts_.parts[id];
        for (std::uint32_t k = 0; k < part.writes + part.reads; ++k)
            if (const std::uint32_t slot = parts_.slots[part.first_slot + k];
                slot >= first && slot - first < program_.registers)
                pinned_[slot - first] = 1;
    }
}

// The values of a tape, which of them each operand is, and where each is last used. False: the tape
// reads what it did not make.
bool Packer::find_values(const ShortTape &tape) {
    values_.clear(), operands_.clear();
    std::ranges::fill(holds_, none);
    for (const Program::Slot &slot : program_.params)
        if (is_register(slot.address) && !pinned_[register_of(slot.address)]) {
            holds_[register_of(slot.address)] = static_cast<std::uint32_t>(values_.size());
            values_.push_back({unused, register_of(slot.address), none});
        }
    initial_ = static_cast<std::uint32_t>(values_.size());
    std::uint32_t position = 0;
    for (const std::uint32_t id : tape.steps)
        if (!find_step(id, ++position)) return false;
    return find_results();
}

bool Packer::find_step(std::uint32_t id, std::uint32_t position) {
    const Step &step = parts_.table[id];
    const Part &part = parts_.parts[id];
    const std::uint32_t *operands = parts_.operands.data() + step.operands;
    if (is_copy(id)) {
        holds_[register_of(operands[0])] = holds_[register_of(operands[1])];
        return holds_[register_of(operands[0])] != none;
    }
    const std::size_t begin = operands_.size();
    operands_.resize(begin + part.operands, none);
    const auto renamed = [&](std::size_t k) {
        return is_register(operands[k]) && !pinned_[register_of(operands[k])];
    };
    const std::size_t outs = std::min(part.surely, part.operands);
    for (std::size_t k = outs; k < part.operands; ++k) {
        if (!renamed(k)) continue;
        const std::uint32_t value = holds_[register_of(operands[k])];
        if (value == none || step.once) return false;
        operands_[begin + k] = value;
        values_[value].last_use = position;
    }
    for (std::size_t k = 0; k < outs; ++k) {
        if (!renamed(k)) continue;
        if (step.once) return false;
        operands_[begin + k] = holds_[register_of(operands[k])] =
            static_cast<std::uint32_t>(values_.size());
        values_.push_back({unused, none, none});
    }
    return true;
}

bool Packer::find_results() {
    for (const Program::Slot &slot : program_.results) {
        if (!is_register(slot.address) || pinned_[register_of(slot.address)]) continue;
        const std::uint32_t value = holds_[register_of(slot.address)];
        if (value == none || value < initial_) return false;
        values_[value].last_use = forever;
        if (values_[value].result == none) values_[value].result = register_of(slot.address);
    }
    return true;
}

void Packer::begin_places() {
    std::ranges::fill(taken_, 0);
    std::vector<char> used(program_.registers);
    for (std::uint32_t v = 0; v < initial_; ++v)
        if (values_[v].last_use != unused) used[values_[v].at] = 1;
    free_.clear();
    for (auto r = static_cast<std::uint32_t>(program_.registers); r-- > 0;) {
        taken_[r] = used[r];
        if (!pinned_[r] && !result_[r] && !used[r]) free_.push_back(r);
    }
}

void Packer::release(std::uint32_t value) {
    const std::uint32_t at = values_[value].at;
    taken_[at] = 0;
    if (!result_[at]) free_.push_back(at);
}

// A result's register is for that result alone.
bool Packer::take(std::uint32_t value) {
    Value &made = values_[value];
    if (made.result != none && !taken_[made.result]) {
        made.at = made.result;
    } else {
        if (free_.empty()) return false;
        made.at = free_.back();
        free_.pop_back();
    }
    taken_[made.at] = 1;
    return true;
}

// False: there are too few registers.
bool Packer::place(const ShortTape &tape, std::vector<Step> &steps,
                   std::vector<std::uint32_t> &operands) {
    begin_places();
    const auto address = [&](std::uint32_t value) {
        return static_cast<std::uint32_t>(program_.first_register +
                                          std::size_t{values_[value].at} * batch_size);
    };
    std::uint32_t position = 0;
    std::size_t at = 0; // in operands_
    for (const std::uint32_t id : tape.steps) {
        ++position;
        if (is_copy(id)) continue;
        const Part &part = parts_.parts[id];
        Step step = parts_.table[id];
        const std::uint32_t *from = parts_.operands.data() + step.operands;
        step.operands = static_cast<std::uint32_t>(operands.size());
        operands.insert(operands.end(), from, from + part.operands);
        const std::size_t outs = std::min(part.surely, part.operands);
        const std::uint32_t *named = operands_.data() + at;
        at += part.operands;
        for (std::size_t k = outs; k < part.operands; ++k)
            if (named[k] != none) operands[step.operands + k] = address(named[k]);
        // An output may stand where an input ends.
        for (std::size_t k = outs; k < part.operands; ++k)
            if (named[k] != none && values_[named[k]].last_use == position &&
                std::find(named + outs, named + k, named[k]) == named + k)
                release(named[k]);
        for (std::size_t k = 0; k < outs; ++k) {
            if (named[k] == none) continue;
            if (!take(named[k])) return false;
            operands[step.operands + k] = address(named[k]);
        }
        for (std::size_t k = 0; k < outs; ++k)
            if (named[k] != none && values_[named[k]].last_use == unused) release(named[k]);
        steps.push_back(step);
    }
    return true;
}

void Packer::copy_results(std::vector<Step> &steps, std::vector<std::uint32_t> &operands) {
    for (const Program::Slot &slot : program_.results) {
        if (!is_register(slot.address) || pinned_[register_of(slot.address)]) continue;
        const std::uint32_t at = values_[holds_[register_of(slot.address)]].at;
        if (at == register_of(slot.address)) continue;
        const Kernel kernel = slot.type == ir::Type::Float ? Kernel::CopyF : Kernel::CopyI;
        steps.push_back({StepKind::Run, false, best_variant(kernel, 0).index,
                         static_cast<std::uint32_t>(operands.size())});
        operands.push_back(slot.address);
        operands.push_back(
            static_cast<std::uint32_t>(program_.first_register + std::size_t{at} * batch_size));
    }
}

void Packer::as_it_is(const ShortTape &tape, std::vector<Step> &steps,
                      std::vector<std::uint32_t> &operands) const {
    for (const std::uint32_t id : tape.steps) {
        Step step = parts_.table[id];
        const std::uint32_t *from = parts_.operands.data() + step.operands;
        step.operands = static_cast<std::uint32_t>(operands.size());
        operands.insert(operands.end(), from, from + parts_.parts[id].operands);
        steps.push_back(step);
    }
}

void Packer::pack(const ShortTape &tape, std::vector<Step> &steps,
                  std::vector<std::uint32_t> &operands) {
    pin(tape);
    const auto copies = [&](std::uint32_t id) { return is_copy(id); };
    if (std::ranges::any_of(tape.steps, copies) && find_values(tape)) {
        const std::size_t first_step = steps.size(), first_operand = operands.size();
        if (place(tape, steps, operands)) return copy_results(steps, operands);
        steps.resize(first_step), operands.resize(first_operand);
    }
    as_it_is(tape, steps, operands);
}

} // namespace fathom::cpu
