// The rule for what is confined to a region: ways round its holes, the raw field in them, and
// bounds by cells for fields that are steep in places. Proofs: docs/lipschitz.md, 6.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::FieldKind;
using ir::NodeId;
using ir::Op;
using ir::ProofStatus;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

// The longest way round the holes over the straight line through them (lipschitz.md, 6): pi/2
// for a ball or a tube, 1 + the second smallest side over the smallest for a box. Infinity where
// the way round may leave the region.
double detour_of(const Zone &zone) {
    double worst = 1;
    const bool bounded = zone.kind != ir::RegionKind::Everywhere;
    const Box whole = from_cell(outer_box(zone), 3);
    for (std::size_t i = 0; i < zone.less.size(); ++i) {
        const Zone &hole = zone.less[i];
        const Box box = from_cell(outer_box(hole), 3);
        bool fits = !bounded;
        if (hole.kind == ir::RegionKind::Tube) { // the region looks the same all round the tube's
                                                 // axis, and is wider
            fits = fits || (zone.kind == ir::RegionKind::Tube && zone.axis == hole.axis &&
                            zone.half[0].lo > hole.half[0].hi);
            bool centred = true, wider = true;
            for (std::size_t a = 0; a < 3; ++a) {
                if (int(a) == hole.axis) continue;
                centred = centred && zone.center[a] == Interval(0.0);
                wider = wider &&
                        zone.half[zone.kind == ir::RegionKind::Box ? a : 0].lo > hole.half[0].hi;
            }
            fits =
                fits || ((zone.kind == ir::RegionKind::Ball || zone.kind == ir::RegionKind::Box) &&
                         centred && wider);
        } else if (zone.kind == ir::RegionKind::Ball) {
            double far = 0;
            for (std::size_t a = 0; a < 3; ++a) {
                Interval off = hole.center[a] - zone.center[a];
                double reach =
                    off.magnitude() + hole.half[hole.kind == ir::RegionKind::Box ? a : 0].hi;
                if (hole.kind == ir::RegionKind::Ball) reach = off.magnitude();
                far += reach * reach;
            }
            far = std::sqrt(far) + (hole.kind == ir::RegionKind::Ball ? hole.half[0].hi : 0);
            fits = far < zone.half[0].lo;
        } else {
            fits = fits || holds(whole, box);
        }
        for (std::size_t j = 0; j < i; ++j)
            fits = fits && disjoint(box, from_cell(outer_box(zone.less[j]), 3));
        if (!fits || hole.kind == ir::RegionKind::Everywhere) return infinity;
        double round = 1.5707963267948968;
        if (hole.kind == ir::RegionKind::Box) {
            std::array<double, 3> sides{hole.half[0].lo, hole.half[1].lo, hole.half[2].lo},
                most{hole.half[0].hi, hole.half[1].hi, hole.half[2].hi};
            std::sort(sides.begin(), sides.end());
            std::sort(most.begin(), most.end());
            round = sides[0] > 0 ? std::max(1.4142135623730952, up(1 + most[1] / sides[0], 4))
                                 : infinity;
        }
        worst = std::max(worst, round);
    }
    return worst;
}

// In a hole the raw field goes from its value at the way out to the mean of two opposite ones, by
// the part s of the way (ir/lower/shapes.cpp): its slope over that of the field (lipschitz.md,
// 6).
double slope_in_holes(const Zone &zone) {
    const double quarter = 1.5707963267948968;
    double worst = 1;
    for (const Zone &hole : zone.less) {
        double slope = std::sqrt(1 + quarter * quarter); // ball: the mean is one number
        if (hole.kind == ir::RegionKind::Tube) slope = std::sqrt(2 + quarter * quarter);
        if (hole.kind == ir::RegionKind::Box) {
            double least = infinity, most = 0, sum = 0;
            for (const Interval &half : hole.half) {
                least = std::min(least, half.lo);
                most = std::max(most, half.hi);
                sum += half.hi * half.hi;
            }
            const double side = std::sqrt(2.0) * most; // from a face's middle to its corner
            const double round = 1 + most / least;     // at least the detour
            slope = least > 0 ? (std::sqrt(sum) +
                                 round * 0.5 * (side + std::sqrt(side * side + 4 * most * most))) /
                                    least
                              : infinity;
        }
        worst = std::max(worst, up(slope, 16));
    }
    return worst;
}

} // namespace

Derived Prover::know_within(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = of_child(shape);
    Zone zone = zone_of(scene.shapes.regions[shape.payload]);
    if (zone.kind == ir::RegionKind::Everywhere && zone.less.empty()) return k;
    Box region = from_cell(outer_box(zone), shape.dims);
    // Outside the region the value is at least the distance to it: {d < t} lies in the region grown
    // by t.
    // What is inside may be smaller than the region: d < t needs |p - q| < t and f(q) < t, so q in
    // the grown box, and p within t of it.
    k.growth_rate = !zone.less.empty()             ? infinity
                    : holds(k.fact.bounds, region) ? 1
                                                   : up(k.growth_rate + 1);
    k.fact.bounds = meeting(region, k.fact.bounds);
    k.outer = Box::everything();
    k.outer_growth_rate = 0;
    k.parts = Box::everything();
    k.fact.moment_arm = {infinity, infinity, infinity};
    if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
    k.fact.exact_outside = k.parts_exact = false;
    for (std::size_t a = 0; a < 3; ++a) {
        bool centred = zone.kind == ir::RegionKind::Tube ||
                       zone.kind == ir::RegionKind::Everywhere || zone.center[a] == Interval(0.0);
        k.fact.symmetric[a] = k.fact.symmetric[a] && centred && zone.less.empty();
    }
    if (k.failed) {
        fail(k);
        return k;
    }
    const double detour = detour_of(zone);
    if (!std::isfinite(detour)) {
        if (Diagnostic *d = report(id, Code::NeedsRegion,
                                   "a region's hole that reaches over its border, or into another "
                                   "hole, cannot be used for a proof"))
            d->help("keep the holes apart and inside the region, or centre the region on the "
                    "tube's axis");
        fail(k);
        return k;
    }
    k.fact.detour = 1 + (detour - 1) * options.rules[Rule::Detour];
    const Derived &inner = child(shape);
    if (inner.leaf && zone.less.empty() && shape.dims == 3 && place(id).reported &&
        graph.is_constant(inner.fact.lipschitz) && inner.fact.status == ProofStatus::Proved) {
        CellAim aim;
        aim.instructions = options.field_instructions;
        find_cells(id, inner.leaf, {outer_box(zone), &zone}, inner.fact.lipschitz_sup, aim);
    }
    const double across = 1 + (slope_in_holes(zone) - 1) * options.rules[Rule::Holes];
    NodeId formula =
        graph.make(Op::Max, {graph.mul(k.fact.lipschitz, graph.number(across)), graph.number(1)});
    set_lipschitz(k, formula, std::max(up(k.fact.lipschitz_sup * across), 1.0));
    return k;
}

} // namespace fathom::proof
