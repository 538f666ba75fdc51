// The deformations: twist, bend and taper by the moment arms of what they deform, other maps by the
// norm of their Jacobians; in the shape's own box alone, and there by the field's own expression,
// where that says more. Proofs: docs/lipschitz.md, 5.1 and 5.2.
#include "ir/maps.h"
#include "proof/deformed.h"
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::FieldKind;
using ir::MapKind;
using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

// Without a moment arm or a region, a shape that has bounds is proved within them, and joined with
// the way to them (ShapeFact::local).
bool own_box(const Shape &shape, const Derived &k) {
    return shape.dims == 3 && k.fact.bounds.finite() && !k.fact.bounds.empty();
}

} // namespace

// The largest distance from the axis at which the shape is evaluated.
double Prover::region_radius(ShapeId id, int axis) const {
    const Place &here = place(id);
    double radius = radius_about(here.box, axis);
    if (here.zone && here.zone->kind == ir::RegionKind::Ball) {
        double off = 0;
        for (int a = 0; a < 3; ++a)
            if (a != axis)
                off = std::hypot(off, here.zone->center[static_cast<std::size_t>(a)].magnitude());
        radius = std::min(radius, up(off + here.zone->half[0].hi, 4));
    }
    if (here.zone && here.zone->kind == ir::RegionKind::Tube && here.zone->axis == axis)
        radius = std::min(radius, here.zone->half[0].hi);
    return radius;
}

void Prover::needs_region(ShapeId id, Derived &k, const std::string &what) {
    if (!k.failed)
        if (Diagnostic *d = report(id, Code::NeedsRegion, what))
            d->help("write `.within(…)` after it, with a region that holds what you want to see, "
                    "as in `.within(ball(3))`");
    k.failed = true;
}

// k: what is known of the shape before it is deformed.
Derived Prover::know_twist(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const Derived &inner = child(shape);
    const double l = inner.fact.lipschitz_sup;
    bool alone = false; // proved in its own box
    Interval rate = number(shape.args[2]);
    int axis = shape.axis;
    auto a = static_cast<std::size_t>(axis);
    double moment_arm = inner.fact.moment_arm[a], region = region_radius(id, axis);
    double arm = std::min(moment_arm, region); // sigma(k M) everywhere, or sigma(k R) within R
    double r = radius_about(inner.fact.bounds, axis);
    if (!everywhere(k.fact.bounds) && !k.fact.bounds.empty())
        for (std::size_t i = 0; i < 3; ++i)
            if (int(i) != axis) k.fact.bounds.lo[i] = -r, k.fact.bounds.hi[i] = r;
    k.fact.round = radius_about(padded(inner.fact.bounds), axis) * options.rules[Rule::Round];
    k.growth_rate *= std::sqrt(2.0);
    forget_moment_arms(k);
    k.fact.moment_arm[a] = moment_arm; // turning about the axis commutes with the twist
    k.fact.symmetric = {false, false, false};
    if (!std::isfinite(arm) && own_box(shape, k)) {
        arm = radius_about(padded(k.fact.bounds), axis);
        alone = true;
    }
    if (!std::isfinite(arm)) {
        needs_region(id, k,
                     "a twist of " + operation_name(scene, shape.children[0]) +
                         ", whose surface is not all near the axis, has no bound");
        return k;
    }
    arm *= options.rules[Rule::Twist];
    double sup = up(l * sigma(rate.magnitude() * arm));
    // sigma(s) = (s + sqrt(s^2 + 4))/2, s = |rate| * arm: grows with |rate|, so a slider at 0
    // pays nothing.
    NodeId s = graph.mul({graph.make(Op::Abs, {shape.args[2]}), graph.number(arm)});
    NodeId root = graph.make(Op::Sqrt, {graph.add({graph.mul(s, s), graph.number(4)})});
    NodeId formula = graph.mul(graph.mul({graph.add(s, root), graph.number(0.5 * (1 + slack))}),
                               inner.fact.lipschitz);
    if (alone && !k.failed)
        keep_local(k, sup, formula);
    else if (!k.failed)
        set_lipschitz(k, formula, sup);
    return k;
}

Derived Prover::know_bend(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const Derived &inner = child(shape);
    const double l = inner.fact.lipschitz_sup;
    bool alone = false; // proved in its own box
    Interval rate = number(shape.args[2]);
    int third = 3 - shape.axis - shape.towards;
    auto t = static_cast<std::size_t>(third);
    double moment_arm = inner.fact.moment_arm[t],
           arm = std::min(moment_arm, region_radius(id, third));
    double r = radius_about(inner.fact.bounds, third);
    if (!everywhere(k.fact.bounds) && !k.fact.bounds.empty())
        for (std::size_t i = 0; i < 3; ++i)
            if (int(i) != third) k.fact.bounds.lo[i] = -r, k.fact.bounds.hi[i] = r;
    k.fact.round = radius_about(padded(inner.fact.bounds), third) * options.rules[Rule::Round];
    k.growth_rate *= std::sqrt(2.0);
    forget_moment_arms(k);
    for (std::size_t i = 0; i < 3; ++i)
        if (i != t) k.fact.symmetric[i] = false;
    if (!std::isfinite(arm) && own_box(shape, k)) {
        arm = radius_about(padded(k.fact.bounds), third);
        alone = true;
    }
    if (!std::isfinite(arm)) {
        needs_region(id, k,
                     "a bend of " + operation_name(scene, shape.children[0]) +
                         ", whose surface is not all near the axis, has no bound");
        return k;
    }
    arm *= options.rules[Rule::Bend];
    double add = up(rate.magnitude() * arm);
    NodeId excess =
        graph.mul({graph.make(Op::Abs, {shape.args[2]}), graph.number(arm * (1 + slack))});
    NodeId formula = graph.mul(graph.add(graph.number(1), excess), inner.fact.lipschitz);
    if (alone && !k.failed)
        keep_local(k, up(l * up(1 + add)), formula);
    else if (!k.failed)
        set_lipschitz(k, formula, up(l * up(1 + add)));
    return k;
}

Derived Prover::know_taper(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const Derived &inner = child(shape);
    const double l = inner.fact.lipschitz_sup;
    const Box here = place(id).box;
    bool alone = false; // proved in its own box
    Interval ratio = number(shape.args[2]), from = number(shape.args[3]),
             to = number(shape.args[4]);
    auto a = static_cast<std::size_t>(shape.axis);
    double length = (to - from).lo;
    double steepness = length > 0
                           ? up(std::max(std::fabs(ratio.lo - 1), std::fabs(ratio.hi - 1)) / length)
                           : infinity;
    double most = std::max(1.0, ratio.hi);
    // What was turned about the same axis before is seen through: its points and surface points
    // turn alike, and the turn adds k m to the slope along the axis, |m| at most the moment arm.
    const Shape below = scene.shapes[shape.children[0]];
    const bool twisted =
        below.kind == ir::ShapeKind::Map && below.map == MapKind::Twist && below.axis == shape.axis;
    const Derived &straight = twisted ? of(below.children[0]) : inner;
    const double rate = twisted ? number(below.args[2]).magnitude() : 0;
    const Box &parts = straight.parts;
    double r = radius_about(parts, shape.axis);
    // How far along the axis a point between the ends can be from its nearest surface point.
    double v = std::max((Interval(parts.hi[a]) - from).hi, (to - Interval(parts.lo[a])).hi);
    const Interval sections(std::max(std::min(1.0, ratio.lo), 0.0), most);
    if (!k.fact.bounds.empty())
        for (std::size_t i = 0; i < 3; ++i)
            if (i != a) {
                const Interval side = Interval(k.fact.bounds.lo[i], k.fact.bounds.hi[i]) * sections;
                k.fact.bounds.lo[i] = side.lo, k.fact.bounds.hi[i] = side.hi;
            }
    k.fact.symmetric[a] = false;
    // {c f(x/c) < t} needs f < t/c.
    k.growth_rate = ratio.lo > 0 ? up(k.growth_rate * most / std::min(1.0, ratio.lo)) : infinity;
    forget_moment_arms(k);
    if (!std::isfinite(steepness)) {
        needs_region(id, k, "a taper whose two ends are at the same height");
        return k;
    }
    double norm = infinity;
    if (std::isfinite(r) && std::isfinite(v) && std::isfinite(straight.mean_slack)) {
        const double slant = up(steepness * r * options.rules[Rule::Taper]),
                     turn = up(most * rate * options.rules[Rule::Twist]);
        norm = lower_triangle_norm(
            up(most + steepness * v * options.rules[Rule::Taper]),
            std::min(up(std::hypot(slant, turn * r), 4),
                     up(slant + turn * std::min(straight.fact.moment_arm[a], r))));
        norm = up((norm * straight.fact.lipschitz_sup +
                   steepness * straight.mean_slack * options.rules[Rule::Taper]) /
                      l,
                  2);
    }
    Box inside = here;
    if (!std::isfinite(norm) && !here.finite() && own_box(shape, k)) {
        inside = padded(k.fact.bounds);
        alone = true;
    }
    if (inside.finite() && !inside.empty()) {
        // In a region: |grad| <= L [[1,0],[|c'| r/c, c]] + |c'| |f|.
        double least = std::max(std::min(1.0, ratio.lo), 1e-4);
        double across =
            (alone ? radius_about(inside, shape.axis) : region_radius(id, shape.axis)) / least;
        Box image = inside; // x/c for x in the region
        for (std::size_t i = 0; i < 3; ++i)
            if (i != a) {
                const Interval side = Interval(inside.lo[i], inside.hi[i]) / Interval(least, most);
                image.lo[i] = side.lo, image.hi[i] = side.hi;
            }
        const double size = magnitude(shape.children[0], image);
        norm = std::min(norm, up(lower_triangle_norm(most, up(steepness * across)) +
                                 steepness * size / std::max(l, 1e-9)));
    }
    if (!std::isfinite(norm)) {
        needs_region(id, k,
                     "a taper of " + operation_name(scene, shape.children[0]) +
                         ", which is not made of exact parts of limited size, has no bound");
        return k;
    }
    if (alone && !k.failed)
        keep_local(k, up(l * norm), graph.number(up(l * norm)));
    else if (!k.failed)
        set_lipschitz(k, up(l * norm));
    return k;
}

Derived Prover::know_distort(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const Derived &inner = child(shape);
    const double l = inner.fact.lipschitz_sup;
    const Box here = place(id).box;
    bool alone = false; // proved in its own box
    forget_moment_arms(k);
    k.fact.symmetric = {false, false, false};
    k.growth_rate = infinity;
    auto shift = whole_shift(shape.args[0]);
    if (shift && !everywhere(k.fact.bounds)) {
        k.fact.bounds = moved(k.fact.bounds, *shift);
        k.growth_rate = inner.growth_rate;
    } else if (!k.fact.bounds.empty()) {
        k.fact.bounds = here;
    }
    double factor;
    if (shape.estimate > 0) {
        factor = shape.estimate;
        test_estimate(id, shape.args[0], factor);
        k.fact.status = std::max(k.fact.status, ir::ProofStatus::Estimated);
        k.fact.kind = FieldKind::Estimate;
    } else if (shape.assumed > 0) {
        const auto b = holds_stated(id, shape.args[0], shape.assumed);
        factor = b ? b->lipschitz : shape.assumed;
        if (!b) k.fact.status = std::max(k.fact.status, ir::ProofStatus::Assumed);
    } else {
        FieldBound b;
        if (everywhere(here) && own_box(shape, k) && place(id).reported) {
            b = bound(id, shape.args[0], "the map", false);
            if (!std::isfinite(b.lipschitz)) { // steeper without limit far away, perhaps; but
                                               // not in the shape's own box
                Budget budget;
                budget.instructions = options.field_instructions;
                b = bound_field(flattening, ranges, shape.args[0],
                                {to_cell(padded(k.fact.bounds)), nullptr}, budget);
                alone = true;
                if (!std::isfinite(b.lipschitz)) report_field(id, b, "the map");
            }
        } else {
            b = bound(id, shape.args[0], "the map");
        }
        factor = 1 + (b.lipschitz - 1) * (b.lipschitz > 1 ? options.rules[Rule::Distort] : 1);
        if (!std::isfinite(b.lipschitz)) k.failed = true;
    }
    if (!k.failed) {
        NodeId formula = graph.mul(inner.fact.lipschitz, graph.number(factor));
        if (alone)
            keep_local(k, up(l * factor), formula);
        else
            set_lipschitz(k, formula, up(l * factor));
    }
    return k;
}

Derived Prover::know_deformed(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = of_child(shape);
    const bool turns = shape.map == MapKind::Twist || shape.map == MapKind::Bend;
    if ((turns && number(shape.args[2]) == Interval(0.0)) ||
        (shape.map == MapKind::Taper && number(shape.args[2]) == Interval(1.0)))
        return k; // at these values it is its child
    k.fact.kind = k.fact.kind == FieldKind::Estimate ? FieldKind::Estimate : FieldKind::Bound;
    k.fact.exact_outside = k.parts_exact = false;
    k.outer = Box::everything(), k.outer_growth_rate = 0;
    switch (shape.map) {
    case MapKind::Twist: k = know_twist(id, k); break;
    case MapKind::Bend: k = know_bend(id, k); break;
    case MapKind::Taper: k = know_taper(id, k); break;
    case MapKind::Distort: k = know_distort(id, k); break;
    case MapKind::Translate:
    case MapKind::Rotate:
    case MapKind::Scale:
    case MapKind::MirrorFold:
    case MapKind::Revolve: break; // know_map's own
    }
    if (!k.failed && own_box(shape, k) && (k.fact.local || shape.map == MapKind::Taper))
        tighten(id, k);
    if (k.failed) fail(k);
    return k;
}

// Rules that hold for every shape count its farthest point and its steepest gradient as one. Where
// the field can be written as one expression, its slope in the shape's own box is measured whole.
void Prover::tighten(ShapeId id, Derived &k) {
    const Shape shape = scene.shapes[id];
    const double rule = k.fact.lipschitz_sup;
    if (!options.tighten || rule <= 1.1 || !graph.is_constant(k.fact.lipschitz) ||
        !place(id).reported)
        return;
    Budget budget;
    // Few deformed shapes share what many would.
    budget.instructions = options.field_instructions / std::clamp<std::size_t>(deformed, 1, 40);
    budget.tolerance = 1.03;
    budget.hopeless = 0.9 * rule;
    const Cell box = to_cell(padded(k.fact.bounds));
    const auto measured = [&]() -> double {
        const auto field = expression(shape.map == MapKind::Distort ? id : shape.children[0]);
        if (!field) return infinity;
        if (shape.map == MapKind::Distort)
            return bound_field(flattening, ranges, *field, {box, nullptr}, budget).lipschitz;
        Deformation how;
        how.map = shape.map;
        how.box = box;
        how.axis = ir::turning_axis(shape);
        if (shape.map == MapKind::Taper)
            how.ratio = number(shape.args[2]), how.from = number(shape.args[3]),
            how.to = number(shape.args[4]);
        else
            how.rate = number(shape.args[2]);
        return bound_deformed(flattening, ranges, *field, how, budget).lipschitz;
    };
    const double found = measured();
    const double bound = 1 + (found - 1) * (found > 1 ? options.rules[Rule::Tightened] : 1);
    // Joined with the way to the box, it is as steep as a distance at least.
    if (bound < budget.hopeless) keep_local(k, bound, graph.number(bound));
}

} // namespace fathom::proof
