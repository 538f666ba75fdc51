// The parts of a scene that a view without a camera may frame, as functions: where each lies is
// found from their values (backend-cpu/prune/solid_box.h).
#include "ir/lower/lowering.h"

#include <algorithm>

namespace fathom::ir {

namespace {

constexpr std::size_t max_alone = 64;  // more parts without bounds are one function
constexpr std::size_t max_found = 512; // parts that are looked for; what they hold is not opened

} // namespace

// Through what unites, paints or moves, down to what has bounds, or is endless on its own.
void Lowering::find_framed(ShapeId id, Where frame, std::vector<NodeId> &alone) {
    const Shape &s = shape(id);
    const Box &box = fact(id).bounds;
    if (box.empty()) return;
    if (!framed_seen_.insert({id, frame.p}).second) return; // shapes share their parts
    const bool opens = s.kind == ShapeKind::Union || is_transparent(s, shapes_);
    const auto has_bounds = [&](ShapeId child) { return fact(child).bounds.finite(); };
    const bool bounded = box.finite() && frame.p == p3_;
    if (bounded && !(opens && std::ranges::all_of(s.children, has_bounds))) {
        scene_.framed_bounded.push_back({expression_of(Reading::Marched, id, frame), box});
        return;
    }
    const bool moves =
        s.kind == ShapeKind::Map && (s.map == MapKind::Translate || s.map == MapKind::Rotate);
    if (bounded || (!box.finite() && (opens || moves) && ++framed_opened_ < max_found)) {
        const Where there = opens ? frame : at(frame, read(s.args[0], frame));
        for (ShapeId child : s.children) find_framed(child, there, alone);
        return;
    }
    alone.push_back(expression_of(Reading::Marched, id, frame));
}

void Lowering::add_framed(Where frame) {
    scene_.framed_point = p3_;
    scene_.framed_bounded.clear();
    scene_.framed_alone.clear();
    scene_.framed = {};
    framed_seen_.clear();
    framed_opened_ = 0;
    if (scene_.camera.given) return;
    std::vector<NodeId> alone;
    for (const TopLevel &part : scene_.top_level) find_framed(part.shape, frame, alone);
    for (const Scene::Framed &part : scene_.framed_bounded)
        scene_.framed = hull(scene_.framed, part.bounds);
    const auto together = [&](const std::vector<NodeId> &distances) {
        return graph_.add_function(
            {"framed_alone", {}, {p3_}, graph_.make(Op::Union, Type::Float, distances)});
    };
    if (alone.size() > max_alone)
        scene_.framed_alone.push_back(together(alone));
    else
        for (NodeId distance : alone) scene_.framed_alone.push_back(together({distance}));
}

} // namespace fathom::ir
