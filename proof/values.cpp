// What values a raw field takes over a box of points: intervals up the tree of shapes. For rules
// that need how large a field can be; slopes are not wanted here.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;

namespace {
// |(x, y)| for a corner's two distances where both are outside, else the greater: joined_distance.
Interval joined_values(Interval x, Interval y) {
    const Interval zero(0.0), outside = sqrt(square(max(x, zero)) + square(max(y, zero)));
    return outside + min(max(x, y), zero);
}
// The distance to a box, as a field that is joined with its own asks for it: box_distance.
Interval values_of_way(const Box &box, const Cell &cell) {
    Interval outside(0.0), most(-infinity);
    for (std::size_t i = 0; i < 3; ++i) {
        const Interval half = (Interval(box.hi[i]) - Interval(box.lo[i])) * Interval(0.5),
                       beyond = abs(cell.p[i] - (Interval(box.lo[i]) + half)) - half;
        outside += square(max(beyond, Interval(0.0)));
        most = max(most, beyond);
    }
    return sqrt(outside) + min(most, Interval(0.0));
}
Cell clamped(const Cell &cell, const Box &box) {
    Cell out = cell;
    for (std::size_t i = 0; i < 3; ++i)
        out.p[i] = max(min(cell.p[i], Interval(box.hi[i])), Interval(box.lo[i]));
    return out;
}
} // namespace

// For values, symmetries and bends, which no choice's border decides.
std::shared_ptr<const Tape> Prover::tape_of(ir::NodeId field) {
    const auto found = tapes.find(field);
    if (found != tapes.end()) return found->second;
    flattening.borders = false;
    Tape tape = flatten(flattening, field);
    flattening.borders = true;
    constexpr std::size_t most_kept = 100'000; // instructions, of about 500 bytes each
    if (tapes_length > most_kept) tapes.clear(), tapes_length = 0;
    tape.each.shrink_to_fit();
    tapes_length += tape.each.size();
    for (const Loop &loop : tape.loops) tapes_length += loop.body.size();
    return tapes[field] = std::make_shared<const Tape>(std::move(tape));
}

// What is proved in its own box alone is joined with the way to it, as it is lowered.
Interval Prover::values(ShapeId id, const Cell &cell, int depth) {
    const ir::ShapeFact &fact = of(id).fact;
    if (!fact.local) return own_values(id, cell, depth);
    if (!fact.bounds.finite() || fact.bounds.empty()) return Interval::everything();
    const Box box = padded(fact.bounds);
    return joined_values(values_of_way(box, cell), own_values(id, clamped(cell, box), depth));
}

Interval Prover::own_values(ShapeId id, const Cell &cell, int depth) {
    const Shape shape = scene.shapes[id];
    if (depth > 64 || work.spent()) return Interval::everything();
    work.take(1); // shapes share their parts
    auto inner = [&](std::size_t i, const Cell &there) {
        return values(shape.children[i], there, depth + 1);
    };
    auto read = [&](ir::NodeId node) {
        const auto tape = tape_of(node);
        if (tape->too_large) return Interval::everything();
        Machine machine(*tape, ranges);
        machine.run(cell);
        return machine.value(0);
    };
    switch (shape.kind) {
    case ShapeKind::Empty: return Interval(1e9);
    case ShapeKind::Leaf: return read(shape.args[0]);
    case ShapeKind::Complement: return -inner(0, cell);
    case ShapeKind::Union:
    case ShapeKind::Intersection:
    case ShapeKind::Blend:
    case ShapeKind::Xor: {
        Interval all = inner(0, cell);
        for (std::size_t i = 1; i < shape.children.size(); ++i) {
            const Interval next = inner(i, cell);
            if (shape.kind == ShapeKind::Intersection)
                all = max(all, next);
            else if (shape.kind == ShapeKind::Xor)
                all = max(min(all, next), -max(all, next));
            else
                all = min(all, next);
            if (shape.kind == ShapeKind::Blend) // profiles lie in [min - r, min] (ir/blends.h)
                all = all + Interval(-std::max(read(shape.args[0]).hi, 0.0), 0);
        }
        return all;
    }
    case ShapeKind::Lerp: {
        const Interval t = read(shape.args[0]);
        return t * inner(0, cell) + (Interval(1.0) - t) * inner(1, cell);
    }
    case ShapeKind::Map: {
        const auto q = range_of(flattening, ranges, shape.args[0], cell);
        return read(shape.args[1]) * inner(0, {{q[0], q[1], q[2]}});
    }
    case ShapeKind::Offset:
    case ShapeKind::Displace: return inner(0, cell) - read(shape.args[0]);
    case ShapeKind::Shell: return abs(inner(0, cell)) - read(shape.args[0]) * Interval(0.5);
    case ShapeKind::Extrude:
        return joined_values(inner(0, cell),
                             abs(cell.p[2]) - abs(read(shape.args[0])) * Interval(0.5));
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Library:
    case ShapeKind::Contract: return inner(0, cell);
    case ShapeKind::Seam:
    case ShapeKind::PseudoNorm:
    case ShapeKind::Within:
    case ShapeKind::Repeat:
    case ShapeKind::Instances: break;
    }
    return Interval::everything();
}

// |f(c)| + L |p - c|, or the largest of the values over the box.
double Prover::magnitude(ShapeId id, const Box &box) {
    const Cell cell = to_cell(box);
    Cell centre;
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        if (!cell.p[i].finite()) return infinity;
        centre.p[i] = cell.p[i].middle();
        sum += std::pow((cell.p[i] - centre.p[i]).magnitude(), 2);
    }
    const double reach =
        values(id, centre).magnitude() + of(id).fact.lipschitz_sup * std::sqrt(sum);
    return ir::rounding::up(std::min(reach, values(id, cell).magnitude()), 8);
}

} // namespace fathom::proof
