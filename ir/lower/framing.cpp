// The parts of a scene that a view without a camera may frame, as functions: where each lies is
// found from their values (backend-cpu/prune/solid_box.h).
#include "ir/lower/lowering.h"

#include <algorithm>

namespace fathom::ir {

namespace {

constexpr std::size_t max_alone = 64;  // more parts without bounds are one function
constexpr std::size_t max_found = 512; // parts that are looked for; what they hold is not opened

// What has its child's parts, each moved or scaled.
bool keeps_parts(const Shape &s) {
    return s.kind == ShapeKind::Map &&
           (s.map == MapKind::Translate || s.map == MapKind::Rotate || s.map == MapKind::Scale);
}

} // namespace

// Whether it holds several parts: what unites, under what paints, moves, scales or cuts.
bool Lowering::has_parts(ShapeId id) const {
    const Shape &s = shape(id);
    if (is_one_of(s.kind, {ShapeKind::Union, ShapeKind::Blend, ShapeKind::Intersection}))
        return s.kind != ShapeKind::Intersection ||
               std::ranges::any_of(s.children, [&](ShapeId child) { return has_parts(child); });
    return (is_transparent(s, shapes_) || keeps_parts(s)) && has_parts(s.children.front());
}

// Through what unites, paints, moves, scales or cuts, down to what has bounds, or is endless on its own.
// A blend's parts are looked for without what it adds between them.
void Lowering::find_framed(ShapeId id, Framing in, std::vector<NodeId> &alone) {
    const Where frame = in.frame;
    const NodeId factor = in.factor, cut = in.cut;
    const Shape &s = shape(id);
    const Box &box = fact(id).bounds;
    if (box.empty()) return;
    if (!framed_seen_.insert({id, frame.p, cut}).second) return; // shapes share their parts
    const auto distance = [&](ShapeId part) {
        const NodeId raw = expression_of(Reading::Marched, part, frame);
        return factor ? graph_.mul(factor, raw) : raw;
    };
    const auto both = [&](NodeId a, NodeId b) { return a ? graph_.make(Op::Max, {a, b}) : b; };
    const bool opens = s.kind == ShapeKind::Union || is_transparent(s, shapes_);
    const auto has_bounds = [&](ShapeId child) { return fact(child).bounds.finite(); };
    const bool bounded = box.finite() && frame.p == p3_;
    if (bounded && !(opens && std::ranges::all_of(s.children, has_bounds))) {
        scene_.framed_bounded.push_back({both(cut, distance(id)), box});
        return;
    }
    const bool endless = !box.finite() && framed_opened_ < max_found;
    if (bounded || (endless && (opens || keeps_parts(s) || s.kind == ShapeKind::Blend))) {
        if (!bounded) ++framed_opened_;
        Framing there = in;
        if (s.kind == ShapeKind::Map) there.frame = at(frame, read(s.args[0], frame));
        if (s.kind == ShapeKind::Map && s.map == MapKind::Scale) {
            const NodeId scaled = read(s.args[1], frame);
            there.factor = factor ? graph_.mul(factor, scaled) : scaled;
        }
        for (ShapeId child : s.children) find_framed(child, there, alone);
        return;
    }
    const auto parts = [&](ShapeId child) { return has_parts(child); };
    if (endless && s.kind == ShapeKind::Intersection &&
        std::ranges::count_if(s.children, parts) == 1) {
        ++framed_opened_;
        Framing rest = in;
        for (ShapeId child : s.children) {
            if (has_parts(child)) continue;
            rest.cut = both(rest.cut, distance(child));
        }
        find_framed(*std::ranges::find_if(s.children, parts), rest, alone);
        return;
    }
    alone.push_back(both(cut, distance(id)));
}

void Lowering::add_framed(Where frame) {
    scene_.framed_point = p3_;
    scene_.framed_bounded.clear();
    scene_.framed_alone.clear();
    scene_.framed = {};
    scene_.framed_reach.clear();
    framed_seen_.clear();
    framed_opened_ = 0;
    if (scene_.camera.given) return;
    std::vector<NodeId> alone;
    for (const TopLevel &part : scene_.top_level) find_framed(part.shape, {frame, {}, {}}, alone);
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
