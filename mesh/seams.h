// Where two parts of a solid touch: no surface that is to be drawn, though the field is 0 there and
// ranges over boxes say no more than that it may be (docs/meshes.md, 6).
#pragma once

#include "mesh/field.h"

#include <optional>

namespace fathom::mesh {

// Whether a box is solid but for gaps between planes at right angles to one axis: how wide these
// gaps are together at most, in the scene's units; 0 where no float in the box has a positive field.
// None where nothing of that kind is found. Slabs of the box are cut up until they are solid or no
// thicker than `thin`; the gaps are at most 8 of these together. The box may be flat, but is no point.
// `boxes` is memory.
std::optional<double> seam_in(Evaluator &evaluator, const cpu::ShortTape &tape, cpu::Boxes &boxes,
                              const Point &lo, const Point &hi, double thin);

} // namespace fathom::mesh
