// Parts that their own region cuts away wholly: the solid lies elsewhere, by the values that the
// field takes in the region, whatever the params in their ranges and the time are.
#include "proof/prover.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace fathom::proof {

using ir::Shape;
using ir::ShapeId;

// Whether the field is above 0 in all of a region.
bool Prover::leaves_nothing(ShapeId id, const Zone &zone, int dims) {
    constexpr int most_cells = 64;
    std::vector<Cell> todo{outer_box(zone)};
    if (dims == 2) todo[0].p[2] = Interval(0.0);
    for (const Interval &side : todo[0].p)
        if (!side.finite()) return false;
    for (int looked = 0; !todo.empty(); ++looked) {
        if (looked == most_cells) return false;
        const Cell cell = todo.back();
        todo.pop_back();
        if (misses(zone, cell)) continue;
        const Interval found = values(id, cell);
        if (found.lo > 0) continue;
        if (found.hi <= 0 || !std::isfinite(found.lo)) return false;
        Cell middle = cell;
        std::size_t widest = 0;
        for (std::size_t i = 0; i < 3; ++i) {
            middle.p[i] = Interval(cell.p[i].middle());
            if (cell.p[i].width() > cell.p[widest].width()) widest = i;
        }
        if (!misses(zone, middle) && values(id, middle).lo <= 0) return false;
        for (const bool upper : {false, true}) {
            Cell half = cell;
            const double at = cell.p[widest].middle();
            half.p[widest] =
                upper ? Interval(at, cell.p[widest].hi) : Interval(cell.p[widest].lo, at);
            todo.push_back(half);
        }
    }
    return true;
}

void Prover::tell_cut_away(ShapeId id) {
    const Shape shape = scene.shapes[id];
    const Zone zone = zone_of(scene.shapes.regions[shape.payload]);
    if (!place(id).reported || !leaves_nothing(shape.children[0], zone, shape.dims)) return;
    Diagnostic *d =
        report(id, Code::CutAway, "nothing of this shape is left: its region holds none of it");
    if (!d) return;
    const Box box = extent(shape.children[0]);
    if (!box.finite()) {
        d->note("a field's solid is where it is below 0, and in the region this one is above")
            .help("choose a region where the shape is, or turn the field's sign");
        return;
    }
    double far = 0;
    for (std::size_t i = 0; i < 3; ++i)
        far += std::pow(std::max(std::fabs(box.lo[i]), std::fabs(box.hi[i])), 2);
    d->note(fmt::format("the shape lies between {} and {}", point_text(box.lo, shape.dims),
                        point_text(box.hi, shape.dims)))
        .help(fmt::format("choose a region that holds it, as `ball({})`",
                          number_text(std::ceil(10 * std::sqrt(far)) / 10)));
}

} // namespace fathom::proof
