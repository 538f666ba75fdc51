#include "mesh/area.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace fathom::mesh {
namespace {

// How far the middle of a box, as a float, moves the value of a plane.
double off_middle(const Point &lo, const Point &hi, const Linear &linear) {
    const Point at = middle_point(lo, hi);
    double off = linear.off;
    for (std::size_t i = 0; i < 3; ++i)
        off += std::fabs(linear.slope[i]) * std::fabs(at[i] - 0.5 * (double(lo[i]) + hi[i]));
    return off;
}

Real3 half_of(const Point &lo, const Point &hi) {
    Real3 half{};
    for (std::size_t i = 0; i < 3; ++i) half[i] = 0.5 * (double(hi[i]) - lo[i]);
    return half;
}

// Of the face of a box across an axis.
double face_of(const Point &lo, const Point &hi, std::size_t axis) {
    const std::size_t i = (axis + 1) % 3, j = (axis + 2) % 3;
    return (double(hi[i]) - lo[i]) * (double(hi[j]) - lo[j]);
}

} // namespace

std::array<double, 2> share_below(double value, const std::array<double, 3> &slope,
                                  const Real3 &half) {
    constexpr double little = 1e-3, rounding = 1e-9; // of the greatest; of a share
    std::array<double, 3> across{};                  // what the sides add
    for (std::size_t i = 0; i < 3; ++i) across[i] = 2 * std::fabs(slope[i]) * half[i];
    const double most = *std::ranges::max_element(across);
    double slack = 0, whole = 0, product = 1;
    std::array<double, 3> sides{};
    std::size_t count = 0;
    for (const double a : across) {
        if (a < little * most || a == 0) {
            slack += 0.5 * a;
        } else {
            sides[count++] = a;
            whole += a, product *= a * static_cast<double>(count);
        }
    }
    const auto share = [&](double above) { // of value <= above
        const double t = above - value + 0.5 * whole;
        if (t <= 0) return 0.0;
        if (t >= whole) return 1.0;
        double sum = 0;
        for (unsigned set = 0; set < 1u << count; ++set) {
            double rest = t, power = 1;
            for (std::size_t i = 0; i < count; ++i)
                if (set >> i & 1) rest -= sides[i];
            for (std::size_t i = 0; i < count; ++i) power *= rest;
            if (rest > 0) sum += std::popcount(set) % 2 ? -power : power;
        }
        return std::clamp(sum / product, 0.0, 1.0);
    };
    return {std::max(share(-slack) - rounding, 0.0), std::min(share(slack) + rounding, 1.0)};
}

Enclosure share_of(const Point &lo, const Point &hi, const Linear &linear) {
    const Real3 half = half_of(lo, hi);
    const double off = off_middle(lo, hi, linear);
    return {share_below(linear.value + off, linear.slope, half)[0],
            share_below(linear.value - off, linear.slope, half)[1]};
}

namespace {

constexpr double slope_rounding = 1e-9;

// How fast the number rises along its mean slope, at least; and that direction.
double least_rise(const Linear &linear, Real3 &along) {
    const double length = std::hypot(linear.slope[0], linear.slope[1], linear.slope[2]);
    if (!(length > 0)) return 0;
    double least = length;
    for (std::size_t i = 0; i < 3; ++i) {
        along[i] = linear.slope[i] / length;
        least -= std::fabs(along[i]) * linear.spread[i];
    }
    return least - slope_rounding * length;
}

} // namespace

std::optional<Slant> slant_of(const Linear &linear) {
    Slant slant;
    const double least = least_rise(linear, slant.along);
    if (!(least > 0)) return std::nullopt;
    double across = 0; // squares
    for (const double spread : linear.spread) across += spread * spread;
    // A gradient is `least` along the direction, at least, and `across` beside it, at most.
    slant.most = std::sqrt(1 + across / (least * least));
    return slant;
}

std::optional<Slant> slant_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                              const Point &lo, const Point &hi, const Linear &linear) {
    constexpr double well = 1.002;
    const double length = std::hypot(linear.slope[0], linear.slope[1], linear.slope[2]);
    if (!(length > 0)) return std::nullopt;
    std::optional<Slant> slant = slant_of(linear);
    if (slant && slant->most < well) return slant;
    // Where gradients of several sorts meet the box of all of them holds too many others.
    Real3 along{};
    least_rise(linear, along);
    double most = 0; // squares
    for (std::size_t i = 0; i < 3; ++i)
        most += std::pow(std::fabs(linear.slope[i]) + linear.spread[i], 2);
    const std::optional<double> rise = least_slope_along(evaluator, tape, boxes, lo, hi, along);
    if (!rise || !(*rise > slope_rounding * length)) return slant;
    const double ratio = std::max(std::sqrt(most) / *rise, 1.0);
    if (!slant) return Slant{along, ratio};
    slant->most = std::min(slant->most, ratio);
    return slant;
}

Enclosure area_of_sheet(const Point &lo, const Point &hi, const Linear &sheet) {
    const std::optional<Slant> slant = slant_of(sheet);
    if (!slant) return {0, std::numeric_limits<double>::infinity()};
    Graph graph{lo, hi, {}};
    graph.add_open(lo, hi, sheet);
    return graph.area(*slant);
}

void Graph::add_inside(const Point &from, const Point &to) {
    for (std::size_t i = 0; i < 3; ++i) {
        const double face = face_of(from, to, i);
        if (from[i] == lo[i]) solid[i][0].lo += face, solid[i][0].hi += face;
        if (to[i] == hi[i]) solid[i][1].lo += face, solid[i][1].hi += face;
    }
}

void Graph::add_open(const Point &from, const Point &to, const std::optional<Linear> &linear) {
    const Real3 half = half_of(from, to);
    double most = 0; // that the field changes from the middle
    for (std::size_t i = 0; linear && i < 3; ++i) most += std::fabs(linear->slope[i]) * half[i];
    for (std::size_t i = 0; i < 3; ++i)
        for (const bool high : {false, true}) {
            if (high ? to[i] != hi[i] : from[i] != lo[i]) continue;
            Enclosure share{0, 1};
            if (linear) {
                // Where the field is 0 all over a face that may be of the solid, or not.
                const double off = off_middle(from, to, *linear) + 1e-12 * most + 0x1p-1000;
                const double value = linear->value + (high ? 1 : -1) * half[i] * linear->slope[i];
                Real3 slope = linear->slope;
                slope[i] = 0;
                share = {share_below(value + off, slope, half)[0],
                         share_below(value - off, slope, half)[1]};
            }
            const double face = face_of(from, to, i);
            solid[i][high].lo += share.lo * face, solid[i][high].hi += share.hi * face;
        }
}

Enclosure Graph::area(const Slant &slant) const {
    // As much of the solid's faces looks along the direction as against it, with the surface.
    Enclosure projected;
    double whole = 0; // the box's projection
    for (std::size_t i = 0; i < 3; ++i)
        for (const bool high : {false, true}) {
            const double share = (high ? -1 : 1) * slant.along[i];
            const Enclosure &face = solid[i][high];
            projected.lo += share * (share > 0 ? face.lo : face.hi);
            projected.hi += share * (share > 0 ? face.hi : face.lo);
            if (share > 0) whole += share * face_of(lo, hi, i);
        }
    constexpr double rounding = 1e-9;
    return {std::max(projected.lo - rounding * whole, 0.0),
            slant.most * std::clamp(projected.hi + rounding * whole, 0.0, whole * (1 + rounding))};
}

} // namespace fathom::mesh
