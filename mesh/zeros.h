// Where numbers that a tape computes may be 0 in a box: there some others are, which change steadily
// (docs/measure.md, 2).
#pragma once

#include "mesh/varying.h"

#include <optional>
#include <span>
#include <vector>

namespace fathom::mesh {

// A number in a box, all but a linear function: there it is no farther from
// value + slope · (p - middle_point) than `off`, and so are its floats.
struct Linear {
    double value = 0, off = 0;
    double rounding = 0; // so much of `off` is what floats are off
    std::array<double, 3> slope{};
    std::array<double, 3> spread{}; // along each axis its slopes are no farther than this from that
    bool jumps = false; // on the way to it something does: what it is near its zeros may tell more
    bool operator==(const Linear &) const = default;
};

// Where a number is 0 one of these is, which rise along some direction all over the box.
struct Zeros {
    bool known = false;
    std::vector<Linear> sheets;
};

// Whether a number rises along its mean slope all over its box.
bool is_steady(const Linear &number);

// An input of a kernel, by its address; what is known of it.
struct Operand {
    std::uint32_t address = 0;
    const Varying *number = nullptr;
    const Zeros *zeros = nullptr;
};

// Of what a kernel gives, which may be 0 in the box. `itself`: it, where it is all but linear.
// `by_id`: of numbers that have ids.
Zeros zeros_of(cpu::Kernel kernel, std::span<const Operand> in, const std::optional<Linear> &itself,
               const std::vector<Zeros> &by_id);

} // namespace fathom::mesh
