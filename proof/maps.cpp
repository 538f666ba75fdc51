// The rules for maps that keep or only scale lengths: rigid motions, scales, folds, revolutions.
// deformations.cpp has the others.
// Proofs: docs/lipschitz.md, 5.
#include "ir/maps.h"
#include "proof/continuity.h"
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

void cap_moment_arms(Derived &k) {
    for (int a = 0; a < 3; ++a) {
        double &moment_arm = k.fact.moment_arm[static_cast<std::size_t>(a)];
        moment_arm = std::min(moment_arm, radius_about(k.parts, a));
    }
}

// More than trigonometry leaves of 0, and far less of a length than single precision keeps.
constexpr double dust = 1e-12;

// The sizes of a rotation's numbers, by row: how much of each axis the new ones can have.
using Sizes = std::array<std::array<double, 3>, 3>;
Sizes sizes_of(const std::array<Interval, 16> &matrix, std::size_t n) { // column-major
    Sizes out{};
    for (std::size_t to = 0; to < n; ++to)
        for (std::size_t from = 0; from < n; ++from) {
            const double size = matrix[from * n + to].magnitude();
            out[to][from] = size <= dust ? 0 : std::min(size, 1.0);
        }
    return out;
}

// How much larger than a cube the box around the turned cube is, at most: 1 where axes are only
// renamed.
double around_turned_cube(const Sizes &sizes, std::size_t n) {
    double most = 1;
    for (const auto &row : sizes) {
        int parts = 0;
        for (double size : row) parts += size != 0;
        if (parts > 1) most = std::max(most, up(row[0] + row[1] + row[2], 4));
    }
    return std::min(most, up(std::sqrt(double(n))));
}

} // namespace

Derived Prover::know_translate(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const bool flat = shape.dims == 2;
    Vec by = vector(shape.args[2]);
    if (flat) by[2] = 0.0;
    k.fact.bounds = moved(k.fact.bounds, by);
    k.fact.bounded = moved(k.fact.bounded, by);
    k.outer = moved(k.outer, by);
    k.parts = moved(k.parts, by);
    for (int a = 0; a < 3; ++a) {
        auto i = static_cast<std::size_t>(a);
        double across = 0;
        for (int b = 0; b < 3; ++b)
            if (b != a) across = std::hypot(across, by[static_cast<std::size_t>(b)].magnitude());
        k.fact.moment_arm[i] = up(k.fact.moment_arm[i] + across, 4); // p x g = q x g + v x g
        k.fact.symmetric[i] = k.fact.symmetric[i] && by[i] == Interval(0.0);
    }
    cap_moment_arms(k);
    return k;
}

Derived Prover::know_rotate(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const bool flat = shape.dims == 2;
    auto matrix = numbers(shape.args[2]);
    int side = flat ? 2 : 3;
    k.fact.bounds = turned(k.fact.bounds, matrix, side);
    k.fact.bounded = turned(k.fact.bounded, matrix, side);
    k.outer = everywhere(k.outer) ? k.outer : turned(k.outer, matrix, side);
    k.parts = everywhere(k.parts) ? k.parts : turned(k.parts, matrix, side);
    auto n = static_cast<std::size_t>(side);
    const Sizes sizes = sizes_of(matrix, n);
    // A box grown by t is, turned, in its turned box grown by more; but of an exact distance {f <
    // t} is the solid grown by a ball.
    const double swells = around_turned_cube(sizes, n);
    const auto swell = [&](double &rate, bool exact) {
        if (swells > 1 && rate > 0) rate = exact ? std::min(rate, 1.0) : up(rate * swells);
    };
    swell(k.growth_rate, k.fact.exact_outside);
    swell(k.outer_growth_rate, k.fact.kind == FieldKind::Exact);
    std::array<double, 3> moment_arm{infinity, infinity, infinity};
    std::array<bool, 3> symmetric{};
    if (flat) { // about z: the moment arm about z stays
        moment_arm[2] = k.fact.moment_arm[2];
        symmetric[2] = k.fact.symmetric[2];
    }
    for (std::size_t to = 0; to < n; ++to)
        for (std::size_t from = 0; from < n; ++from) {
            // Alone in its row, it is +-1: that axis is only renamed, for all params. Near 1 is not
            // enough, as 1 - t^2/2 is for a turn by t.
            const bool axis = sizes[to][(from + 1) % 3] == 0 && sizes[to][(from + 2) % 3] == 0;
            if (!axis) continue;
            if (side == 3) moment_arm[to] = up(k.fact.moment_arm[from], 4);
            symmetric[to] = k.fact.symmetric[from];
        }
    k.fact.moment_arm = moment_arm;
    k.fact.symmetric = symmetric;
    cap_moment_arms(k);
    return k;
}

Derived Prover::know_scale(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    const bool flat = shape.dims == 2;
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
    if (k.lowered > 0) k.lowered = up(k.lowered * most);
    if (k.short_by > 0) k.short_by = up(k.short_by * most);
    k.fact.bounds = times(k.fact.bounds, by);
    k.fact.bounded = times(k.fact.bounded, by);
    k.outer = everywhere(k.outer) ? k.outer : times(k.outer, by);
    if (uniform) {
        k.parts = everywhere(k.parts) ? k.parts : times(k.parts, by);
        for (double &moment_arm : k.fact.moment_arm) moment_arm = up(moment_arm * most);
        k.offset_slack = up(k.offset_slack * most);
        k.mean_slack = up(k.mean_slack * most);
    } else {
        // min|s| * |J^T g| <= min|s| / min|s| * L: the factor takes back what the map adds. Not
        // exact any more, and gradients no longer point from nearest points.
        if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
        k.fact.exact_outside = k.parts_exact = false;
        forget_moment_arms(k);
        double ratio = least > 0 ? most / least : infinity;
        k.growth_rate = up(k.growth_rate * ratio),
        k.outer_growth_rate = up(k.outer_growth_rate * ratio);
    }
    return k;
}

Derived Prover::know_fold(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
    // What lies within the fold's image may have copies: the preimage of the box.
    Box preimage = fold_preimage(shape.args[0], k.fact.bounds);
    k.fact.bounds = preimage;
    // What a gradient points away from may lie behind the mirror, too, and of an elongation's
    // gradient in its flat part a mean of a part's and the mirrored part's is left.
    const int n = ir::components(graph[shape.args[0]].type);
    for (int i = 0; i < n && !k.parts.empty(); ++i) {
        const auto a = static_cast<std::size_t>(i);
        const NodeId c = in_one_form(graph, component_of(graph, shape.args[0], i));
        if (c == graph.component(graph.point(graph[shape.args[0]].type), i)) continue;
        const double r = Interval(k.parts.lo[a], k.parts.hi[a]).magnitude();
        k.parts.lo[a] = -r, k.parts.hi[a] = r;
    }
    k.parts = fold_preimage(shape.args[0], k.parts);
    k.outer = everywhere(k.outer) ? k.outer : Box::everything();
    if (k.fact.kind == FieldKind::Exact) k.fact.kind = FieldKind::Bound;
    // A fold that adds nothing behind its mirrors leaves the distance outside exact; whether
    // the shape lies on one side is known where its box does.
    k.parts_exact = false;
    const auto flat = fold_is_clean(shape.args[0], child(shape).fact.bounds);
    k.fact.exact_outside = k.fact.exact_outside && flat;
    if (flat && *flat > 0) k.short_by = up(k.short_by + *flat);
    k.fact.symmetric = fold_symmetry(shape.args[0], k.fact.symmetric);
    k.fact.moment_arm = {infinity, infinity, infinity};
    cap_moment_arms(k);
    k.growth_rate *= std::sqrt(3.0);
    return k;
}

Derived Prover::know_revolve(ShapeId id, Derived k) {
    const Shape shape = scene.shapes[id];
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
        k.fact.exact_outside = k.parts_exact = false;
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
    return k;
}

Derived Prover::know_map(ShapeId id) {
    const Shape shape = scene.shapes[id];
    Derived k = of_child(shape);
    switch (shape.map) {
    case MapKind::Translate: k = know_translate(id, k); break;
    case MapKind::Rotate: k = know_rotate(id, k); break;
    case MapKind::Scale: k = know_scale(id, k); break;
    case MapKind::MirrorFold: k = know_fold(id, k); break;
    case MapKind::Revolve: k = know_revolve(id, k); break;
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

// Of points p and r the shifts differ by the width of their interval at most: with q(r) = s, the
// nearest of q(p), |p - r| <= |q(p) - s| + that.
std::optional<double> Prover::fold_is_clean(NodeId q, const Box &box) {
    NodeId p = graph.point(graph[q].type);
    double flat = 0;
    for (int i = 0; i < ir::components(graph[q].type); ++i) {
        NodeId c = in_one_form(graph, component_of(graph, q, i)), own = graph.component(p, i);
        if (c == own) continue;
        bool mirror = graph[c].op == Op::Abs && graph.arg(c, 0) == own;
        if (mirror) {
            if (box.lo[static_cast<std::size_t>(i)] < 0) return {};
            continue;
        }
        const Interval shift = number_anywhere(shift_of(q, i).value_or(own));
        if (!shift.finite()) return {};
        flat = up(std::hypot(flat, shift.width()), 4);
    }
    return flat;
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

} // namespace fathom::proof
