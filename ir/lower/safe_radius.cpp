// The fourth reading: beside the marched distance the safe radius by curvature (shading.h, MARCH),
// as one vec2, so that the octaves of a displacement are still evaluated only where they matter.
// Where nothing is known but the ball, both are the same number. A union is nearest and has the
// smallest safe radius by each component; lengths keep their size in isometries; a guard's distance
// is one that every point of the solid keeps, hence the least of both numbers.
#include "ir/lower/lowering.h"
#include "ir/maps.h"

namespace fathom::ir {

namespace {
constexpr double endless = 1e9; // a safe radius without an end, whose square is a float
}

// Whether the shape's own combination hands its children's safe radius on. Folds do not: a mirror
// may bend a field upward sharply. Intersections would need more than the smaller radius.
bool Lowering::passes_safe_radius_on(const Shape &s) const {
    if (s.kind == ShapeKind::Map) return s.map == MapKind::Translate || s.map == MapKind::Rotate;
    return s.kind == ShapeKind::Union || is_transparent(s, shapes_);
}

// Affine in the point: between two samples outside, however far apart, nothing lies.
bool Lowering::is_straight(ShapeId id) const {
    return shape(id).kind != ShapeKind::Displace && fact(id).curvature == 0 && !has_cells(id);
}

void Lowering::find_curved() {
    curved_.assign(shapes_.size(), 0);
    for (std::size_t i = 0; i <= scene_.root.index; ++i) {
        const Shape &s = shape(ShapeId{i});
        curved_[i] = s.kind == ShapeKind::Displace && std::isfinite(fact(ShapeId{i}).curvature) &&
                     std::isfinite(fact(ShapeId{i}).outward);
        curved_[i] |= is_straight(ShapeId{i});
        curved_[i] |= s.kind == ShapeKind::Within && has_cells(ShapeId{i}) &&
                      !scene_.cells.at(ShapeId{i}).bend.empty();
        if (!passes_safe_radius_on(s)) continue;
        for (ShapeId child : s.children) curved_[i] |= curved_[child.index];
    }
}

NodeId Lowering::both(NodeId distance) {
    return graph_.make(Op::Make, Type::Vec2, {distance, distance});
}

NodeId Lowering::safe_radius(ShapeId id, Where frame) {
    const Shape &s = shape(id);
    if (!curved_[id.index]) return both(expression_of(Reading::Marched, id, frame));
    NodeId value;
    if (is_straight(id)) {
        value = graph_.make(Op::Make, Type::Vec2,
                            {expression_of(Reading::Marched, id, frame), graph_.number(endless)});
    } else if (s.kind == ShapeKind::Displace) {
        value = displaced(Reading::SafeRadius, id, frame);
    } else if (s.kind == ShapeKind::Within) {
        const NodeId distance = expression_of(Reading::Marched, id, frame);
        value = graph_.make(Op::Make, Type::Vec2,
                            {distance, graph_.make(Op::Max, {distance, bent_by_cells(id, frame)})});
    } else if (s.kind == ShapeKind::Union) {
        std::vector<NodeId> plain; // by one number as long as they may
        for (ShapeId child : s.children) {
            if (!curved_[child.index]) {
                plain.push_back(expression_of(Reading::Marched, child, frame));
                continue;
            }
            const NodeId one = expression_of(Reading::SafeRadius, child, frame);
            value = value ? graph_.make(Op::Min, {value, one}) : one;
        }
        if (!plain.empty())
            value = graph_.make(Op::Min, {value, both(graph_.make(Op::Union, Type::Float, plain))});
    } else if (s.kind == ShapeKind::Map) {
        value = expression_of(Reading::SafeRadius, s.children.front(),
                              at(frame, read(s.args[0], frame)));
    } else {
        value = expression_of(Reading::SafeRadius, s.children.front(), frame);
    }
    if (!fact(id).guard) return value;
    return graph_.make(Op::Max, {value, both(guard(id, frame))});
}

} // namespace fathom::ir
