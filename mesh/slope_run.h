// A tape over a box, step by step: what each number that it writes is there, and how it changes with
// the place. Loops are run iteration by iteration.
#pragma once

#include "mesh/alternatives.h"
#include "mesh/field.h"
#include "mesh/zeros.h"

#include <functional>
#include <optional>

namespace fathom::mesh {

// Why no slopes are known of a number: which step's result has none.
struct Missing {
    cpu::StepKind kind = cpu::StepKind::Run;
    cpu::Kernel kernel{}; // of a Run
    bool operator==(const Missing &) const = default;
};

// One thread's memory for what is known of numbers by slot: the registers of a tape, and what all
// points share. What an earlier run left is no part of a later one.
struct SlopeMemory {
    struct Slot {
        std::uint64_t run = 0; // that wrote it
        Varying number;
        Zeros zeros;
        Alternatives alternatives;      // known where it is no single one
        std::optional<Missing> missing; // … of a number that is not known
    };
    std::vector<Slot> slots;
    std::uint64_t run = 0;
    std::vector<Zeros> by_id; // of numbers, from 1 on; empty where zeros are not wanted
};

// What is known after a run, until the next one of the same evaluator.
struct Slopes {
    const cpu::PruneProgram &parts;
    const cpu::Shortener &ranges;
    SlopeMemory &memory;
    bool with_zeros = false;

    bool shared(std::uint32_t address) const { return address < parts.program->first_register; }
    std::size_t slot(std::uint32_t address) const {
        const std::size_t first = parts.program->first_register;
        return address < first ? address : first + (address - first) / cpu::batch_size;
    }
    void forget(std::size_t slot) const;
    Varying &number(std::size_t slot) const { return memory.slots[slot].number; }
    void read(std::uint32_t address, Varying &into) const; // `into`: as new
    Varying at(std::uint32_t address) const {
        Varying found;
        read(address, found);
        return found;
    }
    Zeros zeros_at(std::uint32_t address) const;
    std::optional<Missing> missing_at(std::uint32_t address) const;
    Alternatives alternatives_at(std::uint32_t address, const Varying &number) const;
};

struct SlopeQuestion {
    Point lo, hi;                  // the box
    std::array<double, 3> along{}; // the direction beside the axes
    bool zeros = false;            // where numbers are 0 is wanted, and their alternatives
};
using SeeNumber = std::function<void(Register, const Varying &)>; // not of those in loops

constexpr std::size_t longest_tape = 500; // steps, of which slopes are known

// `boxes` is memory; the ranges are of the box and, one further, of its middle.
Slopes slopes_over(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                   const SlopeQuestion &question, const SeeNumber &see = {});

// Of the number in a slot, and at the middle of the box.
Linear linear_of(const Varying &number, Interval middle, const Point &lo, const Point &hi);

// A place about the middle of a box.
inline Point middle_point(const Point &lo, const Point &hi) {
    Point middle{};
    for (std::size_t i = 0; i < 3; ++i) middle[i] = 0.5f * (lo[i] + hi[i]);
    return middle;
}

} // namespace fathom::mesh
