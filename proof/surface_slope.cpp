// How steep a field of one's own is where its solid ends. It is sampled, and nothing that is proved
// rests on it: shading reads the field over it, so that a picture does not depend on the unit that
// the values are in (ir/lower/shaded.cpp).
#include "proof/crossings.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace fathom::proof {

using ir::ShapeId;
using ir::ShapeKind;

namespace {

constexpr std::size_t enough = 12;         // places of the surface
constexpr int starts = 100, steps = 16;    // of Newton's method, from points of the region
constexpr double close_enough = 1e-3;      // of the region's size: how far off the surface
constexpr std::size_t most_work = 100'000; // instructions
constexpr double not_steep = 1.42;         // the power of 2 of such a slope is 1
constexpr double far = 8;                  // where there is no region

// Of params and time as they are now.
Ranges present(const ir::Scene &scene, const Ranges &all) {
    Ranges now = all;
    now.time = 0.0;
    for (std::size_t i = 0; i < scene.params.size() && i < now.params.size(); ++i)
        for (std::size_t c = 0; c < 4; ++c) now.params[i][c] = Interval(scene.params[i].value[c]);
    return now;
}

// Goes down, or up, from a point of the region to the surface; none: it is not reached.
std::optional<double> slope_at_surface(Machine &machine, const Cell &region,
                                       std::array<double, 3> p, double close) {
    for (int step = 0; step < steps; ++step) {
        machine.run(at_point(p));
        if (!std::isfinite(machine.norm())) return {};
        std::array<double, 3> slope{};
        double squares = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            slope[i] = machine.row(0)[i].middle();
            squares += slope[i] * slope[i];
        }
        const double value = machine.value(0).middle();
        if (!(squares > 0) || !std::isfinite(value)) return {};
        if (std::fabs(value) < close * std::sqrt(squares)) return std::sqrt(squares);
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = std::clamp(p[i] - value / squares * slope[i], region.p[i].lo, region.p[i].hi);
    }
    return {};
}

} // namespace

double Prover::surface_slope(ShapeId id, const Derived &k) {
    const ir::Shape shape = scene.shapes[id];
    if (shape.kind != ShapeKind::Leaf) return k.fact.surface_slope; // what is known of its parts
    if (!(k.fact.lipschitz_sup > not_steep) || k.failed || !place(id).reported) return 1;
    const auto kept = tape_of(shape.args[0]);
    const Tape &tape = *kept;
    if (tape.too_large) return 1;
    Cell region = to_cell(ir::intersect(place(id).box, k.fact.bounds));
    double size = 0;
    for (Interval &side : region.p) {
        if (side.lo > side.hi) return 1;
        if (!std::isfinite(side.lo)) side.lo = std::min(-far, side.hi - 2 * far);
        if (!std::isfinite(side.hi)) side.hi = std::max(far, side.lo + 2 * far);
        size = std::max(size, side.hi - side.lo);
    }
    const Ranges now = present(scene, ranges);
    Machine machine(tape, now);
    machine.read_values();
    Dice dice{0x5eed};
    std::vector<double> slopes;
    for (int start = 0; start < starts && slopes.size() < enough && machine.work() < most_work;
         ++start) {
        std::array<double, 3> p{};
        for (std::size_t i = 0; i < 3; ++i)
            p[i] = region.p[i].lo + (region.p[i].hi - region.p[i].lo) * dice.next();
        if (const auto slope = slope_at_surface(machine, region, p, close_enough * size))
            slopes.push_back(*slope);
    }
    if (slopes.empty()) return 1;
    const auto middle = slopes.begin() + static_cast<std::ptrdiff_t>(slopes.size() / 2);
    std::ranges::nth_element(slopes, middle);
    return std::max(1.0, std::exp2(std::round(std::log2(*middle))));
}

} // namespace fathom::proof
