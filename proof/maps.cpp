// The rules for maps: rigid motions, scales, folds, and the deformations with their moment arms.
// Proofs: docs/lipschitz.md, 5.
#include "ir/maps.h"
#include "proof/deformed.h"
#include "proof/prover.h"

#include "proof/continuity.h"

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

void forget_moment_arms(Derived &k) {
    k.parts = Box::everything();
    k.fact.moment_arm = {infinity, infinity, infinity};
}
void cap_moment_arms(Derived &k) {
    for (int a = 0; a < 3; ++a) {
        double &moment_arm = k.fact.moment_arm[static_cast<std::size_t>(a)];
        moment_arm = std::min(moment_arm, radius_about(k.parts, a));
    }
}

} // namespace

Derived Prover::know_map(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = child(shape);
    k.fact.repeat = {};
    k.fact.guard = false;
    bool flat = shape.dims == 2;
    switch (shape.map) {
    case MapKind::Translate: {
        Vec by = vector(shape.args[2]);
        if (flat) by[2] = 0.0;
        k.fact.bounds = moved(k.fact.bounds, by);
        k.outer = moved(k.outer, by);
        k.parts = moved(k.parts, by);
        for (int a = 0; a < 3; ++a) {
            auto i = static_cast<std::size_t>(a);
            double across = 0;
            for (int b = 0; b < 3; ++b)
                if (b != a)
                    across = std::hypot(across, by[static_cast<std::size_t>(b)].magnitude());
            k.fact.moment_arm[i] = up(k.fact.moment_arm[i] + across, 4); // p x g = q x g + v x g
            k.fact.symmetric[i] = k.fact.symmetric[i] && by[i] == Interval(0.0);
        }
        cap_moment_arms(k);
        break;
    }
    case MapKind::Rotate: {
        auto matrix = numbers(shape.args[2]);
        int side = flat ? 2 : 3;
        k.fact.bounds = turned(k.fact.bounds, matrix, side);
        k.outer = everywhere(k.outer) ? k.outer : turned(k.outer, matrix, side);
        k.parts = everywhere(k.parts) ? k.parts : turned(k.parts, matrix, side);
        auto n = static_cast<std::size_t>(side);
        std::array<double, 3> moment_arm{infinity, infinity, infinity};
        std::array<bool, 3> symmetric{};
        if (flat) { // about z: the moment arm about z stays
            moment_arm[2] = k.fact.moment_arm[2];
            symmetric[2] = k.fact.symmetric[2];
        }
        for (std::size_t to = 0; to < n; ++to)
            for (std::size_t from = 0; from < n; ++from) {
                // Column `from` is +-e_to: that axis is only renamed, for all params. Trigonometry
                // leaves 1e-16; a moment arm changes by less than its rounding.
                bool axis = matrix[from * n + to].mignitude() > 1 - 1e-12;
                if (!axis) continue;
                if (side == 3) moment_arm[to] = up(k.fact.moment_arm[from], 4);
                symmetric[to] = k.fact.symmetric[from];
            }
        k.fact.moment_arm = moment_arm;
        k.fact.symmetric = symmetric;
        cap_moment_arms(k);
        break;
    }
    case MapKind::Scale: {
        Vec by = vector(shape.args[2]);
        if (flat) by[2] = by[0];
        bool uniform = graph[shape.args[2]].op == Op::Splat;
        if (!uniform) {
            uniform = true;
            for (std::size_t i = 1; i < (flat ? 2u : 3u); ++i)
                uniform = uniform && by[i].is_point() && abs(by[i]) == abs(by[0]);
        }
        double most = 0, least = infinity;
        for (std::size_t i = 0; i < (flat ? 2u : 3u); ++i) {
            most = std::max(most, by[i].magnitude());
            least = std::min(least, by[i].mignitude());
        }
        if (flat) by[2] = 1.0;
        k.lowered = up(k.lowered * most);
        k.fact.bounds = times(k.fact.bounds, by);
        k.outer = everywhere(k.outer) ? k.outer : times(k.outer, by);
        if (uniform) {
            k.parts = everywhere(k.parts) ? k.parts : times(k.parts, by);
            for (double &moment_arm : k.fact.moment_arm) moment_arm = up(moment_arm * most);
            k.offset_slack = up(k.offset_slack * most);
        } else {
            // min|s| * |J^T g| <= min|s| / min|s| * L: the factor takes back what the map adds. Not
            // exact any more, and gradients no longer point from nearest points.
            if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
            k.exact_outside = k.parts_exact = false;
            forget_moment_arms(k);
            double ratio = least > 0 ? most / least : infinity;
            k.growth_rate = up(k.growth_rate * ratio),
            k.outer_growth_rate = up(k.outer_growth_rate * ratio);
        }
        break;
    }
    case MapKind::MirrorFold: {
        // What lies within the fold's image may have copies: the preimage of the box.
        Box preimage = fold_preimage(shape.args[0], k.fact.bounds);
        k.fact.bounds = preimage;
        k.parts = fold_preimage(shape.args[0], k.parts);
        k.outer = everywhere(k.outer) ? k.outer : Box::everything();
        if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
        // A fold that adds nothing behind its mirrors leaves the distance outside exact; whether
        // the shape lies on one side is known where its box does.
        k.parts_exact = false;
        k.exact_outside = k.exact_outside && fold_is_clean(shape.args[0], child(shape).fact.bounds);
        k.fact.symmetric = fold_symmetry(shape.args[0], k.fact.symmetric);
        k.fact.moment_arm = {infinity, infinity, infinity};
        cap_moment_arms(k);
        k.growth_rate *= std::sqrt(3.0);
        break;
    }
    case MapKind::Revolve: {
        Interval offset = number(shape.args[2]);
        const Box flat_box = k.fact.bounds;
        auto spin = [&](const Box &box, bool beyond) { // beyond: what lies across the axis too
            if (box.empty() || everywhere(box)) return box;
            double r = std::max((Interval(box.hi[0]) + offset).hi, 0.0);
            if (beyond) r = std::max(r, -(Interval(box.lo[0]) + offset).lo);
            Box out;
            out.lo = {-r, box.lo[1], -r};
            out.hi = {r, box.hi[1], r};
            return out;
        };
        k.fact.bounds = spin(k.fact.bounds, false);
        k.outer = Box::everything(), k.outer_growth_rate = 0;
        bool clear = !flat_box.empty() && (Interval(flat_box.lo[0]) + offset).lo >= 0;
        bool mirrored = k.fact.symmetric[0] && offset == Interval(0.0);
        if (!clear &&
            !mirrored) { // parts beyond the axis pull the field down: a bound, not the distance
            if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
            k.exact_outside = k.parts_exact = false;
        }
        // In the plane through p and the axis the gradient g is the profile's, and s its nearest
        // point, as far as o further from the axis: |s x g| there is at most M + |o|, M the
        // profile's own moment arm. About x and z it counts by the same share of that plane's
        // tilt as |g| does.
        k.parts = spin(k.parts, true);
        k.fact.moment_arm[0] = k.fact.moment_arm[2] = up(k.fact.moment_arm[2] + offset.magnitude());
        cap_moment_arms(k);
        k.fact.symmetric = {true, k.fact.symmetric[1], true};
        k.fact.moment_arm[1] = 0; // every profile is its own turn about y
        break;
    }
    case MapKind::Twist:
    case MapKind::Bend:
    case MapKind::Taper:
    case MapKind::Distort: return know_deformed(id);
    }
    k.fact.lipschitz_sup = child(shape).fact.lipschitz_sup;
    if (k.failed) fail(k);
    return k;
}

// A fold's point is p by component, |p_i| there, or p - e with e of limited size (an elongation).
Box Prover::fold_preimage(NodeId q, const Box &box) {
    if (box.empty() || everywhere(box)) return box;
    Box out = box;
    int n = ir::components(graph[q].type);
    NodeId p = graph.point(graph[q].type);
    for (int i = 0; i < n; ++i) {
        auto k = static_cast<std::size_t>(i);
        NodeId c = in_one_form(graph, component_of(graph, q, i)), own = graph.component(p, i);
        if (c == own) continue;
        if (graph[c].op == Op::Abs && graph.arg(c, 0) == own) {
            double r = std::max(box.hi[k], 0.0);
            out.lo[k] = -r, out.hi[k] = r;
            continue;
        }
        if (auto e = shift_of(q, i)) { // p = q + e
            Interval by = number_anywhere(*e);
            if (by.finite()) {
                out.lo[k] = (Interval(box.lo[k]) + by).lo,
                out.hi[k] = (Interval(box.hi[k]) + by).hi;
                continue;
            }
        }
        // Any other fold: 1-Lipschitz and continuous, but it may gather from anywhere.
        if (auto whole = whole_shift(q)) return moved(box, *whole);
        if (!keeps_length(graph, q)) return Box::everything();
        double r = norm_of(box);
        for (int j = 0; j < n; ++j)
            out.lo[static_cast<std::size_t>(j)] = -r, out.hi[static_cast<std::size_t>(j)] = r;
        return out;
    }
    return out;
}

// p - q in one component.
std::optional<NodeId> Prover::shift_of(NodeId q, int i) {
    NodeId p = graph.point(graph[q].type);
    return difference(graph, graph.component(p, i), component_of(graph, q, i));
}

// The interval of p - q over all p, where that is limited.
std::optional<Vec> Prover::whole_shift(NodeId q) {
    Vec out{};
    for (int i = 0; i < ir::components(graph[q].type); ++i) {
        auto e = shift_of(q, i);
        if (!e) return {};
        Interval by = number_anywhere(*e);
        if (!by.finite()) return {};
        out[static_cast<std::size_t>(i)] = by;
    }
    return out;
}

Interval Prover::number_anywhere(NodeId id) { return range_of(flattening, ranges, id)[0]; }

bool Prover::fold_is_clean(NodeId q, const Box &box) {
    NodeId p = graph.point(graph[q].type);
    for (int i = 0; i < ir::components(graph[q].type); ++i) {
        NodeId c = in_one_form(graph, component_of(graph, q, i)), own = graph.component(p, i);
        if (c == own) continue;
        bool mirror = graph[c].op == Op::Abs && graph.arg(c, 0) == own;
        if (mirror ? box.lo[static_cast<std::size_t>(i)] < 0
                   : !number_anywhere(shift_of(q, i).value_or(own)).finite())
            return false;
    }
    return true;
}

std::array<bool, 3> Prover::fold_symmetry(NodeId q, std::array<bool, 3> child) {
    NodeId p = graph.point(graph[q].type);
    std::array<bool, 3> out{};
    for (int i = 0; i < ir::components(graph[q].type); ++i) {
        auto k = static_cast<std::size_t>(i);
        NodeId c = in_one_form(graph, component_of(graph, q, i)), own = graph.component(p, i);
        if (c == own)
            out[k] = child[k];
        else if (graph[c].op == Op::Abs && graph.arg(c, 0) == own)
            out[k] = true;
    }
    return out;
}

// The largest distance from the axis at which the shape is asked.
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

Derived Prover::know_deformed(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const Derived inner = child(shape);
    Derived k = inner;
    k.fact.repeat = {};
    k.fact.guard = false;
    const bool turns = shape.map == MapKind::Twist || shape.map == MapKind::Bend;
    if ((turns && number(shape.args[2]) == Interval(0.0)) ||
        (shape.map == MapKind::Taper && number(shape.args[2]) == Interval(1.0)))
        return k; // at these values it is its child
    k.fact.kind = k.fact.kind == FieldKind::Estimate ? FieldKind::Estimate : FieldKind::Bound;
    k.exact_outside = k.parts_exact = false;
    k.outer = Box::everything(), k.outer_growth_rate = 0;
    const Box here = place(id).box;
    const double l = inner.fact.lipschitz_sup;
    auto needs_region = [&](const std::string &what) {
        if (!k.failed)
            if (Diagnostic *d = report(id, Code::NeedsRegion, what))
                d->help("write `.within(…)` after it, with a region that holds what you want to "
                        "see, as in `.within(ball(3))`");
        k.failed = true;
    };
    const std::string child_name = operation_name(scene, shape.children[0]);
    // Without a moment arm or a region, a shape that has bounds is proved within them, and joined
    // with the way to them.
    auto own_box = [&] {
        return shape.dims == 3 && k.fact.bounds.finite() && !k.fact.bounds.empty();
    };
    bool alone = false;

    switch (shape.map) {
    case MapKind::Twist: {
        Interval rate = number(shape.args[2]);
        int axis = shape.axis;
        auto a = static_cast<std::size_t>(axis);
        double moment_arm = inner.fact.moment_arm[a], region = region_radius(id, axis);
        double arm = std::min(moment_arm, region); // sigma(k M) everywhere, or sigma(k R) within R
        double r = radius_about(inner.fact.bounds, axis);
        if (!everywhere(k.fact.bounds) && !k.fact.bounds.empty())
            for (std::size_t i = 0; i < 3; ++i)
                if (int(i) != axis) k.fact.bounds.lo[i] = -r, k.fact.bounds.hi[i] = r;
        round = radius_about(padded(inner.fact.bounds), axis) * options.rules[Rule::Round];
        k.growth_rate *= std::sqrt(2.0);
        forget_moment_arms(k);
        k.fact.moment_arm[a] = moment_arm; // turning about the axis commutes with the twist
        k.fact.symmetric = {false, false, false};
        if (!std::isfinite(arm) && own_box()) {
            arm = radius_about(padded(k.fact.bounds), axis);
            alone = true;
        }
        if (!std::isfinite(arm)) {
            needs_region("a twist of " + child_name +
                         ", whose surface is not all near the axis, has no bound");
            break;
        }
        arm *= options.rules[Rule::Twist];
        double sup = up(l * sigma(rate.magnitude() * arm));
        // sigma(s) = (s + sqrt(s^2 + 4))/2, s = |rate| * arm: grows with |rate|, so a slider at 0
        // pays nothing.
        NodeId s = graph.mul(graph.make(Op::Abs, {shape.args[2]}), graph.number(arm));
        NodeId root = graph.make(Op::Sqrt, {graph.add(graph.mul(s, s), graph.number(4))});
        NodeId formula = graph.mul(graph.mul(graph.add(s, root), graph.number(0.5 * (1 + slack))),
                                   inner.fact.lipschitz);
        if (alone && !k.failed)
            keep_local(k, sup, formula);
        else if (!k.failed)
            set_lipschitz(k, formula, sup);
        break;
    }
    case MapKind::Bend: {
        Interval rate = number(shape.args[2]);
        int third = 3 - shape.axis - shape.towards;
        auto t = static_cast<std::size_t>(third);
        double moment_arm = inner.fact.moment_arm[t],
               arm = std::min(moment_arm, region_radius(id, third));
        double r = radius_about(inner.fact.bounds, third);
        if (!everywhere(k.fact.bounds) && !k.fact.bounds.empty())
            for (std::size_t i = 0; i < 3; ++i)
                if (int(i) != third) k.fact.bounds.lo[i] = -r, k.fact.bounds.hi[i] = r;
        round = radius_about(padded(inner.fact.bounds), third) * options.rules[Rule::Round];
        k.growth_rate *= std::sqrt(2.0);
        forget_moment_arms(k);
        for (std::size_t i = 0; i < 3; ++i)
            if (i != t) k.fact.symmetric[i] = false;
        if (!std::isfinite(arm) && own_box()) {
            arm = radius_about(padded(k.fact.bounds), third);
            alone = true;
        }
        if (!std::isfinite(arm)) {
            needs_region("a bend of " + child_name +
                         ", whose surface is not all near the axis, has no bound");
            break;
        }
        arm *= options.rules[Rule::Bend];
        double add = up(rate.magnitude() * arm);
        NodeId excess =
            graph.mul(graph.make(Op::Abs, {shape.args[2]}), graph.number(arm * (1 + slack)));
        NodeId formula = graph.mul(graph.add(graph.number(1), excess), inner.fact.lipschitz);
        if (alone && !k.failed)
            keep_local(k, up(l * up(1 + add)), formula);
        else if (!k.failed)
            set_lipschitz(k, formula, up(l * up(1 + add)));
        break;
    }
    case MapKind::Taper: {
        Interval ratio = number(shape.args[2]), from = number(shape.args[3]),
                 to = number(shape.args[4]);
        auto a = static_cast<std::size_t>(shape.axis);
        double length = (to - from).lo;
        double steepness =
            length > 0 ? up(std::max(std::fabs(ratio.lo - 1), std::fabs(ratio.hi - 1)) / length)
                       : infinity;
        double most = std::max(1.0, ratio.hi);
        // What was turned about the same axis before is seen through: its points and surface points
        // turn alike, and the turn adds k m to the slope along the axis, |m| at most the moment arm.
        const Shape below = scene.shapes[shape.children[0]];
        const bool twisted = below.kind == ir::ShapeKind::Map && below.map == MapKind::Twist &&
                             below.axis == shape.axis;
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
                    const Interval side =
                        Interval(k.fact.bounds.lo[i], k.fact.bounds.hi[i]) * sections;
                    k.fact.bounds.lo[i] = side.lo, k.fact.bounds.hi[i] = side.hi;
                }
        k.fact.symmetric[a] = false;
        // {c f(x/c) < t} needs f < t/c.
        k.growth_rate =
            ratio.lo > 0 ? up(k.growth_rate * most / std::min(1.0, ratio.lo)) : infinity;
        forget_moment_arms(k);
        if (!std::isfinite(steepness)) {
            needs_region("a taper whose two ends are at the same height");
            break;
        }
        double norm = infinity;
        if (straight.parts_exact && std::isfinite(r) && std::isfinite(v)) {
            const double slant = up(steepness * r * options.rules[Rule::Taper]),
                         turn = up(most * rate * options.rules[Rule::Twist]);
            norm = lower_triangle_norm(
                up(most + steepness * v * options.rules[Rule::Taper]),
                std::min(up(std::hypot(slant, turn * r), 4),
                         up(slant + turn * std::min(straight.fact.moment_arm[a], r))));
            norm = up(norm * straight.fact.lipschitz_sup / l);
        }
        Box inside = here;
        if (!std::isfinite(norm) && !here.finite() && own_box()) {
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
                    const Interval side =
                        Interval(inside.lo[i], inside.hi[i]) / Interval(least, most);
                    image.lo[i] = side.lo, image.hi[i] = side.hi;
                }
            const double size = magnitude(shape.children[0], image);
            norm = std::min(norm, up(lower_triangle_norm(most, up(steepness * across)) +
                                     steepness * size / std::max(l, 1e-9)));
        }
        if (!std::isfinite(norm)) {
            needs_region("a taper of " + child_name +
                         ", which is not made of exact parts of limited size, has no bound");
            break;
        }
        if (alone && !k.failed)
            keep_local(k, up(l * norm), graph.number(up(l * norm)));
        else if (!k.failed)
            set_lipschitz(k, up(l * norm));
        break;
    }
    case MapKind::Distort: {
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
        if (shape.assumed > 0 || shape.estimate > 0) {
            factor = shape.assumed > 0 ? shape.assumed : shape.estimate;
            test_assumed(id, shape.args[0], factor, shape.assumed <= 0);
            k.fact.status = std::max(k.fact.status, shape.assumed > 0 ? ir::ProofStatus::Assumed
                                                                      : ir::ProofStatus::Estimated);
            if (shape.assumed <= 0) k.fact.kind = FieldKind::Estimate;
        } else {
            FieldBound b;
            if (everywhere(here) && own_box() && place(id).reported) {
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
        break;
    }
    case MapKind::Translate:
    case MapKind::Rotate:
    case MapKind::Scale:
    case MapKind::MirrorFold:
    case MapKind::Revolve: break;
    }
    if (!k.failed && own_box() && (alone || shape.map == MapKind::Taper)) tighten(id, k);
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
