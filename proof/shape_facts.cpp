#include "proof/shape_facts.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::rounding::infinity;
using ir::rounding::up;

namespace {
Interval side(const Box &box, std::size_t i) { return {box.lo[i], box.hi[i]}; }
void set(Box &box, std::size_t i, Interval x) { box.lo[i] = x.lo, box.hi[i] = x.hi; }
} // namespace

void forget_moment_arms(Derived &k) {
    k.parts = Box::everything();
    k.fact.moment_arm = {infinity, infinity, infinity};
}

void differ_by(Derived &k, double by) {
    k.offset_slack = up(k.offset_slack + by);
    k.mean_slack = up(k.mean_slack + by);
}

void unite(Derived &k, const Derived &c) {
    k.fact.bounds = ir::hull(k.fact.bounds, c.fact.bounds);
    k.growth_rate = std::max(k.growth_rate, c.growth_rate);
    k.outer_growth_rate = std::max(k.outer_growth_rate, c.outer_growth_rate);
    k.outer = meeting(k.outer, c.outer);
}

void weigh(Derived &k, const Derived &c) {
    const Box outer = ir::hull(k.outer, c.outer);
    unite(k, c);
    k.outer = outer;
}

void inherit(Derived &k, const Derived &c) {
    k.failed = k.failed || c.failed;
    k.fact.surface_slope = std::min(k.fact.surface_slope, c.fact.surface_slope);
    k.fact.bounded = ir::hull(k.fact.bounded, c.fact.bounded);
    k.fact.status = std::max(k.fact.status, c.fact.status);
    k.parts = ir::hull(k.parts, c.parts);
    k.offset_slack = std::max(k.offset_slack, c.offset_slack);
    k.mean_slack = std::max(k.mean_slack, c.mean_slack);
    k.lowered = std::max(k.lowered, c.lowered);
    k.short_by = std::max(k.short_by, c.short_by);
    for (std::size_t a = 0; a < 3; ++a) {
        k.fact.symmetric[a] = k.fact.symmetric[a] && c.fact.symmetric[a];
        k.fact.moment_arm[a] = std::max(k.fact.moment_arm[a], c.fact.moment_arm[a]);
    }
}

Cell to_cell(const Box &box) { return {{side(box, 0), side(box, 1), side(box, 2)}}; }
Box from_cell(const Cell &cell, int dims) {
    Box box;
    for (std::size_t i = 0; i < 3; ++i)
        set(box, i, dims == 2 && i == 2 ? Interval(0.0) : cell.p[i]);
    return box;
}

Box grow(const Box &box, const std::array<double, 3> &by) {
    if (box.empty()) return box;
    Box out = box;
    for (std::size_t i = 0; i < 3; ++i)
        if (by[i] != 0) set(out, i, side(box, i) + Interval(-by[i], by[i]));
    return out;
}
Box grow(const Box &box, double by) { return grow(box, {by, by, by}); }
Box reached(const Box &box, double growth_rate, double t) {
    if (t <= 0 || growth_rate == 0) return box;
    if (!std::isfinite(growth_rate) || !std::isfinite(t)) return Box::everything();
    return grow(box, up(growth_rate * t));
}
// Of sides a.hi < b.lo, grown by w*t: [b.lo - w*t, a.hi + w*t] lies within w*t of the middle.
Box meeting(const Box &a, const Box &b) {
    if (a.empty() || b.empty()) return empty_box();
    Box out;
    for (std::size_t i = 0; i < 3; ++i) {
        const double lo = std::max(a.lo[i], b.lo[i]), hi = std::min(a.hi[i], b.hi[i]);
        set(out, i, lo <= hi ? Interval(lo, hi) : Interval(Interval(hi, lo).middle()));
    }
    return out;
}
Box moved(const Box &box, const Vec &by) {
    if (box.empty()) return box;
    Box out;
    for (std::size_t i = 0; i < 3; ++i) set(out, i, side(box, i) + by[i]);
    return out;
}
Box times(const Box &box, const Vec &by) {
    if (box.empty()) return box;
    Box out;
    for (std::size_t i = 0; i < 3; ++i) set(out, i, side(box, i) * by[i]);
    return out;
}

// The image of the box, and, since the matrix is an isometry, of the ball that holds it.
Box turned(const Box &box, const std::array<Interval, 16> &matrix, int side_length) {
    if (box.empty()) return box;
    Box out = box;
    auto n = static_cast<std::size_t>(side_length);
    double r = norm_of(box);
    for (std::size_t i = 0; i < n; ++i) {
        Interval sum;
        for (std::size_t j = 0; j < n; ++j)
            sum += meet(Interval(-1, 1), matrix[j * n + i]) * side(box, j);
        set(out, i, std::isfinite(r) ? meet(Interval(-r, r), sum) : sum);
    }
    return out;
}

bool disjoint(const Box &a, const Box &b) {
    if (a.empty() || b.empty()) return true;
    for (std::size_t i = 0; i < 3; ++i)
        if (a.lo[i] > b.hi[i] || b.lo[i] > a.hi[i]) return true;
    return false;
}
bool holds(const Box &outer, const Box &inner) {
    if (inner.empty()) return true;
    for (std::size_t i = 0; i < 3; ++i)
        if (inner.lo[i] < outer.lo[i] || inner.hi[i] > outer.hi[i]) return false;
    return true;
}
bool everywhere(const Box &box) {
    for (std::size_t i = 0; i < 3; ++i)
        if (std::isfinite(box.lo[i]) || std::isfinite(box.hi[i])) return false;
    return true;
}
double radius_about(const Box &box, int axis) {
    if (box.empty()) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i)
        if (int(i) != axis) sum += std::pow(side(box, i).magnitude(), 2);
    return up(std::sqrt(sum), 4);
}
double norm_of(const Box &box) {
    if (box.empty()) return 0;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) sum += std::pow(side(box, i).magnitude(), 2);
    return up(std::sqrt(sum), 4);
}
Box padded(const Box &box) {
    if (box.empty()) return box;
    Box out = box;
    for (std::size_t i = 0; i < 3; ++i) {
        double by =
            slack * std::max({std::fabs(box.lo[i]), std::fabs(box.hi[i]), box.hi[i] - box.lo[i]});
        if (std::isfinite(by)) out.lo[i] -= by, out.hi[i] += by;
    }
    return out;
}

} // namespace fathom::proof
