// The fifth reading: the marched field with no bound above 1 in it (lower.h). A bound below 1
// divides it all the same: it makes the field steeper, and a union with it would otherwise take it
// for nearer than it is.
#include "ir/lower/lowering.h"

#include <algorithm>
#include <cmath>

namespace fathom::ir {

constexpr double rounding = 1e-6; // a bound is not above 1 by less

bool Lowering::has_slope_above_one(ShapeId id) const {
    const ShapeFact &known = fact(id);
    if (known.lipschitz && !graph_.is_constant(known.lipschitz)) return true;
    const double bound = known.lipschitz ? *graph_.as_number(known.lipschitz) : known.lipschitz_sup;
    return std::isfinite(bound) && bound > 1 + rounding;
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
            shaded_apart_[i] = shell || has_slope_above_one(id);
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
