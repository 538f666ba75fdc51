// Numbers that kernels choose: at each place of a box such a number is one of a few others, which
// change steadily, and which one it is follows from decisions that other numbers may share, as the
// lesser and the greater of two do (docs/measure.md, 2).
#pragma once

#include "mesh/varying.h"

#include <cstdint>
#include <span>
#include <vector>

namespace fathom::mesh {

// That one number is at least as great as another, or that it is not; of ids. 0 stands for the number
// 0, `of_choice` for what a choice is made by.
struct Decision {
    static constexpr std::uint32_t of_choice = ~std::uint32_t{0};
    std::uint32_t a = 0, b = 0;
    bool holds = true;
};

// What a number is where these decisions are as they are said to be: its value at the middle of the
// box, and what its slopes lie within all over the box.
struct Alternative {
    Interval middle;
    std::array<Interval, directions> slope{};
    std::array<Decision, 6> where{}; // the first `count` of them
    std::size_t count = 0;
};

// At each place where all decisions are made, the number is one of these whose decisions are made so.
struct Alternatives {
    bool known = false;
    std::vector<Alternative> all;
};

// An input of a kernel: what is known of it as a whole, and by alternatives.
struct Chosen {
    const Varying *number = nullptr;
    Alternatives alternatives;
};

// Of a number that is one all over the box.
Alternatives single(const Varying &number, Interval middle);

bool chooses(cpu::Kernel kernel); // among its inputs, or between them and their negatives

// What a kernel gives, if it chooses, or adds what was chosen. `reach`: half of the box's sides.
Alternatives alternatives_of(cpu::Kernel kernel, std::span<const Chosen> in,
                             const std::array<double, 3> &reach);

// Where a distance of two points is 0 each of these is: their difference along each axis.
std::array<Alternatives, 3> differences_of(std::span<const Chosen> in);

} // namespace fathom::mesh
