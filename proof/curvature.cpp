// Bounds of second derivatives from above, for the second rule by which rays step (lipschitz.md,
// 4): of a distance less a number, and of what is displaced from one.
#include "proof/prover.h"

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
    const auto kept = tape_of(field);
    const Tape &tape = *kept;
    if (tape.too_large) return infinity;
    Machine machine(tape, ranges, true);
    machine.run(to_cell(box));
    return machine.bend();
}

namespace {

// Whether a field is the distance to a closed set, less a number: the length, or the corner form
// (tape.h), of parts that are each the distance to a set in coordinates of their own, as the
// distance to a product of sets is. The coordinates together are straight and lengthen nothing. So
// are made spheres, boxes, cylinders and tori, rounded or not.
struct Distance {
    const Tape &tape;
    const Machine &machine;
    std::vector<Row> coordinates{};

    const Instruction *made(Slot s) const {
        for (const auto *block : {&tape.each, &tape.once})
            for (const Instruction &i : *block)
                if (i.out == s && i.form != Form::Loop) return &i;
        return nullptr;
    }
    bool fixed(Slot s) const { return machine.norm(s) == 0 && machine.bend(s) == 0; }
    bool straight(Slot s) {
        if (machine.bend(s) != 0 || machine.norm(s) == infinity) return false;
        for (int c = 0; c < tape.size[s]; ++c) coordinates.push_back(machine.row(s, c));
        return true;
    }
    bool positive(Slot s) const {
        for (int c = 0; c < tape.size[s]; ++c)
            if (!(machine.value(s, c).lo >= 0)) return false;
        return fixed(s);
    }
    // x, |x| - c or length(x) - c, x straight and c >= 0; by component. Its size is the distance to
    // where it is 0, its positive part to where it is not positive.
    bool part(Slot s) {
        if (straight(s)) return true;
        const Instruction *i = made(s);
        if (!i) return false;
        if (i->form == Form::Plain && i->op == Op::Make && tape.size[s] == i->args.size())
            return std::all_of(i->args.begin(), i->args.end(), [&](Slot a) { return part(a); });
        if (i->form == Form::Plain && i->op == Op::Sub && positive(i->args[1])) {
            i = made(i->args[0]);
            if (!i) return false;
        }
        const bool size = i->form == Form::Plain && i->op == Op::Abs,
                   length = i->form == Form::Norm && i->args.size() == 1;
        return (size || length) && straight(i->args[0]);
    }
    // The number that is taken off; -infinity where it is no such distance.
    double core() {
        Slot s = tape.result;
        double less = 0;
        const Instruction *i = made(s);
        if (i && i->form == Form::Plain && (i->op == Op::Sub || i->op == Op::Add) &&
            fixed(i->args[1])) {
            const Interval by = machine.value(i->args[1], 0);
            less = i->op == Op::Sub ? by.lo : -by.hi;
            i = made(i->args[0]);
        }
        if (!i || i->args.size() != 1 || (i->form != Form::Norm && i->form != Form::Corner) ||
            !part(i->args[0]) || coordinates.size() > 16)
            return -infinity;
        const double norm = spectral_norm(coordinates.data(), int(coordinates.size()));
        return norm <= 1 + 1e-9 ? less : -infinity;
    }
};

} // namespace

double Prover::core_of_leaf(NodeId field) {
    const auto kept = tape_of(field);
    const Tape &tape = *kept;
    if (tape.too_large) return -infinity;
    Machine machine(tape, ranges, true);
    machine.run(Cell{});
    if (tape.size[tape.result] == 1 && machine.bend(tape.result) == 0 &&
        machine.norm(tape.result) < infinity)
        return infinity;
    return Distance{tape, machine}.core();
}

// c, where the raw field f has f'' <= 1/(f + c) along lines wherever f > -c: the distance to a
// closed set, less c, as the distance is the least of those to the set's points. Infinity: what is
// affine in the point, as a plane is. -infinity: unknown.
double Prover::core_of(ShapeId id, int depth) {
    if (depth > 32 || of(id).fact.local) return -infinity;
    if (const auto found = cores.find(id); found != cores.end()) return found->second;
    return cores[id] = core_made(id, depth);
}

double Prover::core_made(ShapeId id, int depth) {
    const Shape shape = scene.shapes[id];
    switch (shape.kind) {
    case ShapeKind::Leaf: return core_of_leaf(shape.args[0]);
    case ShapeKind::Library: {
        const bool exact = scene.shapes.libraries[shape.payload].has_claims &&
                           of(id).fact.kind == ir::FieldKind::Exact;
        return std::max(core_of(shape.children[0], depth + 1), exact ? 0 : -infinity);
    }
    case ShapeKind::Paint:
    case ShapeKind::Repaint:
    case ShapeKind::Mixed:
    case ShapeKind::Contract: return core_of(shape.children[0], depth + 1);
    case ShapeKind::Union: { // a least of fields bends upward as one of them does
        double least = infinity;
        for (std::size_t i = 0; i < shape.children.size(); ++i)
            least = std::min(least, core_of(shape.children[i], depth + 1));
        return shape.children.empty() ? -infinity : least;
    }
    case ShapeKind::Offset:
        if (reads_point(shape.args[0])) return -infinity;
        return down(core_of(shape.children[0], depth + 1) + number(shape.args[0]).lo);
    case ShapeKind::Map:
        if (shape.map == MapKind::Translate || shape.map == MapKind::Rotate)
            return core_of(shape.children[0], depth + 1);
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
    case ShapeKind::Instances: return -infinity;
    }
    return -infinity;
}

// M for f = g - t, g with a core c and t >= -a. Down to the depth D, where f >= -D, g + c is at
// least c - a - D, so f'' <= b + 1/(c - a - D), b the bend of t. The rule wants D >= L^2/(2M): what
// dips deeper is as long as L says. M grows with D, so there is one least D.
double Prover::curvature_of(ShapeId id, const Derived &k) {
    const Shape shape = scene.shapes[id];
    if (shape.kind == ShapeKind::Leaf || shape.kind == ShapeKind::Library)
        return !k.failed && core_of(id) == infinity ? 0 : infinity;
    if (shape.kind != ShapeKind::Displace || k.failed || k.fact.local ||
        !std::isfinite(k.fact.inward))
        return infinity;
    const double slope = k.fact.lipschitz_sup, room = core_of(shape.children[0]) - k.fact.inward;
    if (!(room > 0) || !std::isfinite(slope) || slope <= 1 + slack) return infinity;
    const double bent = bend(shape.args[0], place(id).box);
    if (!std::isfinite(bent)) return infinity;
    const auto at = [&](double depth) { return up(bent + 1 / (room - depth), 8); };
    double low = 0, high = std::isfinite(room) || bent == 0 ? room : up(slope * slope / bent, 8);
    for (int i = 0; i < 40; ++i) {
        const double depth = (low + high) / 2;
        (depth >= up(slope * slope / (2 * at(depth)), 8) ? high : low) = depth;
    }
    if (!(high < room)) return infinity;
    const double most = up(at(high) * (1 + 1e-4)); // float32
    // Of use where the reach sqrt(2f/M) is more than f/L, up to f = 2 L^2/M, on a good part of the
    // way from the range shell to the surface.
    const bool worth = 2 * slope * slope / most > 0.25 * (k.fact.outward + k.fact.inward);
    return worth ? most * options.rules[Rule::Curvature] : infinity;
}

} // namespace fathom::proof
