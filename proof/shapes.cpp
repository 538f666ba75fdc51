// The rules of the kinds that combine, displace, repeat as a instance_table, or claim. Proofs:
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

ProofStatus worse(ProofStatus a, ProofStatus b) { return std::max(a, b); }

// Of a min of fields: {min < t} is in the hull of the children's; {min > -t} in the meet of theirs.
void unite(Derived &k, const Derived &c) {
    k.fact.bounds = ir::hull(k.fact.bounds, c.fact.bounds);
    k.growth_rate = std::max(k.growth_rate, c.growth_rate);
    k.outer_growth_rate = std::max(k.outer_growth_rate, c.outer_growth_rate);
    k.outer = meeting(k.outer, c.outer);
}
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
// What every combination of two inherits: the attributes of the gradients.
void inherit(Derived &k, const Derived &c) {
    k.failed = k.failed || c.failed;
    k.fact.status = worse(k.fact.status, c.fact.status);
    k.parts = ir::hull(k.parts, c.parts);
    k.offset_slack = std::max(k.offset_slack, c.offset_slack);
    k.lowered = std::max(k.lowered, c.lowered);
    for (std::size_t a = 0; a < 3; ++a) {
        k.fact.symmetric[a] = k.fact.symmetric[a] && c.fact.symmetric[a];
        k.fact.moment_arm[a] = std::max(k.fact.moment_arm[a], c.fact.moment_arm[a]);
    }
}

} // namespace

Derived Prover::know_set(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = child(shape);
    k.fact.repeat = {};
    k.fact.guard = false;
    auto profile = static_cast<ir::Profile>(shape.payload);
    auto seam = static_cast<ir::SeamKind>(shape.payload);
    Interval radius = shape.args.empty() ? Interval(0.0) : number(shape.args[0]);
    double r = std::max(radius.hi, 0.0);
    if (!std::isfinite(r) && (shape.kind == ShapeKind::Blend || shape.kind == ShapeKind::Seam))
        r = 0;

    NodeId formula = k.fact.lipschitz;
    double sup = k.fact.lipschitz_sup;
    bool pairwise_disjoint = shape.children.size() <= 64,
         all_exact = k.fact.kind == FieldKind::Exact;
    const Derived first = k;
    for (std::size_t i = 1; i < shape.children.size(); ++i) {
        const Derived &c = child(shape, i);
        bool exact_outside = k.exact_outside && c.exact_outside,
             parts_exact = k.parts_exact && c.parts_exact;
        all_exact = all_exact && c.fact.kind == FieldKind::Exact;
        for (std::size_t j = 0; pairwise_disjoint && j < i; ++j)
            pairwise_disjoint = disjoint(child(shape, j).fact.bounds, c.fact.bounds);
        inherit(k, c);
        k.exact_outside = k.parts_exact = false;
        double w = std::max(k.growth_rate, c.growth_rate);
        switch (shape.kind) {
        case ShapeKind::Union:
            unite(k, c);
            k.exact_outside = exact_outside;
            k.parts_exact = parts_exact;
            break;
        case ShapeKind::Intersection:
            meet(k, c);
            k.parts_exact = parts_exact;
            break;
        case ShapeKind::Xor: // within the union; all else unknown
            unite(k, c);
            k.outer = Box::everything();
            k.outer_growth_rate = 0;
            k.parts_exact = parts_exact;
            break;
        case ShapeKind::Blend: {
            // The part that the profile adds lies where both are below r (blends.h).
            const Box both =
                ir::intersect(reached(k.fact.bounds, w, r), reached(c.fact.bounds, w, r));
            // Further out: where both are below t + r. If that is nowhere for t = 0, as the boxes
            // are `gap` > 2wr apart, it is from 2w(t + r) = gap on, where w(t + r) is at most wt *
            // gap/(gap - 2wr).
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
            k.offset_slack =
                up(k.offset_slack + 2 * r); // a part decides only where it is within r of the least
            if (profile == ir::Profile::Columns) { // not a function of the difference alone
                k.fact.bounds = reached(k.fact.bounds, w, r);
                k.growth_rate = infinity;
                k.outer = Box::everything();
            }
            break;
        }
        case ShapeKind::Seam: {
            k.outer = Box::everything(), k.outer_growth_rate = 0;
            k.offset_slack = infinity;
            if (seam == ir::SeamKind::Pipe) {
                k.fact.bounds =
                    meeting(reached(first.fact.bounds, w, r), reached(c.fact.bounds, w, r));
                k.growth_rate = w;
            } else if (seam == ir::SeamKind::Tongue) {
                double depth = std::max(number(shape.args[1]).hi, 0.0);
                k.fact.bounds = reached(first.fact.bounds, first.growth_rate, depth);
                k.growth_rate = first.growth_rate;
            } else {
                k.fact.bounds = first.fact.bounds; // takes away
                k.growth_rate = first.growth_rate;
            }
            break;
        }
        case ShapeKind::PseudoNorm: // 1 - |((1-a)+, (1-b)+)|_p < 0 needs a or b below 1 - 2^(-1/p)
                                    // <= 1/2
            unite(k, c);
            k.fact.bounds = reached(k.fact.bounds, w, 0.5);
            k.offset_slack = infinity;
            k.growth_rate = infinity;
            k.outer = Box::everything();
            break;
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
        bool quadratic = (shape.kind == ShapeKind::Blend && profile == ir::Profile::Columns) ||
                         (shape.kind == ShapeKind::Seam && seam == ir::SeamKind::Pipe);
        if (quadratic) { // weights on a unit circle: sqrt(La^2 + Lb^2)
            double excess =
                std::hypot(sup, c.fact.lipschitz_sup) - std::max(sup, c.fact.lipschitz_sup);
            sup = up(
                std::max(sup, c.fact.lipschitz_sup) +
                    excess *
                        options.rules[shape.kind == ShapeKind::Seam ? Rule::Pipe : Rule::Columns],
                4);
            formula = graph.number(sup);
        } else if (shape.kind == ShapeKind::PseudoNorm) { // Hoelder: (La^p + Lb^p)^(1/p)
            double p = std::max(number(shape.args[0]).lo, 1.0), a = sup, b = c.fact.lipschitz_sup;
            double most = std::max(a, b),
                   both = most * std::pow(std::pow(a / most, p) + std::pow(b / most, p), 1 / p);
            sup = up(most + (both - most) * options.rules[Rule::PseudoNorm], 16);
            formula = graph.number(sup);
        } else {
            sup = std::max(sup, c.fact.lipschitz_sup);
            formula = graph.make(Op::Max, {formula, c.fact.lipschitz});
        }
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
        k.failed = k.failed || !std::isfinite(b.lipschitz) || profile == ir::Profile::Columns;
        sup = up(sup + 0.5 * b.lipschitz * options.rules[Rule::BlendRadius]);
        formula = graph.number(sup);
        k.fact.moment_arm = {infinity, infinity, infinity};
        k.parts = Box::everything();
        if (shape.kind == ShapeKind::Blend)
            k.fact.bounds = reached(k.fact.bounds, k.growth_rate, b.value.hi);
    }
    if (k.failed)
        fail(k);
    else
        set_lipschitz(k, formula, sup);
    return k;
}

// Where a weight clamp(length(p - c), a, b) varies (thesis 2.14): its gradient is 0 beyond b of c.
static Box varying_part(const ir::Graph &graph, NodeId weight) {
    if (graph[weight].op != ir::Op::Clamp) return Box::everything();
    NodeId length = graph.arg(weight, 0);
    auto reach = graph.as_number(graph.arg(weight, 2));
    if (graph[length].op != ir::Op::Length || !reach) return Box::everything();
    NodeId from = graph.arg(length, 0);
    Box box{{-*reach, -*reach, -*reach}, {*reach, *reach, *reach}};
    if (graph[from].op == ir::Op::Point) return box;
    const bool moved = graph[from].op == ir::Op::Sub || graph[from].op == ir::Op::Add;
    for (int i = 0; moved && i < 2; ++i) {
        NodeId point = graph.arg(from, i), by = graph.arg(from, 1 - i);
        if (graph[point].op != ir::Op::Point || !graph.is_constant(by)) continue;
        const bool less = graph[from].op == ir::Op::Sub; // p - c and c - p alike
        for (std::size_t k = 0; k < 3; ++k) {
            double c = graph.constant_of(by).value[k] * (less ? 1 : -1);
            box.lo[k] += c, box.hi[k] += c;
        }
        return box;
    }
    return Box::everything();
}

Derived Prover::know_lerp(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const Derived &a = child(shape, 0), &b = child(shape, 1);
    Derived k = a;
    k.fact.repeat = {};
    k.fact.guard = false;
    inherit(k, b);
    k.fact.kind = FieldKind::Bound;
    k.exact_outside = k.parts_exact = false;
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
    // t*a + (1-t)*b < 0 needs a < 0 or b < 0 while both weights are at least 0.
    unite(k, b);
    if (!convex) {
        k.fact.bounds = k.outer = Box::everything();
        k.parts = Box::everything();
        k.fact.moment_arm = {infinity, infinity, infinity};
    }
    if (varies && std::isfinite(weight.lipschitz) && weight.lipschitz > 0) {
        // |grad| <= the mean's + |grad t| * |a - b|. For exact a and b of solids A and B the
        // difference is greatest inside one of them: outside both, |a - b| is at most their
        // Hausdorff distance, which is a difference at a point of A or B.
        double gap = infinity;
        Box common = ir::hull(a.fact.bounds, b.fact.bounds);
        if (a.exact_outside && b.exact_outside && common.finite() && !common.empty()) {
            double diagonal = 0; // of the box that holds both: outside both fields lie in [d, d +
                                 // D], inside above -D/2
            for (std::size_t i = 0; i < 3; ++i)
                diagonal += std::pow(common.hi[i] - common.lo[i], 2);
            gap = up(1.5 * std::sqrt(diagonal) + a.lowered + b.lowered, 4);
            auto f = expression(shape.children[0]), g = expression(shape.children[1]);
            if (f && g) {
                Budget budget;
                budget.instructions = options.field_instructions / 4;
                gap = std::min(gap, bound_magnitude(flattening, ranges, graph.sub(*f, *g),
                                                    {to_cell(common), nullptr}, budget));
            }
        }
        Box box = ir::intersect(place(id).box, varying_part(graph, t));
        if (box.finite() && !box.empty())
            gap = std::min(
                gap, up(magnitude(shape.children[0], box) + magnitude(shape.children[1], box)));
        k.fact.moment_arm = {infinity, infinity, infinity};
        k.parts = Box::everything();
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

Derived Prover::know_displaced(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = child(shape);
    k.fact.repeat = {};
    k.fact.guard = false;
    if (shape.kind != ShapeKind::Displace && !k.exact_outside && !k.failed &&
        k.fact.kind != FieldKind::Estimate) {
        bool grows = shape.kind == ShapeKind::Shell || number(shape.args[0]).hi > 0;
        if (grows)
            if (Diagnostic *d =
                    report(id, Code::LowerBound,
                           std::string(shape.kind == ShapeKind::Shell ? "a shell" : "an offset") +
                               " of a field that is only a lower bound of the distance"))
                d->note("the field of " + operation_name(scene, shape.children[0]) +
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
        k.offset_slack = up(k.offset_slack + half);
        k.outer = Box::everything();
        k.outer_growth_rate = 0;
        k.exact_outside = was_exact && !varies;
    } else {
        k.fact.bounds = reached(k.fact.bounds, k.growth_rate, amount.hi);
        k.outer = reached(k.outer, k.outer_growth_rate, -amount.lo);
        k.offset_slack = up(k.offset_slack + amount.magnitude());
        k.lowered = up(k.lowered + std::max(-amount.lo, 0.0));
        k.exact_outside = k.exact_outside && !varies;
        // What moves inward only is still below the child's field: the shell begins at the surface
        // itself.
        if (shape.kind == ShapeKind::Displace && !k.failed) {
            outward = std::max(amount.hi, 0.0) * (1 + slack) * options.rules[Rule::Shell];
            inward = up(std::max(-amount.lo, 0.0) + 1e-5 * amount.magnitude());
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
        partial = partial_sums(id, slope);
    double sup = up(k.fact.lipschitz_sup + slope);
    set_lipschitz(
        k, slope == 0 ? k.fact.lipschitz : graph.add(k.fact.lipschitz, graph.number(slope)), sup);
    return k;
}

Derived Prover::know_extrude(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = child(shape);
    k.fact.repeat = {};
    k.fact.guard = false;
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
    Derived k = child(shape);
    k.fact.repeat = {};
    if (instance_table.count > 1) {
        k.fact.kind = k.fact.kind == FieldKind::Estimate ? FieldKind::Estimate : FieldKind::Bound;
        bool plain = !instance_table.smooth;
        k.exact_outside = k.exact_outside && plain;
        k.parts_exact = k.parts_exact && plain;
        // By induction over the fold: {acc < t} lies in the copies' box grown by growth_rate*(t + k).
        if (instance_table.smooth) {
            const double smooth = std::max(number(shape.args[0]).hi, 0.0);
            k.fact.bounds = reached(k.fact.bounds, k.growth_rate, smooth);
            k.offset_slack = up(k.offset_slack + 2 * smooth * instance_table.count);
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

Derived Prover::know_library(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::Library library = scene.shapes.libraries[shape.payload];
    Derived k = child(shape);
    k.fact.repeat = {};
    if (!library.has_claims) return k;
    const ir::Claims &claims = library.claims;
    bool exact = claims.kind == FieldKind::Exact;
    if (claims.lo && claims.hi) {
        Vec lo = vector(claims.lo), hi = vector(claims.hi);
        Box box;
        for (std::size_t i = 0; i < 3; ++i) {
            bool flat = shape.dims == 2 && i == 2;
            box.lo[i] = flat ? 0 : lo[i].lo;
            box.hi[i] = flat ? 0 : hi[i].hi;
        }
        k.fact.bounds = box;
        k.growth_rate = exact                ? 1
                        : claims.growth_rate ? number(claims.growth_rate).magnitude()
                                             : infinity;
        k.outer = Box::everything();
        k.outer_growth_rate = 0;
    }
    if (claims.kind == FieldKind::Estimate)
        k.fact.kind = FieldKind::Estimate;
    else if (exact)
        k.fact.kind = FieldKind::Exact;
    else if (k.fact.kind != FieldKind::Exact || claims.lipschitz)
        k.fact.kind = FieldKind::Bound;
    for (std::size_t a = 0; a < 3; ++a)
        k.fact.symmetric[a] = k.fact.symmetric[a] || claims.symmetric[a];
    if (exact) {
        k.exact_outside = k.parts_exact = true;
        k.parts = k.fact.bounds;
        if (claims.lo && claims.hi) k.growth_rate = 1;
        for (int a = 0; a < 3; ++a)
            k.fact.moment_arm[static_cast<std::size_t>(a)] = radius_about(k.parts, a);
    } else if (claims.lipschitz) {
        k.exact_outside = k.parts_exact = false;
        k.parts = Box::everything();
        k.fact.moment_arm = {infinity, infinity, infinity};
    }
    for (std::size_t a = 0; a < 3; ++a)
        if (claims.moment_arm[a]) {
            double moment_arm = number(claims.moment_arm[a]).magnitude();
            k.fact.moment_arm[a] = std::min(k.fact.moment_arm[a], moment_arm);
        }
    if (claims.lipschitz || exact) {
        k.failed = false;
        k.fact.status =
            claims.kind == FieldKind::Estimate ? ProofStatus::Estimated : ProofStatus::Proved;
        if (exact)
            set_lipschitz(k, 1);
        else
            set_lipschitz(k, claims.lipschitz, number(claims.lipschitz).magnitude());
    }
    if (claims.kind == FieldKind::Estimate) {
        k.fact.status = ProofStatus::Estimated;
    }
    return k;
}

Derived Prover::know_contract(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::Contract contract = scene.shapes.contracts[shape.payload];
    Derived k = child(shape);
    k.fact.repeat = {};
    if (!k.failed && k.fact.lipschitz_sup > contract.lipschitz * (1 + slack)) {
        if (Diagnostic *d =
                report(id, Code::LipschitzContract,
                       "this shape's bound is " + number_text(k.fact.lipschitz_sup) +
                           ", and `shape<" + number_text(contract.lipschitz) + ">` is wanted")) {
            if (contract.demanded.source) d->label(contract.demanded, "demanded here");
            for (const std::string &line : chain(shape.children[0])) d->note(line);
        }
    }
    return k;
}

} // namespace fathom::proof
