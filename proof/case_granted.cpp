// What counts as equal where a proof by cases ends: what rounding leaves, and what people leave off when
// they write numbers (docs/lipschitz.md, 2.1, What counts as equal).
#include "proof/case_search.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace fathom::proof {
namespace {

constexpr double granted_to_unknown = 1e-12; // beside what may have any size

} // namespace

bool Cases::are_equal(const Sum &a, const Sum &b) {
    const Sum apart = add(a, b, -1), gap = cleared(apart);
    if (gap.empty()) return true;
    if (is_rounding(apart, a, b, granted_to_sides)) {
        if (!is_rounding(apart, a, b, granted_to_doubles)) grant(apart);
        return true;
    }
    if (differs_by_at_most(case_, gap, 0)) return true;
    if (gap == apart && is_at_most(gap, a, b)) return true;
    return split_sizes_ && are_equal_on_line(a, b); // what that grants is not asked on (2.42)
}

// What sides differ by up to each distance, where that is known.
void Cases::grant(const Sum &gap) {
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        Enclosed enclosed = enclosed_near(distance_at(scale));
        const auto range = range_near(gap, enclosed, distance_at(scale));
        if (!range || !range->finite()) {
            looked_.beside = true;
            return;
        }
        double &apart = looked_.apart[std::size_t(scale - least_scale)];
        apart = std::max(apart, range->magnitude());
    }
}

std::optional<Interval> Cases::range_near(const Sum &sum, Enclosed &box, double distance) const {
    Interval out;
    for (const auto &[m, c] : sum) {
        Interval term = c;
        for (std::size_t i = 0; i < m.size(); ++i) {
            const auto one = range_near(m[i], box, distance);
            if (!one) return {};
            const bool twice = i + 1 < m.size() && m[i] == m[i + 1];
            term = term * (twice ? square(*one) : *one);
            i += twice;
        }
        out += term;
    }
    return out;
}

std::optional<Interval> Cases::range_near(std::uint32_t a, Enclosed &box, double distance) const {
    const Atom &atom = atoms_[a];
    if (coordinates_.contains(a)) return Interval(-distance, distance);
    if (atom.below) {
        const auto below = range_near(*atom.below, box, distance);
        return below ? std::optional(sqrt(*below)) : std::nullopt;
    }
    if (atom.square) {
        const auto square = range_near(*atom.square, box, distance);
        return square ? std::optional(sqrt(*square)) : std::nullopt;
    }
    if (atom.range) return atom.range;
    const auto node = nodes_.find(a);
    if (node == nodes_.end()) return {};
    const Interval range = box.of(node->second.first, node->second.second);
    return range.finite() ? std::optional(range) : std::nullopt;
}

// Beside both sides, at all distances from the origin, or from where the claim's parts lie.
bool Cases::is_rounding(const Sum &gap, const Sum &a, const Sum &b, double granted) {
    for (int scale = least_scale; scale <= far_scale; ++scale) {
        looked_.take(64 * (gap.size() + a.size() + b.size()));
        const double distance = distance_at(scale);
        Enclosed enclosed = enclosed_near(distance);
        const auto factor = [&](std::uint32_t f) {
            return KnownFactor{range_near(f, enclosed, distance), atoms_[f].held};
        };
        if (!is_rounding_beside(gap, a, b, granted, granted_to_unknown, most_size_at(distance),
                                factor))
            return false;
    }
    return true;
}

bool Cases::differs_by_at_most(const Case &c, const Sum &gap, double slack) {
    return impossible(c, {gap, true, slack}) && impossible(c, {add({}, gap, -1), true, slack});
}

Enclosed Cases::enclosed_near(double distance) const {
    std::array<Interval, 3> box;
    for (std::size_t i = 0; i < 3; ++i)
        box[i] = (axes_ ? axes_->origin[i] : 0) + Interval(-2 * distance, 2 * distance);
    return Enclosed(graph_, looked_.ranges, box);
}

// By inequalities, with what is granted up to each distance.
bool Cases::is_at_most(const Sum &gap, const Sum &a, const Sum &b) {
    std::map<int, double> known;
    const auto slack_at = [&](int scale) {
        const auto [it, fresh] = known.try_emplace(scale);
        if (fresh) it->second = granted_near(a, b, distance_at(scale));
        return it->second;
    };
    // Up to each of these; at all of them with what is granted at the least, if that does. As it is
    // asked on, a part of it that does is taken for what they differ by.
    const auto holds = [&](auto &&self, int from, int to) -> bool {
        constexpr double part = 1.0 / 64;
        if (looked_.spent()) return false;
        const Case near = with_ranges(case_, distance_at(to));
        if (differs_by_at_most(near, gap, slack_at(from))) {
            const bool less = differs_by_at_most(near, gap, part * slack_at(from));
            const double slack = (less ? part : 1) * slack_at(from);
            for (int scale = from; scale <= to; ++scale) {
                double &apart = looked_.apart[std::size_t(scale - least_scale)];
                apart = std::max(apart, slack);
            }
            return true;
        }
        const int middle = from + (to - from) / 2;
        return from < to && self(self, from, middle) && self(self, middle + 1, to);
    };
    constexpr int usual =
        1; // most that is none differs by more where solids are, and that is cheap
    return differs_by_at_most(with_ranges(case_, distance_at(usual)), gap, slack_at(usual)) &&
           holds(holds, least_scale, far_scale);
}

// Of sides a and b of the claim, where no coordinate is above this: beside both, or as numbers are
// written.
double Cases::granted_near(const Sum &a, const Sum &b, double distance) {
    looked_.take(64 * (a.size() + b.size()));
    Enclosed enclosed = enclosed_near(distance);
    const auto size = [&](const Sum &sum) {
        const auto range = range_near(sum, enclosed, distance);
        return range ? range->magnitude() : 0;
    };
    const double most = granted_to_sides * most_size_at(distance);
    const double beside = granted_to_sides * std::min(size(a), size(b));
    std::array<Interval, 3> box; // the border's part
    for (std::size_t i = 0; i < 3; ++i) {
        const auto range =
            range_near(leaf(graph_.point(ir::Type::Vec3), int(i)), enclosed, distance);
        const Interval all = (axes_ ? axes_->origin[i] : 0) + Interval(-2 * distance, 2 * distance);
        box[i] = range ? meet(all, *range) : all;
    }
    double written = 0;
    for (const NodeId id : {claim_.of, claim_.u, claim_.v})
        written += written_off(graph_, id, Enclosed(graph_, looked_.ranges, box), looked_.work);
    written = std::min(written, most_written_at(distance));
    return std::max(std::isfinite(beside) ? std::min(beside, most) : 0, written);
}

// The case, of points that are no further.
Case Cases::with_ranges(const Case &c, double distance) {
    Case out = c;
    std::set<std::uint32_t> used;
    for (const Sum &sum : c.at_least_0)
        for (const auto &[m, by] : reduced(sum, c)) used.insert(m.begin(), m.end());
    for (const auto &[a, sum] : c.solved) used.insert(a);
    Enclosed enclosed = enclosed_near(distance);
    for (const std::uint32_t a : used)
        if (const auto range = range_near(a, enclosed, distance); range && range->finite()) {
            out.at_least_0.push_back(add(atom(a), constant(range->lo), -1));
            out.at_least_0.push_back(add(constant(range->hi), atom(a), -1));
        }
    return out;
}

} // namespace fathom::proof
