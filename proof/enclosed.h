// What numbers are at most near and far from a place, and whether what is left of a difference of two
// sums is no more than rounding beside them (docs/lipschitz.md, 2, Rounding). By values, never by the
// numbers that stand before them: what they multiply may be tiny or large.
#pragma once

#include "ir/graph.h"
#include "ir/interval.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>
#include <unordered_map>

namespace fathom::proof {

using ir::Interval;
struct Ranges;

// By interval arithmetic, in a box of points.
class Enclosed {
  public:
    Enclosed(const ir::Graph &graph, const Ranges *ranges, const std::array<Interval, 3> &box)
        : graph_(graph), ranges_(ranges), box_(box) {}
    // A component of a node; everything where nothing is known.
    Interval of(ir::NodeId id, int i = 0);

  private:
    Interval found(ir::NodeId id, int i);
    static Interval of_two(ir::Op op, const Interval &a, const Interval &b);
    Interval of_vector(ir::NodeId id);
    double size_of(ir::NodeId matrix);

    const ir::Graph &graph_;
    const Ranges *ranges_; // of params and the time; or none
    std::array<Interval, 3> box_;
    std::map<std::pair<ir::NodeId, int>, Interval> known_;
    int depth_ = 0, left_ = 20'000;
};

// Distances from a place, on a grid of factors of 4: whatever is small beside others near it and far
// from it is small everywhere.
constexpr int least_scale = -5, far_scale = 10;
inline double distance_at(int scale) { return std::ldexp(1.0, 2 * scale); }
// What values count as, at most, up to that distance: beside 1e9, for what has not been found yet, a
// jump by 0.1 is one.
inline double most_size_at(double distance) { return 64 * std::max(1.0, distance * distance); }

// What double precision loses of the terms that a number is the sum of.
constexpr double lost_by_doubles = 4e-15;

// Of terms that have the same factors of which no range is known: what they are the products with.
struct Enclosure {
    Interval sum;
    double terms = 0; // their sizes together

    void add(const Interval &term) {
        sum += term;
        terms += term.magnitude();
    }
};

// What is known of a factor: its range, or that it is the same for all points. Numbers that are the
// same for all points are compared with each other alone, whatever their ranges are.
struct KnownFactor {
    std::optional<Interval> range;
    bool held = false;
};

// gap = a - b. `factor`: what is known of one. Is the gap at most `granted` of both sums, and where
// there are factors of which nothing is known, at most `granted_else`? Sums count as `most_size` at most.
template <class Sum, class Known>
bool is_rounding_beside(const Sum &gap, const Sum &a, const Sum &b, double granted,
                        double granted_else, double most_size, const Known &factor) {
    using Factors = typename Sum::key_type;
    struct Part {
        Enclosure gap, a, b;
    };
    std::map<Factors, Part> parts;
    bool all_known = true;
    const auto enclose = [&](const Sum &sum, Enclosure Part::*of) {
        for (const auto &[m, c] : sum) {
            if (c == 0) continue;
            Factors unknown;
            Interval term = c;
            for (std::size_t i = 0; i < m.size(); ++i) {
                const KnownFactor one = factor(m[i]);
                const bool twice = one.range && i + 1 < m.size() && m[i] == m[i + 1];
                all_known = all_known && (one.range || one.held);
                if (one.range && !one.held)
                    term = term * (twice ? square(*one.range) : *one.range);
                else
                    unknown.insert(unknown.end(), twice ? 2 : 1, m[i]);
                i += twice;
            }
            (parts[unknown].*of).add(term);
        }
    };
    enclose(gap, &Part::gap);
    enclose(a, &Part::a);
    enclose(b, &Part::b);
    return std::ranges::all_of(parts, [&](const auto &one) {
        const Part &part = one.second;
        const double beside = std::min(part.a.sum.magnitude(), part.b.sum.magnitude()),
                     terms = part.a.terms + part.b.terms;
        const double most =
            std::max((all_known ? granted : granted_else) * std::min(beside, most_size),
                     lost_by_doubles * terms);
        return part.gap.sum.magnitude() <= most && std::isfinite(most); // inf - inf is no number
    });
}

} // namespace fathom::proof
