#include "typecheck/bases.h"

#include <map>
#include <tuple>

namespace fathom::typecheck {

using ir::NodeId;
using ir::ShapeId;
using ir::ShapeKind;

namespace {

struct Dresser {
    Evaluator &ev;
    Paints paints;
    const Dress &dress;
    std::map<std::tuple<ShapeId, bool, NodeId>, ShapeId> done{};

    ShapeId rebuilt(ir::Shape shape, const Below &below) {
        for (ShapeId &child : shape.children) child = of(child, below);
        return ev.scene.shapes.add(std::move(shape));
    }

    // Unions gather like shapes into families, so the parts are taken as they were listed and
    // united anew.
    ShapeId united(ShapeId id, std::vector<ShapeId> parts, const Below &below) {
        const ir::Shape shape = ev.scene.shapes[id];
        for (ShapeId &part : parts) part = of(part, below);
        return unite(ev, std::move(parts), shape.dims, shape.origin);
    }

    ShapeId of(ShapeId id, const Below &below) {
        const auto key = std::make_tuple(id, below.inverted, below.factor);
        if (const auto it = done.find(key); it != done.end()) return it->second;
        const ShapeId made = make(id, below);
        done.emplace(key, made);
        return made;
    }

    ShapeId make(ShapeId id, const Below &below) {
        const ir::Shape shape = ev.scene.shapes[id];
        ir::Graph &g = ev.scene.graph;
        switch (shape.kind) {
        case ShapeKind::Empty: return id;
        case ShapeKind::Leaf:
        case ShapeKind::Extrude: return dress(id, below);
        case ShapeKind::Library:
            if (ev.scene.shapes.libraries[shape.payload].has_claims) return dress(id, below);
            return of(shape.children[0], below); // it is no longer what that call made
        case ShapeKind::Union: {
            const auto listed = ev.scene.shapes.listed.find(id);
            return united(id,
                          listed == ev.scene.shapes.listed.end() ? shape.children : listed->second,
                          below);
        }
        case ShapeKind::Many: {
            const auto listed = ev.scene.shapes.listed.find(id);
            const bool is_union = !ev.scene.shapes.families[shape.payload].smooth;
            if (is_union && listed != ev.scene.shapes.listed.end())
                return united(id, listed->second, below);
            return rebuilt(shape, below);
        }
        case ShapeKind::Complement: return rebuilt(shape, {!below.inverted, below.factor});
        case ShapeKind::Map: {
            if (shape.map == ir::MapKind::Revolve) return dress(id, below);
            Below inner = below;
            if (shape.map == ir::MapKind::Scale) inner.factor = g.mul(below.factor, shape.args[1]);
            return rebuilt(shape, inner);
        }
        case ShapeKind::Paint:
        case ShapeKind::Repaint:
            if (paints == Paints::KeepWhole) return id;
            if (paints == Paints::Strip) return of(shape.children[0], below);
            return rebuilt(shape, below);
        case ShapeKind::Intersection:
        case ShapeKind::Xor:
        case ShapeKind::Blend:
        case ShapeKind::Seam:
        case ShapeKind::Lerp:
        case ShapeKind::PseudoNorm:
        case ShapeKind::Offset:
        case ShapeKind::Shell:
        case ShapeKind::Displace:
        case ShapeKind::Repeat:
        case ShapeKind::Within:
        case ShapeKind::Mixed:
        case ShapeKind::Contract: return rebuilt(shape, below);
        }
        return id;
    }
};

} // namespace

ShapeId dressed(Evaluator &ev, ShapeId shape, Paints paints, const Dress &dress) {
    Dresser dresser{ev, paints, dress};
    return dresser.of(shape, {false, ev.scene.graph.number(1)});
}

} // namespace fathom::typecheck
