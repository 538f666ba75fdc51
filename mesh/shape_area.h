// What the surface and the solid measure in boxes in which the field is shown to rise along a direction
// (docs/meshes.md, 13; docs/measure.md, 1 and 2).
#pragma once

#include "mesh/walk.h"

#include <optional>
#include <span>

namespace fathom::mesh {

// A box in which the field rises along a direction, so fast at least: how it changes there.
struct SteadyBox {
    Linear linear;
    Slant slant;
};
SteadyBox steady_box(const Linear &linear, const Real3 &along, double least);

double whole_of(const Block &box); // its own volume

// The area of the surface in some boxes, and the volume of what of them is solid.
struct ShapeSums {
    Enclosure area, volume;
    double whole = 0; // the boxes' own volume
    int looks = 0;    // more at the tape, that this took
    void add(const ShapeSums &other);
};
// In parts of such a box, by the field's values at their middles. The tape holds in all of them.
// `closely`: where the surface may lie along the direction, all but, it is looked at part by part.
ShapeSums sums_in_parts(Splitter &splitter, const cpu::ShortTape &tape, const SteadyBox &box,
                        std::span<const Block> parts, bool closely);

} // namespace fathom::mesh
