// A shader that shows the field itself and not a picture of it, for the viewer's analysis. It
// writes, as fathom_pick,
//   fathom_mode 4, the slice: (distance, t, 0, 1) where the ray meets the plane fathom_plane (unit
//   normal, offset), else 0; fathom_mode 5, the check of steps: (verdict, t of the march, t of the
//   check, steps), verdict 0 they agree,
//     1 the march passed a surface, 2 the march ran out of steps, 3 the check did.
// Knows nothing of materials and lights.
#pragma once

#include "backend-glsl/marcher.h"

namespace fathom::glsl {

std::string probe_text(const MarcherOptions &options);

} // namespace fathom::glsl
