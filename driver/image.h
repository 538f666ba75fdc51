// Picture files: PNG out, PNG and JPEG in (as linear colours). Knows nothing of scenes or of paths.
#pragma once

#include "ir/scene.h"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace fathom::driver {

// Rows from the top, three bytes a pixel, sRGB.
std::string encode_png(int width, int height, const std::vector<std::uint8_t> &rgb);

// Nothing, and why, where the bytes are no picture or hold more than 16 million pixels.
std::optional<ir::ImageData> decode_image(std::string_view bytes, std::string &error);

// A grid of distances: NRRD, three dimensions, float or double, raw or ascii, x the fastest.
std::optional<ir::GridData> decode_grid(std::string_view bytes, std::string &error);

} // namespace fathom::driver
