// Which part of the scene a hit is on, beside how it looks: both travel in a hit's paint (lower.h),
// so that whoever draws a picture can name what it shows without marching again. Knows shapes, not
// what is done with the parts.
#include "ir/lower/lowering.h"

#include <limits>

namespace fathom::ir {
namespace {

bool combines(ShapeKind kind) {
    return is_one_of(kind,
                     {ShapeKind::Union, ShapeKind::Intersection, ShapeKind::Xor, ShapeKind::Blend,
                      ShapeKind::Seam, ShapeKind::Lerp, ShapeKind::PseudoNorm});
}

} // namespace

Parts lower_with_parts(Scene &scene) { return Lowering(scene).run_with_parts(); }

Parts Lowering::run_with_parts() {
    // More than there can be surfaces (each material solid and flat, each mixed shape, what nobody
    // painted), and one.
    std::size_t surfaces = 2 * shapes_.materials.size() + 2;
    for (std::size_t i = 0; i < shapes_.size(); ++i)
        surfaces += shape(ShapeId{i}).kind == ShapeKind::Mixed;
    parts_.stride = static_cast<int>(surfaces);
    run();
    return std::move(parts_);
}

// Every operand of a combination, and the root. A mixed shape answers for its operands: its colour
// is of them all. Shapes that are no part of the scene (an arm that a param did not choose) count
// for nothing.
void Lowering::find_parts() {
    part_.assign(shapes_.size(), 0);
    parts_below_.assign(shapes_.size(), 0);
    colored_.assign(shapes_.size(), 0);
    if (parts_.stride == 0) return;
    const std::size_t maximum =
        static_cast<std::size_t>(std::numeric_limits<int>::max() / parts_.stride) - 1;
    const auto mark = [&](ShapeId id) {
        if (part_[id.index] != 0 || parts_.shapes.size() >= maximum) return;
        parts_.shapes.push_back(id);
        part_[id.index] = static_cast<std::uint32_t>(parts_.shapes.size());
    };
    std::vector<char> shown(scene_.root.index + 1, 0);
    shown[scene_.root.index] = 1;
    for (std::size_t i = scene_.root.index + 1; i-- > 0;)
        if (shown[i])
            for (ShapeId child : shape(ShapeId{i}).children) shown[child.index] = 1;
    for (std::size_t i = 0; i <= scene_.root.index; ++i) {
        if (!shown[i]) continue;
        const Shape &s = shape(ShapeId{i});
        colored_[i] = s.kind == ShapeKind::Paint || s.kind == ShapeKind::Repaint ||
                      s.kind == ShapeKind::Mixed;
        for (ShapeId child : s.children) {
            if (combines(s.kind)) mark(child);
            colored_[i] |= colored_[child.index];
            parts_below_[i] |=
                s.kind != ShapeKind::Mixed && (part_[child.index] || parts_below_[child.index]);
        }
    }
    mark(scene_.root);
}

// The innermost part counts, so what is marked below stays as it is.
NodeId Lowering::marked(ShapeId id, NodeId hit) {
    if (part_[id.index] == 0 || parts_below_[id.index]) return hit;
    Graph &g = graph_;
    const int part = static_cast<int>(part_[id.index]) * parts_.stride;
    NodeId paint = g.integer(part + parts_.stride - 1);
    if (colored_[id.index]) {
        const NodeId own = g.make(Op::HitPaint, {hit});
        paint = g.make(Op::Select,
                       {g.make(Op::Less, {own, g.integer(0)}), paint, g.add(own, g.integer(part))});
    }
    return g.make(Op::MakeHit, {g.make(Op::HitDistance, {hit}), paint, g.make(Op::HitPoint, {hit}),
                                g.make(Op::HitExtra, {hit})});
}

NodeId Lowering::code_of(NodeId paint) {
    if (parts_.stride == 0) return paint;
    Graph &g = graph_;
    const NodeId code = g.make(Op::Mod, {paint, g.integer(parts_.stride)});
    const NodeId none = g.make(Op::Or, {g.make(Op::Less, {paint, g.integer(0)}),
                                        g.make(Op::Equal, {code, g.integer(parts_.stride - 1)})});
    return g.make(Op::Select, {none, g.integer(-1), code});
}

NodeId Lowering::part_only(NodeId paint) {
    Graph &g = graph_;
    return g.make(Op::Select, {g.make(Op::Less, {paint, g.integer(0)}), g.integer(0),
                               g.sub(paint, g.make(Op::Mod, {paint, g.integer(parts_.stride)}))});
}

// What FillPaint is to a hit without parts; with `over`, whatever was painted before.
NodeId Lowering::painted_part(NodeId hit, bool over, NodeId paint, NodeId point, NodeId extra) {
    Graph &g = graph_;
    const NodeId own = g.make(Op::HitPaint, {hit});
    NodeId both = g.add(paint, part_only(own));
    if (!over) {
        const NodeId bare = g.make(Op::Less, {code_of(own), g.integer(0)});
        both = g.make(Op::Select, {bare, both, own});
        point = g.make(Op::Select, {bare, point, g.make(Op::HitPoint, {hit})});
        extra = g.make(Op::Select, {bare, extra, g.make(Op::HitExtra, {hit})});
    }
    return g.make(Op::MakeHit, {g.make(Op::HitDistance, {hit}), both, point, extra});
}

// The farthest operand decides which part it is; where it is bare, the first one how it looks
// (semantics.md, 22).
NodeId Lowering::farthest_part(NodeId farthest, NodeId first) {
    Graph &g = graph_;
    if (!colored_[scene_.root.index]) return farthest;
    const NodeId own = g.make(Op::HitPaint, {farthest}), other = g.make(Op::HitPaint, {first});
    const NodeId bare = g.make(Op::And, {g.make(Op::Less, {code_of(own), g.integer(0)}),
                                         g.make(Op::LessEqual, {g.integer(0), code_of(other)})});
    const NodeId paint = g.make(Op::Select, {bare, g.add({part_only(own), code_of(other)}), own});
    const auto of = [&](Op op) {
        return g.make(Op::Select, {bare, g.make(op, {first}), g.make(op, {farthest})});
    };
    return g.make(Op::MakeHit,
                  {g.make(Op::HitDistance, {farthest}), paint, of(Op::HitPoint), of(Op::HitExtra)});
}

} // namespace fathom::ir
