// What scenes read besides text: pictures (PNG, JPEG) as linear colours, grids of distances. Knows
// nothing of paths.
#pragma once

#include "ir/scene.h"

#include <optional>
#include <string>
#include <string_view>

namespace fathom::driver {

// Nothing, and why, where the bytes are no picture or hold more than 16 million pixels.
std::optional<ir::ImageData> decode_image(std::string_view bytes, std::string &error);

// A grid of distances: NRRD, three dimensions, float or double, raw or ascii, x the fastest.
std::optional<ir::GridData> decode_grid(std::string_view bytes, std::string &error);

} // namespace fathom::driver
