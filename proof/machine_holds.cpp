// What is known of an instruction's slope beside what its op's rule says: forms that were seen on the
// expressions. Each holds together with the rule's own bound.
#include "proof/ellipsoids.h"
#include "proof/instruction_rules.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::times;
using ir::rounding::up;

// What a value's gradient is, as a mean of two others (means.h), beside what its own rule says.
void Machine::hold_mean(const Instruction &instruction) {
    const Slot out = instruction.out;
    const auto [a, b, by_a, by_b, beyond, reach] = *instruction.mean;
    const std::uint32_t at_a = tape_.first[a], at_b = tape_.first[b];
    if (norm_[out] == infinity || norm_[a] == infinity || norm_[b] == infinity) return;
    if (odd_[at_a] || odd_[at_b]) return;
    if (value_[at_a].magnitude() > reach || value_[at_b].magnitude() > reach) return;
    for (std::size_t j = 0; j < 3; ++j) {
        const Interval of_a = Interval(by_a) * grad_[at_a][j],
                       of_b = Interval(by_b) * grad_[at_b][j];
        const Interval way = Interval(-beyond, beyond) * Interval((of_a - of_b).magnitude());
        Interval &own = grad_[tape_.first[out]][j];
        own = meet(own, hull(of_a, of_b) + (beyond > 0 ? way : Interval(0.0)));
    }
    const double most =
        std::max(times(std::fabs(by_a), norm_[a]), times(std::fabs(by_b), norm_[b]));
    norm_[out] = std::min(norm_[out], up(times(most, 1 + 2 * beyond + 1e-9), 4));
}

// A vector that turns with an angle: M J_v + M' v grad a (linear_maps.h).
void Machine::hold_turning(const Instruction &instruction) {
    using Way = Instruction::Turning::Way;
    const auto &[vector, angle, norm, by, moving, way] = *instruction.turning;
    const Slot out = instruction.out;
    if (norm_[out] == infinity || odd_[tape_.first[angle]]) return;
    Interval sum;
    unsigned taken = 0; // of the point's coordinates
    bool is_point = distances_.has_value();
    for (std::uint32_t c = 0; c < tape_.size[vector]; ++c) {
        const std::uint32_t at = tape_.first[vector] + c;
        if (odd_[at]) return;
        if (!(moving >> c & 1)) continue;
        sum += square(value_[at]);
        is_point = is_point && coordinate_[at] != 0;
        if (is_point) taken |= 1u << (coordinate_[at] - 1);
    }
    const double arm = length_of(is_point ? taken : 0, sqrt(sum)).hi;
    double turns = up(times(norm_[angle], arm), 4);
    if (far_out_.holds()) { // an arm that grows, and an angle that falls
        Growth arms{0};
        for (std::uint32_t c = 0; c < tape_.size[vector]; ++c)
            if (moving >> c & 1) arms = far_out_.sum(arms, far(vector, int(c)).most);
        turns = std::min(turns, far_out_.most(product(arms, far(angle, 0).slope, true)));
    }
    turns = up(times(by, turns), 4);
    const double moves = up(times(norm, norm_[vector]), 4);
    double most = moves + turns;
    if (way == Way::Apart) most = std::hypot(moves, turns);
    if (way == Way::Shear) most = (turns + std::hypot(turns, 2 * moves)) / 2;
    hold_norm(out, up(most, 8));
}

// A bound of the norm beside the rule's own.
void Machine::hold_norm(Slot s, double most) {
    if (!(most < norm_[s])) return;
    norm_[s] = most;
    for (std::uint32_t i = tape_.first[s]; i < tape_.first[s] + tape_.size[s]; ++i)
        for (Interval &own : grad_[i]) own = meet(own, Interval(-most, most));
}

// A product about an axis on which its angle is singular, and it is not (around.h).
void Machine::hold_around(const Instruction &instruction) {
    const auto [vector, by, vanishing, rest, rest_by] = *instruction.around;
    const Slot out = instruction.out;
    const std::uint32_t part = tape_.first[vector];
    double most = up(times(by, norm_[vector]), 4);
    if (rest_by > 0) {
        if (odd_[tape_.first[rest]] || odd_[tape_.first[vanishing]]) return;
        most = up(most + times(times(value(vanishing, 0).magnitude(), rest_by), norm_[rest]), 8);
    }
    if (!(most < norm_[out]) || trouble_[out] == Trouble::Overflow) return;
    if ((tape_.near && !near_) || odd_[part] || odd_[part + 1]) return;
    trouble_[out] = Trouble::None;
    cause_[out] = NodeId();
    hold_norm(out, most);
}

// What turns about an axis changes across it, in which what is the same all around does not.
void Machine::hold_beside_turn(const Instruction &instruction) {
    const auto &[still, radial, across, vanishing, rest, rest_by] = *instruction.beside_turn;
    const Slot out = instruction.out;
    if (norm_[out] == infinity || odd_[tape_.first[out]] || odd_[tape_.first[still]]) return;
    double most = std::hypot(norm_[still] + radial, across);
    if (rest_by > 0) {
        if (odd_[tape_.first[rest]] || odd_[tape_.first[vanishing]]) return;
        most += times(times(value(vanishing, 0).magnitude(), rest_by), norm_[rest]);
    }
    hold_norm(out, up(most, 8));
}

// Between values at corners that stand still, wherever they do not jump (interpolation.h).
void Machine::hold_between(const Instruction &instruction) {
    const Slot out = instruction.out, vector = instruction.between->vector;
    const std::uint32_t at = tape_.first[out];
    if (norm_[out] == infinity || odd_[at]) return;
    for (std::uint32_t i = 0; i < tape_.size[vector]; ++i)
        if (odd_[tape_.first[vector] + i]) return;
    Interval all = value(instruction.between->corners[0], 0);
    for (const Slot corner : instruction.between->corners) {
        if (norm_[corner] != 0 || odd_[tape_.first[corner]]) return;
        all = hull(all, value(corner, 0));
    }
    value_[at] = meet(value_[at], all);
    const double slope = times(instruction.between->by, norm_[vector]);
    hold_norm(out, up(times(slope, (Interval(all.hi) - Interval(all.lo)).hi), 4));
}

// A vector made longer or shorter by its length (radial.h).
void Machine::hold_along(const Instruction &instruction) {
    const auto [vector, factor, divides] = *instruction.along;
    const Slot out = instruction.out;
    if (norm_[out] == infinity) return;
    for (std::uint32_t i = 0; i < tape_.size[vector]; ++i)
        if (odd_[tape_.first[vector] + i]) return;
    const Interval size = value(factor, 0);
    const double by = divides ? up(1 / size.mignitude(), 4) : size.magnitude();
    hold_norm(out, up(times(by, norm_[vector]), 4));
}

// The distance from an ellipsoid to first order (ellipsoids.h).
void Machine::hold_ellipsoid(const Instruction &instruction) {
    const auto &[vector, k0, k1, inverse, by] = *instruction.ellipsoid;
    const Slot out = instruction.out;
    if (norm_[out] == infinity) return;
    for (std::uint32_t i = 0; i < tape_.size[vector]; ++i)
        if (odd_[tape_.first[vector] + i]) return;
    std::vector<Interval> numbers;
    for (const Slot one : inverse) numbers.push_back(value(one, 0));
    const double slope = slope_of_ellipsoid(value(k0, 0), value(k1, 0), numbers);
    if (slope == infinity) return;
    hold_norm(out, up(times(times(slope, std::fabs(by)), norm_[vector]), 4));
}

// The angle between a vector and an axis turns as the vector does, by |J|/|v| at most: also on the
// axis, where its cosine's inverse is infinitely steep (2.35).
void Machine::hold_angle(const Instruction &instruction) {
    const Slot out = instruction.out, ratio = instruction.args[0];
    const auto [v, length] = *instruction.from_axis;
    if (norm_[v] == infinity || pole_[ratio] || odd_[tape_.first[ratio]]) return;
    for (std::uint32_t i = 0; i < tape_.size[v]; ++i)
        if (odd_[tape_.first[v] + i]) return;
    const double away = value(length, 0).lo;
    if (!(away >= ir::rounding::min_single)) return;
    const double most = up(norm_[v] / away, 4);
    if (!(most < norm_[out]) || trouble_[out] == Trouble::Overflow) return;
    trouble_[out] = Trouble::None;
    cause_[out] = NodeId();
    hold_norm(out, most);
    if (!far_out_.holds()) return;
    Far known = far(out, 0);
    known.slope = over({norm_[v]}, far(length, 0).least);
    keep_far(out, 0, known);
}

// asin(sin u), and the like of cosines, is a triangle wave of u: as steep as u, also at its corners,
// where its parts are not.
void Machine::hold_triangle(const Instruction &instruction) {
    const Slot out = instruction.out;
    const Instruction *wave = maker(instruction.args[0]);
    if (!wave || (wave->op != Op::Sin && wave->op != Op::Cos) || wave->form != Form::Plain) return;
    const Slot of = wave->args[0];
    if (tape_.size[of] != tape_.size[out] || trouble_[out] == Trouble::Overflow) return;
    for (std::uint32_t i = 0; i < tape_.size[of]; ++i)
        if (odd_[tape_.first[of] + i]) return;
    if (!(norm_[of] < norm_[out])) return;
    trouble_[out] = Trouble::None;
    cause_[out] = NodeId();
    pole_[out] = 0;
    hold_norm(out, norm_[of]);
}

namespace {

// Of a polynomial, the lowest power first, and of its derivative over an interval: by Horner's rule
// in its parts, whose hull is narrower than what the whole interval gives.
struct OverInterval {
    Interval value, slope;
};
OverInterval over(const std::vector<double> &by, Interval x) {
    constexpr int most_parts = 16;
    const bool wide = x.finite() && x.width() > 1e-3;
    const int parts = wide ? most_parts : 1;
    OverInterval out;
    for (int part = 0; part < parts; ++part) {
        Interval t = x;
        if (parts > 1) {
            t.lo = part == 0 ? x.lo : x.lo + x.width() * part / parts;
            t.hi = part == parts - 1 ? x.hi : x.lo + x.width() * (part + 1) / parts;
        }
        Interval value = by.back(), slope = 0.0;
        for (std::size_t i = by.size() - 1; i-- > 0;) {
            slope = slope * t + value;
            value = value * t + Interval(by[i]);
        }
        const Interval middle = t.middle(); // the mean value theorem
        Interval there = by.back();
        for (std::size_t i = by.size() - 1; i-- > 0;) there = there * middle + Interval(by[i]);
        if (t.finite()) value = meet(value, there + slope * (t - middle));
        out.value = part == 0 ? value : hull(out.value, value);
        out.slope = part == 0 ? slope : hull(out.slope, slope);
    }
    return out;
}

} // namespace

void Machine::hold_univariate(const Instruction &instruction) {
    const auto &[of, by] = *instruction.univariate;
    const Slot out = instruction.out;
    if (norm_[out] == infinity) return;
    double most = 0;
    for (std::uint32_t i = 0; i < tape_.size[out]; ++i) {
        const std::uint32_t from = tape_.first[of] + i, to = tape_.first[out] + i;
        if (odd_[from]) return;
        const OverInterval found = over(by, value_[from]);
        most = std::max(most, found.slope.magnitude());
        value_[to] = meet(found.value, value_[to]);
        for (std::size_t k = 0; k < 3; ++k) {
            const Interval g = found.slope * grad_[from][k];
            const Interval both{std::max(g.lo, grad_[to][k].lo), std::min(g.hi, grad_[to][k].hi)};
            if (both.lo <= both.hi) grad_[to][k] = both;
        }
    }
    hold_norm(out, up(times(most, norm_[of]), 4));
}

} // namespace fathom::proof
