// What can be enclosed of a drawing, a solid that does not change along z about z = 0: by the walk that
// measures solids, in boxes that are divided across x and y alone (docs/measure.md, 5).
#pragma once

#include "mesh/section.h"

namespace fathom::mesh {

struct FlatMeasures {
    Failure failure = Failure::None;
    Enclosure area;
    Enclosure perimeter;         // without an upper end where there are
    std::size_t open_places = 0; // … boxes of which none is known,
    std::array<double, 2> open_place{};
    std::array<Enclosure, 2> center;
    std::array<Enclosure, 2> least, greatest; // the ends of the drawing's box
    bool used_bound = false;
};

// `thick`: from z = -thick to thick nothing changes along z.
FlatMeasures measure_flat(const Cut &cut, double thick, unsigned threads, Progress &progress,
                          const MeasureEffort &effort = {});

// What contours measure.
struct ContourSums {
    double area = 0, perimeter = 0;
    std::array<double, 2> center{};
    Rectangle box;
    std::size_t outlines = 0, holes = 0;
};
ContourSums sums_of(const Contours &contours);

} // namespace fathom::mesh
