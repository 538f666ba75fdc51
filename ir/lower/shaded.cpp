// The fifth reading: the marched field with no bound above 1 in it (lower.h). A union takes the least
// for what is nearest, so all fields have to be about as steep as a distance: a bound below 1 divides
// all the same, as does the slope that is seen at the surface; and what is scaled by a vector is
// measured.
#include "ir/lower/lowering.h"

#include <algorithm>
#include <cmath>

namespace fathom::ir {

constexpr double rounding = 1e-6;          // a bound is not above 1 by less
constexpr double most_cost = 400;          // operations of what is evaluated four times
constexpr double away_arm = 1.0 / 64;      // of the field: of a gradient off the surface
constexpr double stretch_arm = 1.0 / 1024; // of half the width of what is stretched: at least

bool Lowering::has_slope_above_one(ShapeId id) const {
    const ShapeFact &known = fact(id);
    if (known.lipschitz && !graph_.is_constant(known.lipschitz)) return true;
    const double bound = known.lipschitz ? *graph_.as_number(known.lipschitz) : known.lipschitz_sup;
    return std::isfinite(bound) && bound > 1 + rounding;
}

// Whether it scales a distance by a vector: the slope of what is left differs from place to place by as
// much as the factors do.
bool Lowering::is_stretched(ShapeId id) const {
    const Shape &s = shape(id);
    return s.kind == ShapeKind::Map && s.map == MapKind::Scale && !passes_through(id) &&
           fact(s.children.front()).exact_outside && cost_[s.children.front().index] <= most_cost;
}

// The child's gradient v, by forward differences, says where its nearest place is: a plane that touches
// the surface there is stretched, too, and E = f/|v/s| is how far off it is. From there on, as where an
// edge is beyond, the child's field says what is left.
NodeId Lowering::stretched(ShapeId id, Where frame) {
    Graph &g = graph_;
    const Shape &s = shape(id);
    const ShapeId child = s.children.front();
    const auto dims = static_cast<std::size_t>(s.dims);
    const Box &box = fact(child).bounds;
    const bool known = box.finite() && !box.empty();
    const NodeId q = read(s.args[0], frame), by = read(s.args[2], frame);
    const auto field = [&](NodeId point) {
        return expression_of(Reading::Raw, child, at(frame, point));
    };
    const auto vector = [&](const std::array<NodeId, 3> &parts) {
        return g.make(Op::Make, vector_type(s.dims), std::span(parts).first(dims));
    };
    const NodeId here = field(q), zero = g.number(0);
    const NodeId away = g.mul(g.number(away_arm), g.make(Op::Abs, {here}));
    NodeId steep = zero, far = zero; // squares of |v/s| and |v s|
    std::array<NodeId, 3> down{};    // v/s^2
    for (std::size_t i = 0; i < dims; ++i) {
        const double half = known ? 0.5 * (box.hi[i] - box.lo[i]) : 1;
        const NodeId arm = g.make(Op::Max, {g.number(stretch_arm * (half > 0 ? half : 1)), away});
        std::array<NodeId, 3> off{zero, zero, zero};
        off[i] = arm;
        const NodeId v = g.div(g.sub(field(g.add({q, vector(off)})), here), arm);
        const NodeId factor = g.component(by, static_cast<int>(i));
        const auto add_square = [&](NodeId &sum, NodeId x) { sum = g.add({sum, g.mul(x, x)}); };
        add_square(steep, g.div(v, factor));
        add_square(far, g.mul(v, factor));
        down[i] = g.div(v, g.mul(factor, factor));
    }
    steep = g.make(Op::Max, {steep, g.number(1e-12)});
    const NodeId step = g.div(here, steep);
    const NodeId left = field(g.sub(q, g.mul(step, vector(down))));
    const NodeId beyond = g.mul(g.mul(left, left), far);
    const NodeId distance = g.make(Op::Sqrt, {g.add({g.div(g.mul(here, here), steep), beyond})});
    return g.make(Op::Select, {g.make(Op::Less, {here, zero}), g.neg(distance), distance});
}

// Children come before their parents. Minima, maxima and negations of fields with the slope 1 have
// it too, as have shells, offsets and what moves them; a smooth blend has less in its seam.
void Lowering::find_shaded() {
    shaded_apart_.assign(shapes_.size(), 0);
    unit_slope_.assign(shapes_.size(), 0);
    for (std::size_t i = 0; i <= scene_.root.index; ++i) {
        const ShapeId id{i};
        const Shape &s = shape(id);
        const auto apart = [&](ShapeId child) { return shaded_apart_[child.index] != 0; };
        const auto unit = [&](ShapeId child) { return unit_slope_[child.index] != 0; };
        if (passes_through(id)) {
            shaded_apart_[i] = std::ranges::any_of(s.children, apart);
            unit_slope_[i] = std::ranges::all_of(s.children, unit);
        } else if (s.kind == ShapeKind::Within) {
            shaded_apart_[i] = shapes_.regions[s.payload].kind != RegionKind::Everywhere ||
                               has_slope_above_one(s.children.front()) ||
                               fact(id).detour > 1 + rounding || has_cells(id);
        } else if (s.kind == ShapeKind::Offset || s.kind == ShapeKind::Shell) {
            shaded_apart_[i] = has_slope_above_one(id);
            unit_slope_[i] = unit(s.children.front());
        } else {
            const bool shell = s.kind == ShapeKind::Displace && std::isfinite(fact(id).outward);
            shaded_apart_[i] = shell || has_slope_above_one(id) || is_stretched(id);
            unit_slope_[i] = fact(id).kind == FieldKind::Exact;
        }
    }
}

// Where two surfaces may lie in one plane, with nothing between them; of fields of one's own nothing is
// known.
bool Lowering::may_have_films() const {
    for (std::size_t i = 0; i <= scene_.root.index; ++i) {
        const Shape &s = shape(ShapeId{i});
        if (is_one_of(s.kind, {ShapeKind::Intersection, ShapeKind::Complement, ShapeKind::Xor,
                               ShapeKind::Within}))
            return true;
        if (s.kind == ShapeKind::Library) continue;
        for (const ShapeId child : s.children)
            if (shape(child).kind == ShapeKind::Leaf) return true;
    }
    return shape(scene_.root).kind == ShapeKind::Leaf;
}

NodeId Lowering::shaded(ShapeId id, NodeId raw) {
    const ShapeFact &known = fact(id);
    if (!has_slope_above_one(id)) return divided(id, raw);
    if (known.surface_slope > 1) return graph_.div(raw, graph_.number(known.surface_slope));
    if (!known.lipschitz || graph_.is_constant(known.lipschitz)) return raw;
    const NodeId bound = graph_.make(Op::Max, {known.lipschitz, graph_.number(1e-6)});
    return graph_.div(raw, graph_.make(Op::Min, {bound, graph_.number(1)}));
}

} // namespace fathom::ir
