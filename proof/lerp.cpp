// The rule for a blend by a weight, t a + (1 - t) b. Proofs: docs/lipschitz.md, 3.
#include "proof/gap.h"
#include "proof/prover.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <numeric>

namespace fathom::proof {

using ir::FieldKind;
using ir::NodeId;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

// Numbers in their order, and back: so that halving ends at neighbours, whatever their size.
std::int64_t place_of(double x) {
    const auto bits = std::bit_cast<std::int64_t>(x);
    return bits < 0 ? std::numeric_limits<std::int64_t>::min() - bits : bits;
}
double number_at(std::int64_t place) {
    return std::bit_cast<double>(place < 0 ? std::numeric_limits<std::int64_t>::min() - place
                                           : place);
}

} // namespace

// The part of a box in which a weight varies: beyond each side its gradient is 0. Each side is
// found by halving, with what the others have cut off already.
Box Prover::varying_box(NodeId weight, const Box &within) {
    const auto kept = tape_of(weight);
    const Tape &tape = *kept;
    if (tape.too_large) return within;
    Machine machine(tape, ranges);
    Box box = within;
    for (std::size_t axis = 0; axis < 3; ++axis)
        for (const bool upper : {true, false}) {
            const auto flat_beyond = [&](double side) {
                Box beyond = box;
                (upper ? beyond.lo : beyond.hi)[axis] = side;
                machine.run(to_cell(beyond));
                return machine.norm() == 0;
            };
            std::int64_t in = place_of(box.lo[axis]), out = place_of(box.hi[axis]);
            if (!upper) std::swap(in, out);
            if (in == out || !flat_beyond(number_at(out))) continue;
            while (true) {
                const std::int64_t middle = std::midpoint(in, out);
                if (middle == in || middle == out) break;
                (flat_beyond(number_at(middle)) ? out : in) = middle;
            }
            (upper ? box.hi : box.lo)[axis] = number_at(out);
        }
    return box;
}

// The most by which the two fields differ; infinity where that is not known, or endless. As their
// expressions say; or, of exact fields, where one of them is 0, or they have not the same sign. What is
// nowhere has a number in place of a distance, and a fold may leave a field less than the way to the
// point it falls towards: that is added. `enough`: a gap than which none need be less.
double Prover::gap_of(ShapeId id, double enough) {
    const Shape shape = scene.shapes[id];
    const Derived &a = child(shape, 0), &b = child(shape, 1);
    const auto f = expression(shape.children[0]), g = expression(shape.children[1]);
    double gap = infinity;
    if (f && g) gap = bound_difference(flattening, ranges, *f, *g, to_cell(place(id).box));
    const Box common = ir::hull(a.fact.bounds, b.fact.bounds);
    const bool nowhere = a.fact.bounds.empty() || b.fact.bounds.empty();
    if (gap <= enough || !a.fact.exact_outside || !b.fact.exact_outside || !common.finite() ||
        nowhere)
        return gap;
    const double less = a.short_by + b.short_by;
    // of the box that holds both: outside both fields lie in [d, d + D], inside above -D/2
    double diagonal = 0;
    for (std::size_t i = 0; i < 3; ++i) diagonal += std::pow(common.hi[i] - common.lo[i], 2);
    gap = std::min(gap, up(1.5 * std::sqrt(diagonal) + a.lowered + b.lowered + less, 4));
    if (!f || !g) return gap;
    Budget budget;
    budget.enough = enough;
    const double steepest = std::max(a.fact.lipschitz_sup, b.fact.lipschitz_sup);
    if (a.lowered > 0 || b.lowered > 0 || less > 0 || steepest > 1) {
        budget.instructions = options.field_instructions / 4;
        return std::min(gap, up(less + bound_magnitude(flattening, ranges, graph.sub(*f, *g),
                                                       {to_cell(common), nullptr}, budget)));
    }
    const bool inside = a.fact.kind == FieldKind::Exact && b.fact.kind == FieldKind::Exact;
    gap = std::min(gap, bound_difference(flattening, ranges, *f, *g, to_cell(common)));
    if (gap <= enough) return gap;
    budget.instructions = 4 * options.field_instructions;
    budget.hopeless = 0.95 * gap;
    return std::min(gap, bound_gap(flattening, ranges, *f, *g, inside, to_cell(common), budget));
}

Derived Prover::know_lerp(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const Derived &a = child(shape, 0), &b = child(shape, 1);
    Derived k = of_child(shape);
    inherit(k, b);
    k.fact.kind = FieldKind::Bound;
    k.fact.exact_outside = k.parts_exact = false;
    NodeId t = shape.args[0];
    bool varies = reads_point(t);
    FieldBound weight;
    if (varies) weight = bound(id, t, "the blend's weight");
    Interval range = varies ? weight.value : number(t), rest = Interval(1.0) - range;
    // Rounding outward may reach a little beyond 0..1; the slack covers it.
    bool convex = range.lo >= -1e-9 && range.hi <= 1 + 1e-9;
    double la = a.fact.lipschitz_sup, lb = b.fact.lipschitz_sup;
    double sup =
        convex ? (varies || !range.is_point() ? std::max(la, lb) : up(range.hi * la + rest.hi * lb))
               : up(range.magnitude() * la + rest.magnitude() * lb);
    if (!convex) sup = 1 + (sup - 1) * options.rules[Rule::LerpWeights];
    k.offset_slack = infinity;
    if (varies || !convex) k.mean_slack = infinity;
    weigh(k, b); // both weights are at least 0
    if (!convex) {
        k.fact.bounds = k.outer = Box::everything();
        forget_moment_arms(k);
    }
    if (varies && std::isfinite(weight.lipschitz) && weight.lipschitz > 0) {
        // |grad| <= the mean's + |grad t| * |a - b|, where t varies.
        const Box box = varying_box(t, place(id).box);
        // a gap that adds no more than that is not worth more work
        constexpr double flat = 0.01;
        double gap =
            gap_of(id, std::isfinite(sup) ? flat * std::max(sup, 1.0) / weight.lipschitz : 0);
        if (box.finite() && !box.empty())
            gap = std::min(
                gap, up(magnitude(shape.children[0], box) + magnitude(shape.children[1], box)));
        forget_moment_arms(k);
        k.fact.symmetric = {false, false, false};
        if (!std::isfinite(gap) && !k.failed) {
            if (Diagnostic *d = report(id, Code::NeedsRegion,
                                       "a blend with a varying weight needs a region: its two "
                                       "fields may differ without limit"))
                d->help("write `.within(…)` after it, with a region that holds what you want to "
                        "see, as in `.within(ball(3))`");
            k.failed = true;
        }
        sup = up(sup + weight.lipschitz * gap * options.rules[Rule::LerpVarying]);
    }
    if (varies && !std::isfinite(weight.lipschitz)) k.failed = true;
    if (!std::isfinite(sup) && !k.failed && !a.failed && !b.failed) {
        if (Diagnostic *d = report(id, Code::NeedsRegion, "the blend's weight grows without limit"))
            d->help("write `.within(…)` after it, or hold the weight, as in `saturate(…)`");
        k.failed = true;
    }
    if (k.failed)
        fail(k);
    else
        set_lipschitz(k, sup);
    return k;
}

} // namespace fathom::proof
