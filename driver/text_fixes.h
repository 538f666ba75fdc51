// Edits for what the proof refuses: the proof knows expressions, and the edit wants the text.
#pragma once

#include "base/diagnostic.h"
#include "base/source.h"

namespace fathom::driver {

// Adds the edits that are sure to the proof's answers:
// - the inside of an ellipsoid of one's own, `k0 * (k0 - 1) / k1`, apart from its outside;
// - an `if` that only spares work, left out;
// - a region for a field that is evaluated `everywhere`;
// - `estimate: 1` for a function that is named as a fractal's estimate of the distance.
void add_text_fixes(const Sources &sources, Diagnostics &diagnostics);

} // namespace fathom::driver
