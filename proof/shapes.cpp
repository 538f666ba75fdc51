// The rules of the kinds that combine, displace, extrude, or repeat as a table of instances. Proofs:
// docs/lipschitz.md, 3.
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
using ir::ShapeKind;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

void meet(Derived &k, const Derived &c) {
    std::swap(k.fact.bounds, k.outer);
    std::swap(k.growth_rate, k.outer_growth_rate);
    Derived other = c;
    std::swap(other.fact.bounds, other.outer);
    std::swap(other.growth_rate, other.outer_growth_rate);
    unite(k, other);
    std::swap(k.fact.bounds, k.outer);
    std::swap(k.growth_rate, k.outer_growth_rate);
}
// The part that a profile adds lies where both are below r (blends.h). Further out: where both are
// below t + r. If that is nowhere for t = 0, as the boxes are `gap` > 2wr apart, it is from 2w(t +
// r) = gap on, where w(t + r) is at most wt * gap/(gap - 2wr).
void blend(Derived &k, const Derived &c, double r, ir::Profile profile) {
    double w = std::max(k.growth_rate, c.growth_rate);
    const Box both = ir::intersect(reached(k.fact.bounds, w, r), reached(c.fact.bounds, w, r));
    if (both.empty() && !k.fact.bounds.empty() && !c.fact.bounds.empty()) {
        double gap = 0;
        for (std::size_t a = 0; a < 3; ++a)
            gap = std::max({gap, k.fact.bounds.lo[a] - c.fact.bounds.hi[a],
                            c.fact.bounds.lo[a] - k.fact.bounds.hi[a]});
        w = gap > 2 * w * r ? up(w * gap / (gap - 2 * w * r), 4) : infinity;
    }
    unite(k, c);
    k.growth_rate = std::max(k.growth_rate, w);
    if (!both.empty()) k.fact.bounds = ir::hull(k.fact.bounds, both);
    differ_by(k, 2 * r);                   // a part decides only where it is within r of the least
    if (profile == ir::Profile::Columns) { // not a function of the difference alone
        k.fact.bounds = reached(k.fact.bounds, w, r);
        k.growth_rate = infinity;
        k.outer = Box::everything();
    }
}

// first: the operand that a seam takes away from, or adds to. depth: of a tongue.
void seam(Derived &k, const Derived &first, const Derived &c, double r, double depth,
          ir::SeamKind kind) {
    const double w = std::max(k.growth_rate, c.growth_rate);
    k.outer = Box::everything(), k.outer_growth_rate = 0;
    differ_by(k, infinity);
    switch (kind) {
    case ir::SeamKind::Pipe:
        k.fact.bounds = meeting(reached(first.fact.bounds, w, r), reached(c.fact.bounds, w, r));
        k.growth_rate = w;
        break;
    case ir::SeamKind::Tongue:
        k.fact.bounds = reached(first.fact.bounds, first.growth_rate, depth);
        k.growth_rate = first.growth_rate;
        break;
    case ir::SeamKind::Engrave:
    case ir::SeamKind::Groove: // takes away
        k.fact.bounds = first.fact.bounds;
        k.growth_rate = first.growth_rate;
        break;
    }
}

// Within the union; all else unknown.
void exclusive(Derived &k, const Derived &c) {
    unite(k, c);
    k.outer = Box::everything();
    k.outer_growth_rate = 0;
}

// 1 - |((1-a)+, (1-b)+)|_p < 0 needs a or b below 1 - 2^(-1/p) <= 1/2
void pseudo_norm(Derived &k, const Derived &c) {
    const double w = std::max(k.growth_rate, c.growth_rate);
    unite(k, c);
    k.fact.bounds = reached(k.fact.bounds, w, 0.5);
    differ_by(k, infinity);
    k.growth_rate = infinity;
    k.outer = Box::everything();
}

} // namespace

// The next operand's box, gradients and exactness joined to what is known of those before it.
Derived Prover::join_operand(const Shape &shape, Derived k, const Derived &first,
                             const Derived &c) {
    const bool exact_outside = k.fact.exact_outside && c.fact.exact_outside,
               parts_exact = k.parts_exact && c.parts_exact;
    inherit(k, c);
    k.fact.exact_outside = k.parts_exact = false;
    const bool sized = shape.kind == ShapeKind::Blend || shape.kind == ShapeKind::Seam;
    double r = sized ? std::max(number(shape.args[0]).hi, 0.0) : 0;
    if (!std::isfinite(r)) r = 0;
    switch (shape.kind) {
    case ShapeKind::Union:
        unite(k, c);
        k.fact.exact_outside = exact_outside;
        k.parts_exact = parts_exact;
        break;
    case ShapeKind::Intersection:
        meet(k, c);
        k.parts_exact = parts_exact;
        break;
    case ShapeKind::Xor:
        exclusive(k, c);
        k.parts_exact = parts_exact;
        break;
    case ShapeKind::Blend: blend(k, c, r, static_cast<ir::Profile>(shape.payload)); break;
    case ShapeKind::Seam: {
        const auto kind = static_cast<ir::SeamKind>(shape.payload);
        const double depth =
            kind == ir::SeamKind::Tongue ? std::max(number(shape.args[1]).hi, 0.0) : 0;
        seam(k, first, c, r, depth, kind);
        break;
    }
    case ShapeKind::PseudoNorm: pseudo_norm(k, c); break;
    // know() sends no other kind here
    case ShapeKind::Empty:
    case ShapeKind::Leaf:
    case ShapeKind::Complement:
    case ShapeKind::Lerp:
    case ShapeKind::Map:
    case ShapeKind::Offset:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Within:
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Instances:
    case ShapeKind::Library:
    case ShapeKind::Contract: break;
    }
    return k;
}

// The bound of two operands together: the first's so far, and the next's.
Prover::Steepness Prover::join_bounds(const Shape &shape, Steepness so_far, const Derived &c) {
    const double a = so_far.sup, b = c.fact.lipschitz_sup, most = std::max(a, b);
    const bool pipe = shape.kind == ShapeKind::Seam &&
                      static_cast<ir::SeamKind>(shape.payload) == ir::SeamKind::Pipe,
               columns = shape.kind == ShapeKind::Blend &&
                         static_cast<ir::Profile>(shape.payload) == ir::Profile::Columns;
    if (pipe || columns) { // weights on a unit circle: sqrt(La^2 + Lb^2)
        const double excess = std::hypot(a, b) - most;
        const double sup = up(most + excess * options.rules[pipe ? Rule::Pipe : Rule::Columns], 4);
        return {graph.number(sup), sup};
    }
    if (shape.kind == ShapeKind::PseudoNorm) { // Hoelder: (La^p + Lb^p)^(1/p)
        const double p = std::max(number(shape.args[0]).lo, 1.0),
                     both = most * std::pow(std::pow(a / most, p) + std::pow(b / most, p), 1 / p),
                     sup = up(most + (both - most) * options.rules[Rule::PseudoNorm], 16);
        return {graph.number(sup), sup};
    }
    return {graph.make(Op::Max, {so_far.formula, c.fact.lipschitz}), most};
}

Derived Prover::know_set(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const Derived first = of_child(shape);
    Derived k = first;
    Steepness steep{k.fact.lipschitz, k.fact.lipschitz_sup};
    bool pairwise_disjoint = shape.children.size() <= 64,
         all_exact = k.fact.kind == FieldKind::Exact;
    for (std::size_t i = 1; i < shape.children.size(); ++i) {
        const Derived &c = child(shape, i);
        all_exact = all_exact && c.fact.kind == FieldKind::Exact;
        for (std::size_t j = 0; pairwise_disjoint && j < i; ++j)
            pairwise_disjoint = disjoint(child(shape, j).fact.bounds, c.fact.bounds);
        k = join_operand(shape, k, first, c);
        steep = join_bounds(shape, steep, c);
    }
    k.fact.kind = FieldKind::Bound;
    if (shape.children.size() == 1)
        k.fact.kind = first.fact.kind;
    else if (shape.kind == ShapeKind::Union && all_exact && pairwise_disjoint)
        k.fact.kind = FieldKind::Exact;
    for (ShapeId c : shape.children)
        if (of(c).fact.kind == FieldKind::Estimate) k.fact.kind = FieldKind::Estimate;
    if ((shape.kind == ShapeKind::Blend || shape.kind == ShapeKind::Seam) &&
        reads_point(shape.args[0])) {
        // The profile's derivative in r lies in [-1/2, 0] for every profile but Columns (1/4 of the
        // quadratic).
        FieldBound b = bound(id, shape.args[0], "the blend's radius");
        const bool columns = static_cast<ir::Profile>(shape.payload) == ir::Profile::Columns;
        k.failed = k.failed || !std::isfinite(b.lipschitz) || columns;
        steep.sup = up(steep.sup + 0.5 * b.lipschitz * options.rules[Rule::BlendRadius]);
        steep.formula = graph.number(steep.sup);
        forget_moment_arms(k);
        if (shape.kind == ShapeKind::Blend)
            k.fact.bounds = reached(k.fact.bounds, k.growth_rate, b.value.hi);
    }
    if (k.failed)
        fail(k);
    else
        set_lipschitz(k, steep.formula, steep.sup);
    return k;
}

Derived Prover::know_displaced(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = of_child(shape);
    const auto less_region = [&](ShapeId s) {
        return scene.shapes[s].kind == ShapeKind::Within ? scene.shapes[s].children[0] : s;
    };
    if (shape.kind != ShapeKind::Displace && !k.fact.exact_outside && !k.failed &&
        k.fact.kind != FieldKind::Estimate) {
        bool grows = shape.kind == ShapeKind::Shell || number(shape.args[0]).hi > 0;
        if (grows)
            if (Diagnostic *d =
                    report(id, Code::LowerBound,
                           std::string(shape.kind == ShapeKind::Shell ? "a shell" : "an offset") +
                               " of a field that is only a lower bound of the distance"))
                d->note("the field of " + operation_name(scene, less_region(shape.children[0])) +
                        " is not the exact distance near edges; the result there is thinner or "
                        "less round than the number says")
                    .help("apply it to the exact parts first, then combine them");
    }
    bool varies = reads_point(shape.args[0]);
    Interval amount;
    double slope = 0;
    if (varies) {
        if (shape.args.size() >
            3) { // a map: the library states what its uv_map and its data give (ir/uv_maps.h)
            slope = number(shape.args[1]).magnitude();
            amount = hull(number(shape.args[2]), number(shape.args[3]));
        } else {
            FieldBound b =
                bound(id, shape.args[0],
                      shape.kind == ShapeKind::Displace ? "the displacement" : "the amount");
            amount = b.value;
            slope = b.lipschitz;
        }
        k.parts = Box::everything();
        k.fact.moment_arm = {infinity, infinity, infinity};
        k.fact.symmetric = {false, false, false};
        if (!std::isfinite(slope))
            k.failed = true;
        else if (!amount.finite() && !k.failed) {
            if (Diagnostic *d =
                    report(id, Code::NeedsRegion, "the displacement grows without bound"))
                d->help("write `.within(…)` after it, or limit it, as in `clamp(…, -1, 1)`");
            k.failed = true;
        }
    } else {
        amount = number(shape.args[0]);
    }
    bool was_exact = k.fact.kind == FieldKind::Exact;
    if (shape.kind == ShapeKind::Shell) {
        double half = std::max(amount.hi, 0.0) / 2;
        slope /= 2;
        k.fact.bounds = reached(k.fact.bounds, k.growth_rate, half);
        differ_by(k, half);
        k.outer = Box::everything();
        k.outer_growth_rate = 0;
        k.fact.exact_outside = was_exact && !varies;
    } else {
        k.fact.bounds = reached(k.fact.bounds, k.growth_rate, amount.hi);
        k.outer = reached(k.outer, k.outer_growth_rate, -amount.lo);
        differ_by(k, amount.magnitude());
        if (amount.lo < 0) k.lowered = up(k.lowered - amount.lo);
        k.fact.exact_outside = k.fact.exact_outside && !varies;
        // What moves inward only is still below the child's field: the shell begins at the surface
        // itself.
        if (shape.kind == ShapeKind::Displace && !k.failed) {
            k.fact.outward = std::max(amount.hi, 0.0) * (1 + slack) * options.rules[Rule::Shell];
            k.fact.inward = up(std::max(-amount.lo, 0.0) + 1e-5 * amount.magnitude());
        }
    }
    k.parts_exact = false;
    if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
    if (k.failed) {
        fail(k);
        return k;
    }
    slope *= options.rules[Rule::Displace];
    if (shape.kind == ShapeKind::Displace && varies && shape.args.size() <= 3)
        k.fact.partial = partial_sums(id, slope);
    if (slope == 0) {
        set_lipschitz(k, k.fact.lipschitz, k.fact.lipschitz_sup);
        return k;
    }
    const bool by_field = varies && shape.args.size() <= 3 && shape.kind == ShapeKind::Displace &&
                          options.rules[Rule::Displace] == 1;
    const Steepness own =
        by_field ? by_params(id, shape.args[0], slope) : Steepness{graph.number(slope), slope};
    set_lipschitz(k, graph.add(k.fact.lipschitz, own.formula), up(k.fact.lipschitz_sup + own.sup));
    return k;
}

Derived Prover::know_extrude(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = of_child(shape);
    double half = number(shape.args[0]).magnitude() / 2;
    auto stand = [&](Box &box) {
        if (!box.empty()) box.lo[2] = -half, box.hi[2] = half;
    };
    // length((f)+, (|z| - h)+) + min(max(f, |z| - h), 0): the weights of the two gradients, which
    // are at right angles, lie on a unit circle: max(L, 1).
    double moment_arm = k.fact.moment_arm[2];
    stand(k.fact.bounds);
    // The solid's nearest point is that of the flat shape as it is, not of the part that makes the
    // gradient: they differ by the offset_slack, along that gradient.
    k.parts = reached(k.parts, 1, k.offset_slack);
    k.offset_slack = 0;
    k.mean_slack = k.parts_exact ? 0 : infinity;
    stand(k.parts);
    k.fact.symmetric[2] = true;
    for (int a = 0; a < 2; ++a)
        k.fact.moment_arm[static_cast<std::size_t>(a)] = radius_about(k.parts, a);
    k.fact.moment_arm[2] = std::min(moment_arm, radius_about(k.parts, 2));
    k.outer = Box::everything();
    k.outer_growth_rate = 0;
    if (k.failed) {
        fail(k);
        return k;
    }
    NodeId formula = graph.make(Op::Max, {k.fact.lipschitz, graph.number(1)});
    set_lipschitz(k, formula, std::max(k.fact.lipschitz_sup, 1.0));
    return k;
}

Derived Prover::know_instances(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::InstanceTable instance_table = scene.shapes.instance_tables[shape.payload];
    Derived k = of_child(shape);
    if (instance_table.count > 1) {
        k.fact.kind = k.fact.kind == FieldKind::Estimate ? FieldKind::Estimate : FieldKind::Bound;
        bool plain = !instance_table.smooth;
        k.fact.exact_outside = k.fact.exact_outside && plain;
        k.parts_exact = k.parts_exact && plain;
        // By induction over the fold: {acc < t} lies in the copies' box grown by growth_rate*(t + k).
        if (instance_table.smooth) {
            const double smooth = std::max(number(shape.args[0]).hi, 0.0);
            k.fact.bounds = reached(k.fact.bounds, k.growth_rate, smooth);
            differ_by(k, 2 * smooth * instance_table.count);
        }
    }
    // Symmetric copies need not be a symmetric whole.
    k.fact.symmetric = {false, false, false};
    if (k.failed)
        fail(k);
    else
        set_lipschitz(k, k.fact.lipschitz, k.fact.lipschitz_sup);
    return k;
}

} // namespace fathom::proof
