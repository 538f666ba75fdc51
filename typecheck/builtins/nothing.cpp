// Shapes that are nowhere, as a union of an empty list is, and what becomes of what is made of them.
#include "typecheck/builtins/builtins.h"
#include "typecheck/instances.h"

#include <algorithm>

namespace fathom::typecheck {

using ir::ShapeKind;

bool is_empty(Interpreter &ev, ir::ShapeId id) {
    return ev.scene.shapes[id].kind == ShapeKind::Empty;
}
bool is_everything(Interpreter &ev, ir::ShapeId id) {
    const ir::Shape &s = ev.scene.shapes[id];
    return s.kind == ShapeKind::Complement && is_empty(ev, s.children[0]);
}

void leave_out_everything(Interpreter &ev, std::vector<ir::ShapeId> &intersected) {
    const auto nothing =
        std::ranges::find_if(intersected, [&](ir::ShapeId shape) { return is_empty(ev, shape); });
    if (nothing != intersected.end()) intersected = {*nothing};
    const auto whole = [&](ir::ShapeId shape) { return is_everything(ev, shape); };
    if (!std::ranges::all_of(intersected, whole)) std::erase_if(intersected, whole);
}

ir::ShapeId intersect(Interpreter &ev, std::vector<ir::ShapeId> shapes, int dims, Span origin) {
    leave_out_everything(ev, shapes);
    if (shapes.size() == 1) return shapes[0];
    ir::Shape s;
    s.kind = ShapeKind::Intersection;
    s.dims = static_cast<std::uint8_t>(dims);
    s.children = std::move(shapes);
    s.origin = origin;
    return ev.scene.shapes.add(std::move(s));
}

// Of nothing, whatever is made of it: nothing. Of two shapes of which one is nothing: what the
// formula becomes where its distance is infinite.
std::optional<ir::ShapeId> made_of_nothing(Interpreter &ev, const ir::Shape &s) {
    if (s.children.empty()) return std::nullopt;
    const ir::ShapeId a = s.children[0], b = s.children.back();
    const bool no_a = is_empty(ev, a), no_b = is_empty(ev, b);
    if (!no_a && !no_b) return std::nullopt;
    switch (s.kind) {
    case ShapeKind::Empty:
    case ShapeKind::Leaf:
    case ShapeKind::Union: // these leave it out themselves
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Instances:
    case ShapeKind::Contract: return std::nullopt;
    case ShapeKind::Seam:
        if (static_cast<ir::SeamKind>(s.payload) == ir::SeamKind::Pipe) return no_a ? a : b;
        return a;
    case ShapeKind::Lerp: {
        const std::optional<double> t = ev.scene.graph.as_number(s.args[0]);
        if (t == 1) return a;
        if (t == 0) return b;
        return no_a ? a : b;
    }
    case ShapeKind::PseudoNorm: return no_a ? b : a;
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
    case ShapeKind::Library: return a;
    }
    return std::nullopt;
}

} // namespace fathom::typecheck
