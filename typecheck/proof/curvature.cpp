// Bounds of second derivatives from above, for the second rule by which rays step (lipschitz.md,
// curvature): of a distance less a number, and of what is displaced from one.
#include "typecheck/proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::MapKind;
using ir::NodeId;
using ir::Op;
using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::down;
using ir::rounding::infinity;
using ir::rounding::up;

// The largest |d²t/ds²| along lines, over a box.
double Prover::bend(NodeId field, const Box &box) {
    const Tape &tape = tape_of(field);
    if (tape.too_large) return infinity;
    Machine machine(tape, ranges, true);
    machine.run(to_cell(box));
    return machine.bend();
}

// `length(v) - c` with a v that is straight and lengthens nothing: |v|'' = (|v'|^2 - (v'.u)^2)/|v|
// is at most 1/|v|.
double Prover::core_of_leaf(NodeId field) {
    NodeId length = field;
    Interval less;
    if (graph[field].op == Op::Sub || graph[field].op == Op::Add) {
        const bool minus = graph[field].op == Op::Sub;
        for (int side = 0; side < (minus ? 1 : 2); ++side) {
            const NodeId other = graph.arg(field, 1 - side);
            if (graph[graph.arg(field, side)].op != Op::Length || reads_point(other) ||
                graph.reads(other).free_vars)
                continue;
            length = graph.arg(field, side);
            less = minus ? number(other) : -number(other);
        }
    }
    if (graph[length].op != Op::Length) return -infinity;
    const Tape &tape = tape_of(graph.arg(length, 0));
    if (tape.too_large) return -infinity;
    Machine machine(tape, ranges, true);
    machine.run(Cell{});
    const bool straight = machine.bend() == 0 && machine.norm() <= 1 + 1e-9;
    return straight ? less.lo : -infinity;
}

// c, where the raw field f has f'' <= 1/(f + c) along lines wherever f > -c: the distance to a
// closed set, less c, as the distance is the least of those to the set's points. -infinity:
// unknown.
double Prover::core_of(ShapeId id) {
    const Shape shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Leaf: return core_of_leaf(shape.args[0]);
    case ShapeKind::Library: {
        const bool exact = scene.shapes.libraries[shape.payload].has_claims &&
                           of(id).fact.kind == ir::FieldKind::Exact;
        return std::max(of(shape.children[0]).core, exact ? 0 : -infinity);
    }
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Contract: return child(shape).core;
    case ShapeKind::Union: { // a least of fields bends upward as one of them does
        double least = infinity;
        for (std::size_t i = 0; i < shape.children.size(); ++i)
            least = std::min(least, child(shape, i).core);
        return shape.children.empty() ? -infinity : least;
    }
    case ShapeKind::Offset:
        if (reads_point(shape.args[0])) return -infinity;
        return down(child(shape).core + number(shape.args[0]).lo);
    case ShapeKind::Map:
        if (shape.map == MapKind::Translate || shape.map == MapKind::Rotate)
            return child(shape).core;
        return -infinity;
    case ShapeKind::Empty:
    case ShapeKind::Intersection:
    case ShapeKind::Complement:
    case ShapeKind::Xor:
    case ShapeKind::Blend:
    case ShapeKind::Seam:
    case ShapeKind::Lerp:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Shell:
    case ShapeKind::Displace:
    case ShapeKind::Extrude:
    case ShapeKind::Repeat:
    case ShapeKind::Within:
    case ShapeKind::Many: return -infinity;
    }
    return -infinity;
}

// M for f = g - t, g with a core c and t >= -a. Down to the depth D, where f >= -D, g + c is at
// least c - a - D, so f'' <= b + 1/(c - a - D), b the bend of t. The rule wants D >= L^2/(2M): what
// dips deeper is as long as L says. M grows with D, so there is one least D.
double Prover::curvature_of(ShapeId id, const Known &k) {
    const Shape shape = scene.shapes[id];
    if (shape.kind != ShapeKind::Displace || k.failed || local || !std::isfinite(inward))
        return infinity;
    const double slope = k.fact.lipschitz_sup, room = child(shape).core - inward;
    if (!(room > 0) || !std::isfinite(slope) || slope <= 1 + slack) return infinity;
    const double bent = bend(shape.args[0], place(id).box);
    if (!std::isfinite(bent)) return infinity;
    const auto at = [&](double depth) { return up(bent + 1 / (room - depth), 8); };
    double low = 0, high = room;
    for (int i = 0; i < 40; ++i) {
        const double depth = (low + high) / 2;
        (depth >= up(slope * slope / (2 * at(depth)), 8) ? high : low) = depth;
    }
    if (!(high < room)) return infinity;
    const double most = up(at(high) * (1 + 1e-4)); // float32
    // Of use where the reach sqrt(2f/M) is more than f/L, up to f = 2 L^2/M, on a good part of the
    // way from the range shell to the surface.
    const bool worth = 2 * slope * slope / most > 0.25 * (outward + inward);
    return worth ? most * options.rules[Rule::Curvature] : infinity;
}

} // namespace fathom::proof
