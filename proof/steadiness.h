// Numbers that are the same at all points of a cell in single precision, too: what is made of counts, of
// truths and of what does not vary. `p - 0.7 * fract(p / 0.7)` is none, though it has no slope: rounding
// makes other numbers of it from point to point, which a hash tells apart, and a step at its border.
#pragma once

#include "proof/tape.h"

namespace fathom::proof {

// Sets Instruction::wavers: reads an instruction what varies with the point other than by steps?
void mark_wavering(Tape &tape);

} // namespace fathom::proof
