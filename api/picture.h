// What pictures by the CPU and by OpenGL have in common.
#pragma once

#include "api/impl.h"
#include "ir/view.h"

namespace fathom::v1 {

// Why there is no picture with such options; empty where there is one.
std::string refused(const Facts &facts, const PictureOptions &options);
Picture without_picture(std::string why);
double aspect_of(const PictureOptions &options); // width / height
// The scene's own view at a time, in seconds, gone around what it looks at by `turned`.
ir::View view_of(const ir::Scene &scene, const PictureOptions &options, double time);

} // namespace fathom::v1
