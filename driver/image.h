// What scenes read besides text: pictures (PNG, JPEG) as linear colours, grids of distances; and
// pictures as JPEG files. Knows nothing of paths.
#pragma once

#include "ir/scene.h"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

namespace fathom::driver {

// Nothing, and why, where the bytes are no picture or hold more than 16 million pixels.
std::optional<ir::ImageData> decode_image(std::string_view bytes, std::string &error);

// A whole JPEG file of rows from the top, RGBA, sRGB-encoded; of a quality from 1 to 100 in
// libjpeg's scale, with colours as fine as lightness. Empty where there are no pixels, or more of
// them than JPEG allows.
std::string encode_jpeg(int width, int height, std::span<const std::uint8_t> rgba, int quality);

// A grid of distances: NRRD, three dimensions, float or double, raw or ascii, x the fastest.
std::optional<ir::GridData> decode_grid(std::string_view bytes, std::string &error);

} // namespace fathom::driver
