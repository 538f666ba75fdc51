// What pictures by the CPU and by OpenGL have in common.
#pragma once

#include "api/impl.h"
#include "ir/view.h"

namespace fathom::v1 {

double aspect_of(const PictureOptions &options); // width / height
// The scene's own view at a time, in seconds, gone around what it looks at by `turned`.
ir::View view_of(const ir::Scene &scene, const PictureOptions &options, double time);

} // namespace fathom::v1
