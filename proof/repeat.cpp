// Repetition: how many copies have to be evaluated so that the least of them bounds the distance to
// all, continuously. Proofs: docs/lipschitz.md, 7.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::FieldKind;
using ir::Shape;
using ir::ShapeId;
using ir::rounding::infinity;
using ir::rounding::up;

namespace {

constexpr int max_per_axis = 9, max_copies = 128;

// Of like copies at j*cell, those that can hold the nearest point when the evaluator is at x (own
// cell: |x| <= cell/2): a point s of the motif, lo <= s <= hi, is nearest in the copy with |x - s -
// j*cell| <= cell/2.
void copies_that_matter(double lo, double hi, double cell, double &least, double &most) {
    least = std::ceil((-cell / 2 - hi) / cell - 0.5 + 1e-9);
    most = std::floor((cell / 2 - lo) / cell + 0.5 - 1e-9);
}

} // namespace

// How many copies are evaluated, and why that may not do.
struct Prover::Copies {
    ir::RepeatPlan plan;
    double product = 1;     // copies in all
    bool unbounded = false; // the motif has no bounds along an axis of the lattice
    bool too_many = false;
};

// Copies about an axis; writes the bounds, symmetry and moment arms of them all to `k`.
Prover::Copies Prover::ring_copies(const Shape &shape, const ir::Repetition &repetition,
                                   const Derived &motif, Derived &k) {
    Copies copies;
    copies.plan.copy = motif.fact.bounds;
    const Box &box = motif.fact.bounds;
    const bool differ = static_cast<bool>(repetition.id), exact = motif.fact.exact_outside;
    int n = int(std::max(number(shape.args[0]).hi, 1.0));
    auto a = static_cast<std::size_t>(repetition.axis);
    // The first copy's direction, and what lies across: of y they are x and z; of x, y and z;
    // of z, x and y.
    std::size_t u = repetition.axis == 0 ? 1 : 0, v = repetition.axis == 2 ? 1 : 2;
    double half = 3.141592653589793 / n;
    bool fits = box.empty() || n == 1;
    double reach = 3.141592653589793; // the largest angle of a point of the motif
    if (!box.empty() && box.lo[u] > 0) {
        double across = std::max(std::fabs(box.lo[v]), std::fabs(box.hi[v]));
        reach = std::atan2(across, box.lo[u]);
        fits = reach <= half;
    }
    bool mirrored = motif.fact.symmetric[v];
    int need;
    if (n == 1)
        need = 1;
    else if (fits && mirrored && !differ)
        need = 1;
    else if (fits && !differ && exact)
        need = 2;
    else {
        // The copies within half a turn's share of any point of the motif; copies that differ,
        // or whose fields are only bounds, take one more on each side and the guard.
        int more = int(std::ceil((reach + half) / (2 * half) - 0.5 - 1e-9));
        need = 2 * std::max(more, 1) + 1;
        copies.plan.guard = differ || !exact;
        if (need >= n) {
            need = n;
            copies.plan.guard = false;
        }
    }
    if (need > 1) need = std::max(1, int(need * options.rules[Rule::Sectors]));
    if (need > max_copies) copies.too_many = true;
    copies.plan.neighbors[0] = std::min(need, n);
    copies.product = copies.plan.neighbors[0];
    double r = radius_about(box, repetition.axis);
    if (!box.empty())
        for (std::size_t i = 0; i < 3; ++i)
            if (i != a && !(shape.dims == 2 && i == 2))
                k.fact.bounds.lo[i] = -r, k.fact.bounds.hi[i] = r;
    k.growth_rate *= std::sqrt(2.0);
    for (std::size_t i = 0; i < 3; ++i)
        if (i != a) k.fact.symmetric[i] = false;
    // Even counts of mirror images: a motif symmetric across its own plane makes a whole that
    // is, too.
    if (mirrored && !differ) k.fact.symmetric[v] = true;
    if (n % 2 == 0 && mirrored && !differ) k.fact.symmetric[u] = true;
    k.parts_exact = motif.parts_exact;
    if (exact && motif.parts_exact && !box.empty()) {
        k.parts = k.fact.bounds;
        for (int i = 0; i < 3; ++i)
            k.fact.moment_arm[static_cast<std::size_t>(i)] = radius_about(k.parts, i);
        k.fact.moment_arm[a] =
            std::min(k.fact.moment_arm[a],
                     motif.fact.moment_arm[a]); // each copy is turned about that axis
    }
    return copies;
}

// Copies along the axes; as above.
Prover::Copies Prover::lattice_copies(const Shape &shape, const ir::Repetition &repetition,
                                      const Derived &motif, Derived &k) {
    Copies copies;
    copies.plan.copy = motif.fact.bounds;
    const Box &box = motif.fact.bounds;
    const bool differ = static_cast<bool>(repetition.id), exact = motif.fact.exact_outside;
    Vec cells = vector(shape.args[0]), counts = vector(shape.args[1]);
    for (std::size_t a = 0; a < 3; ++a) {
        if (!repetition.along[a] || box.empty()) {
            if (repetition.along[a]) copies.plan.neighbors[a] = 1;
            continue;
        }
        double cell = std::max(cells[a].lo, 0.0), lo = box.lo[a], hi = box.hi[a];
        if (!std::isfinite(lo) || !std::isfinite(hi)) {
            copies.unbounded = true;
            copies.plan.neighbors[a] = 1;
            continue;
        }
        if (!(cell > 0)) {
            copies.too_many = true;
            continue;
        }
        // What reaches further out has to be seen from beyond the wall.
        bool fits = lo >= -cell / 2 * (1 + slack) && hi <= cell / 2 * (1 + slack);
        double least, most;
        if (repetition.mirrored) {
            double reach = std::max(-lo, hi);
            copies_that_matter(-reach, reach, cell, least, most);
        } else {
            copies_that_matter(lo, hi, cell, least, most);
        }
        int need;
        if (fits && !differ && (repetition.mirrored || motif.fact.symmetric[a]))
            need = 1;
        else if (fits && !differ && exact)
            need = 2;
        else if (fits) {
            need = 2;
            copies.plan.guard = true;
        } else {
            double away = std::max(-least, most);
            if (differ || !exact || repetition.mirrored) {
                // The guard must not press on the own cell: what is left out keeps half a cell
                // away.
                away = std::max(away, std::ceil(std::max(-lo, hi) / cell));
                copies.plan.guard = true;
            }
            if (away > 64) away = 64;
            need = 2 * int(std::max(away, 1.0)) + 1;
        }
        need = std::max(
            1, int(std::lround(need * (need > 1 ? options.rules[Rule::RepeatNeighbors] : 1))));
        if (counts[a].hi < 1e8) need = std::min(need, int(std::max(2 * counts[a].hi - 1, 1.0)));
        if (need > max_per_axis) copies.too_many = true;
        copies.plan.neighbors[a] = need;
        copies.product *= need;
        // Which copies are evaluated changes in the middle between two; the guard is continuous
        // there if the boxes lie evenly about their cells' middles.
        copies.plan.copy.hi[a] = std::max(-lo, hi);
        copies.plan.copy.lo[a] = -copies.plan.copy.hi[a];
        bool endless = counts[a].hi >= 1e8;
        double extent = endless ? infinity : up((counts[a].hi - 1) / 2 * cells[a].hi);
        if (repetition.mirrored) {
            double reach = std::max(-lo, hi);
            k.fact.bounds.lo[a] = -reach - extent, k.fact.bounds.hi[a] = reach + extent;
        } else {
            k.fact.bounds.lo[a] = lo - extent, k.fact.bounds.hi[a] = hi + extent;
        }
    }
    if (exact && motif.parts_exact) k.parts = k.fact.bounds;
    for (int i = 0; i < 3; ++i)
        k.fact.moment_arm[static_cast<std::size_t>(i)] = radius_about(k.parts, i);
    for (std::size_t a = 0; a < 3; ++a) k.fact.symmetric[a] = motif.fact.symmetric[a] && !differ;
    return copies;
}

// Where the copies are many along one axis, as of a long rod, and a few along the others: how to have
// these alone.
static std::string cells_across(const ir::Repetition &repetition, const Vec &cells,
                                const std::array<int, 3> &copies) {
    constexpr int few = 3;
    std::string written;
    bool long_one = false, others = false;
    for (std::size_t a = 0; a < 3 && !repetition.polar; ++a) {
        const bool kept = repetition.along[a] && copies[a] <= few;
        others = others || kept;
        long_one = long_one || (repetition.along[a] && !kept);
        if (kept && cells[a].lo != cells[a].hi) return {};
        written += (a > 0 ? ", " : "") + (kept ? number_text(cells[a].lo) : "0");
    }
    if (!long_one || !others) return {};
    return "; `.repeat([" + written +
           "])` has copies along those axes alone that it is short along";
}

Derived Prover::know_repeat(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const ir::Repetition repetition = scene.shapes.repetitions[shape.payload];
    const Derived &motif = child(shape);
    Derived k = of_child(shape);
    k.outer = Box::everything(), k.outer_growth_rate = 0;
    k.parts = Box::everything();
    k.fact.moment_arm = {infinity, infinity, infinity};
    const bool differ = static_cast<bool>(repetition.id), exact = motif.fact.exact_outside;
    const Copies copies = repetition.polar ? ring_copies(shape, repetition, motif, k)
                                           : lattice_copies(shape, repetition, motif, k);
    ir::RepeatPlan plan = copies.plan;
    if (copies.unbounded) {
        if (Diagnostic *d = report(id, Code::NeedsRegion,
                                   "a repetition of " + operation_name(scene, shape.children[0]) +
                                       ", which has no bounds along the repeated axis"))
            d->help("cut it with `& box(…)` or `.within(…)` first, so that each copy has an end");
        k.failed = true;
    }
    if ((copies.too_many || copies.product > max_copies) && !k.failed) {
        if (Diagnostic *d = report(
                id, Code::RepeatLimit,
                "the repeated shape reaches over too many cells: " + number_text(copies.product) +
                    " copies would have to be evaluated at every point"))
            d->help("make the cell larger or the shape smaller" +
                    cells_across(repetition, vector(shape.args[0]), plan.neighbors));
        k.failed = true;
        for (int &n : plan.neighbors) n = std::min(n, 3);
    }
    if (k.fact.kind == FieldKind::Exact) {
        bool alone = true; // copies apart keep the inside exact as well
        for (std::size_t a = 0; a < 3; ++a) alone = alone && plan.neighbors[a] <= 2;
        if (!alone || differ || repetition.polar) k.fact.kind = FieldKind::Bound;
    }
    if (plan.guard) {
        k.fact.kind = k.fact.kind == FieldKind::Estimate ? FieldKind::Estimate : FieldKind::Bound;
        k.fact.exact_outside = k.parts_exact = false;
        k.parts = Box::everything();
        k.fact.moment_arm = {infinity, infinity, infinity};
        k.growth_rate = infinity; // the guard may be less than the field
    }
    plan.hold = plan.guard && !exact;
    k.fact.repeat = plan;
    if (k.failed)
        fail(k);
    else if (plan.guard) // the guard is a distance
        set_lipschitz(k, graph.make(ir::Op::Max, {k.fact.lipschitz, graph.number(1)}),
                      std::max(k.fact.lipschitz_sup, 1.0));
    return k;
}

} // namespace fathom::proof
