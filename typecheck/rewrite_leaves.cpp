#include "typecheck/rewrite_leaves.h"
#include "typecheck/instances.h"

#include <map>
#include <tuple>

namespace fathom::typecheck {

using ir::NodeId;
using ir::ShapeId;
using ir::ShapeKind;

namespace {

struct LeafRewriter {
    Interpreter &ev;
    Paints paints;
    const RewriteLeaf &rewrite;
    std::map<std::tuple<ShapeId, bool, NodeId, Line>, ShapeId> done{};

    ShapeId rebuilt(ir::Shape shape, const Below &below) {
        for (ShapeId &child : shape.children) child = of(child, below);
        return ev.scene.shapes.add(std::move(shape));
    }

    // The line in the space of a flat map's child, where its numbers are known.
    Line mapped(const ir::Shape &shape, Line line) const {
        const ir::Graph &g = ev.scene.graph;
        if (!line.known() || shape.dims != 2 || shape.args.size() < 3 ||
            !g.is_constant(shape.args[2]))
            return {};
        const auto &n = g.constant_of(shape.args[2]).value;
        const auto [at, along, left] = line;
        switch (shape.map) {
        case ir::MapKind::Translate: return {{at[0] - n[0], at[1] - n[1]}, along, left};
        case ir::MapKind::Scale:
            return {{at[0] / n[0], at[1] / n[1]},
                    {along[0] / n[0], along[1] / n[1]},
                    left != (n[0] * n[1] < 0)};
        case ir::MapKind::Rotate: // by the transposed matrix, whose columns are n[0..1] and n[2..3]
            return {{n[0] * at[0] + n[1] * at[1], n[2] * at[0] + n[3] * at[1]},
                    {n[0] * along[0] + n[1] * along[1], n[2] * along[0] + n[3] * along[1]},
                    left != (n[0] * n[3] < n[1] * n[2])};
        case ir::MapKind::MirrorFold:
        case ir::MapKind::Revolve:
        case ir::MapKind::Twist:
        case ir::MapKind::Bend:
        case ir::MapKind::Taper:
        case ir::MapKind::Distort: return {};
        }
        return {};
    }

    // Unions gather like shapes into instance_tables, so the parts are taken as they were listed
    // and united anew.
    ShapeId united(ShapeId id, std::vector<ShapeId> parts, const Below &below) {
        const ir::Shape shape = ev.scene.shapes[id];
        for (ShapeId &part : parts) part = of(part, below);
        return unite(ev, std::move(parts), shape.dims, shape.origin);
    }

    ShapeId of(ShapeId id, const Below &below) {
        const auto key = std::make_tuple(id, below.inverted, below.factor, below.axis);
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
        case ShapeKind::Extrude: return rewrite(id, below);
        case ShapeKind::Library:
            if (ev.scene.shapes.libraries[shape.payload].has_claims) return rewrite(id, below);
            return of(shape.children[0], below); // it is no longer what that call made
        case ShapeKind::Union: {
            const auto listed = ev.scene.shapes.listed.find(id);
            return united(id,
                          listed == ev.scene.shapes.listed.end() ? shape.children : listed->second,
                          below);
        }
        case ShapeKind::Instances: {
            const auto listed = ev.scene.shapes.listed.find(id);
            const bool is_union = !ev.scene.shapes.instance_tables[shape.payload].smooth;
            if (is_union && listed != ev.scene.shapes.listed.end())
                return united(id, listed->second, below);
            return rebuilt(shape, below);
        }
        case ShapeKind::Complement:
            return rebuilt(shape, {!below.inverted, below.factor, below.axis});
        case ShapeKind::Map: {
            if (shape.map == ir::MapKind::Revolve) return rewrite(id, below);
            Below inner = below;
            if (shape.map == ir::MapKind::Scale) inner.factor = g.mul(below.factor, shape.args[1]);
            inner.axis = mapped(shape, below.axis);
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
        case ShapeKind::Mixed:
        case ShapeKind::Contract: return rebuilt(shape, below);
        // what makes new surfaces of the old ones, or evaluates them elsewhere
        case ShapeKind::Seam:
        case ShapeKind::Lerp:
        case ShapeKind::PseudoNorm:
        case ShapeKind::Offset:
        case ShapeKind::Shell:
        case ShapeKind::Displace:
        case ShapeKind::Repeat:
        case ShapeKind::Within: return rebuilt(shape, {below.inverted, below.factor, {}});
        }
        return id;
    }
};

} // namespace

ShapeId rewrite_leaves(Interpreter &ev, ShapeId shape, Paints paints, const RewriteLeaf &rewrite,
                       Line axis) {
    LeafRewriter rewriter{ev, paints, rewrite};
    return rewriter.of(shape, {false, ev.scene.graph.number(1), axis});
}

} // namespace fathom::typecheck
