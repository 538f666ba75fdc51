// The parts of a scene that a view without a camera may frame, as functions: where each lies is
// found from their values (backend-cpu/prune/solid_box.h).
#include "ir/lower/lowering.h"

namespace fathom::ir {

namespace {

constexpr std::size_t max_alone = 64;  // more parts without bounds are one function
constexpr std::size_t max_found = 512; // parts that are looked for; what they hold is not opened

} // namespace

// Through what unites, paints or moves, down to what has bounds, or is endless on its own.
void Lowering::find_framed(ShapeId id, Where frame, std::vector<NodeId> &bounded,
                           std::vector<NodeId> &alone) {
    const Shape &s = shape(id);
    const Box &box = fact(id).bounds;
    if (box.empty()) return;
    if (box.finite() && frame.p == p3_) {
        scene_.framed = hull(scene_.framed, box);
        bounded.push_back(expression_of(Reading::Marched, id, frame));
        return;
    }
    const bool opens = s.kind == ShapeKind::Union || is_transparent(s, shapes_);
    const bool moves =
        s.kind == ShapeKind::Map && (s.map == MapKind::Translate || s.map == MapKind::Rotate);
    if (!framed_seen_.insert({id, frame.p}).second) return; // shapes share their parts
    if (!box.finite() && (opens || moves) && framed_seen_.size() < max_found) {
        const Where there = opens ? frame : at(frame, read(s.args[0], frame));
        for (ShapeId child : s.children) find_framed(child, there, bounded, alone);
        return;
    }
    alone.push_back(expression_of(Reading::Marched, id, frame));
}

void Lowering::add_framed(Where frame) {
    scene_.framed_together = {};
    scene_.framed_alone.clear();
    scene_.framed = {};
    framed_seen_.clear();
    if (scene_.camera.given) return;
    std::vector<NodeId> bounded, alone;
    for (const TopLevel &part : scene_.top_level) find_framed(part.shape, frame, bounded, alone);
    const auto together = [&](const char *name, const std::vector<NodeId> &distances) {
        return graph_.add_function(
            {name, {}, {p3_}, graph_.make(Op::Union, Type::Float, distances)});
    };
    if (!bounded.empty()) scene_.framed_together = together("framed", bounded);
    if (alone.size() > max_alone)
        scene_.framed_alone.push_back(together("framed_alone", alone));
    else
        for (NodeId distance : alone)
            scene_.framed_alone.push_back(together("framed_alone", {distance}));
}

} // namespace fathom::ir
