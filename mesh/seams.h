// Where parts of a solid only touch: no surface that is to be drawn, though the field is 0 there and
// ranges over boxes say no more than that it may be (docs/meshes.md, 6). Between parts that stand
// beside each other lies a *gap* in the solid, of no width but for rounding. Where a part is cut away
// or left over as far as the face of another, a *sheet* of the solid is left, of no thickness: the
// solid without it is what is drawn.
#pragma once

#include "mesh/seam_samples.h"

#include <optional>

namespace fathom::mesh {

struct Seam {
    bool solid = false; // but for gaps; else it is empty but for sheets
    double width = 0;   // of these together at most, along one axis; 0: there are none
};

inline constexpr double most_thin = 32; // thin slabs: all gaps or sheets of a seam together

// Whether a box is solid but for gaps, or empty but for sheets. Slabs of it are cut up until no surface
// is in them or they are no thicker than `thin`: at right angles to an axis, or else the places where
// a number that the field's tape computes on its way, and that changes steadily over the box, lies
// between two floats. `closely`: also where up to three such planes meet, in an edge or a corner. The
// box may be flat, but is no point. `boxes` is memory.
std::optional<Seam> seam_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                            const Point &lo, const Point &hi, double thin, bool closely = false);

struct SeamSearch {
    std::optional<Seam> seam;
    std::size_t runs = 0; // of the tape over boxes
};
// The same of a box of which it is known what samples say.
SeamSearch search_seam(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                       const Extent &box, const Sighting &sighting, double thin, bool closely);

} // namespace fathom::mesh
