// Where the solid of a field that nobody stated a box for can lie, from the values that the field
// takes: whatever half-space has only values above 0, as intervals, holds nothing of it.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>

namespace fathom::proof {

using ir::Shape;
using ir::ShapeId;
using ir::ShapeKind;
using ir::rounding::infinity;

namespace {

// Places where a side of the box may be: from -2^12 to 2^12, sixteen to the doubling, so that a box
// is at most a twentieth too large; 0 for what is smaller than 2^-8.
constexpr int octaves = 20, places_each = 16, places_most = octaves * places_each;
double place_at(int i) { // -places_most <= i <= places_most
    if (i == 0) return 0;
    const double size = std::exp2(std::abs(i) / double(places_each) - 8);
    return i < 0 ? -size : size;
}

constexpr std::size_t most_asked = 200;

} // namespace

// Sides in turn, each with what the others have cut off already, and twice over: in a box that is
// bounded on one side the next may be easier to find. A half-space in which the field is above 0
// stays so as it gets smaller, so the side is found by halving.
Box Prover::extent(ShapeId id) {
    const int dims = scene.shapes[id].dims;
    Box box = Box::everything();
    if (dims == 2) box.lo[2] = box.hi[2] = 0;
    const std::size_t before = work.left;
    if (values(id, to_cell(box)).lo > 0) return box; // no solid at all: nothing to look for
    // A search asks for about a hundred values, and may not take what the proof needs.
    if ((before - work.left) > work.left / most_asked) return box;
    for (int round = 0; round < 2; ++round) {
        const Box before = box;
        for (std::size_t axis = 0; axis < std::size_t(dims); ++axis)
            for (const bool upper : {true, false}) {
                const auto empty_beyond = [&](int i) {
                    Box beyond = box;
                    const double side = upper ? place_at(i) : -place_at(i);
                    (upper ? beyond.lo : beyond.hi)[axis] = side;
                    if (beyond.lo[axis] > beyond.hi[axis]) return true;
                    return values(id, to_cell(beyond)).lo > 0;
                };
                int good = places_most, bad = -places_most;
                if (!empty_beyond(good)) continue;
                while (good - bad > 1) {
                    const int middle = (good + bad) / 2;
                    (empty_beyond(middle) ? good : bad) = middle;
                }
                const double side = upper ? place_at(good) : -place_at(good);
                if (upper)
                    box.hi[axis] = std::min(box.hi[axis], side);
                else
                    box.lo[axis] = std::max(box.lo[axis], side);
            }
        if (box.lo == before.lo && box.hi == before.hi) break;
    }
    return box.empty() ? Box::everything() : box;
}

// A box for a field of one's own, and for what offsets, displacements and blends make of shapes
// whose growth is unknown, while they themselves are bounded.
void Prover::find_extent(ShapeId id, Derived &k) {
    const Shape &shape = scene.shapes[id];
    if (k.failed || k.fact.bounds.finite() || !place(id).reported) return;
    const bool grows = shape.kind == ShapeKind::Offset || shape.kind == ShapeKind::Shell ||
                       shape.kind == ShapeKind::Displace || shape.kind == ShapeKind::Blend;
    if (!grows && shape.kind != ShapeKind::Leaf) return;
    if (grows && std::none_of(shape.children.begin(), shape.children.end(), [&](ShapeId c) {
            return of(c).fact.bounds.finite() && !std::isfinite(of(c).growth_rate);
        }))
        return;
    const Box found = extent(id);
    const Box cut = ir::intersect(k.fact.bounds, found);
    if (cut.empty() || holds(cut, k.fact.bounds)) return;
    k.fact.bounds = cut;
    k.growth_rate = infinity;
}

} // namespace fathom::proof
