// Whether a mesh has the shape of the solid that it was made of: as many pieces, and handles
// (docs/meshes.md, 13).
#pragma once

#include "mesh/certify.h"

namespace fathom::mesh {

// Of a certificate's mesh: says whether its pieces and handles are proved to be those of the solid's
// surface, and else in how many places that is open. Not looked for where that takes more than so many
// kernels over boxes, about. Where there is an earlier certificate, only what has changed since is
// looked at again.
inline constexpr double shape_work = 0.3e6;
// Where it is open in more leaves the shape stays open: no others are looked at.
inline constexpr std::size_t few_open_leaves = 128;
void prove_shape(const Field &field, const Settings &settings, const Made &made, Progress &progress,
                 Certificate &certificate, const Earlier *earlier = nullptr,
                 double work = shape_work);

} // namespace fathom::mesh
