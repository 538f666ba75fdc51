// Runs of a part of a tape. In a small cell most of a long field is at rest: of a hundred blobs a
// few are near, and of a union the others are farther than these. What was found of a larger cell
// holds in each part of it, so such steps need no run of their own there.
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace fathom::proof {

using ir::Profile;
using ir::rounding::infinity;

Machine::Steps Machine::all_steps() const {
    Steps steps(tape_.each.size());
    std::iota(steps.begin(), steps.end(), 0u);
    return steps;
}

void Machine::run(const Cell &cell, const Steps &steps) {
    if (ranges_.work->spent()) return know_nothing();
    const std::size_t before = work_;
    reach(cell);
    for (const std::uint32_t i : steps) {
        const Instruction &instruction = tape_.each[i];
        ++work_;
        if (instruction.form == Form::Loop)
            run_loop(instruction);
        else
            step(instruction);
    }
    ranges_.work->take(work_ - before);
    conclude();
}

// The same number at all points of the cell.
bool Machine::is_one_value(Slot s) const {
    if (norm_[s] != 0) return false;
    for (std::uint32_t i = 0; i < tape_.size[s]; ++i) {
        const std::uint32_t at = tape_.first[s] + i;
        if (!value_[at].is_point() || !value_[at].finite() || odd_[at]) return false;
    }
    return true;
}

// Marks the arguments that decide an instruction's result somewhere in the cell.
void Machine::need_args(const Instruction &in, std::vector<bool> &wanted) const {
    const auto of = [&](std::size_t a, int c) { return value(in.args[a], c); };
    const auto want = [&](std::size_t a) { wanted[in.args[a]] = true; };
    // Of arguments from `first` on the least, which those that are `by` above another never are.
    const auto least = [&](std::size_t first, double by, double sign) {
        for (std::size_t a = first; a < in.args.size(); ++a) {
            bool dropped = false;
            for (std::size_t b = first; b < in.args.size() && !dropped; ++b) {
                dropped = b != a;
                for (int c = 0; c < tape_.size[in.out] && dropped; ++c)
                    dropped =
                        sign > 0 ? of(a, c).lo > of(b, c).hi + by : of(a, c).hi < of(b, c).lo - by;
            }
            if (!dropped) want(a);
        }
    };
    for (const Slot s : in.turned) wanted[s] = true;
    if (in.turning) wanted[in.turning->vector] = wanted[in.turning->angle] = true;
    if (in.around) wanted[in.around->vector] = true;
    if (in.around && in.around->rest_by > 0)
        wanted[in.around->vanishing] = wanted[in.around->rest] = true;
    if (in.beside_turn) {
        wanted[in.beside_turn->still] = true;
        if (in.beside_turn->rest_by > 0)
            wanted[in.beside_turn->vanishing] = wanted[in.beside_turn->rest] = true;
    }
    if (in.along) wanted[in.along->vector] = wanted[in.along->factor] = true;
    if (in.ellipsoid) {
        for (const Slot s : in.ellipsoid->inverse) wanted[s] = true;
        wanted[in.ellipsoid->vector] = wanted[in.ellipsoid->k0] = wanted[in.ellipsoid->k1] = true;
    }
    if (in.univariate) wanted[in.univariate->of] = true;
    if (in.from_axis) wanted[in.from_axis->vector] = wanted[in.from_axis->length] = true;
    if (in.between) {
        wanted[in.between->vector] = true;
        for (const Slot s : in.between->corners) wanted[s] = true;
    }
    if (in.mean) wanted[in.mean->a] = wanted[in.mean->b] = true;
    if (in.form == Form::Plain && (in.op == Op::Min || in.op == Op::Union)) return least(0, 0, 1);
    if (in.form == Form::Plain && (in.op == Op::Max || in.op == Op::Intersection))
        return least(0, 0, -1);
    if (in.op == Op::Select) {
        const Interval condition = of(0, 0);
        want(0);
        if (condition.hi >= 0.5) want(1);
        if (condition.lo <= 0.5) want(2);
        return;
    }
    for (std::size_t a = 0; a < in.args.size(); ++a) want(a);
}

Machine::Steps Machine::needed(const Steps &steps) const {
    if (!tape_.loops.empty()) return steps;
    std::vector<bool> wanted(tape_.first.size(), false);
    wanted[tape_.result] = true;
    Steps out;
    for (std::size_t i = steps.size(); i-- > 0;) {
        const Instruction &instruction = tape_.each[steps[i]];
        if (!wanted[instruction.out] || is_one_value(instruction.out)) continue;
        out.push_back(steps[i]);
        need_args(instruction, wanted);
    }
    std::ranges::reverse(out);
    return out;
}

} // namespace fathom::proof
